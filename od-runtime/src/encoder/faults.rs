//! Active faults, and their way into 6503h, 6505h, 1001h, 1003h and an EMCY message.

use od_model::Address;

use super::fault::{Appears, Fault, Report, Until};
use super::profile::EncoderProfile;
use crate::application::Context;
use crate::store::Store;
use od_wire::emcy::Emcy;

const ALARMS: Address = Address::new(0x6503, 0);
const WARNINGS: Address = Address::new(0x6505, 0);

/// The sensor does not tell the angle, and the family has no alarm for the reason: the row of
/// [`EncoderProfile::NO_ANGLE`], and a bit beside those of faults.
const NO_ANGLE: u32 = 1 << 31;

/// Bytes 3–7 of an EMCY: 6503h, 6505h, nothing (manual 000, chapter 4.3.5).
pub(super) fn info(store: &Store<'_>) -> [u8; 5] {
    let [alarm_low, alarm_high] = (store.unsigned(ALARMS.index, 0) as u16).to_le_bytes();
    let [low, high] = (store.unsigned(WARNINGS.index, 0) as u16).to_le_bytes();
    [alarm_low, alarm_high, low, high, 0]
}

/// Sets of [`Fault`]s and of rows of [`EncoderProfile::reports`], a bit each.
#[derive(Clone, Copy, Debug)]
pub(super) struct Faults {
    /// Something changed that [`report`](Self::report) has not seen.
    changed: bool,
    /// Faults that the host set.
    broken: u32,
    /// Reason why the sensor does not deliver the angle; see [`seen`].
    sensed: u32,
    /// Faults at the last start.
    at_start: u32,
    /// The last reset was by the watchdog.
    watchdog: bool,
    /// The last start found the memory damaged: [`Fault::Memory`] until it holds something
    /// sound again.
    damaged: bool,
    /// Number of times that each came; kept without power.
    counts: [u32; Fault::NAMES.len()],
    /// Rows that the check at the last start found.
    found: u32,
    /// Rows that were there and last longer than their fault.
    latched: u32,
    /// Rows that 2116h injected.
    injected: u32,
    /// Rows that the device knows of.
    shown: u32,
}

/// Time without power, for [`Faults::reset`].
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Off {
    /// There was power all the time.
    Never,
    /// Power was off for this many microseconds.
    For(u64),
    /// There never was any before.
    Always,
}

impl Faults {
    pub(super) const fn new() -> Self {
        Self {
            changed: false,
            broken: 0,
            sensed: 0,
            at_start: 0,
            watchdog: false,
            damaged: false,
            counts: [0; Fault::NAMES.len()],
            found: 0,
            latched: 0,
            injected: 0,
            shown: 0,
        }
    }

    pub(super) fn set(&mut self, fault: Fault, broken: bool) {
        self.changed = true;
        if broken {
            self.broken |= bit(fault);
        } else {
            self.broken &= !bit(fault);
            self.at_start &= !bit(fault);
            self.watchdog &= fault != Fault::Watchdog;
        }
    }

    /// Does the memory hold something damaged?
    pub(super) fn set_damaged(&mut self, damaged: bool) {
        self.changed = true;
        self.damaged = damaged;
    }

    /// Whether the sensor could not tell the angle when it was asked last.
    #[inline(always)]
    pub(super) const fn is_blind(&self) -> bool {
        self.sensed != 0
    }

    /// Takes what the sensor said when it was asked for the angle. Answers whether that is
    /// news.
    #[inline]
    pub(super) fn sensed(&mut self, fault: Option<Fault>, reports: &[Report]) -> bool {
        let sensed = fault.map_or(0, |fault| seen(fault, reports));
        let is_news = self.sensed != sensed;
        if is_news {
            self.sensed = sensed;
            self.changed = true;
        }
        is_news
    }

    /// Faults that the device can find now: those of the host, the sensor and the memory.
    fn found(&self) -> u32 {
        self.broken | self.sensed | if self.damaged { bit(Fault::Memory) } else { 0 }
    }

    pub(super) fn is_set(&self, fault: Fault) -> bool {
        self.broken & bit(fault) != 0 || (fault == Fault::Watchdog && self.watchdog)
    }

    /// The device starts: it knows how often what came, and whether its watchdog bit it, and
    /// checks what can be checked then.
    pub(super) fn reset(&mut self, cx: &mut Context<'_, '_>, reports: &[Report], off: Off) {
        self.changed = true;
        self.watchdog = self.broken & bit(Fault::Watchdog) != 0;
        self.broken &= !bit(Fault::Watchdog);
        self.at_start = self.found();
        self.shown = 0;
        self.found = 0;
        let mut lasting = 0;
        for (row, report) in rows(reports) {
            if report.until == Until::Ever {
                lasting |= row;
            }
            let checked = match off {
                Off::Never => report.off_ms == 0,
                Off::For(micros) => micros / 1000 >= u64::from(report.off_ms),
                Off::Always => true,
            };
            if report.appears == Appears::Startup
                && checked
                && (self.is_set(report.fault) || self.at_start & bit(report.fault) != 0)
            {
                self.found |= row;
            }
            if let Some(counter) = report.counter {
                let stored = cx.store.unsigned(counter.index, counter.sub) as u32;
                let count = &mut self.counts[report.fault as usize];
                *count = stored.max(*count);
                cx.store.set_unsigned(counter, (*count).into());
            }
        }
        self.latched &= lasting;
        self.injected &= lasting;
    }

    /// A code of 2116h; `false` where the table does not have it.
    pub(super) fn knows(reports: &[Report], code: u32) -> bool {
        code == 0 || reports.iter().any(|report| report.injection == Some(code))
    }

    /// 2116h takes a code that it [`knows`](Self::knows): the codes add up, and 0 ends them.
    pub(super) fn inject(&mut self, reports: &[Report], code: u32) {
        self.changed = true;
        if code == 0 {
            self.injected = 0;
            return;
        }
        for (row, report) in rows(reports) {
            if report.injection == Some(code) {
                self.injected |= row;
            }
        }
    }

    /// Brings objects and errors up to date where something changed.
    pub(super) fn report(&mut self, cx: &mut Context<'_, '_>, profile: &EncoderProfile) {
        if !core::mem::take(&mut self.changed) {
            return;
        }
        let reports = profile.reports;
        for (row, report) in rows(reports) {
            let there = self.is_there(row, report, reports);
            if there && report.until != Until::Repaired {
                self.latched |= row;
            }
            let active = there || (self.latched | self.injected) & row != 0;
            let known = self.shown & row != 0;
            if active == known || (profile.by_support && !is_supported(cx, report)) {
                continue;
            }
            self.change(cx, row, report, reports);
        }
    }

    /// Is the fault of a row there, so that the row sees it?
    fn is_there(&self, row: u32, report: &Report, reports: &[Report]) -> bool {
        if row == NO_ANGLE {
            return self.sensed & NO_ANGLE != 0;
        }
        let is_broken = match report.fault {
            // What the host set is for the next start.
            Fault::Watchdog => self.watchdog,
            fault => self.found() & bit(fault) != 0,
        };
        if !is_broken {
            return false;
        }
        let found_otherwise = |other: &Report| {
            other.fault == report.fault
                && other.appears == Appears::Startup
                && self.at_start & bit(report.fault) != 0
        };
        match report.appears {
            Appears::Always => true,
            Appears::Startup => self.found & row != 0 && self.at_start & bit(report.fault) != 0,
            Appears::Runtime => !reports.iter().any(found_otherwise),
            Appears::Injected => false,
        }
    }

    /// A row comes or goes.
    fn change(&mut self, cx: &mut Context<'_, '_>, row: u32, report: &Report, reports: &[Report]) {
        self.shown ^= row;
        let comes = self.shown & row != 0;
        for (address, bits) in [
            (ALARMS, (|report| report.alarm) as fn(&Report) -> u16),
            (WARNINGS, |report| report.warning),
        ] {
            let of_table = rows(reports).fold(0, |all, (_, report)| all | bits(report));
            let old = cx.store.unsigned(address.index, address.sub);
            let shown = self.shown_rows(reports);
            let new = shown.fold(0, |all, report| all | bits(report));
            let others = old & !u64::from(of_table);
            cx.store.set_unsigned(address, others | u64::from(new));
        }
        let info = info(cx.store);
        // Two rows that say the same are one error for the bus.
        let same = |other: &&Report| other.code == report.code && other.register == report.register;
        let others = self.shown_rows(reports).filter(same).count() - usize::from(comes);
        if comes {
            if let Some(counter) = report.counter {
                let count = &mut self.counts[report.fault as usize];
                *count = count.saturating_add(1);
                cx.store.set_unsigned(counter, (*count).into());
            }
            cx.signals.raise(Emcy {
                code: report.code,
                register: report.register,
                info,
            });
        } else if others == 0 {
            cx.signals.clear_one(report.code, report.register, info);
        }
    }

    fn shown_rows<'r>(&self, reports: &'r [Report]) -> impl Iterator<Item = &'r Report> {
        let shown = self.shown;
        rows(reports).filter_map(move |(row, report)| (shown & row != 0).then_some(report))
    }
}

/// The rows of a table, each with its bit, and the one of [`NO_ANGLE`].
fn rows(reports: &[Report]) -> impl Iterator<Item = (u32, &Report)> {
    let of_table = (0..31).map(|row| 1 << row).zip(reports);
    of_table.chain([(NO_ANGLE, &EncoderProfile::NO_ANGLE)])
}

/// Can this device have the fault? 6504h and 6506h say so, where they are.
fn is_supported(cx: &Context<'_, '_>, report: &Report) -> bool {
    let has = |index, bits: u16| match cx.store.try_unsigned(index, 0) {
        Some(supported) => supported & u64::from(bits) == u64::from(bits),
        None => true,
    };
    has(0x6504, report.alarm) && has(0x6506, report.warning)
}

/// The bit of a fault that keeps the sensor silent; also [`NO_ANGLE`], unless the family has
/// an alarm for it while the device runs.
#[cold]
fn seen(fault: Fault, reports: &[Report]) -> u32 {
    let is_alarm = |report: &Report| {
        let at_run_time = matches!(report.appears, Appears::Always | Appears::Runtime);
        report.fault == fault && report.alarm != 0 && at_run_time
    };
    let unknown = !reports.iter().any(is_alarm);
    bit(fault) | if unknown { NO_ANGLE } else { 0 }
}

const fn bit(fault: Fault) -> u32 {
    1 << fault as u32
}
