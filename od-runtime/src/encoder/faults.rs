//! What is broken, and how it gets into 6503h, 6505h, 1001h, 1003h and an EMCY.

use od_model::Address;

use super::{Fault, Report};
use crate::{Context, Error, Store};

const ALARMS: Address = Address::new(0x6503, 0);
const WARNINGS: Address = Address::new(0x6505, 0);

/// Bytes 3–7 of an EMCY: 6503h, 6505h, nothing (manual 000, chapter 4.3.5).
pub(super) fn info(store: &Store<'_>) -> [u8; 5] {
    let [alarm_low, alarm_high] = (store.unsigned(ALARMS.index, 0) as u16).to_le_bytes();
    let [low, high] = (store.unsigned(WARNINGS.index, 0) as u16).to_le_bytes();
    [alarm_low, alarm_high, low, high, 0]
}

/// Sets of [`Fault`]s, a bit each.
#[derive(Clone, Copy, Debug)]
pub(super) struct Faults {
    /// What the host broke.
    broken: u32,
    /// What the device knows of.
    reported: u32,
    /// The last reset was by the watchdog.
    watchdog: bool,
    /// How often each came, as the device remembers it without power.
    counts: [u32; Fault::NAMES.len()],
}

impl Faults {
    pub(super) const fn new() -> Self {
        Self {
            broken: 0,
            reported: 0,
            watchdog: false,
            counts: [0; Fault::NAMES.len()],
        }
    }

    pub(super) fn set(&mut self, fault: Fault, broken: bool) {
        if broken {
            self.broken |= bit(fault);
        } else {
            self.broken &= !bit(fault);
            self.watchdog &= fault != Fault::Watchdog;
        }
    }

    pub(super) fn is_set(&self, fault: Fault) -> bool {
        self.broken & bit(fault) != 0 || (fault == Fault::Watchdog && self.watchdog)
    }

    /// The device starts: it knows how often what came, and whether its watchdog bit it.
    pub(super) fn reset(&mut self, cx: &mut Context<'_, '_>, reports: &[Report]) {
        self.reported = 0;
        self.watchdog = self.broken & bit(Fault::Watchdog) != 0;
        self.broken &= !bit(Fault::Watchdog);
        for report in reports {
            if let Some(counter) = report.counter {
                let stored = cx.store.unsigned(counter.index, counter.sub) as u32;
                let count = &mut self.counts[report.fault as usize];
                *count = stored.max(*count);
                cx.store.set_unsigned(counter, (*count).into());
            }
        }
    }

    /// Brings objects and errors up to date.
    pub(super) fn report(&mut self, cx: &mut Context<'_, '_>, reports: &[Report]) {
        for report in reports {
            let active = match report.fault {
                Fault::Watchdog => self.watchdog,
                fault => self.broken & bit(fault) != 0,
            };
            let known = self.reported & bit(report.fault) != 0;
            if active == known || !is_supported(cx, report) {
                continue;
            }
            self.reported ^= bit(report.fault);
            change(cx, ALARMS, report.alarm, active);
            change(cx, WARNINGS, report.warning, active);
            let info = info(cx.store);
            if active {
                if let Some(counter) = report.counter {
                    let count = &mut self.counts[report.fault as usize];
                    *count = count.saturating_add(1);
                    cx.store.set_unsigned(counter, (*count).into());
                }
                cx.signals.raise(Error {
                    code: report.code,
                    register: report.register,
                    info,
                });
            } else {
                cx.signals.clear(report.code, info);
            }
        }
    }
}

/// Can this device have the fault? 6504h and 6506h say so, where they are.
fn is_supported(cx: &Context<'_, '_>, report: &Report) -> bool {
    let has = |index, bits: u16| match cx.store.try_unsigned(index, 0) {
        Some(supported) => supported & u64::from(bits) == u64::from(bits),
        None => true,
    };
    has(0x6504, report.alarm) && has(0x6506, report.warning)
}

fn change(cx: &mut Context<'_, '_>, address: Address, bits: u16, on: bool) {
    let old = cx.store.unsigned(address.index, address.sub);
    let bits = u64::from(bits);
    let new = if on { old | bits } else { old & !bits };
    cx.store.set_unsigned(address, new);
}

const fn bit(fault: Fault) -> u32 {
    1 << fault as u8
}
