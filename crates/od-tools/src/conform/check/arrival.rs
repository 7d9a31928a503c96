//! CiA 402: when an axis has arrived: windows, and the time in them. Each case needs the permission `motion`.

use od_model::Address;
use od_wire::Instant;

use super::axis::{Axis, CYCLIC_POSITION, MOVE, PROFILE_POSITION, PROFILE_VELOCITY, REACHED, each};
use crate::conform::dut::Dut;
use crate::conform::end::{Checked, at_least_one, ensure, lacks};

/// Time in a window until bit 10 is 1, in milliseconds.
const IN_WINDOW: i64 = 500;

/// Bit 10 becomes 1 when the position was within 6067h for the time of 6068h, not before.
pub(super) fn position_window_time(dut: &mut Dut<'_>) -> Checked {
    each(dut, PROFILE_POSITION, |dut, axis| {
        axis.choose(dut, 0x6068, IN_WINDOW)?;
        let target = axis.value(dut, 0x6064)? + axis.way(dut)?;
        let window = axis.window(dut, 0x6067)?;
        axis.set_point(dut, target, 0)?;
        reaches_after(axis, dut, 0x6064, target, window, 0x6068)
    })
}

/// Bit 10 is 1 only while the position is within 6067h of the target, also with another window.
pub(super) fn position_window(dut: &mut Dut<'_>) -> Checked {
    each(dut, PROFILE_POSITION, |dut, axis| {
        axis.lag(dut, 100)?;
        let before = axis.window(dut, 0x6067)?;
        if before < 2 {
            return lacks("6067h is 0 or 1, so that no window is smaller");
        }
        let way = axis.way(dut)?;
        for window in [before, before / 4, before] {
            axis.choose(dut, 0x6067, window)?;
            let target = axis.value(dut, 0x6064)? + way;
            axis.set_point(dut, target, 0)?;
            let end = dut.now().plus_micros(MOVE);
            while axis.value(dut, 0x6041)? as u64 & REACHED.1 == 0 && dut.now() < end {
                dut.wait(2_000)?;
            }
            let place = axis.value(dut, 0x6064)?;
            let is_reached = axis.value(dut, 0x6041)? as u64 & REACHED.1 != 0;
            let off = (target - place).abs();
            let name = axis.at(0x6067);
            // A drive may not come as near as a quarter of its window; its sensor may be one unit off.
            let is_right = if is_reached {
                off <= window + 1
            } else {
                window < before
            };
            let done = ensure(
                is_right,
                format!("bit 10 = 1 at the target position, {window} off at most, as {name} says"),
                format!(
                    "bit 10 was {} when the axis was {off} off",
                    u8::from(is_reached)
                ),
            );
            dut.fault(done)?;
        }
        Ok(())
    })
}

/// Bit 10 becomes 1 when the velocity was within 606Dh for the time of 606Eh, not before.
pub(super) fn velocity_window_time(dut: &mut Dut<'_>) -> Checked {
    each(dut, PROFILE_VELOCITY, |dut, axis| {
        axis.choose(dut, 0x606E, IN_WINDOW)?;
        let (pace, window) = (axis.pace(dut)?, axis.window(dut, 0x606D)?);
        axis.set(dut, 0x60FF, pace)?;
        // Until now the axis was at its target, 0.
        dut.wait(10_000)?;
        reaches_after(axis, dut, 0x606C, pace, window, 0x606E)
    })
}

/// With a wide velocity window (606Dh) bit 10 becomes 1 on the ramp, and with a high threshold (606Fh) bit 12 stays 1.
pub(super) fn velocity_windows(dut: &mut Dut<'_>) -> Checked {
    each(dut, PROFILE_VELOCITY, |dut, axis| {
        let pace = axis.pace(dut)?;
        let writes = |dut: &Dut<'_>, index: u16| dut.eds.writes(index + axis.0, 0);
        let mut is_tested = false;
        if writes(dut, 0x606D) && writes(dut, 0x6083) {
            is_tested = true;
            if writes(dut, 0x606E) {
                axis.choose(dut, 0x606E, 0)?;
            }
            axis.choose(dut, 0x606D, pace / 2)?;
            // One second to the speed.
            axis.choose(dut, 0x6083, pace)?;
            axis.set(dut, 0x60FF, pace)?;
            // Until now the axis was at its target, 0.
            dut.wait(20_000)?;
            axis.shows(dut, MOVE, REACHED)?;
            let speed = axis.value(dut, 0x606C)?;
            let done = ensure(
                (speed - pace).abs() >= pace / 4,
                format!(
                    "bit 10 of {} at half of {pace}, as {} says",
                    axis.at(0x6041),
                    axis.at(0x606D)
                ),
                format!("{speed} in {} when it was 1", axis.at(0x606C)),
            );
            dut.fault(done)?;
        }
        if writes(dut, 0x606F) {
            is_tested = true;
            if writes(dut, 0x6070) {
                axis.choose(dut, 0x6070, 0)?;
            }
            axis.choose(dut, 0x606F, pace)?;
            axis.set(dut, 0x60FF, pace / 2)?;
            dut.wait(1_500_000)?;
            let what = format!("bit 12 = 1 at half of {pace}, the value of 606Fh,");
            axis.shows(dut, 0, (&what, 1 << 12, 1 << 12))?;
        }
        at_least_one(is_tested, "the drive does not have 606Dh rw or 606Fh rw")
    })
}

/// In cyclic synchronous position mode an axis takes the time of 60C2h from one target position to the next.
pub(super) fn interpolation_time(dut: &mut Dut<'_>) -> Checked {
    each(dut, CYCLIC_POSITION, |dut, axis| {
        let [value, index] = [1, 2].map(|sub| Address::new(0x60C2 + axis.0, sub));
        for address in [value, index] {
            dut.keep(address)?;
        }
        // Mantissa, exponent and milliseconds. The axis has another target position after each.
        for (mantissa, exponent, millis) in [(250u8, -3i8, 250), (25, -2, 250), (2, -3, 2)] {
            let exponent = exponent.to_le_bytes();
            if dut.download(index, &exponent)?.is_err()
                || dut.download(value, &[mantissa])?.is_err()
            {
                return lacks(format!(
                    "the drive has no interpolation time of {millis} ms"
                ));
            }
            let (from, way) = (axis.value(dut, 0x6064)?, axis.way(dut)?);
            let window = axis.window(dut, 0x6067)?.max(way / 10);
            let begin = dut.now();
            axis.set(dut, 0x607A, from + way)?;
            axis.comes_to(dut, 0x6064, from + way, window, "after its target position")?;
            let took = dut.now().micros_since(begin) / 1000;
            ensure(
                took + dut.rig.slack() / 1000 >= millis / 2,
                format!(
                    "a movement of {millis} ms to the next target position, by {value} and {index}"
                ),
                format!("it took {took} ms"),
            )?;
            if millis == 2 {
                continue;
            }
            dut.wait(200_000)?;
        }
        Ok(())
    })
}

/// Waits for bit 10, which must not come before the value was within the window for [`IN_WINDOW`].
fn reaches_after(
    axis: Axis,
    dut: &mut Dut<'_>,
    index: u16,
    wanted: i64,
    window: i64,
    time: u16,
) -> Checked {
    let end = dut.now().plus_micros(MOVE);
    let mut inside: Option<Instant> = None;
    loop {
        let asked = dut.now();
        if (axis.value(dut, index)? - wanted).abs() <= window {
            inside.get_or_insert(asked);
        } else {
            inside = None;
        }
        let now = dut.now();
        if axis.value(dut, 0x6041)? as u64 & REACHED.1 != 0 {
            let took = inside.map_or(0, |from| now.micros_since(from));
            return ensure(
                took + dut.rig.slack() + 100_000 >= IN_WINDOW as u64 * 1000,
                format!(
                    "bit 10 of {} after {IN_WINDOW} ms in the window, as {} says",
                    axis.at(0x6041),
                    axis.at(time)
                ),
                format!("it was 1 after {} ms", took / 1000),
            );
        }
        if now >= end {
            return axis.shows(dut, 0, REACHED);
        }
        dut.wait(5_000)?;
    }
}
