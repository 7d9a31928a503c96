//! A link to the node under test, which may also switch its power.

use std::borrow::BorrowMut;
use std::process::Command;

use od_sim::bus::Bus;

use super::pulse::Pulse;
use crate::bench::OnBench;
use crate::error::Error;
use crate::link::{Heard, Link};
use od_wire::{Frame, Instant};

/// A link to the node under test, with its power supply.
pub trait Rig: Link {
    /// Returns whether [`power`](Self::power) switches the supply.
    fn has_power(&self) -> bool {
        false
    }

    /// Switches the supply of the node.
    ///
    /// # Errors
    /// The command fails.
    fn power(&mut self, _on: bool) -> Result<(), Error> {
        Ok(())
    }

    /// Longest delay of an observation, in microseconds; 0 in virtual time.
    fn slack(&self) -> u64 {
        0
    }

    /// Longest delay with which this computer resumed a waiting program since the last call, in microseconds; 0 in virtual time.
    fn host_late(&self) -> u64 {
        0
    }
}

impl<B: BorrowMut<Bus>> Rig for OnBench<B> {
    fn has_power(&self) -> bool {
        true
    }

    fn power(&mut self, on: bool) -> Result<(), Error> {
        self.0.borrow_mut().set_power(0, on);
        Ok(())
    }
}

/// A real bus, with a command that switches the power of the node.
pub struct RealBus {
    /// The link.
    pub link: Box<dyn Link>,
    /// A command line; `on` or `off` is appended to it. `None`: the power is not switched.
    pub power: Option<String>,
    /// Measures how busy this computer is. `None` for a link with virtual time.
    pub pulse: Option<Pulse>,
}

impl Link for RealBus {
    fn now(&self) -> Instant {
        self.link.now()
    }

    fn send(&mut self, frame: &Frame) -> Result<(), Error> {
        self.link.send(frame)
    }

    fn receive(&mut self, until: Instant) -> Result<Option<Heard>, Error> {
        self.link.receive(until)
    }

    fn resume(&mut self) {
        self.link.resume();
    }
}

impl Rig for RealBus {
    fn has_power(&self) -> bool {
        self.power.is_some()
    }

    fn power(&mut self, on: bool) -> Result<(), Error> {
        let Some(command) = &self.power else {
            return Ok(());
        };
        let line = format!("{command} {}", if on { "on" } else { "off" });
        let (shell, flag) = if cfg!(windows) {
            ("cmd", "/C")
        } else {
            ("sh", "-c")
        };
        let fail = |why: String| Error::Usage(format!("`{line}`: {why}"));
        let status = Command::new(shell).args([flag, &line]).status();
        match status {
            Ok(status) if status.success() => Ok(()),
            Ok(status) => Err(fail(status.to_string())),
            Err(error) => Err(fail(error.to_string())),
        }
    }

    fn slack(&self) -> u64 {
        10_000
    }

    fn host_late(&self) -> u64 {
        self.pulse.as_ref().map_or(0, Pulse::take)
    }
}
