//! CiA 402: an axis in motion. Each case needs the permission `motion`.
//!
//! A case moves each axis a short way, and stops it again, also if it fails: quick stop, then disable voltage.

use od_model::Address;
use od_wire::nmt::Command;

use crate::conform::dut::Dut;
use crate::conform::end::{Checked, End, ensure, fail, lacks};
use crate::conform::sdo::abort_text;

/// Time in which a drive changes to another state or mode, in microseconds.
pub(super) const CHANGE: u64 = 1_000_000;
/// Time in which an axis reaches its target or stops, in microseconds.
pub(super) const MOVE: u64 = 10_000_000;
/// Shortest way of a movement in position units.
const WAY: i64 = 1000;

/// Number of a mode in 6060h.
pub(super) const PROFILE_POSITION: i8 = 1;
pub(super) const PROFILE_VELOCITY: i8 = 3;
pub(super) const HOMING: i8 = 6;
pub(super) const CYCLIC_POSITION: i8 = 8;
const CYCLIC_VELOCITY: i8 = 9;
const INTERPOLATED: i8 = 7;

/// Controlword: enable operation, and its bits in the modes.
pub(super) const ENABLE: u16 = 0x0F;
pub(super) const START: u16 = 1 << 4;
const AT_ONCE: u16 = 1 << 5;
const RELATIVE: u16 = 1 << 6;
pub(super) const HALT: u16 = 1 << 8;

/// A state in the statusword (6041h): its name, the mask of its bits, and their values.
pub(super) type Shown<'s> = (&'s str, u64, u64);
pub(super) const DISABLED: Shown<'_> = ("Switch on disabled", 0x4F, 0x40);
pub(super) const READY: Shown<'_> = ("Ready to switch on", 0x6F, 0x21);
pub(super) const SWITCHED_ON: Shown<'_> = ("Switched on", 0x6F, 0x23);
pub(super) const ENABLED: Shown<'_> = ("Operation enabled", 0x6F, 0x27);
const QUICK_STOP: Shown<'_> = ("Quick stop active", 0x6F, 0x07);
const FAULT: Shown<'_> = ("Fault", 0x4F, 0x08);
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
    fn codes(self, dut: &mut Dut<'_>, index: u16, codes: &[i64]) -> Checked<Vec<i64>> {
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
    fn test(self, dut: &mut Dut<'_>, mode: i8, test: Test) -> Checked {
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
    fn enable(self, dut: &mut Dut<'_>) -> Checked {
        for (word, state) in [(6, READY), (7, SWITCHED_ON), (ENABLE, ENABLED)] {
            self.command(dut, word)?;
            self.shows(dut, CHANGE, state)?;
        }
        Ok(())
    }

    /// Quick stop; after the stop, disable voltage.
    fn stop(self, dut: &mut Dut<'_>) -> Checked {
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

    /// Moves at this speed in a velocity mode.
    fn runs(self, dut: &mut Dut<'_>, pace: i64) -> Checked {
        let window = self.window(dut, 0x606D)?.max(pace / 100);
        self.set(dut, 0x60FF, pace)?;
        self.comes_to(dut, 0x606C, pace, window, "after 60FFh was written")
    }

    /// Writes a set-point, and waits for the handshake of bits 4 and 12.
    pub(super) fn set_point(self, dut: &mut Dut<'_>, target: i64, how: u16) -> Checked {
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
        self.command(dut, ENABLE | how)?;
        self.shows(dut, MOVE, ("bit 12 = 0 after bit 4 = 0", acknowledged, 0))
    }

    /// Waits for bit 10, and compares the place.
    fn arrives(self, dut: &mut Dut<'_>, target: i64) -> Checked {
        self.shows(dut, MOVE, REACHED)?;
        let window = self.window(dut, 0x6067)?;
        let is = self.value(dut, 0x6064)?;
        self.is_at(0x6064, is, target, window, "when bit 10 is 1")
    }
}

fn signed(bytes: &[u8]) -> i64 {
    let value = crate::conform::sdo::number(bytes);
    let unused = 64 - 8 * bytes.len().clamp(1, 8) as u32;
    (value << unused) as i64 >> unused
}

/// Transitions 2 to 5, 8 and 9.
pub(super) fn enable(dut: &mut Dut<'_>) -> Checked {
    each(dut, PROFILE_VELOCITY, |dut, axis| {
        for (word, state) in [
            (7, SWITCHED_ON),
            (ENABLE, ENABLED),
            (6, READY),
            (7, SWITCHED_ON),
            (ENABLE, ENABLED),
            (0, DISABLED),
        ] {
            axis.command(dut, word)?;
            axis.shows(dut, CHANGE, state)?;
        }
        Ok(())
    })
}

pub(super) fn set_point(dut: &mut Dut<'_>) -> Checked {
    each(dut, PROFILE_POSITION, |dut, axis| {
        let target = axis.value(dut, 0x6064)? + axis.way(dut)?;
        axis.set_point(dut, target, 0)?;
        axis.arrives(dut, target)?;
        if axis.has(dut, 0x6062) {
            let (is, window) = (axis.value(dut, 0x6062)?, axis.window(dut, 0x6067)?);
            axis.is_at(0x6062, is, target, window, "when the axis is there")?;
        }
        if axis.has(dut, 0x60F4) {
            let window = axis.window(dut, 0x6067)?;
            let is = axis.value(dut, 0x60F4)?;
            axis.is_at(0x60F4, is, 0, window, "when the axis is there")?;
        }
        if !dut.eds.writes(0x6081 + axis.0, 0) || !axis.has(dut, 0x606C) {
            return Ok(());
        }
        let pace = axis.pace(dut)?;
        axis.set(dut, 0x6081, pace)?;
        let mut target = target;
        for (index, most) in [(0x6081, pace), (0x607F, pace / 2)] {
            if index == 0x607F && (!dut.eds.writes(index + axis.0, 0) || pace < 2) {
                continue;
            }
            axis.set(dut, index, most)?;
            target -= axis.way(dut)?;
            axis.set_point(dut, target, 0)?;
            let end = dut.now().plus_micros(MOVE);
            let window = axis.window(dut, 0x606D)?.max(most / 10);
            let mut speed = 0;
            while axis.value(dut, 0x6041)? as u64 & REACHED.1 == 0 && dut.now() < end {
                speed = axis.value(dut, 0x606C)?.abs().max(speed);
                dut.wait(2_000)?;
            }
            ensure(
                speed <= most + window,
                format!(
                    "{} within {most}, the value of {index:04X}h",
                    axis.at(0x606C)
                ),
                format!("{speed} was read"),
            )?;
            axis.arrives(dut, target)?;
        }
        Ok(())
    })
}

pub(super) fn relative(dut: &mut Dut<'_>) -> Checked {
    each(dut, PROFILE_POSITION, |dut, axis| {
        let (from, way) = (axis.value(dut, 0x6064)?, axis.way(dut)?);
        axis.set_point(dut, way, RELATIVE)?;
        axis.arrives(dut, from + way)?;
        axis.set_point(dut, -way, RELATIVE)?;
        axis.arrives(dut, from)
    })
}

/// The second set-point arrives while the axis moves slowly to the first, which it must not reach.
pub(super) fn at_once(dut: &mut Dut<'_>) -> Checked {
    each(dut, PROFILE_POSITION, |dut, axis| {
        let (from, way) = (axis.value(dut, 0x6064)?, axis.way(dut)?);
        let far = from + 10 * way;
        if axis.has(dut, 0x6081) {
            let pace = axis.pace(dut)?;
            axis.set(dut, 0x6081, pace)?;
        }
        axis.set_point(dut, far, 0)?;
        axis.set_point(dut, from, AT_ONCE)?;
        let place = axis.value(dut, 0x6064)?;
        ensure(
            place < far - way,
            format!("{} on its way back, before {far}", axis.at(0x6064)),
            format!("{place} was read"),
        )?;
        axis.arrives(dut, from)
    })
}

pub(super) fn limit(dut: &mut Dut<'_>) -> Checked {
    each(dut, PROFILE_POSITION, |dut, axis| {
        let way = axis.way(dut)?;
        for (sub, sign, beyond) in [(2, 1, "above"), (1, -1, "below")] {
            let edge = Address::new(0x607D + axis.0, sub);
            if !dut.eds.writes(edge.index, sub) {
                continue;
            }
            let before = dut.keep(edge)?;
            let from = axis.value(dut, 0x6064)?;
            let limit = from + sign * way;
            dut.write(edge, &(limit as i32).to_le_bytes())?;
            axis.command(dut, ENABLE)?;
            dut.keep(axis.at(0x607A))?;
            let target = (limit + sign * way) as i32;
            // A drive may refuse such a target.
            if dut
                .download(axis.at(0x607A), &target.to_le_bytes())?
                .is_ok()
            {
                axis.command(dut, ENABLE | START)?;
            }
            let end = dut.now().plus_micros(CHANGE);
            let window = axis.window(dut, 0x6067)?;
            let mut place = from;
            while dut.now() < end {
                let is = axis.value(dut, 0x6064)?;
                place = if sign * is > sign * place { is } else { place };
                dut.wait(10_000)?;
            }
            ensure(
                sign * (place - limit) <= window,
                format!(
                    "{} not {beyond} {limit}, the limit in {edge}",
                    axis.at(0x6064)
                ),
                format!("{place} was read"),
            )?;
            dut.write(edge, &before)?;
        }
        Ok(())
    })
}

/// Target velocity, then 0: bits 10 and 12.
pub(super) fn velocity(dut: &mut Dut<'_>) -> Checked {
    each(dut, PROFILE_VELOCITY, |dut, axis| {
        let pace = axis.pace(dut)?;
        axis.runs(dut, pace)?;
        axis.shows(dut, CHANGE, REACHED)?;
        axis.shows(dut, CHANGE, ("bit 12 = 0 while the axis moves", 1 << 12, 0))?;
        if axis.has(dut, 0x606B) {
            let window = axis.window(dut, 0x606D)?.max(pace / 100);
            let is = axis.value(dut, 0x606B)?;
            axis.is_at(0x606B, is, pace, window, "at the target velocity")?;
        }
        axis.runs(dut, -pace)?;
        axis.set(dut, 0x60FF, 0)?;
        axis.shows(dut, MOVE, ("speed zero, bit 12 = 1", 1 << 12, 1 << 12))?;
        let (is, window) = (axis.value(dut, 0x606C)?, axis.standing(dut)?);
        axis.is_at(0x606C, is, 0, window, "when bit 12 is 1")?;
        if !dut.eds.writes(0x607F + axis.0, 0) || pace < 2 {
            return Ok(());
        }
        axis.set(dut, 0x607F, pace / 2)?;
        axis.set(dut, 0x60FF, pace)?;
        let window = axis.window(dut, 0x606D)?.max(pace / 100);
        axis.comes_to(dut, 0x606C, pace / 2, window, "with this value in 607Fh")?;
        dut.wait(200_000)?;
        let is = axis.value(dut, 0x606C)?;
        axis.is_at(0x606C, is, pace / 2, window, "with this value in 607Fh")
    })
}

/// Bit 6 of 607Eh turns the direction of a velocity, not the sign of 606Ch; bit 7 turns the sign of positions.
pub(super) fn polarity(dut: &mut Dut<'_>) -> Checked {
    each(dut, PROFILE_VELOCITY, |dut, axis| {
        let pace = axis.pace(dut)?;
        for (polarity, sign) in [(0, 1), (0x40, -1)] {
            axis.recover(dut)?;
            axis.choose(dut, 0x607E, polarity)?;
            axis.enable(dut)?;
            axis.runs(dut, pace)?;
            let from = axis.value(dut, 0x6064)?;
            dut.wait(200_000)?;
            let way = axis.value(dut, 0x6064)? - from;
            ensure(
                way * sign > 0,
                format!(
                    "{} to become {} with {pace} in 60FFh and {polarity:02X}h in 607Eh",
                    axis.at(0x6064),
                    if sign > 0 { "greater" } else { "smaller" }
                ),
                format!("it changed by {way}"),
            )?;
        }
        axis.recover(dut)?;
        axis.choose(dut, 0x607E, 0)?;
        axis.turns_sign(dut)
    })
}

pub(super) fn cyclic_velocity(dut: &mut Dut<'_>) -> Checked {
    each(dut, CYCLIC_VELOCITY, |dut, axis| {
        let pace = axis.pace(dut)?;
        axis.runs(dut, pace)?;
        axis.shows(dut, CHANGE, FOLLOWS)?;
        axis.runs(dut, 0)
    })
}

const FOLLOWS: Shown<'_> = (
    "drive follows the command value, bit 12 = 1",
    1 << 12,
    1 << 12,
);

/// Twenty target positions in a row.
pub(super) fn cyclic_position(dut: &mut Dut<'_>) -> Checked {
    each(dut, CYCLIC_POSITION, |dut, axis| {
        let (from, way) = (axis.value(dut, 0x6064)?, axis.way(dut)?);
        let mut target = from;
        for step in 1..=20 {
            target = from + way * step / 20;
            axis.set(dut, 0x607A, target)?;
            dut.wait(10_000)?;
        }
        axis.shows(dut, CHANGE, FOLLOWS)?;
        let window = axis.window(dut, 0x6067)?.max(way / 100);
        axis.comes_to(
            dut,
            0x6064,
            target,
            window,
            "after the last target position",
        )
    })
}

/// Twenty positions in a row while bit 4 is 1; without it the axis stays.
pub(super) fn interpolated(dut: &mut Dut<'_>) -> Checked {
    each(dut, INTERPOLATED, |dut, axis| {
        let record = Address::new(0x60C1 + axis.0, 1);
        dut.keep(record)?;
        let (from, way) = (axis.value(dut, 0x6064)?, axis.way(dut)?);
        let window = axis.window(dut, 0x6067)?.max(way / 100);
        let active = "interpolation active, bit 12 = 1, with bit 4 of 6040h";
        for (word, is_active, to) in [(ENABLE | START, true, from + way), (ENABLE, false, from)] {
            let (begin, end) = (axis.value(dut, 0x6064)?, to);
            dut.write(record, &(begin as i32).to_le_bytes())?;
            axis.command(dut, word)?;
            for step in 1..=20 {
                let place = begin + (end - begin) * step / 20;
                dut.write(record, &(place as i32).to_le_bytes())?;
                dut.wait(10_000)?;
            }
            if is_active {
                axis.shows(dut, CHANGE, (active, FOLLOWS.1, FOLLOWS.2))?;
                axis.comes_to(dut, 0x6064, end, window, "after the last record of 60C1h")?;
            } else {
                dut.wait(200_000)?;
                let is = axis.value(dut, 0x6064)?;
                axis.is_at(0x6064, is, begin, window, "with bit 4 of 6040h = 0")?;
            }
        }
        Ok(())
    })
}

pub(super) fn quick_stop(dut: &mut Dut<'_>) -> Checked {
    each(dut, PROFILE_VELOCITY, |dut, axis| {
        let pace = axis.pace(dut)?;
        let codes = axis.codes(dut, 0x605A, &[2, 6, 1, 5, 3, 7, 4, 8, 0])?;
        for code in codes {
            axis.choose(dut, 0x605A, code)?;
            axis.enable(dut)?;
            axis.runs(dut, pace)?;
            axis.command(dut, 2)?;
            if code != 0 {
                let window = axis.standing(dut)?;
                let when = format!("after quick stop with {code} in 605Ah");
                axis.comes_to(dut, 0x606C, 0, window, &when)?;
            }
            let state = if code < 5 { DISABLED } else { QUICK_STOP };
            axis.shows(dut, CHANGE, state)?;
            axis.command(dut, 0)?;
            axis.shows(dut, CHANGE, DISABLED)?;
        }
        Ok(())
    })
}

/// Each ramp lasts longer with a smaller value of its object.
pub(super) fn ramps(dut: &mut Dut<'_>) -> Checked {
    each(dut, PROFILE_VELOCITY, |dut, axis| {
        let mut is_tested = false;
        for ramp in RAMPS {
            if dut.eds.writes(ramp.index + axis.0, 0) {
                let done = axis.slow(dut, ramp).map(drop);
                dut.fault(done)?;
                is_tested = true;
            }
        }
        if is_tested {
            Ok(())
        } else {
            lacks("no object of a ramp can be written")
        }
    })
}

/// Code 1 slows down on the slow down ramp (6084h), code 2 on the quick stop ramp (6085h). 6084h is small here, so that
/// the axis still moves with code 1 at the moment when it was at rest with code 2.
pub(super) fn ramp_options(dut: &mut Dut<'_>) -> Checked {
    each(dut, PROFILE_VELOCITY, |dut, axis| {
        if !dut.eds.writes(0x6084 + axis.0, 0) || !axis.has(dut, 0x6085) {
            return lacks("the drive does not have both ramps, 6084h rw and 6085h");
        }
        let pace = axis.pace(dut)?;
        let slow = axis.slow(dut, DECELERATION)?;
        axis.set(dut, 0x6084, slow)?;
        if axis.has(dut, 0x6007) {
            axis.set(dut, 0x6007, 1)?;
        }
        for stop in STOPS {
            let has = dut.eds.writes(stop.index + axis.0, 0);
            if !has || stop.index == 0x605E && !axis.has(dut, 0x6007) {
                continue;
            }
            let done = axis.stops_by(dut, stop, pace);
            dut.fault(done)?;
        }
        axis.recover(dut)
    })
}

/// A ramp: its object, and the change of the speed on it.
#[derive(Clone, Copy)]
pub(super) struct Ramp {
    index: u16,
    /// Whether the axis moves before the ramp, and rests after it.
    is_stop: bool,
    /// The controlword that begins the ramp; otherwise 60FFh begins it.
    word: Option<u16>,
}

pub(super) const DECELERATION: Ramp = Ramp {
    index: 0x6084,
    is_stop: true,
    word: None,
};
const RAMPS: [Ramp; 3] = [
    Ramp {
        index: 0x6083,
        is_stop: false,
        word: None,
    },
    DECELERATION,
    Ramp {
        index: 0x6085,
        is_stop: true,
        word: Some(2),
    },
];

/// An option code with the codes 1 and 2: the controlword that stops the axis, or NMT stop.
#[derive(Clone, Copy)]
struct Stop {
    index: u16,
    word: Option<u16>,
}

const STOPS: [Stop; 3] = [
    Stop {
        index: 0x605A,
        word: Some(2),
    },
    Stop {
        index: 0x605D,
        word: Some(ENABLE | HALT),
    },
    Stop {
        index: 0x605E,
        word: None,
    },
];

impl Axis {
    /// Leads to Switch on disabled, also from a fault, whose reaction may last.
    fn recover(self, dut: &mut Dut<'_>) -> Checked {
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

    /// Finds a value of a ramp with which it lasts longer than with the present one, which returns. The quick stop option
    /// code is 2 then.
    pub(super) fn slow(self, dut: &mut Dut<'_>, ramp: Ramp) -> Checked<i64> {
        const LONGER: u64 = 200_000;
        let pace = self.pace(dut)?;
        let present = self.window(dut, ramp.index)?;
        if ramp.word.is_some() && self.has(dut, 0x605A) {
            self.choose(dut, 0x605A, 2)?;
        }
        let quick = self.takes(dut, ramp, pace)?;
        let smaller = [4, 8, 12, 16].map(|bits| (present >> bits).max(1));
        for value in smaller.into_iter().filter(|value| *value < present) {
            self.runs_again(dut, if ramp.is_stop { pace } else { 0 })?;
            self.choose(dut, ramp.index, value)?;
            self.begin(dut, ramp, pace)?;
            dut.wait(quick + LONGER)?;
            let is = self.value(dut, 0x606C)?;
            self.set(dut, ramp.index, present)?;
            let wanted = if ramp.is_stop { 0 } else { pace };
            if (is - wanted).abs() > pace / 10 {
                return Ok(value);
            }
        }
        fail(
            format!(
                "a longer ramp with a smaller value in {}",
                self.at(ramp.index)
            ),
            format!("it lasts {} ms with every value", quick / 1000),
        )
    }

    /// Bit 7 of 607Eh turns the sign of 6064h, of an axis at rest.
    fn turns_sign(self, dut: &mut Dut<'_>) -> Checked {
        dut.wait(200_000)?;
        let (place, window) = (self.value(dut, 0x6064)?, self.window(dut, 0x6067)?);
        if place.abs() <= 10 * window.max(1) || self.value(dut, 0x6064)? != place {
            return Ok(());
        }
        match self.choose(dut, 0x607E, 0x80) {
            // A drive need not have this bit.
            Err(End::NotApplicable(_)) => return Ok(()),
            done => done?,
        }
        dut.wait(50_000)?;
        let is = self.value(dut, 0x6064)?;
        self.choose(dut, 0x607E, 0)?;
        self.is_at(0x6064, is, -place, window, "with 80h in 607Eh")
    }

    /// Begins a ramp.
    fn begin(self, dut: &mut Dut<'_>, ramp: Ramp, pace: i64) -> Checked {
        match ramp.word {
            Some(word) => self.command(dut, word),
            None => self.set(dut, 0x60FF, if ramp.is_stop { 0 } else { pace }),
        }
    }

    /// Duration of a ramp with the present value, in microseconds.
    fn takes(self, dut: &mut Dut<'_>, ramp: Ramp, pace: i64) -> Checked<u64> {
        self.runs_again(dut, if ramp.is_stop { pace } else { 0 })?;
        let from = dut.now();
        self.begin(dut, ramp, pace)?;
        let wanted = if ramp.is_stop { 0 } else { pace };
        self.comes_to(dut, 0x606C, wanted, pace / 10, "at the end of the ramp")?;
        Ok(dut.now().micros_since(from))
    }

    /// Stops with code 2, then with code 1.
    fn stops_by(self, dut: &mut Dut<'_>, stop: Stop, pace: i64) -> Checked {
        let mut quick = 0;
        for code in [2, 1] {
            match self.choose(dut, stop.index, code) {
                // A drive need not have both codes.
                Err(End::NotApplicable(_)) => return Ok(()),
                done => done?,
            }
            self.runs_again(dut, pace)?;
            let from = dut.now();
            match stop.word {
                Some(word) => self.command(dut, word)?,
                None => {
                    dut.nmt(Command::Stop)?;
                    dut.nmt(Command::Start)?;
                }
            }
            let when = format!("with {code} in {}", self.at(stop.index));
            if code == 2 {
                self.comes_to(dut, 0x606C, 0, pace / 10, &when)?;
                quick = dut.now().micros_since(from);
                continue;
            }
            dut.wait(quick.saturating_sub(dut.now().micros_since(from)))?;
            let is = self.value(dut, 0x606C)?;
            ensure(
                is.abs() > pace / 10,
                format!(
                    "an axis that still moves after {} ms {when}, as 6084h is small",
                    quick / 1000
                ),
                format!("{is} in {}", self.at(0x606C)),
            )?;
        }
        Ok(())
    }
}

/// Slow down, then the next state (code 1 in 605Bh and 605Ch).
pub(super) fn stop_options(dut: &mut Dut<'_>) -> Checked {
    each(dut, PROFILE_VELOCITY, |dut, axis| {
        let pace = axis.pace(dut)?;
        for (index, word, state) in [(0x605C, 7, SWITCHED_ON), (0x605B, 6, READY)] {
            if !axis.has(dut, index) {
                continue;
            }
            axis.choose(dut, index, 1)?;
            axis.command(dut, 7)?;
            axis.command(dut, ENABLE)?;
            axis.shows(dut, CHANGE, ENABLED)?;
            axis.runs(dut, pace)?;
            axis.command(dut, word)?;
            axis.shows(dut, MOVE, state)?;
            let (is, window) = (axis.value(dut, 0x606C)?, axis.standing(dut)?);
            let when = format!("in {}, with 1 in {}", state.0, axis.at(index));
            axis.is_at(0x606C, is, 0, window, &when)?;
        }
        Ok(())
    })
}

pub(super) fn halt(dut: &mut Dut<'_>) -> Checked {
    each(dut, PROFILE_VELOCITY, |dut, axis| {
        let pace = axis.pace(dut)?;
        axis.runs(dut, pace)?;
        let mut codes = vec![axis.value(dut, 0x605D)?];
        if dut.eds.writes(0x605D + axis.0, 0) {
            codes = axis.codes(dut, 0x605D, &[1, 2, 3, 4])?;
        }
        for code in codes {
            if dut.eds.writes(0x605D + axis.0, 0) {
                axis.choose(dut, 0x605D, code)?;
            }
            axis.command(dut, ENABLE | HALT)?;
            let window = axis.standing(dut)?;
            let when = format!("after halt, bit 8 of 6040h, with {code} in 605Dh");
            axis.comes_to(dut, 0x606C, 0, window, &when)?;
            axis.shows(dut, CHANGE, ENABLED)?;
            axis.shows(
                dut,
                CHANGE,
                ("bit 10 = 1 when the axis is halted", REACHED.1, REACHED.2),
            )?;
            axis.command(dut, ENABLE)?;
            let window = axis.window(dut, 0x606D)?.max(pace / 100);
            axis.comes_to(dut, 0x606C, pace, window, "after halt ends")?;
        }
        Ok(())
    })
}

/// A fault, by NMT stop with code 1 in 6007h, and its reset.
pub(super) fn connection_lost(dut: &mut Dut<'_>) -> Checked {
    each(dut, PROFILE_VELOCITY, |dut, axis| {
        axis.choose(dut, 0x6007, 1)?;
        dut.nmt(Command::Stop)?;
        dut.nmt(Command::Start)?;
        axis.shows(dut, MOVE, FAULT)?;
        // A fault ends by bit 7 only.
        axis.command(dut, 6)?;
        axis.shows(dut, 0, FAULT)?;
        if axis.has(dut, 0x603F) {
            let code = axis.value(dut, 0x603F)?;
            let done = ensure(
                code != 0,
                format!("the code of the fault in {}", axis.at(0x603F)),
                "0 was read",
            );
            dut.fault(done)?;
        }
        axis.command(dut, 0x80)?;
        axis.shows(dut, CHANGE, DISABLED)?;
        // The change of bit 7 from 0 to 1 resets a fault: one that occurs later stays.
        axis.command(dut, 0)?;
        axis.enable(dut)?;
        axis.command(dut, ENABLE | 0x80)?;
        dut.nmt(Command::Stop)?;
        dut.nmt(Command::Start)?;
        axis.shows(dut, MOVE, FAULT)?;
        axis.command(dut, ENABLE | 0x80)?;
        dut.wait(50_000)?;
        axis.shows(
            dut,
            0,
            ("Fault, as bit 7 of 6040h stayed 1,", FAULT.1, FAULT.2),
        )?;
        axis.command(dut, 0)?;
        axis.command(dut, 0x80)?;
        axis.shows(dut, CHANGE, DISABLED)
    })
}

/// The axis moves when the fault occurs: with code 1 or 2 in 605Eh it is at rest in Fault.
pub(super) fn fault_reaction(dut: &mut Dut<'_>) -> Checked {
    each(dut, PROFILE_VELOCITY, |dut, axis| {
        axis.choose(dut, 0x6007, 1)?;
        let pace = axis.pace(dut)?;
        for code in axis.codes(dut, 0x605E, &[1, 2, 3, 4])? {
            axis.choose(dut, 0x605E, code)?;
            axis.command(dut, 0)?;
            axis.shows(dut, CHANGE, DISABLED)?;
            axis.enable(dut)?;
            axis.runs(dut, pace)?;
            dut.nmt(Command::Stop)?;
            dut.nmt(Command::Start)?;
            axis.shows(dut, MOVE, FAULT)?;
            let (is, window) = (axis.value(dut, 0x606C)?, axis.standing(dut)?);
            let when = format!("in Fault, with {code} in 605Eh");
            axis.is_at(0x606C, is, 0, window, &when)?;
            axis.command(dut, 0x80)?;
            axis.shows(dut, CHANGE, DISABLED)?;
        }
        Ok(())
    })
}

/// NMT stop with the other codes of 6007h: no action, disable voltage, quick stop.
pub(super) fn connection_options(dut: &mut Dut<'_>) -> Checked {
    each(dut, PROFILE_VELOCITY, |dut, axis| {
        // Quick stop active shows that the stop was a quick stop.
        let quick = axis.has(dut, 0x605A) && axis.choose(dut, 0x605A, 6).is_ok();
        for code in axis.codes(dut, 0x6007, &[2, 3, 0])? {
            let state = match code {
                0 => ENABLED,
                3 if quick => QUICK_STOP,
                3 => continue,
                _ => DISABLED,
            };
            axis.choose(dut, 0x6007, code)?;
            axis.command(dut, 0)?;
            axis.shows(dut, CHANGE, DISABLED)?;
            axis.enable(dut)?;
            dut.nmt(Command::Stop)?;
            dut.nmt(Command::Start)?;
            let (name, mask, bits) = state;
            let name = format!("{name} after NMT stop, with {code} in 6007h,");
            axis.shows(dut, CHANGE, (&name, mask, bits))?;
        }
        Ok(())
    })
}
