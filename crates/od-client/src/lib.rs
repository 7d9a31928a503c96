//! Client side of a CANopen bus: SDO client, NMT commands, heartbeat and EMCY consumers, LSS
//! master, PDO decoding.
//!
//! Sans-io like the node in `od-runtime`: time and frames are arguments, and this crate reads no
//! clock and no bus. [`Client`] (feature `alloc`, on by default) serves all
//! nodes of a bus; [`sdo::Upload`], [`sdo::Download`], [`lss::Master`] and [`watch::Watch`] are
//! its parts, for a microcontroller without an allocator.
//!
//! ```
//! use od_client::{Client, Event, Frame, Instant, NodeId};
//! use od_model::Address;
//! # #[cfg(feature = "alloc")] {
//! # struct Bus(Option<Frame>);
//! # impl Bus {
//! #     fn send(&mut self, frame: &Frame) {
//! #         assert_eq!(frame.to_string(), "601#4000100000000000");
//! #         self.0 = Some(Frame::standard(0x581, &[0x43, 0x00, 0x10, 0x00, 0x96, 0x01, 0x02, 0x00]));
//! #     }
//! #     fn receive_until(&mut self, _: Option<Instant>) -> Option<Frame> { self.0.take() }
//! # }
//! # let mut bus = Bus(None);
//! # let clock = || Instant::ZERO;
//! let mut client = Client::new();
//! let job = client.read(NodeId::ONE, Address::new(0x1000, 0));
//! let value = loop {
//!     // 1. Send what waits.
//!     while let Some(frame) = client.poll_transmit(clock()) {
//!         bus.send(&frame);
//!     }
//!     // 2. Handle events.
//!     match client.poll_event() {
//!         Some(Event::Read(done, result)) if done == job => break result,
//!         Some(_) => continue,
//!         None => {}
//!     }
//!     // 3. Wait for a frame, or for the next deadline.
//!     match bus.receive_until(client.poll_timeout()) {
//!         Some(frame) => client.handle_frame(clock(), &frame),
//!         None => client.handle_timeout(clock()),
//!     }
//! };
//! assert_eq!(value, Ok(vec![0x96, 0x01, 0x02, 0x00]));
//! # }
//! ```
#![no_std]
#![forbid(unsafe_code)]
#![cfg_attr(docsrs, feature(doc_cfg))]

#[cfg(feature = "alloc")]
extern crate alloc;
#[cfg(test)]
extern crate std;

#[cfg(feature = "alloc")]
mod client;
pub mod emcy;
mod error;
pub mod lss;
pub mod nmt;
pub mod pdo;
pub mod sdo;
pub mod watch;

#[cfg(feature = "alloc")]
pub use client::{Client, Event, Job};
pub use error::Error;
pub use od_wire::{AbortCode, CanId, Duration, Frame, Instant, NodeId};

/// The example in the README is a test, too.
#[cfg(all(doctest, feature = "alloc"))]
#[doc = include_str!("../README.md")]
pub struct Readme;
