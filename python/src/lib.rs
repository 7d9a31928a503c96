//! The Python package `odkit`: a CAN bus with CANopen devices in it, in virtual time.
//!
//! `wire` is a bus with its devices and listeners; `party` and `pass` decide which thread moves its
//! time. The classes above it are one file each. `files/` is about device descriptions,
//! `client/` is the other end of a bus.

#![forbid(unsafe_op_in_unsafe_fn)]

mod bench;
mod client;
mod cyclic;
mod device;
mod diagnose;
mod expect;
mod faults;
mod files;
mod filter;
mod journal;
mod party;
mod pass;
mod play;
mod port;
mod registry;
mod snapshot;
mod spec;
mod state;
mod story;
mod time;
mod value;
mod waits;
mod wire;

use pyo3::prelude::*;

/// The compiled part of `odkit`.
///
/// It needs the interpreter's lock: a free-threaded build of Python turns it on when it imports this module.
#[pymodule(gil_used = true)]
mod _odkit {
    #[pymodule_export]
    use crate::bench::Bench;
    #[pymodule_export]
    use crate::client::calls::Client;
    #[pymodule_export]
    use crate::client::conform::{Conform, Record, conform_cases};
    #[pymodule_export]
    use crate::client::errors::{NodeError, SdoAbort};
    #[pymodule_export]
    use crate::client::heard::{Emcy, Found, Pdo};
    #[pymodule_export]
    use crate::client::node::Node;
    #[pymodule_export]
    use crate::device::Device;
    #[pymodule_export]
    use crate::diagnose::Incident;
    #[pymodule_export]
    use crate::files::canopen::to_canopen;
    #[pymodule_export]
    use crate::files::convert::convert;
    #[pymodule_export]
    use crate::files::description::{Description, overlay, read, restore_description};
    #[pymodule_export]
    use crate::files::diff::{Difference, diff};
    #[pymodule_export]
    use crate::files::entry::Entry;
    #[pymodule_export]
    use crate::files::finding::Finding;
    #[pymodule_export]
    use crate::files::fix::{Fixed, check, fix};
    #[pymodule_export]
    use crate::files::identity::Identity;
    #[pymodule_export]
    use crate::files::object::Object;
    #[pymodule_export]
    use crate::files::value::Relative;
    #[pymodule_export]
    use crate::party::end_program;
    #[pymodule_export]
    use crate::play::{play, restore_snapshot, shrink};
    #[pymodule_export]
    use crate::port::Port;
    #[pymodule_export]
    use crate::registry::wires;
    #[pymodule_export]
    use crate::snapshot::Snapshot;
    #[pymodule_export]
    use crate::spec::devices;
    #[pymodule_export]
    use crate::waits::{Child, Waiting, moment, patch, takes_part, wake};
}
