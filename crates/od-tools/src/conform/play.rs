//! Steps that are lines of a script, on any link.

use std::collections::VecDeque;

use od_model::{Address, DataType, values};
use od_sim::script::{
    Action, Deed, Expect, Frames, Outcome, Pattern, Script, Statement, Timing, When, Write, resolve,
};
use od_wire::{AbortCode, Frame};

use super::dut::Dut;
use super::end::{Checked, End, ensure, fail, lacks, skip};
use super::sdo::abort_text;
use crate::link::Heard;

/// Plays the lines up to the first that fails.
pub(crate) fn play(dut: &mut Dut<'_>, first_line: u32, text: &str) -> Checked {
    let text = placed(text, dut.node.raw());
    let script = match Script::parse_at(&text, first_line) {
        Ok(script) => script,
        Err(problems) => {
            return skip(
                problems
                    .first()
                    .map(ToString::to_string)
                    .unwrap_or_default(),
            );
        }
    };
    let mut player = Player {
        periodic: Periodic::of(dut, &text),
        ignored: Vec::new(),
        pending: VecDeque::new(),
    };
    let start = dut.now();
    for line in script.statements() {
        match line.when {
            When::Next => {}
            When::After(micros) => player.wait(dut, micros)?,
            When::At(at) => {
                let passed = dut.now().micros_since(start);
                player.wait(dut, at.as_micros().saturating_sub(passed))?;
            }
        }
        player.play(dut, line)?;
    }
    Ok(())
}

/// The text with `$NODEID` as a number, and `$580` as that CAN-ID plus the node ID.
pub(crate) fn placed(text: &str, node: u8) -> String {
    let mut out = String::new();
    let mut rest = text;
    while let Some((before, after)) = rest.split_once('$') {
        out.push_str(before);
        if let Some(after) = after.strip_prefix("NODEID") {
            out.push_str(&node.to_string());
            rest = after;
            continue;
        }
        let base = after
            .get(..3)
            .and_then(|hex| u16::from_str_radix(hex, 16).ok());
        match base {
            Some(base) => {
                out.push_str(&format!("{:03X}", base + u16::from(node)));
                rest = &after[3..];
            }
            None => {
                out.push('$');
                rest = after;
            }
        }
    }
    out + rest
}

fn unreadable<T>(line: &Statement, why: impl std::fmt::Display) -> Checked<T> {
    skip(format!("`{}` cannot be read: {why}", line.text))
}

/// CAN-IDs of the messages that the node sends periodically: they neither count as an unexpected frame nor as a
/// response.
struct Periodic {
    /// SYNC, if the node produces it.
    sync: Option<u16>,
    /// Heartbeats, unless the case tests them.
    heartbeat: Option<u16>,
}

impl Periodic {
    fn of(dut: &Dut<'_>, text: &str) -> Self {
        let heartbeat = 0x700 + u16::from(dut.node.raw());
        let by_number = format!("{heartbeat:X}#");
        let words = ["1017", "17 10", "$700", &by_number];
        Self {
            sync: own_sync(dut),
            heartbeat: (!words.iter().any(|word| text.contains(word))).then_some(heartbeat),
        }
    }

    /// Returns whether the frame is one of these messages. A boot-up message (state 0) is not.
    fn has(&self, frame: &Frame) -> bool {
        let id = frame.id().as_standard();
        id.is_some()
            && (id == self.sync
                || id == self.heartbeat && matches!(frame.data(), [state] if *state != 0))
    }
}

/// The CAN-ID of SYNC, if the node produces it.
fn own_sync(dut: &Dut<'_>) -> Option<u16> {
    let entry = dut.eds.entry(0x1005, 0)?;
    let raw = entry.default.integer(dut.node.raw())?;
    (raw & 0x4000_0000 != 0).then_some((raw & 0x7FF) as u16)
}

struct Player {
    periodic: Periodic,
    ignored: Vec<Pattern>,
    /// Frames that arrived and that no line has expected yet.
    pending: VecDeque<Heard>,
}

impl Player {
    fn play(&mut self, dut: &mut Dut<'_>, line: &Statement) -> Checked {
        match &line.action {
            Action::Deed(Deed::Wait) => Ok(()),
            Action::Deed(Deed::Send {
                frame,
                times,
                every,
            }) => {
                let frame = frame.frame(dut.node, dut.eds.dictionary());
                let frame = frame.or_else(|why| unreadable(line, why))?;
                for turn in 0..*times {
                    if turn > 0 {
                        self.wait(dut, *every)?;
                    }
                    dut.send(frame)?;
                }
                Ok(())
            }
            Action::Read { object, outcome } => read(dut, line, object, outcome),
            Action::Write { write, outcome } => self::write(dut, line, write, outcome),
            Action::Ignore(None) => {
                self.ignored.clear();
                Ok(())
            }
            Action::Ignore(Some(pattern)) => {
                self.pending.retain(|heard| !pattern.matches(&heard.frame));
                self.ignored.push(pattern.clone());
                Ok(())
            }
            Action::Skip => {
                self.pending.clear();
                dut.drain()
            }
            Action::Expect(expect) => self.expect(dut, line, expect),
            Action::Deed(_) | Action::Device(_) | Action::Random(_) => skip(on_a_bench(line)),
        }
    }

    fn is_ignored(&self, frame: &Frame) -> bool {
        self.ignored.iter().any(|one| one.matches(frame))
    }

    /// Lets time pass.
    fn wait(&mut self, dut: &mut Dut<'_>, micros: u64) -> Checked {
        let until = dut.now().plus_micros(micros);
        while let Some(heard) = dut.receive(until)? {
            if !self.is_ignored(&heard.frame) {
                self.pending.push_back(heard);
            }
        }
        Ok(())
    }

    /// The next frame that is neither ignored nor sent periodically, within `micros` microseconds. A frame with
    /// the CAN-ID `wanted` is never ignored.
    fn next(
        &mut self,
        dut: &mut Dut<'_>,
        micros: u64,
        wanted: Option<&Frames>,
    ) -> Checked<Option<Heard>> {
        let counts = |frame: &Frame| {
            wanted.is_some_and(|wanted| wanted.matches(frame)) || !self.periodic.has(frame)
        };
        while let Some(heard) = self.pending.pop_front() {
            if counts(&heard.frame) {
                return Ok(Some(heard));
            }
        }
        dut.next(micros, |frame| counts(frame) && !self.is_ignored(frame))
    }

    fn expect(&mut self, dut: &mut Dut<'_>, line: &Statement, expect: &Expect) -> Checked {
        let (frames, times, timing) = match expect {
            Expect::Frame {
                frames,
                times,
                timing,
            } => (frames, *times, *timing),
            Expect::Silence(micros) => {
                return match self.next(dut, *micros, None)? {
                    Some(heard) => fail(expected(line), format!("{} came", heard.frame)),
                    None => Ok(()),
                };
            }
            Expect::Fact { .. } => return skip(on_a_bench(line)),
        };
        let (micros, exact) = match timing {
            // A frame that is being transmitted counts as received.
            Timing::Now => (super::dut::QUIET, false),
            Timing::Within(micros) => (micros, false),
            Timing::After(micros) | Timing::Every(micros) => (micros, true),
        };
        let slack = dut.rig.slack();
        for _ in 0..times {
            let from = dut.now();
            let Some(heard) = self.next(dut, micros, Some(frames))? else {
                return fail(expected(line), "nothing came");
            };
            let early = exact && heard.at.micros_since(from) + slack < micros;
            let got = format!("({:?}) {} came", heard.at, heard.frame);
            ensure(frames.matches(&heard.frame) && !early, expected(line), got)?;
        }
        Ok(())
    }
}

/// The expectation of an `expect` line, as written.
fn expected(line: &Statement) -> &str {
    let (_, expected) = line.text.split_once("expect ").unwrap_or(("", &line.text));
    expected
}

fn on_a_bench(line: &Statement) -> String {
    format!(
        "`{}` is about a simulated device; `odkit run` plays it",
        line.text
    )
}

/// `sdo read 1017h`, `sdo read 1017h = 5`, each with `aborts 06020000h`.
fn read(dut: &mut Dut<'_>, line: &Statement, object: &str, outcome: &Outcome) -> Checked {
    let found = resolve(dut.eds.dictionary(), object);
    let (address, data_type) = found.or_else(|why| unreadable(line, why))?;
    let result = dut.upload(address)?;
    if let (Outcome::Value(value), Ok(is)) = (outcome, &result) {
        let wanted = values::parse(data_type.unwrap_or(DataType::Domain), value);
        let wanted = wanted.or_else(|why| unreadable(line, why))?;
        let shown = format!("{object} = {}", values::hex(&wanted));
        return ensure(
            *is == wanted,
            shown,
            format!("{} was read", values::hex(is)),
        );
    }
    ended(line, result.map(drop), outcome, false)
}

/// `sdo write 1017h = 5`, `sdo write 1017h = 5 as u16`, each with `aborts 06090030h`.
fn write(dut: &mut Dut<'_>, line: &Statement, write: &Write, outcome: &Outcome) -> Checked {
    let found = write.bytes(dut.eds.dictionary());
    let (address, bytes) = found.or_else(|why| unreadable(line, why))?;
    let excluded = dut.eds.excludes(address, &bytes, dut.node);
    let is_excluded = excluded.is_some();
    if !matches!(outcome, Outcome::Aborts(_)) {
        if dut.eds.entry(address.index, address.sub).is_none() {
            return lacks(format!("the EDS does not have {address}"));
        }
        if let Some(why) = excluded {
            return skip(why);
        }
        keep(dut, address)?;
    }
    let result = dut.download(address, &bytes)?;
    ended(line, result, outcome, is_excluded)
}

/// The value is restored after the case, if it can be read.
fn keep(dut: &mut Dut<'_>, address: Address) -> Checked {
    if matches!(address.index, 0x1003 | 0x1010 | 0x1011) {
        return Ok(());
    }
    match dut.keep(address) {
        Err(End::Lost(fault)) => Err(End::Lost(fault)),
        _ => Ok(()),
    }
}

/// Compares the result of a transfer with the expected one. `is_excluded`: the value breaks a limit in the EDS, so
/// the node may abort because of the limit.
fn ended(
    line: &Statement,
    result: Result<(), u32>,
    outcome: &Outcome,
    is_excluded: bool,
) -> Checked {
    let Outcome::Aborts(wanted) = outcome else {
        let came = |code| format!("{} came", abort_text(code));
        return match result {
            Ok(()) => Ok(()),
            Err(code) => fail(format!("{} to succeed", line.text), came(code)),
        };
    };
    let names_limit = is_excluded && *wanted == AbortCode::ValueRange;
    match result {
        Err(code) if code == wanted.code() => Ok(()),
        Err(code)
            if names_limit
                && (code == AbortCode::ValueTooHigh.code()
                    || code == AbortCode::ValueTooLow.code()) =>
        {
            Ok(())
        }
        Err(code) => fail(
            abort_text(wanted.code()),
            format!("{} came", abort_text(code)),
        ),
        Ok(()) => fail(abort_text(wanted.code()), "it succeeded"),
    }
}
