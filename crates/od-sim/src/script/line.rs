//! One line with one frame: the input of the send line of a page.

use std::prelude::v1::*;

use od_model::{Address, DataType, values};
use od_wire::sdo::Request;
use od_wire::{Frame, NodeId, nmt};

use super::typed;
use crate::grammar::problem::Problem;
use crate::grammar::tokens::{Tokens, nmt_command};
use crate::logs::candump;

/// Context of a line.
pub struct LineContext<'k> {
    /// The node of the line.
    pub node: NodeId,
    /// The type of an object of that node.
    pub type_of: &'k dyn Fn(Address) -> Option<DataType>,
    /// Reads a decimal fraction.
    pub real: &'k dyn Fn(&str) -> Option<f64>,
}

/// Reads a line of a log, a frame in any usual form, or a script's words for one frame:
/// `601#40 04 60 00`, `(0.1) can0 601#40046000`, `nmt start`, `sync`, `sdo read 6004h`, and the
/// short forms `read 6004`, `write 6001 = 4096`, `sync 5`, `guard`.
///
/// # Errors
/// The problem, and the text to write instead.
pub fn frame_of(text: &str, known: &LineContext<'_>) -> Result<Frame, Problem> {
    let start = Tokens::new(1, text);
    let mut words = start;
    let mut verb = words.next().to_ascii_lowercase();
    if verb == "sdo" {
        verb = words.next().to_ascii_lowercase();
    }
    let frame = match verb.as_str() {
        "guard" => {
            let asked = Frame::remote(known.node.plus(0x700), 1);
            asked.ok_or_else(|| start.problem("a frame has at most 8 bytes", ""))?
        }
        "sync" => {
            words.take("counter");
            if words.is_empty() {
                Frame::standard(0x80, &[])
            } else {
                Frame::standard(0x80, &[words.number(0, 255)? as u8])
            }
        }
        "nmt" => {
            let (command, node) = nmt_command(&mut words)?;
            let node = node.unwrap_or(known.node.raw());
            Frame::standard(0, &nmt::Repr { command, node }.emit())
        }
        "read" => {
            let address = address(words)?;
            return Ok(request(known.node, Request::InitiateUpload { address }));
        }
        "write" => return write(words, known),
        _ => return typed_or_logged(text, start),
    };
    words.end()?;
    Ok(frame)
}

fn typed_or_logged(text: &str, start: Tokens<'_>) -> Result<Frame, Problem> {
    typed::frame(text).or_else(|error| {
        // A line of a log has a time or an interface.
        let line = candump::parse_line(text).map(|line| line.frame);
        let is_logged = text.trim_start().starts_with('(') || text.contains('[');
        line.map_err(|logged| start.frame_problem(if is_logged { &logged } else { &error }))
    })
}

/// `6001h = 4096`.
fn write(mut words: Tokens<'_>, known: &LineContext<'_>) -> Result<Frame, Problem> {
    let start = words;
    let object = words
        .split_at_equals()
        .ok_or_else(|| start.problem("the value is missing", "write `write 6001 = 4096`"))?;
    let address = address(object)?;
    let help = "write an object of the node";
    let missing = || start.problem(format!("{address} is not in the dictionary"), help);
    let data_type = (known.type_of)(address).ok_or_else(missing)?;
    let bytes = typed::value(data_type, words.rest(), known.real);
    let bytes = bytes.map_err(|why| words.problem(why, ""))?;
    let mut data = [0; 4];
    let room = data.get_mut(..bytes.len()).filter(|room| !room.is_empty());
    let room =
        room.ok_or_else(|| words.problem("the value has more than 4 bytes", "use the SDO line"))?;
    room.copy_from_slice(&bytes);
    let download = Request::InitiateDownload {
        address,
        size: Some(bytes.len() as u32),
        expedited: Some(data),
    };
    Ok(request(known.node, download))
}

fn request(node: NodeId, request: Request) -> Frame {
    Frame::full(node.plus(0x600), request.emit())
}

fn address(words: Tokens<'_>) -> Result<Address, Problem> {
    let text = words.rest();
    let message = || format!("`{text}` is not an object address");
    values::address(text).ok_or_else(|| words.problem(message(), "write 6004 or 1018:01"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::string::ToString;

    fn read(text: &str) -> Result<String, Problem> {
        let node = NodeId::new(5).expect("1 to 127");
        let known = Address::new(0x6001, 0);
        let known = LineContext {
            node,
            type_of: &|address| (address == known).then_some(DataType::Unsigned32),
            real: &|text| text.parse().ok(),
        };
        frame_of(text, &known).map(|frame| frame.to_string())
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
            ("read position", "not an object address"),
            ("write 6004 = 1", "not in the dictionary"),
            ("write 6001 = x", "not a whole number"),
            ("sync 5 times", "unexpected"),
            ("hello", "hexadecimal"),
        ] {
            let problem = read(text).expect_err(text);
            assert!(problem.message.contains(why), "{text}: {problem}");
        }
    }

    /// Lines of candump with any of its options, here and in scripts, lessons and `--link -`, which share one reader.
    #[test]
    fn a_line_of_candump_is_a_frame_everywhere() {
        use crate::grammar::action::Action;
        use crate::grammar::deed::Deed;
        use crate::grammar::named_frame::NamedFrame;
        use crate::script::read::Reader;

        for (line, frame) in [
            ("can0  123   [4]  11 22 33 44", "123#11223344"),
            ("  can0  123   [2]  11 23   '.#'", "123#1123"),
            ("  can0  123   [3]  20 23 41   ' #A'", "123#202341"),
            (" (000.001000)  can0  123   [1]  11", "123#11"),
            (" (2026-11-25 15:50:01.123456)  can0  123   [0]", "123#"),
            (" (1.5)  can0  RX - -  123   [1]  41   'A'", "123#41"),
            ("  can0  TX B E  1F334455   [2]  11 22", "1F334455#1122"),
            ("  can0  701   [0]  remote request", "701#R"),
            ("  can0  701   [1]  remote request", "701#R1"),
            ("(1732549801.123456) can0 601#40046000", "601#40046000"),
            ("(1.5) can0 123#1122 R", "123#1122"),
            ("(1.5) vcan1 1F334455#R4 T", "1F334455#R4"),
        ] {
            assert_eq!(read(line).as_deref(), Ok(frame), "{line}");
            let statement = Reader::default().statement(line);
            let Ok(Some(statement)) = statement else {
                panic!("{line}: {statement:?}");
            };
            let Action::Deed(Deed::Send {
                frame: NamedFrame::Frame(sent),
                ..
            }) = statement.action
            else {
                panic!("{line}");
            };
            assert_eq!(sent.to_string(), frame, "{line}");
        }
        for line in [
            "  can0  20000004   [8]  00 00 00 00 00 00 00 00   ERRORFRAME",
            "(1.5) can0 20000004#0000000000000000",
        ] {
            for problem in [
                read(line).expect_err(line),
                Reader::default().statement(line).expect_err(line),
            ] {
                assert!(problem.message.ends_with("is an error frame"), "{problem}");
            }
        }
    }
}
