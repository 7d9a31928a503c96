//! The client from outside: frames in, frames out. It is one program, since one program links
//! faster than several.

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
