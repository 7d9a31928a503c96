//! One line that is one frame: what the send line of a page takes.

use std::prelude::v1::*;

use od_model::{Address, DataType, values};
use od_wire::sdo::Request;
use od_wire::{Frame, NodeId, nmt};

use super::Problem;
use super::parse::statement;
use super::statement::{Action, Outcome};
use super::typed;
use super::words::Words;
use crate::logs::candump;

/// Reads a line of a script, of a log, or a frame as people type it, for a node:
/// `601#40 04 60 00`, `(0.1) can0 601#40046000`, `nmt start`, `sync`, `sdo read 6004h`, and for
/// short `read 6004`, `write 6001 = 4096`, `sync 5`, `guard`. `type_of` knows the objects of
/// the node.
///
/// # Errors
/// What is wrong with it and what to write instead.
pub fn frame_of(
    text: &str,
    node: NodeId,
    type_of: impl Fn(Address) -> Option<DataType>,
) -> Result<Frame, Problem> {
    let words = Words::new(1, text);
    let mut rest = words;
    let verb = rest.next().to_ascii_lowercase();
    match verb.as_str() {
        "guard" if rest.is_empty() => {
            let asked = Frame::remote(node.plus(0x700), 1);
            asked.ok_or_else(|| words.problem("a frame has at most 8 bytes", ""))
        }
        "sync" if rest.at_number() && !rest.rest().contains(' ') => {
            let counter = rest.number(0, 255)? as u8;
            Ok(Frame::standard(0x80, &[counter]))
        }
        "read" | "write" => {
            let line = format!("sdo {verb} {}", rest.rest());
            act(Words::new(1, &line), node, type_of).map_err(|problem| Problem {
                column: problem.column.saturating_sub(4).max(1),
                ..problem
            })
        }
        "sdo" | "nmt" | "sync" | "send" => act(words, node, type_of),
        _ => typed::frame(text).or_else(|error| {
            // A line of a log has a time or an interface.
            let line = candump::parse_line(text).map(|line| line.frame);
            line.map_err(|_| words.frame_problem(&error))
        }),
    }
}

fn act(
    words: Words<'_>,
    node: NodeId,
    type_of: impl Fn(Address) -> Option<DataType>,
) -> Result<Frame, Problem> {
    match statement(words, &mut None)?.1 {
        Action::Send {
            frame, times: 1, ..
        } => Ok(frame),
        Action::Nmt { command, node: of } => {
            let node = of.unwrap_or(node.raw());
            Ok(Frame::standard(0, &nmt::Repr { command, node }.emit()))
        }
        Action::Read {
            object,
            outcome: Outcome::Done,
        } => {
            let address = address(words, &object)?;
            Ok(request(node, Request::InitiateUpload { address }))
        }
        Action::Write {
            object,
            value,
            type_name: None,
            outcome: Outcome::Done,
        } => {
            let address = address(words, &object)?;
            let help = "write an object of the node";
            let data_type = type_of(address).ok_or_else(|| {
                words.problem(format!("{address} is not in the dictionary"), help)
            })?;
            let bytes = typed::value(data_type, &value).map_err(|why| words.problem(why, ""))?;
            let mut data = [0; 4];
            let room = data.get_mut(..bytes.len()).filter(|room| !room.is_empty());
            let room = room.ok_or_else(|| {
                words.problem("the value has more than 4 bytes", "use the SDO line")
            })?;
            room.copy_from_slice(&bytes);
            let download = Request::InitiateDownload {
                address,
                size: Some(bytes.len() as u32),
                expedited: Some(data),
            };
            Ok(request(node, download))
        }
        _ => Err(words.problem("this line is not one frame", "write one frame")),
    }
}

fn request(node: NodeId, request: Request) -> Frame {
    Frame::full(node.plus(0x600), request.emit())
}

fn address(words: Words<'_>, text: &str) -> Result<Address, Problem> {
    let help = "write it as 6004 or 1018:01";
    let message = || format!("`{text}` is not the address of an object");
    values::address(text).ok_or_else(|| words.problem(message(), help))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::string::ToString;

    fn read(text: &str) -> Result<String, Problem> {
        let node = NodeId::new(5).expect("1 to 127");
        let known = Address::new(0x6001, 0);
        let type_of = |address| (address == known).then_some(DataType::Unsigned32);
        frame_of(text, node, type_of).map(|frame| frame.to_string())
    }

    #[test]
    fn a_line_is_a_frame() {
        for (text, frame) in [
            ("601#40 04 60 00", "601#40046000"),
            ("601 40 4", "601#4004"),
            (
                "(0.100000) can0 601#4004600000000000",
                "601#4004600000000000",
            ),
            (" can0  601   [2]  40 04", "601#4004"),
            ("read 6004", "605#4004600000000000"),
            ("sdo read 1018:2", "605#4018100200000000"),
            ("write 6001 = 4096", "605#2301600000100000"),
            ("WRITE 6001 = 1000h", "605#2301600000100000"),
            ("nmt start", "000#0105"),
            ("nmt stop all", "000#0200"),
            ("nmt reset 7", "000#8107"),
            ("sync", "080#"),
            ("sync 5", "080#05"),
            ("guard", "705#R1"),
        ] {
            assert_eq!(read(text).as_deref(), Ok(frame), "{text}");
        }
        for (text, why) in [
            ("nmt begin", "begin"),
            ("read position", "address"),
            ("write 6004 = 1", "not in the dictionary"),
            ("write 6001 = x", "not a whole number"),
            ("sync 5 times", "one frame"),
            ("hello", "hexadecimal"),
        ] {
            let problem = read(text).expect_err(text);
            assert!(problem.message.contains(why), "{text}: {problem}");
        }
    }
}
