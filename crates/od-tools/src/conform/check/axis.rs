//! CiA 402: an axis of a drive, its states and modes, and a test that moves it.
//!
//! A case moves each axis a short way, and stops it again, also if it fails: quick stop, then disable voltage.

use od_model::Address;
use od_wire::nmt::Command;

use crate::conform::dut::Dut;
use crate::conform::end::{Checked, End, ensure, lacks};
use crate::conform::sdo::abort_text;

/// Time in which a drive changes to another state or mode, in microseconds.
pub(super) const CHANGE: u64 = 1_000_000;
/// Time in which an axis reaches its target or stops, in microseconds.
pub(super) const MOVE: u64 = 10_000_000;
/// Shortest way of a movement in position units.
pub(super) const WAY: i64 = 1000;

/// Number of a mode in 6060h.
pub(super) const PROFILE_POSITION: i8 = 1;
pub(super) const PROFILE_VELOCITY: i8 = 3;
pub(super) const HOMING: i8 = 6;
pub(super) const CYCLIC_POSITION: i8 = 8;
pub(super) const CYCLIC_VELOCITY: i8 = 9;
pub(super) const INTERPOLATED: i8 = 7;

/// Controlword: enable operation, and its bits in the modes.
pub(super) const ENABLE: u16 = 0x0F;
pub(super) const START: u16 = 1 << 4;
pub(super) const AT_ONCE: u16 = 1 << 5;
pub(super) const RELATIVE: u16 = 1 << 6;
pub(super) const HALT: u16 = 1 << 8;

/// A state in the statusword (6041h): its name, the mask of its bits, and their values.
pub(super) type Shown<'s> = (&'s str, u64, u64);
pub(super) const DISABLED: Shown<'_> = ("Switch on disabled", 0x4F, 0x40);
pub(super) const READY: Shown<'_> = ("Ready to switch on", 0x6F, 0x21);
pub(super) const SWITCHED_ON: Shown<'_> = ("Switched on", 0x6F, 0x23);
pub(super) const ENABLED: Shown<'_> = ("Operation enabled", 0x6F, 0x27);
pub(super) const QUICK_STOP: Shown<'_> = ("Quick stop active", 0x6F, 0x07);
pub(super) const FAULT: Shown<'_> = ("Fault", 0x4F, 0x08);
pub(super) const REACHED: Shown<'_> = ("target reached, bit 10 = 1", 1 << 10, 1 << 10);

/// An axis: the distance of its objects from those of the first axis.
#[derive(Clone, Copy)]
pub(super) struct Axis(pub(super) u16);

/// A test with the operation enabled.
pub(super) type Test = fn(&mut Dut<'_>, Axis) -> Checked;

/// Tests each axis that has the mode, enabled in it.
pub(super) fn each(dut: &mut Dut<'_>, mode: i8, test: Test) -> Checked {
    let axes = (0..8).map(|number| Axis(number * 0x800));
    let axes: Vec<Axis> = axes
        .filter(|axis| dut.eds.writes(0x6040 + axis.0, 0))
        .collect();
    for axis in axes {
        let done = axis.test(dut, mode, test);
        dut.fault(done)?;
    }
    Ok(())
}

impl Axis {
    pub(super) const fn at(self, index: u16) -> Address {
        Address::new(index + self.0, 0)
    }

    pub(super) fn has(self, dut: &Dut<'_>, index: u16) -> bool {
        dut.eds.has(index + self.0)
    }

    /// A value with its sign.
    pub(super) fn value(self, dut: &mut Dut<'_>, index: u16) -> Checked<i64> {
        let bytes = dut.read(self.at(index))?;
        Ok(signed(&bytes))
    }

    /// Writes a number with the length of the object; the old value returns after the case.
    pub(super) fn set(self, dut: &mut Dut<'_>, index: u16, value: i64) -> Checked {
        let len = dut.keep(self.at(index))?.len();
        dut.write(self.at(index), &value.to_le_bytes()[..len.min(8)])
    }

    /// Writes a number as [`set`](Self::set); a drive that refuses it skips the case.
    pub(super) fn choose(self, dut: &mut Dut<'_>, index: u16, value: i64) -> Checked {
        let len = dut.keep(self.at(index))?.len();
        match dut.download(self.at(index), &value.to_le_bytes()[..len.min(8)])? {
            Ok(()) => Ok(()),
            Err(code) => lacks(format!(
                "{value} in {}: {}",
                self.at(index),
                abort_text(code)
            )),
        }
    }

    /// The codes of an option code object that the drive accepts; without any the case is skipped.
    pub(super) fn codes(self, dut: &mut Dut<'_>, index: u16, codes: &[i64]) -> Checked<Vec<i64>> {
        let mut all = Vec::new();
        for code in codes {
            match self.choose(dut, index, *code) {
                Ok(()) => all.push(*code),
                Err(End::NotApplicable(_)) => {}
                Err(other) => return Err(other),
            }
        }
        if all.is_empty() {
            return lacks(format!(
                "the drive refuses every code in {}",
                self.at(index)
            ));
        }
        Ok(all)
    }

    pub(super) fn command(self, dut: &mut Dut<'_>, word: u16) -> Checked {
        dut.write(self.at(0x6040), &word.to_le_bytes())
    }

    /// Waits until the statusword shows this.
    pub(super) fn shows(
        self,
        dut: &mut Dut<'_>,
        micros: u64,
        (what, mask, bits): Shown<'_>,
    ) -> Checked {
        let end = dut.now().plus_micros(micros);
        loop {
            let is = self.value(dut, 0x6041)? as u64;
            if is & mask == bits || dut.now() >= end {
                return ensure(
                    is & mask == bits,
                    format!(
                        "{what} in {} within {} s",
                        self.at(0x6041),
                        micros / 1_000_000
                    ),
                    format!("{:04X}h was read", is & 0xFFFF),
                );
            }
            dut.wait(10_000)?;
        }
    }

    /// Waits until a value is this one, or nearly so.
    pub(super) fn comes_to(
        self,
        dut: &mut Dut<'_>,
        index: u16,
        wanted: i64,
        window: i64,
        when: &str,
    ) -> Checked {
        let end = dut.now().plus_micros(MOVE);
        loop {
            let is = self.value(dut, index)?;
            if (is - wanted).abs() <= window || dut.now() >= end {
                return self.is_at(index, is, wanted, window, when);
            }
            dut.wait(10_000)?;
        }
    }

    pub(super) fn is_at(
        self,
        index: u16,
        is: i64,
        wanted: i64,
        window: i64,
        when: &str,
    ) -> Checked {
        ensure(
            (is - wanted).abs() <= window,
            format!(
                "{wanted}, {window} off at most, in {} {when}",
                self.at(index)
            ),
            format!("{is} was read"),
        )
    }

    /// Enables the operation in a mode, runs the test, and stops the axis.
    pub(super) fn test(self, dut: &mut Dut<'_>, mode: i8, test: Test) -> Checked {
        if self.has(dut, 0x6502) {
            let modes = self.value(dut, 0x6502)?;
            if modes >> (mode - 1) & 1 == 0 {
                return lacks(format!("{} does not have mode {mode}", self.at(0x6502)));
            }
        }
        dut.nmt(Command::Start)?;
        self.command(dut, 0)?;
        if self.value(dut, 0x6041)? & 0x4F == 0x08 {
            return lacks("the drive has a fault");
        }
        self.shows(dut, CHANGE, DISABLED)?;
        if self.has(dut, 0x6060) {
            self.set(dut, 0x6060, mode.into())?;
        }
        // A target of an earlier movement does not move the axis.
        if self.has(dut, 0x60FF) {
            self.set(dut, 0x60FF, 0)?;
        }
        if self.has(dut, 0x607A) && self.has(dut, 0x6064) {
            let place = self.value(dut, 0x6064)?;
            self.set(dut, 0x607A, place)?;
        }
        let done = self.enable(dut).and_then(|()| test(dut, self));
        if matches!(done, Err(End::Lost(_))) {
            return done;
        }
        let stopped = self.stop(dut);
        done.and(stopped)
    }

    /// Transitions 2, 3 and 4.
    pub(super) fn enable(self, dut: &mut Dut<'_>) -> Checked {
        for (word, state) in [(6, READY), (7, SWITCHED_ON), (ENABLE, ENABLED)] {
            self.command(dut, word)?;
            self.shows(dut, CHANGE, state)?;
        }
        Ok(())
    }

    /// Quick stop; after the stop, disable voltage.
    pub(super) fn stop(self, dut: &mut Dut<'_>) -> Checked {
        dut.nmt(Command::Start)?;
        self.command(dut, 2)?;
        let end = dut.now().plus_micros(MOVE);
        while self.value(dut, 0x6041)? & 0x4F == 0x07 && dut.now() < end {
            if self.has(dut, 0x606C) && self.value(dut, 0x606C)?.abs() <= self.standing(dut)? {
                break;
            }
            dut.wait(10_000)?;
        }
        self.command(dut, 0)
    }

    /// Greatest speed of an axis that is at rest (606Fh).
    pub(super) fn standing(self, dut: &mut Dut<'_>) -> Checked<i64> {
        self.window(dut, 0x606F)
    }

    /// The value of a window, or 0 without the object.
    pub(super) fn window(self, dut: &mut Dut<'_>, index: u16) -> Checked<i64> {
        if self.has(dut, index) {
            let bytes = dut.read(self.at(index))?;
            return Ok(crate::conform::sdo::number(&bytes) as i64);
        }
        Ok(0)
    }

    /// A place that is [`WAY`] away, or ten times the position window (6067h).
    pub(super) fn way(self, dut: &mut Dut<'_>) -> Checked<i64> {
        match self.window(dut, 0x6067)? {
            window @ 0..=100_000 => Ok(WAY.max(10 * window)),
            _ => lacks("6067h is too wide to see whether the axis moves"),
        }
    }

    /// A tenth of the profile velocity (6081h), or ten times the velocity window (606Dh).
    pub(super) fn pace(self, dut: &mut Dut<'_>) -> Checked<i64> {
        let window = self.window(dut, 0x606D)?;
        let most = if self.has(dut, 0x6081) {
            self.window(dut, 0x6081)?
        } else {
            WAY
        };
        Ok((most / 10).max(10 * window).max(1))
    }

    /// Lets the built-in drive follow its demand late, as a real one does, by the object 2001h of this drive.
    pub(super) fn lag(self, dut: &mut Dut<'_>, millis: u16) -> Checked {
        let is_its = dut.number(0x1018, 1)? == 0x5F && dut.number(0x1018, 2)? == 0x402;
        let lag = Address::new(0x2001, (self.0 / 0x800) as u8 + 1);
        if is_its && dut.eds.writes(lag.index, lag.sub) {
            dut.set(lag, &millis.to_le_bytes())?;
        }
        Ok(())
    }

    /// Moves at this speed in a velocity mode.
    pub(super) fn runs(self, dut: &mut Dut<'_>, pace: i64) -> Checked {
        let window = self.window(dut, 0x606D)?.max(pace / 100);
        self.set(dut, 0x60FF, pace)?;
        self.comes_to(dut, 0x606C, pace, window, "after 60FFh was written")
    }

    /// Writes a set-point, and waits for the handshake of bits 4 and 12. Returns the statusword after bit 12 became 1.
    pub(super) fn set_point(self, dut: &mut Dut<'_>, target: i64, how: u16) -> Checked<u64> {
        let acknowledged = 1 << 12;
        self.command(dut, ENABLE | how)?;
        self.shows(
            dut,
            CHANGE,
            ("bit 12 = 0 before a new set-point", acknowledged, 0),
        )?;
        self.set(dut, 0x607A, target)?;
        self.command(dut, ENABLE | how | START)?;
        let set = (
            "set-point acknowledged, bit 12 = 1, after bit 4 of the controlword",
            acknowledged,
            acknowledged,
        );
        self.shows(dut, CHANGE, set)?;
        let word = self.value(dut, 0x6041)? as u64;
        self.command(dut, ENABLE | how)?;
        self.shows(dut, MOVE, ("bit 12 = 0 after bit 4 = 0", acknowledged, 0))?;
        Ok(word)
    }

    /// Waits for bit 10, and compares the place.
    pub(super) fn arrives(self, dut: &mut Dut<'_>, target: i64) -> Checked {
        self.shows(dut, MOVE, REACHED)?;
        let window = self.window(dut, 0x6067)?;
        let is = self.value(dut, 0x6064)?;
        self.is_at(0x6064, is, target, window, "when bit 10 is 1")
    }

    /// Leads to Switch on disabled, also from a fault, whose reaction may last.
    pub(super) fn recover(self, dut: &mut Dut<'_>) -> Checked {
        dut.nmt(Command::Start)?;
        let end = dut.now().plus_micros(MOVE);
        self.command(dut, 0)?;
        while self.value(dut, 0x6041)? as u64 & DISABLED.1 != DISABLED.2 && dut.now() < end {
            self.command(dut, 0x80)?;
            self.command(dut, 0)?;
            dut.wait(20_000)?;
        }
        self.shows(dut, 0, DISABLED)
    }

    /// Enables the operation again, after a stop or a fault, and moves the axis.
    pub(super) fn runs_again(self, dut: &mut Dut<'_>, pace: i64) -> Checked {
        self.recover(dut)?;
        self.enable(dut)?;
        self.runs(dut, 0)?;
        self.runs(dut, pace)
    }
}

/// A number of two's complement.
pub(super) fn signed(bytes: &[u8]) -> i64 {
    let value = crate::conform::sdo::number(bytes);
    let unused = 64 - 8 * bytes.len().clamp(1, 8) as u32;
    (value << unused) as i64 >> unused
}
