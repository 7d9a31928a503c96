//! Protocols of adapters and daemons: they convert frames to bytes and back.
//!
//! | module | protocol of |
//! |---|---|
//! | `address` | the values of `--link`; feature `serve` |
//! | [`adapter`] | the client side of slcan |
//! | [`slcan`] | serial adapters, `slcand`, python-can's `slcan` |
//! | [`socketcand`] | the daemon of that name, python-can's `socketcand`, Kayak |
//! | `web_socket` | slcan in a WebSocket, for pages; feature `serve` |
//! | [`can_frame`] | a raw socket of Linux |
//! | [`lines`] | standard input and output of `odkit sim --link -` |

pub mod adapter;
#[cfg(feature = "serve")]
pub mod address;
pub mod can_frame;
pub mod codec;
pub mod lines;
pub mod slcan;
pub mod socketcand;
#[cfg(feature = "serve")]
pub mod web_socket;

pub use codec::{Codec, Step};
