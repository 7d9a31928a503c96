//! Formats for `defmt`: the same text as `Display`, made on the host.

use defmt::{Format, Formatter, write};

use crate::frame::{CanId, Frame};
use crate::ids::{CobId, NodeId};
use crate::time::Instant;

impl Format for CanId {
    fn format(&self, f: Formatter<'_>) {
        match self.as_standard() {
            Some(raw) => write!(f, "{=u16:03X}", raw),
            None => write!(f, "{=u32:08X}", self.raw()),
        }
    }
}

impl Format for Frame {
    fn format(&self, f: Formatter<'_>) {
        if self.is_remote() {
            write!(f, "{}#R{=u8}", self.id(), self.dlc())
        } else {
            write!(f, "{}#{=[u8]:02X}", self.id(), self.data())
        }
    }
}

impl Format for NodeId {
    fn format(&self, f: Formatter<'_>) {
        write!(f, "{=u8}", self.raw());
    }
}

impl Format for CobId {
    fn format(&self, f: Formatter<'_>) {
        write!(f, "{=u32:08X}h", self.raw());
    }
}

impl Format for Instant {
    fn format(&self, f: Formatter<'_>) {
        write!(f, "{=u64:us}", self.as_micros());
    }
}
