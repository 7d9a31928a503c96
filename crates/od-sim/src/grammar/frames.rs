//! Expected frames: as a pattern with gaps, or by their meaning.

use std::prelude::v1::*;
use std::{fmt, format};

use od_model::{Address, values};
use od_runtime::Frame;
use od_wire::nmt::Command;
use od_wire::{AbortCode, emcy, nmt, sdo};

use super::pattern::Pattern;
use super::problem::Problem;
use super::tokens::{Tokens, nmt_command};
use crate::device::VirtualDevice;
use crate::words;

/// Expected frames.
#[derive(Clone, PartialEq, Debug)]
pub enum Frames {
    /// A pattern with gaps.
    Pattern(Pattern),
    /// An NMT command; without a node it may be for any node.
    Nmt(Command, Option<u8>),
    /// The boot-up message of any node.
    BootUp,
    /// An EMCY message; `None`: with any code.
    Emcy(Option<u16>),
    /// An SDO abort; `None`: with any code.
    Abort(Option<AbortCode>),
    /// An SDO upload of the object was answered.
    Read(Address),
    /// An SDO download of the object was confirmed.
    Written(Address),
}

const HELP: &str = "write a frame (701#00, 581#43*), or nmt start 5, sync, boot-up, emcy 8130h, \
                    abort 06020000h, read 1017h or write 1017h";

impl Frames {
    pub(crate) fn parse(tokens: &mut Tokens<'_>) -> Result<Self, Problem> {
        let start = *tokens;
        let pattern = |text| Pattern::parse(text).map_err(|error| start.frame_problem(&error));
        let frames = match tokens.next() {
            "nmt" => {
                let (command, node) = nmt_command(tokens)?;
                Self::Nmt(command, node)
            }
            "sync" => Self::Pattern(pattern("080#*")?),
            "boot-up" => Self::BootUp,
            "emcy" if tokens.is_empty() => Self::Emcy(None),
            "emcy" => Self::Emcy(Some(tokens.number(0, 0xFFFF)? as u16)),
            "abort" if tokens.is_empty() => Self::Abort(None),
            "abort" => Self::Abort(Some(abort(tokens)?)),
            kind @ ("read" | "write") => {
                let here = *tokens;
                let Some(address) = values::address(tokens.next()) else {
                    let help = "write 1017h or 1018h:01";
                    return Err(here.problem("the object is missing", help));
                };
                match kind {
                    "read" => Self::Read(address),
                    _ => Self::Written(address),
                }
            }
            "" => return Err(start.problem("the frame is missing", HELP)),
            word if !word.contains('#') => {
                return Err(start.problem(format!("`{word}` is not a frame"), HELP));
            }
            _ => {
                tokens.take_rest();
                Self::Pattern(pattern(start.rest())?)
            }
        };
        tokens.end()?;
        Ok(frames)
    }

    /// Returns whether a frame is one of these.
    pub fn matches(&self, frame: &Frame) -> bool {
        let id = frame.id().as_standard().unwrap_or(u16::MAX);
        match self {
            Self::Pattern(pattern) => pattern.matches(frame),
            Self::Nmt(wanted, node) => {
                id == 0
                    && nmt::Repr::parse(frame.data()).is_some_and(|nmt| {
                        nmt.command == *wanted && node.is_none_or(|node| node == nmt.node)
                    })
            }
            Self::BootUp => {
                (0x701..=0x77F).contains(&id) && !frame.is_remote() && frame.data() == [0]
            }
            Self::Emcy(code) => {
                (0x081..=0x0FF).contains(&id)
                    && emcy::Emcy::parse(frame.data())
                        .is_some_and(|emcy| code.is_none_or(|code| code == emcy.code))
            }
            Self::Abort(code) => response(frame).is_some_and(|response| {
                matches!(response, sdo::Response::Abort { code: came, .. }
                    if code.map(AbortCode::code).is_none_or(|code| code == came))
            }),
            Self::Read(wanted) => answered(frame, *wanted, true),
            Self::Written(wanted) => answered(frame, *wanted, false),
        }
    }

    /// The frames in words, with the object names of the devices.
    pub(crate) fn words(&self, devices: &[VirtualDevice]) -> String {
        let label = |address: &Address| match devices.first() {
            Some(device) => values::label(device.dictionary(), *address),
            None => address.to_string(),
        };
        match self {
            Self::Pattern(pattern) => {
                let whole: Option<Vec<u8>> = match pattern.bytes() {
                    Some(bytes) if !pattern.is_open() => bytes.iter().copied().collect(),
                    _ => None,
                };
                match whole.and_then(|bytes| Frame::new(pattern.id(), &bytes)) {
                    Some(frame) => format!("`{pattern}` ({})", words::explain(devices, &frame)),
                    None => format!("`{pattern}`"),
                }
            }
            Self::Nmt(command, node) => {
                let name = words::command_text(*command);
                match node {
                    None => format!("NMT {name}"),
                    Some(0) => format!("NMT {name} to all nodes"),
                    Some(node) => format!("NMT {name} to node {node}"),
                }
            }
            Self::BootUp => "a boot-up message".into(),
            Self::Emcy(None) => "an EMCY message".into(),
            Self::Emcy(Some(code)) => format!("EMCY {code:04X}h ({})", emcy::text(None, *code)),
            Self::Abort(None) => "an SDO abort".into(),
            Self::Abort(Some(code)) => format!("SDO abort {code}"),
            Self::Read(address) => format!("{} is read", label(address)),
            Self::Written(address) => format!("{} is written", label(address)),
        }
    }
}

/// The name in scripts.
impl fmt::Display for Frames {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Pattern(pattern) => pattern.fmt(f),
            other => f.write_str(&other.words(&[])),
        }
    }
}

/// An abort code of CiA 301.
pub(super) fn abort(tokens: &mut Tokens<'_>) -> Result<AbortCode, Problem> {
    let here = *tokens;
    let word = tokens.next();
    let digits = word.strip_suffix(['h', 'H']).unwrap_or(word);
    let digits = digits.trim_start_matches("0x").replace('_', "");
    let code = u32::from_str_radix(&digits, 16).ok();
    code.and_then(AbortCode::from_code).ok_or_else(|| {
        here.problem(
            format!("abort code `{word}` does not exist"),
            "write eight hex digits, such as 06090031h",
        )
    })
}

fn response(frame: &Frame) -> Option<sdo::Response> {
    let id = frame.id().as_standard()?;
    let is_response = (0x581..=0x5FF).contains(&id) && frame.dlc() == 8 && !frame.is_remote();
    is_response.then(|| sdo::Response::parse(frame.bytes()))
}

fn answered(frame: &Frame, wanted: Address, upload: bool) -> bool {
    match response(frame) {
        Some(
            sdo::Response::InitiateUpload { address, .. }
            | sdo::Response::InitiateBlockUpload { address, .. },
        ) => upload && address == wanted,
        Some(
            sdo::Response::InitiateDownload { address }
            | sdo::Response::InitiateBlockDownload { address, .. },
        ) => !upload && address == wanted,
        _ => false,
    }
}
