//! From the faults of an encoder to 6503h, 6505h, 1001h, 1003h and an EMCY message.

use od_model::Address;

use super::profile::EncoderProfile;
use super::report::{Appears, Fault, Report, Until};
use crate::application::Context;
use crate::store::Store;
use od_wire::emcy::Emcy;

const ALARMS: Address = Address::new(0x6503, 0);
const WARNINGS: Address = Address::new(0x6505, 0);

/// The sensor does not deliver the angle, and the family has no alarm for the reason. The bit stands for the
/// row [`EncoderProfile::NO_ANGLE`] in a set of rows, and for no fault in a set of faults.
const NO_ANGLE: u32 = 1 << 31;

/// Returns bytes 3 to 7 of an EMCY message: 6503h, 6505h, and 0 (manual 000, 4.3.5).
pub(super) fn info(store: &Store<'_>) -> [u8; 5] {
    let [alarm_low, alarm_high] = (store.unsigned(ALARMS.index, 0) as u16).to_le_bytes();
    let [low, high] = (store.unsigned(WARNINGS.index, 0) as u16).to_le_bytes();
    [alarm_low, alarm_high, low, high, 0]
}

/// State of the faults: sets of [`Fault`]s and of rows of [`EncoderProfile::reports`], a bit each.
#[derive(Clone, Copy, Debug)]
pub(super) struct Faults {
    /// A set changed since the last [`report`](Self::report).
    changed: bool,
    /// Faults that the host set.
    broken: u32,
    /// Reason why the sensor does not deliver the angle; see [`sensed_bits`].
    sensed: u32,
    /// Faults at the last start.
    at_start: u32,
    /// The last reset was by the watchdog.
    watchdog: bool,
    /// The storage holds damaged values: [`Fault::Memory`] until a save replaces them.
    damaged: bool,
    /// Number of occurrences of each fault; kept without power.
    counts: [u32; Fault::NAMES.len()],
    /// Rows that the check at the last start found.
    found: u32,
    /// Rows that were active and last longer than their fault.
    latched: u32,
    /// Rows that a test injected.
    injected: u32,
    /// Rows that objects and EMCY messages have reported.
    shown: u32,
}

/// Time without power, for [`Faults::reset`].
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Off {
    /// Power was always on: NMT reset node.
    Never,
    /// Power was off for this many microseconds.
    For(u64),
    /// Power was never on before.
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

    /// Sets or ends a fault that the host reports.
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

    /// Receives whether the storage holds damaged values.
    pub(super) fn set_damaged(&mut self, damaged: bool) {
        self.changed = true;
        self.damaged = damaged;
    }

    /// Receives the result of reading the sensor. Returns whether it differs from the one before.
    pub(super) fn sensed(&mut self, fault: Option<Fault>, reports: &[Report]) -> bool {
        let sensed = fault.map_or(0, |fault| sensed_bits(fault, reports));
        let is_new = self.sensed != sensed;
        if is_new {
            self.sensed = sensed;
            self.changed = true;
        }
        is_new
    }

    /// Returns the faults of host, sensor and storage.
    fn present(&self) -> u32 {
        self.broken | self.sensed | if self.damaged { bit(Fault::Memory) } else { 0 }
    }

    /// Returns whether the host has set this fault.
    pub(super) fn is_set(&self, fault: Fault) -> bool {
        self.broken & bit(fault) != 0 || (fault == Fault::Watchdog && self.watchdog)
    }

    /// Starts the device: loads the counters, detects a watchdog reset (MANUALS.md C-EAM-35), and
    /// checks for faults that are reported at a start.
    pub(super) fn reset(&mut self, cx: &mut Context<'_, '_>, reports: &[Report], off: Off) {
        self.changed = true;
        self.watchdog = self.broken & bit(Fault::Watchdog) != 0;
        self.broken &= !bit(Fault::Watchdog);
        self.at_start = self.present();
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

    /// Returns whether an injected code is 0 or in the table.
    pub(super) fn knows(reports: &[Report], code: u32) -> bool {
        code == 0 || reports.iter().any(|report| report.injection == Some(code))
    }

    /// Injects the fault with a code that it [`knows`](Self::knows), besides those injected before;
    /// 0 ends them all (manual 001, 9.4).
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

    /// Reports faults that appeared or ended since the last call: in 6503h, 6505h, and by the
    /// EMCY service.
    pub(super) fn report(&mut self, cx: &mut Context<'_, '_>, profile: &EncoderProfile) {
        if !core::mem::take(&mut self.changed) {
            return;
        }
        let reports = profile.reports;
        for (row, report) in rows(reports) {
            let detected = self.is_detected(row, report, reports);
            if detected && report.until != Until::Repaired {
                self.latched |= row;
            }
            let active = detected || (self.latched | self.injected) & row != 0;
            let known = self.shown & row != 0;
            if active == known || (profile.by_support && !is_supported(cx, report)) {
                continue;
            }
            self.change(cx, row, report, reports);
        }
    }

    /// Returns whether the fault of a row is present in the phase in which the row detects it.
    fn is_detected(&self, row: u32, report: &Report, reports: &[Report]) -> bool {
        if row == NO_ANGLE {
            return self.sensed & NO_ANGLE != 0;
        }
        let is_present = match report.fault {
            // The host sets it for the next start.
            Fault::Watchdog => self.watchdog,
            fault => self.present() & bit(fault) != 0,
        };
        if !is_present {
            return false;
        }
        let at_start_by = |other: &Report| {
            other.fault == report.fault
                && other.appears == Appears::Startup
                && self.at_start & bit(report.fault) != 0
        };
        match report.appears {
            Appears::Always => true,
            Appears::Startup => self.found & row != 0 && self.at_start & bit(report.fault) != 0,
            Appears::Runtime => !reports.iter().any(at_start_by),
            Appears::Injected => false,
        }
    }

    /// Reports that a row became active or ended: alarms (6503h), warnings (6505h), EMCY message.
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
        // Rows with the same code and the same bits of 1001h are one error for the EMCY service.
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

    /// Returns the reports that are active.
    fn shown_rows<'r>(&self, reports: &'r [Report]) -> impl Iterator<Item = &'r Report> {
        let shown = self.shown;
        rows(reports).filter_map(move |(row, report)| (shown & row != 0).then_some(report))
    }
}

/// Returns the rows of a table, each with its bit, and the row of [`NO_ANGLE`].
fn rows(reports: &[Report]) -> impl Iterator<Item = (u32, &Report)> {
    let of_table = (0..31).map(|row| 1 << row).zip(reports);
    of_table.chain([(NO_ANGLE, &EncoderProfile::NO_ANGLE)])
}

/// Returns whether the device supports a report: 6504h and 6506h, where they exist, have its bits.
fn is_supported(cx: &Context<'_, '_>, report: &Report) -> bool {
    let has = |index, bits: u16| match cx.store.try_unsigned(index, 0) {
        Some(supported) => supported & u64::from(bits) == u64::from(bits),
        None => true,
    };
    has(0x6504, report.alarm) && has(0x6506, report.warning)
}

/// Returns the bit of a fault that keeps the sensor from delivering the angle, and [`NO_ANGLE`]
/// unless the family has an alarm for the fault while the device runs.
fn sensed_bits(fault: Fault, reports: &[Report]) -> u32 {
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
