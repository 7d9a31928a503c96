//! SYNC producer (CiA 301, chapter 7.2.5, and objects 1005h, 1006h, 1019h).

use od_wire::{CanId, CobId, Instant};

use crate::blank::Blank;
use crate::store::Store;

/// State of SYNC producer and TIME.
#[derive(Clone, Debug)]
pub struct Clocks {
    pub(crate) sync: Producer,
    /// CAN-ID of the TIME messages that the device receives.
    pub(crate) time_id: Option<CanId>,
}

impl Blank for Clocks {
    const BLANK: Self = Self {
        sync: Producer::IDLE,
        time_id: None,
    };
}

/// State of the producer.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Producer {
    /// 1006h in microseconds; 0 if the device produces no SYNC.
    period_us: u32,
    next: Instant,
    /// 1019h: 0 or 2 to 240.
    overflow: u8,
    /// Counter of the last SYNC; 0 before the first one.
    counter: u8,
}

impl Producer {
    pub(crate) const IDLE: Self = Self {
        period_us: 0,
        next: Instant::MAX,
        overflow: 0,
        counter: 0,
    };

    /// Reads the objects again. The first SYNC is sent one period after the producer starts or its
    /// period changes; the counter begins at 1 after each start.
    pub(crate) fn configure(&mut self, store: &Store<'_>, now: Instant, may_send: bool) {
        let is_on = CobId::new(store.unsigned(0x1005, 0) as u32).produces_sync();
        let period_us = if is_on && may_send {
            store.unsigned(0x1006, 0) as u32
        } else {
            0
        };
        if period_us == self.period_us {
            return;
        }
        if period_us == 0 || self.period_us == 0 {
            self.counter = 0;
            let overflow = store.unsigned(0x1019, 0) as u8;
            self.overflow = if is_overflow(overflow) { overflow } else { 0 };
        }
        self.period_us = period_us;
        self.next = now.plus_micros(period_us.into());
    }

    /// Time when the next SYNC is due.
    pub(crate) fn deadline(&self) -> Option<Instant> {
        (self.period_us > 0).then_some(self.next)
    }

    /// Returns the counter of the SYNC that is due; `Some(None)`: a SYNC without a counter.
    pub(crate) fn handle_timeout(&mut self, now: Instant) -> Option<Option<u8>> {
        let at = self.deadline().filter(|at| *at <= now)?;
        self.next = at.next_period(self.period_us.into(), now);
        if self.overflow == 0 {
            return Some(None);
        }
        self.counter = if self.counter >= self.overflow {
            1
        } else {
            self.counter + 1
        };
        Some(Some(self.counter))
    }
}

/// CAN-ID of SYNC: that of 1005h, or 080h if 1005h is missing; `None` if no service may have it.
pub(crate) fn can_id(store: &Store<'_>) -> Option<CanId> {
    CobId::new(store.word(0x1005, 0, 0x80)).usable_id()
}

/// Length of a SYNC that a consumer expects (CiA 301, object 1019h).
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Length {
    /// The device has no 1019h, so it does not know whether SYNC has a counter.
    Any,
    Zero,
    One,
}

impl Length {
    pub(crate) fn of(store: &Store<'_>) -> Self {
        match store.try_word(0x1019, 0) {
            None => Self::Any,
            Some(0) => Self::Zero,
            Some(_) => Self::One,
        }
    }

    /// Returns whether a SYNC may have this length in bytes.
    pub(crate) fn is_right(self, len: usize) -> bool {
        match self {
            Self::Any => len <= 1,
            Self::Zero => len == 0,
            Self::One => len == 1,
        }
    }
}

/// Returns whether 1019h can have the value; 1 and 241 to 255 are reserved.
pub(crate) const fn is_overflow(value: u8) -> bool {
    matches!(value, 0 | 2..=240)
}
