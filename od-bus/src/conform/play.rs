//! Steps that are lines of a script, on any link.

use od_bench::script::{Known, Pattern, frame_of};
use od_model::{DataType, values};
use od_wire::{AbortCode, Frame};

use super::dut::Dut;
use super::end::{Checked, End, ensure, fail, lacks, skip};
use super::sdo::abort_text;

/// Lines that are about a simulated device, not about the bus.
const WORLD: [&str; 12] = [
    "device", "use", "shaft", "power", "switch", "fault", "emcy", "set", "bus", "line", "send",
    "at",
];

/// Plays the lines, from the first to the last or to the one that does not hold.
pub(crate) fn play(dut: &mut Dut<'_>, text: &str) -> Checked {
    let mut ignored = Vec::new();
    let periodic = Periodic::of(dut, text);
    for line in text.lines() {
        let line = placed(line, dut.node.raw());
        let line = match line.find(" #") {
            Some(at) => line[..at].trim(),
            None => line.trim(),
        };
        if line.is_empty() || line.starts_with('#') {
            continue;
        }
        let (verb, rest) = line.split_once(' ').unwrap_or((line, ""));
        match verb {
            "wait" | "after" => {
                let micros = duration(rest)?;
                dut.wait(micros)?;
            }
            "skip" => dut.drain()?,
            "ignore" if rest == "nothing" => ignored.clear(),
            "ignore" => ignored.push(pattern(rest)?),
            "expect" => expect(dut, rest, &ignored, &periodic)?,
            "sdo" => transfer(dut, rest)?,
            _ if WORLD.contains(&verb) => {
                return skip(format!(
                    "`{verb}` acts on a simulated device; `odkit run` plays it"
                ));
            }
            _ => send(dut, line)?,
        }
    }
    Ok(())
}

/// The line with `$NODEID` as a number, and `$580` as that CAN-ID plus the node ID.
fn placed(line: &str, node: u8) -> String {
    let mut out = String::new();
    let mut rest = line;
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

fn unreadable<T>(line: &str, why: impl std::fmt::Display) -> Checked<T> {
    skip(format!("`{line}` cannot be read: {why}"))
}

fn pattern(text: &str) -> Checked<Pattern> {
    Pattern::parse(text).or_else(|error| unreadable(text, error.message))
}

/// `500ms`, `1.5s`, `20us`, `2min`, in microseconds.
fn duration(text: &str) -> Checked<u64> {
    let text = text.trim();
    let unit = text
        .find(|c: char| c.is_ascii_alphabetic())
        .unwrap_or(text.len());
    let (number, unit) = text.split_at(unit);
    let scale = match unit {
        "us" => 1.0,
        "ms" => 1e3,
        "s" => 1e6,
        "min" => 6e7,
        _ => return unreadable(text, "write 500ms, 1.5s, 20us or 2min"),
    };
    match number.parse::<f64>() {
        Ok(number) if (0.0..1e9).contains(&number) => Ok((number * scale) as u64),
        _ => unreadable(text, "write 500ms, 1.5s, 20us or 2min"),
    }
}

fn send(dut: &mut Dut<'_>, line: &str) -> Checked {
    let dictionary = dut.eds.dictionary();
    let type_of = |address| dictionary.find(address).ok().map(|entry| entry.data_type);
    let known = Known {
        node: dut.node,
        type_of: &type_of,
        real: &|text| text.parse().ok(),
    };
    match frame_of(line, &known) {
        Ok(frame) => dut.send(frame),
        Err(problem) => unreadable(line, problem.message),
    }
}

/// CAN-IDs of the messages that the node sends periodically, whatever a master does: they neither break a
/// silence nor take the place of a response.
struct Periodic {
    /// SYNC, if the node produces it.
    sync: Option<u16>,
    /// Heartbeats, unless the lines of the case are about them.
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

    /// Whether the frame is one of these messages. A boot-up message (state 0) is not.
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

/// `PATTERN`, `PATTERN within 1s`, `PATTERN after 100ms`, `silence 1s`.
fn expect(dut: &mut Dut<'_>, text: &str, ignored: &[Pattern], periodic: &Periodic) -> Checked {
    let is_ignored = |frame: &Frame| ignored.iter().any(|one| one.matches(frame));
    if let Some(rest) = text.strip_prefix("silence ") {
        let micros = duration(rest)?;
        let came = dut.next(micros, |frame| !periodic.has(frame) && !is_ignored(frame))?;
        return match came {
            Some(heard) => fail(
                format!("silence for {rest}"),
                format!("{} came", heard.frame),
            ),
            None => Ok(()),
        };
    }
    let split = |word: &str| text.split_once(word);
    let (shown, micros, exact) = match (split(" within "), split(" after ")) {
        (Some((head, time)), _) => (head, duration(time)?, false),
        (None, Some((head, time))) => (head, duration(time)?, true),
        // What is on its way counts as there.
        (None, None) => (text, super::dut::QUIET, false),
    };
    let wanted = pattern(shown)?;
    let from = dut.now();
    let slack = dut.rig.slack();
    let came = dut.next(micros, |frame| {
        (wanted.matches(frame) || !periodic.has(frame)) && !is_ignored(frame)
    })?;
    let Some(heard) = came else {
        return fail(text, "nothing came");
    };
    let early = exact && heard.at.micros_since(from) + slack < micros;
    let got = format!("({:?}) {} came", heard.at, heard.frame);
    ensure(wanted.matches(&heard.frame) && !early, text, got)
}

/// `read 1017h`, `read 1017h = 5`, `write 1017h = 5 as u16`, each with `aborts 06090030h`.
fn transfer(dut: &mut Dut<'_>, text: &str) -> Checked {
    let (body, aborts) = match text.split_once(" aborts ") {
        Some((body, code)) => (body, Some(abort(code)?)),
        None => (text, None),
    };
    let (kind, body) = body.split_once(' ').unwrap_or((body, ""));
    let (object, value) = match body.split_once('=') {
        Some((object, value)) => (object.trim(), Some(value.trim())),
        None => (body.trim(), None),
    };
    let dictionary = dut.eds.dictionary();
    let (address, own) = match (values::find(dictionary, object), values::address(object)) {
        (Ok(entry), _) => (entry.address, Some(entry.data_type)),
        (Err(_), Some(address)) => (address, None),
        (Err(why), None) => return unreadable(text, why),
    };
    let bytes = value.map(|value| typed(value, own)).transpose()?;
    let bounded = bytes
        .as_ref()
        .and_then(|bytes| dut.eds.excludes(address, bytes, dut.node));
    let result = match (kind, bytes) {
        ("read", wanted) => match (dut.upload(address)?, wanted) {
            (Ok(is), Some(wanted)) => {
                let got = format!("{} was read", values::hex(&is));
                return ensure(
                    is == wanted,
                    format!("{object} = {}", values::hex(&wanted)),
                    got,
                );
            }
            (result, _) => result.map(drop),
        },
        ("write", Some(_))
            if aborts.is_none() && dut.eds.entry(address.index, address.sub).is_none() =>
        {
            return lacks(format!("the EDS does not have {address}"));
        }
        ("write", Some(bytes)) => {
            if let (None, Some(why)) = (aborts, &bounded) {
                return skip(why.as_str());
            }
            // What the case changes is put back after it, if it can be read.
            if aborts.is_none()
                && !matches!(address.index, 0x1003 | 0x1010 | 0x1011)
                && let Err(End::Lost(fault)) = dut.keep(address)
            {
                return Err(End::Lost(fault));
            }
            dut.download(address, &bytes)?
        }
        _ => return unreadable(text, "write `sdo read 6004h` or `sdo write 6001h = 4096`"),
    };
    match (result, aborts) {
        (Ok(()), None) => Ok(()),
        (Err(code), Some(wanted)) if code == wanted => Ok(()),
        // The EDS has the limit, so the node may name it.
        (Err(code), Some(wanted))
            if wanted == AbortCode::ValueRange.code()
                && (code == AbortCode::ValueTooHigh.code()
                    || code == AbortCode::ValueTooLow.code())
                && bounded.is_some() =>
        {
            Ok(())
        }
        (result, Some(wanted)) => fail(
            abort_text(wanted),
            result.map_or_else(
                |code| format!("{} came", abort_text(code)),
                |()| "it succeeded".into(),
            ),
        ),
        (Err(code), None) => fail(
            format!("sdo {text} to succeed"),
            format!("{} came", abort_text(code)),
        ),
    }
}

fn abort(text: &str) -> Checked<u32> {
    let digits = text.trim().trim_end_matches(['h', 'H']);
    match u32::from_str_radix(digits, 16)
        .ok()
        .and_then(AbortCode::from_code)
    {
        Some(code) => Ok(code.code()),
        None => unreadable(text, "write an abort code, such as 06090031h"),
    }
}

/// The bytes of a value, by its `as u16` or by the type of the object.
fn typed(text: &str, own: Option<DataType>) -> Checked<Vec<u8>> {
    let (value, data_type) = match text.rsplit_once(" as ") {
        Some((value, name)) => {
            let long = name.trim().replace('u', "UNSIGNED").replace('i', "INTEGER");
            let all = DataType::ALL.into_iter();
            let found = all.clone().find(|one| one.name() == long);
            (value.trim(), found)
        }
        None => (text, own),
    };
    let data_type = data_type.unwrap_or(DataType::Unsigned32);
    values::parse(data_type, value).or_else(|why| unreadable(text, why))
}
