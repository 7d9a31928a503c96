//! CiA 402: when an axis has arrived (the time in a window, the home position), and when it stops on its way.

use od_model::Address;
use od_wire::Instant;

use super::motion::{
    Axis, CHANGE, CYCLIC_POSITION, DECELERATION, ENABLE, HALT, HOMING, MOVE, PROFILE_POSITION,
    PROFILE_VELOCITY, REACHED, READY, START, SWITCHED_ON, each,
};
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

/// Homing at the present position: bits 10, 12 and 13.
pub(super) fn homing(dut: &mut Dut<'_>) -> Checked {
    each(dut, HOMING, |dut, axis| {
        const BITS: u64 = 1 << 10 | 1 << 12 | 1 << 13;
        let method = axis.at(0x6098);
        dut.keep(method)?;
        // Method 35 has the number 37 since the second edition.
        if dut.download(method, &[37])?.is_err() && dut.download(method, &[35])?.is_err() {
            return lacks("the drive has neither homing method 37 nor 35");
        }
        let offset = axis.way(dut)?;
        axis.set(dut, 0x607C, offset)?;
        axis.shows(
            dut,
            CHANGE,
            ("bits 12 and 13 = 0 before homing", 1 << 12 | 1 << 13, 0),
        )?;
        axis.command(dut, ENABLE | START)?;
        let attained = "homing attained and target reached, bits 13, 12 and 10 = 011";
        axis.shows(dut, MOVE, (attained, BITS, 1 << 10 | 1 << 12))?;
        let (is, window) = (axis.value(dut, 0x6064)?, axis.window(dut, 0x6067)?);
        axis.command(dut, ENABLE)?;
        // The editions of the standard differ in the sign of the home offset.
        axis.is_at(
            0x6064,
            is.abs(),
            offset,
            window,
            "(without its sign) after homing, the home offset",
        )
    })
}

/// With an acceleration (609Ah) of one second to the speed, homing is slower than half of it after 200 ms.
fn starts_slowly(dut: &mut Dut<'_>, axis: Axis, pace: i64) -> Checked {
    let before = axis.value(dut, 0x609A)?;
    axis.set(dut, 0x609A, pace)?;
    axis.command(dut, ENABLE | START)?;
    dut.wait(200_000)?;
    let speed = axis.value(dut, 0x606C)?.abs();
    axis.set(dut, 0x609A, before)?;
    axis.command(dut, ENABLE)?;
    dut.wait(500_000)?;
    ensure(
        speed <= pace / 2,
        format!(
            "{} at most in {} after 200 ms of homing, as {} is {pace}",
            pace / 2,
            axis.at(0x606C),
            axis.at(0x609A)
        ),
        format!("{speed} was read"),
    )
}

/// A movement to a switch has the speed of 6099h; it ends before the switch is found.
pub(super) fn homing_speed(dut: &mut Dut<'_>) -> Checked {
    each(dut, HOMING, |dut, axis| {
        let method = axis.at(0x6098);
        dut.keep(method)?;
        let mut has_method = false;
        for number in [17, 18, 19, 20, 1, 2] {
            has_method = has_method || dut.download(method, &[number])?.is_ok();
        }
        if !has_method {
            return lacks("the drive has no homing method with a switch");
        }
        let pace = axis.pace(dut)?;
        for sub in [1, 2] {
            let address = Address::new(0x6099 + axis.0, sub);
            let len = dut.keep(address)?.len();
            dut.write(address, &pace.to_le_bytes()[..len.min(8)])?;
        }
        if dut.eds.writes(0x609A + axis.0, 0) {
            starts_slowly(dut, axis, pace)?;
        }
        axis.command(dut, ENABLE | START)?;
        let window = axis.window(dut, 0x606D)?.max(pace / 20);
        let end = dut.now().plus_micros(MOVE);
        let mut speed = 0;
        while (speed - pace).abs() > window && dut.now() < end {
            dut.wait(10_000)?;
            speed = axis.value(dut, 0x606C)?.abs();
        }
        // The axis keeps this speed.
        dut.wait(100_000)?;
        let later = axis.value(dut, 0x606C)?.abs();
        axis.command(dut, ENABLE)?;
        let wrong = [speed, later]
            .into_iter()
            .find(|is| (is - pace).abs() > window);
        let done = ensure(
            wrong.is_none(),
            format!(
                "{pace}, {window} off at most, in {} during homing, as 6099h says",
                axis.at(0x606C)
            ),
            format!("{} was read", wrong.unwrap_or(0)),
        );
        dut.fault(done)?;
        // Halt stops homing, too.
        let standing = axis.standing(dut)?;
        axis.comes_to(dut, 0x606C, 0, standing, "after bit 4 of 6040h became 0")?;
        axis.command(dut, ENABLE | START)?;
        let end = dut.now().plus_micros(MOVE);
        while axis.value(dut, 0x606C)?.abs() < pace - window && dut.now() < end {
            dut.wait(10_000)?;
        }
        axis.command(dut, ENABLE | START | HALT)?;
        axis.comes_to(
            dut,
            0x606C,
            0,
            standing,
            "after halt, bit 8 of 6040h, during homing",
        )
    })
}

/// With option code 0 the drive function ends at once: the state changes while the axis would still slow down.
pub(super) fn stop_at_once(dut: &mut Dut<'_>) -> Checked {
    each(dut, PROFILE_VELOCITY, |dut, axis| {
        if !dut.eds.writes(0x6084 + axis.0, 0) {
            return lacks("6084h, the ramp of a slow stop, cannot be written");
        }
        let pace = axis.pace(dut)?;
        // A ramp of 200 ms and more.
        let slow = axis.slow(dut, DECELERATION)?;
        let mut is_tested = false;
        for (index, word, (name, mask, bits)) in [(0x605C, 7, SWITCHED_ON), (0x605B, 6, READY)] {
            if !dut.eds.writes(index + axis.0, 0) || axis.choose(dut, index, 0).is_err() {
                continue;
            }
            is_tested = true;
            axis.runs_again(dut, pace)?;
            axis.set(dut, 0x6084, slow)?;
            axis.command(dut, word)?;
            dut.wait(AT_ONCE)?;
            let is = axis.value(dut, 0x6041)? as u64;
            let done = ensure(
                is & mask == bits,
                format!(
                    "{name} in {} within {} ms, with 0 in {}",
                    axis.at(0x6041),
                    AT_ONCE / 1000,
                    axis.at(index)
                ),
                format!("{:04X}h was read", is & 0xFFFF),
            );
            dut.fault(done)?;
        }
        at_least_one(is_tested, "605Bh and 605Ch cannot be 0")
    })
}

/// Time in which a state changes without a ramp, in microseconds.
const AT_ONCE: u64 = 100_000;

/// Quick stop stops an axis on its way to a target position, too.
pub(super) fn quick_stop_position(dut: &mut Dut<'_>) -> Checked {
    each(dut, PROFILE_POSITION, |dut, axis| {
        stops_on_its_way(dut, axis, 2, "quick stop")
    })
}

/// Halt stops an axis on its way to a target position, too.
pub(super) fn halt_position(dut: &mut Dut<'_>) -> Checked {
    each(dut, PROFILE_POSITION, |dut, axis| {
        stops_on_its_way(dut, axis, ENABLE | HALT, "halt (bit 8 of 6040h)")
    })
}

/// Tests that a controlword stops an axis before its target position; `name` is that of the command.
fn stops_on_its_way(dut: &mut Dut<'_>, axis: Axis, controlword: u16, name: &str) -> Checked {
    if !axis.has(dut, 0x606C) || !dut.eds.writes(0x6081 + axis.0, 0) {
        return lacks("the drive does not have 606Ch and 6081h rw");
    }
    let (from, way) = (axis.value(dut, 0x6064)?, axis.way(dut)?);
    let pace = axis.pace(dut)?;
    axis.set(dut, 0x6081, pace)?;
    // Five seconds and more.
    let target = from + way.max(5 * pace);
    axis.set_point(dut, target, 0)?;
    let near = axis.window(dut, 0x606D)?.max(pace / 10);
    axis.comes_to(
        dut,
        0x606C,
        pace,
        near,
        "on the way, with this value in 6081h",
    )?;
    axis.command(dut, controlword)?;
    let window = axis.standing(dut)?;
    let when = format!("after {name} on the way to a target position");
    axis.comes_to(dut, 0x606C, 0, window, &when)?;
    let place = axis.value(dut, 0x6064)?;
    ensure(
        (place - target).abs() > axis.window(dut, 0x6067)?,
        format!("{} before {target} after {name}", axis.at(0x6064)),
        format!("{place} was read"),
    )
}
