//! Visible state of a device without a frame: its values and its LEDs.

use std::prelude::v1::*;

use od_model::Address;
use od_runtime::{Application, Context, Instant, Signals};

use crate::device::VirtualDevice;
use crate::device::leds;
use crate::device::leds::Led;

/// Bit 4 of 1001h.
const COMMUNICATION: u64 = 1 << 4;

impl VirtualDevice {
    /// The value at an address as an SDO would carry it now, without a frame on the bus;
    /// empty if the object does not exist. Also of objects that a master may not read.
    pub fn read(&mut self, address: Address, now: Instant) -> Vec<u8> {
        #[cfg(feature = "real")]
        if let Some(value) = self.seen_value(address) {
            return value.to_vec();
        }
        #[cfg(feature = "eds")]
        if let Some(parts) = &self.node.application.file_parts
            && let Some(value) = parts.long.get(address)
        {
            return value.to_vec();
        }
        let is_refreshed = self.node.is_powered() && address.index >= 0x2000;
        self.node.look(|behaviour, store| {
            let Ok(entry) = store.dictionary().find(address) else {
                return Vec::new();
            };
            if is_refreshed {
                let mut context = Context {
                    store,
                    now,
                    signals: &mut Signals::default(),
                };
                // A value that cannot be refreshed now is shown as it was last.
                let _ = behaviour.refresh(&mut context, address);
            }
            store.bytes(&entry, &mut [0; 8]).to_vec()
        })
    }

    /// The number at an address, live values as they were last read.
    pub fn stored(&self, index: u16, sub: u8) -> Option<u64> {
        let dictionary = self.dictionary();
        let entry = dictionary.entry(index, sub)?;
        let start = entry.slot.offset as usize;
        let bytes = self
            .node
            .values()
            .get(start..start + usize::from(entry.slot.len))?;
        match bytes {
            [] => u64::try_from(entry.default.integer(self.node_id().raw())?).ok(),
            bytes if bytes.len() <= 8 && !entry.is_variable() => Some(
                bytes
                    .iter()
                    .rev()
                    .fold(0, |value, byte| value << 8 | u64::from(*byte)),
            ),
            _ => None,
        }
    }

    /// Returns whether it has the dual LED. A device of an EDS file always has one.
    pub(crate) fn has_leds(&self) -> bool {
        self.has_leds
    }

    /// States of the two dies of the LED: green, red (manual 000, chapter 7.3).
    pub fn leds(&self) -> (Led, Led) {
        let bits = |index| self.stored(index, 0).unwrap_or(0);
        let warning = bits(0x6505) != 0;
        // A warning sets bits of 1001h as an error does, except bit 4, which only errors set.
        let encoder = self.node.application.encoder();
        let broken = encoder.is_some_and(|encoder| {
            let reports = encoder.profile().reports.iter();
            let mut errors = reports.filter(|report| report.warning == 0);
            errors.any(|report| encoder.is_broken(report.fault))
        });
        let register = bits(0x1001);
        let error = broken
            || bits(0x6503) != 0
            || register & COMMUNICATION != 0
            || (register != 0 && !warning);
        leds::dual(self.is_powered(), self.state(), warning, error)
    }
}
