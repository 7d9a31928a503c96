//! The bus-cover family as in manual 000, device by device and frame by frame.

mod bench;
mod models;
mod objects;
mod position;
mod storage;
mod trace;
mod writes;
