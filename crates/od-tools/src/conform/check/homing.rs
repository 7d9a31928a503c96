//! CiA 402: homing of an axis. Each case needs the permission `motion`.

use od_model::Address;

use super::axis::{Axis, CHANGE, ENABLE, HALT, HOMING, MOVE, START, each};
use crate::conform::dut::Dut;
use crate::conform::end::{Checked, at_least_one, ensure, fail, lacks};
use crate::conform::sdo::abort_text;

/// The bits of the statusword that show the progress of homing.
const BITS: u64 = 1 << 10 | 1 << 12 | 1 << 13;

/// 6098h takes each method of 60E3h.
pub(super) fn methods(dut: &mut Dut<'_>) -> Checked {
    each(dut, HOMING, |dut, axis| {
        let list = 0x60E3 + axis.0;
        if !dut.eds.has(list) {
            return lacks("the drive has no list of homing methods, 60E3h");
        }
        let method = axis.at(0x6098);
        dut.keep(method)?;
        for sub in 1..=dut.number(list, 0)?.min(0xFE) as u8 {
            let wanted = dut.read(Address::new(list, sub))?;
            let number: Vec<u8> = wanted.iter().copied().take(1).collect();
            let done = match dut.download(method, &number)? {
                Err(code) => fail(
                    format!("{number:02X?} in {method}, a method of 60E3h"),
                    abort_text(code),
                ),
                Ok(()) => {
                    let is = dut.read(method)?;
                    ensure(
                        is == number,
                        format!("{number:02X?} in {method}, as written"),
                        format!("{is:02X?} was read"),
                    )
                }
            };
            dut.fault(done)?;
        }
        Ok(())
    })
}

/// Homing at the present position: bits 10, 12 and 13.
pub(super) fn homing(dut: &mut Dut<'_>) -> Checked {
    each(dut, HOMING, |dut, axis| {
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
pub(super) fn speed(dut: &mut Dut<'_>) -> Checked {
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
        let progress = ("homing in progress, bits 13, 12 and 10 = 000", BITS, 0);
        let done = axis.shows(dut, 0, progress);
        dut.fault(done)?;
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
        let interrupted = "homing interrupted, bits 13, 12 and 10 = 001";
        let done = axis.shows(dut, CHANGE, (interrupted, BITS, 1 << 10));
        dut.fault(done)?;
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

/// With two speeds in 6099h, one to the switch and a slower one to the zero position, an axis has one of them in each
/// homing method.
pub(super) fn speeds(dut: &mut Dut<'_>) -> Checked {
    each(dut, HOMING, |dut, axis| {
        let pace = axis.pace(dut)?;
        if pace < 8 {
            return lacks("the axis is too slow for two speeds");
        }
        for (sub, speed) in [(1, pace), (2, pace / 4)] {
            let address = Address::new(0x6099 + axis.0, sub);
            let len = dut.keep(address)?.len();
            dut.write(address, &speed.to_le_bytes()[..len.min(8)])?;
        }
        let method = axis.at(0x6098);
        dut.keep(method)?;
        let mut any = false;
        for number in [17, 18, 19, 20, 1, 2] {
            if dut.download(method, &[number])?.is_err() {
                continue;
            }
            axis.command(dut, ENABLE | START)?;
            let speed = axis.steady(dut, pace / 50)?;
            axis.command(dut, ENABLE)?;
            let standing = axis.standing(dut)?;
            axis.comes_to(dut, 0x606C, 0, standing, "after bit 4 of 6040h became 0")?;
            // An axis at rest is at its switch already, or has found it.
            any |= speed > standing;
            let near = |wanted: i64| (speed - wanted).abs() <= wanted / 10;
            let done = ensure(
                speed <= standing || near(pace) || near(pace / 4),
                format!(
                    "{pace} or {} in {} with homing method {number}, as 6099h says",
                    pace / 4,
                    axis.at(0x606C)
                ),
                format!("{speed} was read"),
            );
            dut.fault(done)?;
        }
        at_least_one(any, "no homing method with a switch moves the axis")
    })
}

impl Axis {
    /// Waits until the speed stays the same, and returns it without its sign.
    fn steady(self, dut: &mut Dut<'_>, noise: i64) -> Checked<i64> {
        let end = dut.now().plus_micros(MOVE);
        let mut before = i64::MAX;
        loop {
            dut.wait(200_000)?;
            let speed = self.value(dut, 0x606C)?.abs();
            if (speed - before).abs() <= noise || dut.now() >= end {
                return Ok(speed);
            }
            before = speed;
        }
    }
}
