//! EMCY producer and the error objects (CiA 301, chapter 7.2.7, objects 1001h, 1003h, 1014h and 1015h).

use crate::blank::Blank;
use crate::deadline::Deadline;
use crate::fifo::Fifo;
use crate::profile::ErrorReset;
use crate::services::{Services, may_have};
use crate::store::Store;
use od_model::Address;

use crate::sync;
use od_wire::emcy::Emcy;
use od_wire::{CanId, CobId, Frame, Instant};

/// EMCY error code of an RPDO that is shorter than its mapping (CiA 301, table 26).
pub(crate) const PDO_LENGTH: u16 = 0x8210;
/// EMCY error code of a SYNC with an unexpected length.
pub(crate) const SYNC_LENGTH: u16 = 0x8240;
/// EMCY error code of an RPDO whose frame is late.
pub(crate) const RPDO_TIMEOUT: u16 = 0x8250;

/// An error that began or ended, as the application reports it to the node.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum Change {
    /// The error began.
    Raised(Emcy),
    /// The error with this code ended; `info` is in the EMCY message that reports it.
    Cleared {
        /// EMCY error code.
        code: u16,
        /// The bits of 1001h that the error set, if several errors have this code.
        register: Option<u8>,
        /// Manufacturer-specific bytes 3 to 7 of the message.
        info: [u8; 5],
    },
}

impl Change {
    /// Content of an empty place.
    pub(crate) const NONE: Self = Self::Raised(Emcy {
        code: 0,
        register: 0,
        info: [0; 5],
    });
}

impl Blank for Emcy {
    const BLANK: Self = Self {
        code: 0,
        register: 0,
        info: [0; 5],
    };
}

impl Blank for Change {
    const BLANK: Self = Self::NONE;
}

/// No error began or ended.
const NO_NEWS: Outcome = Outcome {
    is_news: false,
    set: 0,
    is_dropped: false,
};

/// State of the EMCY producer, except its queues.
#[derive(Clone, Debug)]
pub(crate) struct State {
    blocked_until: Instant,
    /// Bits of 1001h without an EMCY message.
    silent: u8,
}

impl State {
    pub(crate) const NEW: Self = Self {
        blocked_until: Instant::ZERO,
        silent: 0,
    };

    /// Returns 1001h while these errors are active.
    pub(crate) fn register(&self, active: &Fifo<[Emcy]>) -> u8 {
        let bits = active.iter().map(|error| error.register);
        bits.fold(self.silent, |all, bits| all | bits)
    }

    /// Time when the next message can be sent, if one waits.
    pub(crate) fn deadline(&self, waiting: &Fifo<[Emcy]>) -> Deadline {
        if waiting.is_empty() {
            Deadline::NEVER
        } else {
            Deadline::at(self.blocked_until)
        }
    }
}

/// The EMCY producer with its queues.
pub(crate) struct Producer<'p> {
    pub(crate) active: &'p mut Fifo<[Emcy]>,
    pub(crate) waiting: &'p mut Fifo<[Emcy]>,
    pub(crate) state: &'p mut State,
}

/// Result of a reported change.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) struct Outcome {
    /// The error was not active before, or was active until now, so the report is a change.
    pub(crate) is_news: bool,
    /// Bits of 1001h that became set.
    pub(crate) set: u8,
    /// Its message is dropped, because too many messages wait for the inhibit time.
    pub(crate) is_dropped: bool,
}

impl Producer<'_> {
    /// Resets the state: the device starts without errors.
    pub(crate) fn reset(&mut self) {
        self.active.clear();
        self.waiting.clear();
        *self.state = State::NEW;
    }

    /// Applies a change to 1001h and 1003h.
    ///
    /// `send` is false if the NMT state or 1014h forbids the message; 1003h gets the error in any
    /// case. Messages that wait for the inhibit time keep their order. If 16 messages wait, the
    /// next one is dropped, and an event reports it.
    pub(crate) fn change<D: Services>(
        &mut self,
        store: &mut Store<'_>,
        change: Change,
        reset: ErrorReset,
        send: bool,
    ) -> Outcome {
        let before = self.register();
        let (mut code, register, info) = match change {
            Change::Raised(error) => (error.code, Some(error.register), error.info),
            Change::Cleared {
                code,
                register,
                info,
            } => (code, register, info),
        };
        match (change, self.position(code, register)) {
            (Change::Raised(error), None) => {
                self.active.push(error);
                if const { may_have::<D>(0x1003, 0x1003, None) } {
                    log::<D>(store, code);
                }
            }
            (Change::Cleared { .. }, Some(at)) => {
                self.active.take_out(at);
                code = 0;
            }
            _ => return NO_NEWS,
        }
        let register = self.show(store);
        let is_last = reset == ErrorReset::EachError || self.active.is_empty();
        let message = Emcy {
            code,
            register,
            info,
        };
        let is_due = send && (code != 0 || is_last);
        Outcome {
            is_news: true,
            set: register & !before,
            is_dropped: is_due && !self.waiting.push(message),
        }
    }

    /// Returns whether an error with this code and these bits of 1001h is active.
    pub(crate) fn is_active(&self, error: Emcy) -> bool {
        self.position(error.code, Some(error.register)).is_some()
    }

    /// Position of the first active error with this code and these bits of 1001h; sources that
    /// share a code differ in the bits.
    fn position(&self, code: u16, register: Option<u8>) -> Option<u8> {
        self.active.position(|known| {
            known.code == code && register.is_none_or(|bits| bits == known.register)
        })
    }

    /// Sets the bits of 1001h without an EMCY message. Returns those that became set.
    pub(crate) fn set_silent(&mut self, store: &mut Store<'_>, bits: u8) -> u8 {
        let before = self.register();
        self.state.silent = bits;
        self.show(store) & !before
    }

    /// Ends errors without an EMCY message, as a reset of the communication does.
    pub(crate) fn forget(&mut self, store: &mut Store<'_>, which: impl Fn(u16) -> bool) {
        self.active.remove(|error| which(error.code));
        self.state.silent = 0;
        self.show(store);
    }

    /// Returns 1001h.
    fn register(&self) -> u8 {
        self.state.register(self.active)
    }

    fn show(&self, store: &mut Store<'_>) -> u8 {
        let register = self.register();
        store.set_unsigned(Address::new(0x1001, 0), register.into());
        register
    }

    /// Returns the next message, if the inhibit time 1015h (in units of 100 µs) allows it.
    pub(crate) fn poll<D: Services>(&mut self, store: &Store<'_>, now: Instant) -> Option<Frame> {
        if self.waiting.is_empty() || now < self.state.blocked_until {
            return None;
        }
        let id = can_id(store);
        let emcy = self.waiting.pop()?;
        if const { may_have::<D>(0x1015, 0x1015, None) } {
            let inhibit = u64::from(store.word(0x1015, 0, 0)) * 100;
            self.state.blocked_until = now.plus_micros(inhibit);
        }
        id.map(|id| Frame::full(id, emcy.emit()))
    }
}

/// CAN-ID of EMCY messages: that of 1014h, if the object exists, is valid, and SYNC has another
/// CAN-ID.
pub(crate) fn can_id(store: &Store<'_>) -> Option<CanId> {
    let cob_id = CobId::new(store.word(0x1014, 0, 1 << 31));
    let id = cob_id.usable_id().filter(|_| cob_id.is_valid())?;
    (sync::can_id(store) != Some(id)).then_some(id)
}

/// Adds the code to 1003h as the newest entry; a full history loses its oldest entry.
fn log<D: Services>(store: &mut Store<'_>, code: u16) {
    let capacity = capacity::<D>(store);
    if capacity == 0 {
        return;
    }
    let count = (store.word(0x1003, 0, 0) as u8)
        .saturating_add(1)
        .min(capacity);
    let mut entry = code.into();
    for sub in 0..count {
        let older = store.word(0x1003, sub + 1, 0);
        put(store, sub + 1, entry);
        entry = older;
    }
    put(store, 0, count.into());
}

/// Sets a sub-index of 1003h.
fn put(store: &mut Store<'_>, sub: u8, value: u32) {
    store.set_unsigned(Address::new(0x1003, sub), value.into());
}

/// Clears 1003h, as writing 0 to its sub-index 0 does.
pub(crate) fn clear_log<D: Services>(store: &mut Store<'_>) {
    for sub in 0..u16::from(capacity::<D>(store)) + 1 {
        put(store, sub as u8, 0);
    }
}

/// Number of entries of 1003h, as a constant if the compiler knows the dictionary.
fn capacity<D: Services>(store: &Store<'_>) -> u8 {
    let known = const {
        match &D::DICTIONARY {
            Some(dictionary) => Some(dictionary.last_sub(0x1003)),
            None => None,
        }
    };
    known.unwrap_or_else(|| store.dictionary().last_sub(0x1003))
}
