//! The client from outside: frames in, frames out. One program, as linking one is quicker.

mod client;
mod fastscan;
mod lss;
mod pdo;
mod random;
mod sdo_block_download;
mod sdo_block_upload;
mod sdo_download;
mod sdo_node;
mod sdo_upload;
mod support;
mod texts;
mod watch;
