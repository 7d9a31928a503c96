//! Layer setting services (CiA 305): the names of the commands.

use std::format;
use std::prelude::v1::*;

use od_runtime::Frame;

use super::description::{Service, Words, bytes};

fn name(command: u8) -> Option<&'static str> {
    Some(match command {
        0x04 => "switch state global",
        0x11 => "configure node ID",
        0x13 => "configure bit timing",
        0x15 => "activate bit timing",
        0x17 => "store configuration",
        0x40 => "switch state selective, vendor-ID",
        0x41 => "switch state selective, product code",
        0x42 => "switch state selective, revision number",
        0x43 => "switch state selective, serial number",
        0x44 => "switch state selective, confirmed",
        0x46 => "identify remote slave, vendor-ID",
        0x47 => "identify remote slave, product code",
        0x48 => "identify remote slave, lowest revision",
        0x49 => "identify remote slave, highest revision",
        0x4A => "identify remote slave, lowest serial number",
        0x4B => "identify remote slave, highest serial number",
        0x4C => "identify non-configured slave",
        0x4F => "identify slave",
        0x50 => "non-configured slave",
        0x51 => "fastscan",
        0x5A => "inquire vendor-ID",
        0x5B => "inquire product code",
        0x5C => "inquire revision number",
        0x5D => "inquire serial number",
        0x5E => "inquire node ID",
        _ => return None,
    })
}

pub(super) fn request(frame: &Frame) -> Words {
    words(frame, |command, data| match (command, data) {
        (0x04, [0, ..]) => ": waiting".into(),
        (0x04, [1, ..]) => ": configuration".into(),
        (0x11, [node, ..]) => format!(" {node}"),
        (0x13, [table, index, ..]) => format!(", table {table}, index {index}"),
        (0x15, [low, high, ..]) => format!(", delay {} ms", u16::from_le_bytes([*low, *high])),
        (0x40..=0x43 | 0x46..=0x4B, [a, b, c, d, ..]) => {
            format!(" {:X}h", u32::from_le_bytes([*a, *b, *c, *d]))
        }
        _ => String::new(),
    })
}

pub(super) fn response(frame: &Frame) -> Words {
    words(frame, |command, data| match (command, data) {
        (0x11 | 0x13 | 0x17, [0, ..]) => ": done".into(),
        (0x11 | 0x13 | 0x17, [error, specific, ..]) => format!(": error {error} ({specific})"),
        (0x5A..=0x5D, [a, b, c, d, ..]) => {
            format!(": {:X}h", u32::from_le_bytes([*a, *b, *c, *d]))
        }
        (0x5E, [node, ..]) => format!(": {node}"),
        _ => String::new(),
    })
}

fn words(frame: &Frame, rest: impl Fn(u8, &[u8]) -> String) -> Words {
    let is_short = frame.dlc() < 8;
    let text = match frame.data() {
        [command, ..] if is_short => {
            let name = name(*command).map_or(format!("command {command:02X}h"), str::to_owned);
            let count = bytes(frame.dlc().into());
            format!("{name}: {count}, but an LSS message has 8 (CiA 305)")
        }
        [command, data @ ..] => match name(*command) {
            Some(name) => format!("{name}{}", rest(*command, data)),
            None => format!("unknown command {command:02X}h"),
        },
        [] => String::from("no command"),
    };
    let words = Words::new(Service::Lss, None, text);
    if is_short { words.error() } else { words }
}
