//! The bus-cover family as manual 000 has it, device by device and frame by frame.

mod bench;
mod models;
mod objects;
mod position;
mod storage;
mod trace;
mod writes;
