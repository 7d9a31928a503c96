//! CiA 402: the modes of an axis in motion. Each case needs the permission `motion`.

use od_model::Address;
use od_wire::nmt::Command;

use super::axis::{
    AT_ONCE, Axis, CHANGE, CYCLIC_POSITION, CYCLIC_VELOCITY, DISABLED, ENABLE, ENABLED,
    INTERPOLATED, MOVE, PROFILE_POSITION, PROFILE_VELOCITY, REACHED, READY, RELATIVE, START,
    SWITCHED_ON, Shown, each,
};
use crate::conform::dut::Dut;
use crate::conform::end::{Checked, End, ensure};

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
            if word == ENABLE {
                let bits = 1 << 4 | 1 << 9;
                let shown = "voltage enabled and remote, bits 4 and 9 = 11, in Operation enabled";
                let done = axis.shows(dut, CHANGE, (shown, bits, bits));
                dut.fault(done)?;
            }
        }
        if !dut.may_reset {
            return Ok(());
        }
        axis.enable(dut)?;
        dut.reset(Command::ResetNode)?;
        let (_, mask, bits) = DISABLED;
        let after = "Switch on disabled after NMT reset node in Operation enabled,";
        axis.shows(dut, CHANGE, (after, mask, bits))
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
        let word = axis.set_point(dut, far, 0)?;
        let done = ensure(
            word & REACHED.1 == 0,
            format!(
                "bit 10 = 0 in {} with a new set-point that is {} away",
                axis.at(0x6041),
                10 * way
            ),
            format!("{word:04X}h was read"),
        );
        dut.fault(done)?;
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

impl Axis {
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
}
