//! A CANopen node on a board: what a firmware needs besides the node itself. Devices use it as
//! `odkit::board`.
//!
//! A [`Node`](od_runtime::Node) owns its values, application and storage, and can be a `static`.
//!
//! - [`Port`] connects it to a CAN controller with the traits of `embedded-can`, nb or blocking.
//! - `Shared` (feature `embassy`) is a node for several tasks, with the task that runs it. `Watch`
//!   detects bus-off if the driver of the CAN controller does not report it.
//! - [`Filters`] are the acceptance filters for the CAN-IDs that the node listens to.
//! - [`storage`] stores saved values on NOR flash, in the background or at once (feature `flash`).
//! - [`Clock`] is the time of a counter of at most 32 bits that wraps.
//! - Feature `defmt`: formats for frames, states, abort codes and events.
//!
//! # A loop
//!
//! The CAN controller is any driver with the traits of `embedded-can`, the timer any counter.
//!
//! ```
//! use odkit::board::{Clock, Filters, Owner, Port};
//! use odkit::storage::NoStorage;
//! use odkit::{Application, Node, NodeId};
//!
//! odkit::object_dictionary! {
//!     /// A thermometer that sends its temperature when it changes.
//!     mod thermometer {
//!         without lss, storage;
//!         add 0x1000 { name = "Device type"; type = u32; access = const; default = 0 }
//!         add 0x1001 { name = "Error register"; type = u8 }
//!         add 0x1018 { code = record; name = "Identity object" }
//!         add 0x1018sub1 { name = "Vendor-ID"; type = u32; default = 0x5F }
//!         add 0x1800 { code = record; name = "TPDO communication parameter 1" }
//!         add 0x1800sub1 { name = "COB-ID"; type = u32; access = rw; default = $NODEID + 0x180 }
//!         add 0x1800sub2 { name = "Transmission type"; type = u8; access = rw; default = 254 }
//!         add 0x1A00 { code = record; name = "TPDO mapping parameter 1" }
//!         add 0x1A00sub1 { name = "Entry 1"; type = u32; access = rw; default = 0x2000_0010 }
//!         add 0x2000 { name = "Temperature"; type = i16; mappable = true; default = 0 }
//!         rename 0x2000 = TEMPERATURE;
//!     }
//! }
//!
//! struct Heater;
//! impl Application for Heater {}
//!
//! fn run<C>(can: &mut C, timer: impl Fn() -> u32, sensor: impl Fn() -> i16) -> Result<(), C::Error>
//! where
//!     C: embedded_can::nb::Can,
//! {
//!     let (mut clock, mut port) = (Clock::<1_000_000>::new(), Port::new());
//!     let mut node = Node::new(thermometer::Device, NodeId::ONE, Heater, NoStorage);
//!     node.power_on(clock.at(timer()));
//!     loop {
//!         let now = clock.at(timer());
//!         port.serve_nb(&mut node, can, now)?;
//!         node.set(now, thermometer::TEMPERATURE, sensor());
//!         let mut filters = Filters::<14>::default();
//!         node.poll_wanted_ids().into_iter().flatten().for_each(|id| filters.add(id));
//!         // … set the filters of the controller if there are any, and sleep until an interrupt
//!         # if now.as_micros() > u64::from(u32::MAX) + 3000 { return Ok(()) }
//!     }
//! }
//! # // A controller with a master behind it.
//! # #[derive(Default)]
//! # struct Can(Vec<String>, bool);
//! # #[derive(Debug)] struct Never;
//! # impl embedded_can::Error for Never {
//! #     fn kind(&self) -> embedded_can::ErrorKind { embedded_can::ErrorKind::Other }
//! # }
//! # impl embedded_can::nb::Can for Can {
//! #     type Frame = odkit::Frame;
//! #     type Error = Never;
//! #     fn transmit(&mut self, frame: &odkit::Frame) -> nb::Result<Option<odkit::Frame>, Never> {
//! #         self.0.push(frame.to_string());
//! #         Ok(None)
//! #     }
//! #     fn receive(&mut self) -> nb::Result<odkit::Frame, Never> {
//! #         if std::mem::replace(&mut self.1, true) { return Err(nb::Error::WouldBlock) }
//! #         Ok(odkit::Frame::standard(0, &[1, 0]))
//! #     }
//! # }
//! # let time = std::cell::Cell::new(u32::MAX - 1000);
//! # let mut can = Can::default();
//! # run(&mut can, || { time.set(time.get().wrapping_add(500)); time.get() }, || 21).unwrap();
//! # assert_eq!(can.0, ["701#00", "181#0000", "181#1500"]);
//! ```
//!
//! # RTIC
//!
//! The interrupt of the CAN controller handles frames, and a task of low priority writes flash;
//! both use the node. `firmware/rtic` is a complete program; these are its two tasks:
//!
//! ```text
//! #[task(binds = GPIOA, priority = 2, shared = [node, can], local = [port, clock])]
//! fn frames(cx: frames::Context) {
//!     let now = cx.local.clock.at(ticks());
//!     (cx.shared.node, cx.shared.can).lock(|node, can| cx.local.port.serve_nb(node, can, now));
//! }
//!
//! #[task(priority = 1, shared = [node], local = [log])]
//! async fn keep(mut cx: keep::Context) {
//!     cx.local.log.run(|act| cx.shared.node.lock(|node| act(&mut node.storage))).await;
//! }
//! ```
//!
//! The interrupt sends one frame of a block transfer at a time. While flash is erased or written
//! nothing locks the node, so it responds to a SYNC at once. A frame waits at most as long as the
//! longest call of the node takes: a save copies the values and returns, as `firmware/rtic`
//! measures.
#![cfg_attr(
    all(feature = "embassy", feature = "flash"),
    doc = r#"
# embassy

One task runs the node, one keeps what it saves, and any other changes values; a change is on the bus at
once. A half of a controller is a few lines: here is the receiving one of any driver with `embedded-can` frames.

```
use embassy_sync::blocking_mutex::raw::CriticalSectionRawMutex;
use odkit::board::storage::{Log, Mirror, Steps};
use odkit::board::{Receive, Shared, Transmit};
use odkit::storage::image::capacity_needed;
use odkit::{BusEvent, Frame, NoApplication, NodeId};

odkit::object_dictionary! {
    mod thermometer {
        without lss;
        add 0x1000 { name = "Device type"; type = u32; access = const; default = 0 }
        add 0x1001 { name = "Error register"; type = u8 }
        add 0x1010 { code = array; name = "Store parameters" }
        add 0x1010sub1 { name = "Save all parameters"; type = u32; access = rw; default = 1 }
        add 0x1017 { name = "Producer heartbeat time"; type = u16; access = rw; default = 1000 }
        add 0x1018 { code = record; name = "Identity object" }
        add 0x1018sub1 { name = "Vendor-ID"; type = u32; default = 0x5F }
        add 0x2000 { name = "Temperature"; type = i16; mappable = true; default = 0 }
        rename 0x2000 = TEMPERATURE;
    }
}

const SAVED: usize = capacity_needed(&thermometer::DICTIONARY);
type Saved = Mirror<SAVED, { thermometer::STORE_LEN }>;
type Node = thermometer::Node<NoApplication, Saved>;

static NODE: Shared<CriticalSectionRawMutex, Node> = Shared::new(Node::new(
    thermometer::Device,
    NodeId::ONE,
    NoApplication,
    Saved::new(&thermometer::DICTIONARY),
));

struct Rx<D>(D);
# trait Driver { type Frame: embedded_can::Frame; async fn read(&mut self) -> Result<Self::Frame, ()>; }

impl<D: Driver> Receive for Rx<D> {
    async fn receive(&mut self) -> Result<Frame, BusEvent> {
        let frame = self.0.read().await.map_err(|_| BusEvent::Warning)?;
        Ok(Frame::from_can(&frame).unwrap_or(Frame::standard(0x7FF, &[])))
    }
}

async fn run(mut rx: impl Receive, mut tx: impl Transmit) {
    NODE.run(&mut rx, &mut tx).await;
}

async fn keep<F: embedded_storage::nor_flash::NorFlash>(flash: F) {
    let mut log = Log::<_, { SAVED / 2 + 64 }>::new(Steps(flash), 0x1_E000..0x2_0000);
    let mut saved = Saved::new(&thermometer::DICTIONARY);
    log.load(&mut saved).await.ok();
    NODE.with(|node, now| {
        node.storage = saved;
        node.power_on(now);
    });
    log.run(|act| NODE.with(|node, _| act(&mut node.storage))).await;
}

fn measured(temperature: i16) {
    NODE.with(|node, now| node.set(now, thermometer::TEMPERATURE, temperature));
}
```
"#
)]
#![no_std]
#![forbid(unsafe_code)]
#![cfg_attr(docsrs, feature(doc_cfg))]

mod clock;
mod filters;
mod owner;
mod port;
#[cfg(feature = "embassy")]
mod shared;
pub mod storage;
#[cfg(feature = "embassy")]
mod watch;

pub use clock::Clock;
pub use filters::{Filter, Filters};
pub use owner::Owner;
pub use port::Port;
#[cfg(feature = "embassy")]
pub use shared::{Receive, Shared, Transmit};
#[cfg(feature = "embassy")]
pub use watch::Watch;

pub use od_wire as wire;
