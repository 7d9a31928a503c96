//! CiA 402: faults of an axis, and the end of its communication. Each case needs the permission `motion`.

use od_wire::nmt::Command;

use super::axis::{
    Axis, CHANGE, DISABLED, ENABLE, ENABLED, FAULT, MOVE, PROFILE_POSITION, PROFILE_VELOCITY,
    QUICK_STOP, REACHED, each,
};
use crate::conform::dut::{Dut, is_data};
use crate::conform::end::{Checked, ensure, lacks};

/// A fault, by NMT stop with code 1 in 6007h, and its reset.
pub(super) fn connection_lost(dut: &mut Dut<'_>) -> Checked {
    each(dut, PROFILE_VELOCITY, |dut, axis| {
        axis.choose(dut, 0x6007, 1)?;
        let from = dut.frames.len();
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
            let done = axis.is_code_of_emcy(dut, from, code);
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

/// Bit 13 in profile position mode, or a fault, shows a position that is farther from its demand (60F4h) than the window
/// (6065h) for longer than the time (6066h), and no other one.
pub(super) fn following_error(dut: &mut Dut<'_>) -> Checked {
    each(dut, PROFILE_POSITION, |dut, axis| {
        const TIME: i64 = 500;
        axis.lag(dut, 100)?;
        let pace = axis.pace(dut)?;
        axis.set(dut, 0x6081, pace)?;
        let has_time = dut.eds.writes(0x6066 + axis.0, 0);
        if has_time {
            axis.choose(dut, 0x6066, 0)?;
        }
        axis.choose(dut, 0x6065, UNSUPERVISED)?;
        let Stray {
            greatest, apart, ..
        } = axis.strays(dut, pace, UNSUPERVISED)?;
        let window = axis.window(dut, 0x6067)?;
        let done = ensure(
            apart < 10 * window.max(1) || 4 * greatest >= apart,
            format!(
                "about {apart} in {}, the distance of 6062h and 6064h",
                axis.at(0x60F4)
            ),
            format!("{greatest} was read at most"),
        );
        dut.fault(done)?;
        if greatest < 8 {
            return lacks("the axis follows its demand so closely that no window is too small");
        }
        let (wide, narrow) = (4 * greatest, greatest / 4);
        let before = dut.number(0x1001, 0)?;
        for (window, time) in [(wide, 0), (narrow, 0), (narrow, TIME)] {
            if time > 0 && !has_time {
                continue;
            }
            axis.choose(dut, 0x6065, window)?;
            if has_time {
                axis.choose(dut, 0x6066, time)?;
            }
            let from = dut.frames.len();
            let seen = axis.strays(dut, pace, window)?;
            let when =
                format!("with {window} in 6065h, {time} ms in 6066h and up to {greatest} in 60F4h");
            let is_right = match seen.error_after {
                None => window == wide,
                Some(millis) => {
                    window == narrow && millis + 50 + (dut.rig.slack() / 1000) as i64 >= time
                }
            };
            let wanted = if window == wide {
                "no following error"
            } else {
                "a following error after this time"
            };
            let got = match seen.error_after {
                None => String::from("there was none"),
                Some(millis) => format!("bit 13 of 6041h or a fault came after {millis} ms"),
            };
            let done = ensure(is_right, format!("{wanted} {when}"), got);
            dut.fault(done)?;
            if axis.has(dut, 0x603F) && axis.value(dut, 0x6041)? as u64 & FAULT.1 == FAULT.2 {
                let code = axis.value(dut, 0x603F)? & 0xFFFF;
                let done = axis.is_code_of_emcy(dut, from, code);
                dut.fault(done)?;
            }
            if axis.value(dut, 0x6041)? as u64 & FAULT.1 == FAULT.2 {
                let done = is_reported(dut, from);
                dut.fault(done)?;
            }
            axis.recover(dut)?;
            let after = dut.number(0x1001, 0)?;
            let done = ensure(
                after == before,
                format!("1001h = {before:02X}h after the reset of a fault, as before it"),
                format!("{after:02X}h was read"),
            );
            dut.fault(done)?;
            axis.comes_to(dut, 0x60F4, 0, narrow / 2, "after the end of the error")?;
            axis.enable(dut)?;
        }
        Ok(())
    })
}

/// The following error window (6065h) that turns the supervision off.
const UNSUPERVISED: i64 = u32::MAX as i64;

/// A movement with a following error.
struct Stray {
    /// The greatest following error before bit 13 was 1.
    greatest: i64,
    /// The greatest distance of 6062h and 6064h, read one after the other; 0 with the supervision.
    apart: i64,
    /// Milliseconds from the moment at which the error was beyond the window to bit 13 or a fault; `None` without them.
    error_after: Option<i64>,
}

/// A fault in Operational causes an EMCY message, if the node has any.
fn is_reported(dut: &mut Dut<'_>, from: usize) -> Checked {
    if !dut.eds.has(0x1014) || dut.number(0x1014, 0)? as u32 >> 31 != 0 {
        return Ok(());
    }
    dut.wait(100_000)?;
    let id = dut.id(0x80);
    let mut came = dut.frames.get(from..).unwrap_or_default().iter();
    let is_one = came
        .any(|one| !one.ours && is_data(&one.frame, id) && !one.frame.data().starts_with(&[0, 0]));
    ensure(is_one, "an EMCY message of the fault", "none came")
}

impl Axis {
    /// 603Fh has the code of an EMCY message since the frame `from`, if there was any: one of the fault, since a node may
    /// report the end of its communication, too.
    fn is_code_of_emcy(self, dut: &mut Dut<'_>, from: usize, code: i64) -> Checked {
        dut.wait(20_000)?;
        let id = dut.id(0x80);
        let came = dut.frames.get(from..).unwrap_or_default().iter();
        let emcy = came.filter(|one| !one.ours && is_data(&one.frame, id));
        let codes: Vec<i64> = emcy
            .map(|one| {
                i64::from(u16::from_le_bytes([
                    one.frame.bytes()[0],
                    one.frame.bytes()[1],
                ]))
            })
            .filter(|code| *code != 0)
            .collect();
        ensure(
            codes.is_empty() || codes.contains(&(code & 0xFFFF)),
            format!(
                "the code of an EMCY message of the fault in {}",
                self.at(0x603F)
            ),
            format!("{code:04X}h was read, after EMCY {codes:04X?}"),
        )
    }

    /// Moves for two seconds and more, and watches the following error.
    fn strays(self, dut: &mut Dut<'_>, pace: i64, window: i64) -> Checked<Stray> {
        const ERROR: u64 = 1 << 13;
        let target = self.value(dut, 0x6064)? + self.way(dut)?.max(2 * pace);
        // The error may begin, and end in a fault, during the handshake.
        let from = dut.now();
        let mut asked = from;
        self.set_point(dut, target, 0)?;
        let end = dut.now().plus_micros(MOVE);
        let (mut greatest, mut apart, mut beyond) = (0, 0, None);
        // More reads take time, in which an error of a supervised axis would come unseen.
        let has_time_to_compare = window == UNSUPERVISED;
        loop {
            if has_time_to_compare && self.has(dut, 0x6062) {
                let demand = self.value(dut, 0x6062)?;
                apart = apart.max((demand - self.value(dut, 0x6064)?).abs());
            }
            let error = self.value(dut, 0x60F4)?.abs();
            greatest = greatest.max(error);
            if error > window {
                beyond.get_or_insert(asked);
            }
            let word = self.value(dut, 0x6041)? as u64;
            // Fault, or the reaction to it.
            if word & ERROR != 0 || word & FAULT.2 != 0 {
                let millis = dut.now().micros_since(beyond.unwrap_or(from)) / 1000;
                return Ok(Stray {
                    greatest,
                    apart,
                    error_after: Some(millis as i64),
                });
            }
            if word & REACHED.1 != 0 || dut.now() >= end {
                return Ok(Stray {
                    greatest,
                    apart,
                    error_after: None,
                });
            }
            dut.wait(5_000)?;
            asked = dut.now();
        }
    }
}
