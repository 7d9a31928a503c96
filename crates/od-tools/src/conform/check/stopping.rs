//! CiA 402: an axis that stops: ramps, quick stop, halt, and the states in which it need not move. Each case needs the
//! permission `motion`.

use od_wire::nmt::Command;

use super::axis::{
    Axis, CHANGE, DISABLED, ENABLE, ENABLED, HALT, MOVE, PROFILE_POSITION, PROFILE_VELOCITY,
    QUICK_STOP, REACHED, READY, SWITCHED_ON, each,
};
use crate::conform::dut::Dut;
use crate::conform::end::{Checked, End, at_least_one, ensure, fail, lacks};

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
