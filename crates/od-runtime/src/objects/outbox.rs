//! Work that a call postpones to its end.

use od_model::Address;

use crate::application::Signals;
use crate::emcy::Change;
use crate::fifo::Fifo;

/// Effect of a write on the services.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub(crate) enum Effect {
    /// The object at this address has a new value. Two numbers take two bytes less than an
    /// `Address`.
    Written {
        /// Index.
        index: u16,
        /// Sub-index.
        sub: u8,
    },
    /// 1010h: these groups were saved (sub-index).
    Saved(u8),
    /// A save failed after it had begun.
    NotSaved,
    /// 1011h: these groups were restored (sub-index), at once or at the next reset.
    Restored(u8),
}

/// Effects of a call, collected while `Objects` has the parts of the device, and carried out before
/// the call returns.
#[derive(Clone, Debug)]
pub struct Outbox<Q: ?Sized = [Change]> {
    /// Objects that were written: one by an SDO, up to 64 by an RPDO.
    pub(crate) effects: Fifo<[Effect; 8]>,
    /// More objects were written than `effects` can hold.
    pub(crate) overflow: bool,
    /// Set of the live values, as bits of [`live_bit`]; it may contain further addresses.
    pub(crate) live: u32,
    /// The application's requests.
    pub(crate) signals: Signals<Q>,
}

/// Returns whether the value at an address may be live, by this set.
pub(crate) const fn is_live(live: u32, address: Address) -> bool {
    address.index >= 0x2000 && live & live_bit(address) != 0
}

/// Maps an address to one of 32 bits; neighbours have different bits.
pub(super) const fn live_bit(address: Address) -> u32 {
    1 << (address.index & 31)
}

impl<Q> Outbox<Q> {
    /// An outbox without effects; `room` is the content of empty places.
    pub const fn new(room: Q) -> Self {
        Self {
            effects: Fifo::new([Effect::Written { index: 0, sub: 0 }; 8]),
            overflow: false,
            live: 0,
            signals: Signals::with_room(room),
        }
    }
}

impl Outbox {
    #[inline]
    pub(crate) const fn is_empty(&self) -> bool {
        self.effects.is_empty() && self.signals.is_idle()
    }

    /// The written objects, and other effects.
    pub(crate) fn effects(&mut self) -> &mut Fifo<[Effect]> {
        &mut self.effects
    }

    pub(super) fn written(&mut self, Address { index, sub }: Address) {
        self.effect(Effect::Written { index, sub });
    }

    pub(super) fn effect(&mut self, effect: Effect) {
        self.overflow |= !self.effects().push(effect);
    }
}

impl<Q: ?Sized> Outbox<Q> {
    /// Returns whether the value at an address may be live.
    pub(crate) const fn is_live(&self, address: Address) -> bool {
        is_live(self.live, address)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_set_contains_its_addresses_and_no_communication_object() {
        let address = Address::new(0x2000, 0);
        let bit = live_bit(address);
        assert_eq!(bit.count_ones(), 1);
        for (live, index, named) in [
            (bit, 0x2000, true),
            (!bit, 0x2000, false),
            (0, 0x2000, false),
            (u32::MAX, 0x2000, true),
            (u32::MAX, 0x6004, true),
            (u32::MAX, 0x1FFF, false),
            (u32::MAX, 0x1000, false),
        ] {
            assert_eq!(is_live(live, Address::new(index, 0)), named, "{index:X}");
        }
        let mut outbox = Outbox::new([Change::NONE; 1]);
        for live in [0, bit, !bit, u32::MAX] {
            outbox.live = live;
            assert_eq!(outbox.is_live(address), live & bit != 0);
        }
    }

    #[test]
    fn an_overflow_is_noted() {
        let mut full = Outbox::new([Change::NONE; 1]);
        let outbox: &mut Outbox = &mut full;
        assert!(outbox.is_empty());
        for sub in 0..8 {
            outbox.written(Address::new(0x2000, sub));
            assert!(!outbox.overflow && !outbox.is_empty());
        }
        outbox.effect(Effect::NotSaved);
        assert!(outbox.overflow);
        for sub in 0..8 {
            let index = 0x2000;
            let written = outbox.effects().pop();
            assert_eq!(written, Some(Effect::Written { index, sub }));
        }
        assert!(outbox.is_empty());
        outbox.signals.wake();
        assert!(!outbox.is_empty());
    }
}
