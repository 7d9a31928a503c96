//! Node and life guarding (CiA 301, chapter 7.2.8.3.2.1, objects 100Ch and 100Dh).

use crate::blank::Blank;
use crate::deadline::Deadline;
use crate::store::Store;
use od_wire::Instant;
use od_wire::nmt::State;

/// The slave's side of guarding: a response with a toggle bit to each remote frame, and the life
/// time of the master.
#[derive(Clone, Debug)]
pub struct Guard {
    enabled: bool,
    toggle: bool,
    /// Guard time × life time factor, in milliseconds; 0: the master is not monitored.
    life_ms: u32,
    /// Time when the master is lost; the first guarding request sets it.
    deadline: Deadline,
    lost: bool,
}

impl Blank for Guard {
    const BLANK: Self = Self {
        enabled: false,
        toggle: false,
        life_ms: 0,
        deadline: Deadline::NEVER,
        lost: false,
    };
}

impl Guard {
    pub(super) fn configure(&mut self, store: &Store<'_>, enabled: bool) {
        let life_ms = {
            let [guard, factor] = [0x100C, 0x100D].map(|index| store.word(index, 0, 0));
            guard.wrapping_mul(factor)
        };
        if !enabled || life_ms == 0 {
            self.deadline = Deadline::NEVER;
            self.lost = false;
        }
        self.enabled = enabled;
        self.life_ms = life_ms;
    }

    pub(super) fn request(&mut self, state: State, now: Instant) -> Option<u8> {
        if !self.enabled {
            return None;
        }
        self.lost = false;
        self.deadline = match self.life_ms {
            0 => Deadline::NEVER,
            life => Deadline::at(now.plus_millis(life.into())),
        };
        let answer = state as u8 | u8::from(self.toggle) << 7;
        self.toggle = !self.toggle;
        Some(answer)
    }

    pub(super) fn handle_timeout(&mut self, now: Instant) {
        if self.deadline.is_due(now) {
            self.deadline = Deadline::NEVER;
            self.lost = true;
        }
    }

    pub(super) fn is_lost(&self) -> bool {
        self.lost
    }

    pub(super) fn deadline(&self) -> Deadline {
        self.deadline
    }
}
