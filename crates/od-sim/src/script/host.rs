//! Interface of a script to the program that runs it.

use od_model::Refused;
use std::format;
use std::prelude::v1::*;

use od_runtime::{DeviceKind, Frame, Instant, NodeId};

use super::limits::Limits;
use crate::bus::Bus;
use crate::device::VirtualDevice;

/// Sender of a frame.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Origin {
    /// The script.
    Script,
    /// A device, counted from 0 in the order of the `device` lines.
    Device(usize),
}

impl Origin {
    /// Sender of a frame that the bus reports.
    pub(crate) fn of(device: Option<usize>) -> Self {
        device.map_or(Self::Script, Self::Device)
    }
}

/// Interface of a script to the program that runs it.
///
/// A host that wraps another one returns it from `inner`, and defines only what it changes.
pub trait Host {
    /// The host that this one wraps. It gets each call that this one does not define.
    fn inner(&mut self) -> Option<&mut dyn Host> {
        None
    }

    /// Makes the device of a `device` line: by the name of a built-in one, or of an EDS file.
    /// Without a name, the default device of scripts.
    ///
    /// # Errors
    /// The reason why the device does not exist, and what to do.
    fn device(
        &mut self,
        name: Option<&str>,
        node_id: Option<NodeId>,
    ) -> Result<VirtualDevice, Refused> {
        match self.inner() {
            Some(host) => host.device(name, node_id),
            None => Err("this program makes no devices; remove the line".into()),
        }
    }

    /// The limits of a script; `None`: no limits.
    fn limits(&mut self) -> Option<Limits> {
        self.inner()?.limits()
    }

    /// Returns whether a line of a script is done only when the responses to its frames are through.
    fn waits_for_responses(&mut self) -> bool {
        self.inner().is_some_and(Host::waits_for_responses)
    }

    /// The seed of the draws of `random` lines; without a host that has one: 0.
    fn seed(&mut self) -> u64 {
        self.inner().map_or(0, Host::seed)
    }

    /// Returns whether the run has to end now, as after Ctrl-C. A run asks often.
    fn stops(&mut self) -> bool {
        self.inner().is_some_and(Host::stops)
    }

    /// Called before a line acts on the bench: it sends, or changes a device or the bus line.
    fn act(&mut self) {
        if let Some(host) = self.inner() {
            host.act();
        }
    }

    /// Called for each frame on the bus.
    fn frame(&mut self, at: Instant, origin: Origin, frame: &Frame) {
        if let Some(host) = self.inner() {
            host.frame(at, origin, frame);
        }
    }

    /// Called after a frame or a line, with the bench after it.
    fn look(&mut self, bus: &mut Bus) {
        if let Some(host) = self.inner() {
            host.look(bus);
        }
    }
}

/// A host that passes frames to a function; another host makes its devices.
pub(crate) struct Recorder<'a, F> {
    pub(crate) host: &'a mut dyn Host,
    pub(crate) record: F,
}

impl<F: FnMut(Instant, Origin, Frame)> Host for Recorder<'_, F> {
    fn inner(&mut self) -> Option<&mut dyn Host> {
        Some(self.host)
    }

    fn frame(&mut self, at: Instant, origin: Origin, frame: &Frame) {
        (self.record)(at, origin, *frame);
    }
}

/// A host with limits, for scripts from other people.
pub struct Limited<'a>(
    /// The host that makes the devices.
    pub &'a mut dyn Host,
    /// The limits.
    pub Limits,
);

impl Host for Limited<'_> {
    fn inner(&mut self) -> Option<&mut dyn Host> {
        Some(self.0)
    }

    fn limits(&mut self) -> Option<Limits> {
        Some(self.1)
    }
}

/// A host with these devices and without other functions.
#[derive(Clone, Copy, Debug)]
pub struct Bare(
    /// The named devices; the first is the default device of scripts.
    pub &'static [DeviceKind],
);

impl Host for Bare {
    fn device(
        &mut self,
        name: Option<&str>,
        node_id: Option<NodeId>,
    ) -> Result<VirtualDevice, Refused> {
        let kind = match name {
            Some(name) => self
                .0
                .iter()
                .find(|kind| kind.name.eq_ignore_ascii_case(name)),
            None => self.0.first(),
        };
        let name = name.unwrap_or_default();
        match kind {
            Some(kind) => Ok(VirtualDevice::new(kind, node_id.unwrap_or(NodeId::ONE))),
            None => {
                let names: Vec<_> = self.0.iter().map(|kind| kind.name).collect();
                Err(format!("device `{name}` does not exist; write {}", names.join(", ")).into())
            }
        }
    }
}
