//! NMT, SYNC, and error control: boot-up, heartbeat, guarding (CiA 301, chapters 7.2.5 and 7.2.8).

use std::format;
use std::prelude::v1::*;

use od_runtime::Frame;
use od_wire::nmt::{Command, Repr, State};

use super::description::{Service, Words};

pub(super) fn nmt(frame: &Frame) -> Words {
    let Some(Repr { command, node }) = Repr::parse(frame.data()) else {
        return Words::new(Service::Nmt, None, "command not defined in CiA 301").error();
    };
    let text = command_text(command);
    match node {
        0 => Words::new(Service::Nmt, None, format!("{text}, all nodes")),
        node => Words::new(Service::Nmt, Some(node), text),
    }
}

/// An NMT command in words.
pub(crate) fn command_text(command: Command) -> &'static str {
    match command {
        Command::Start => "start",
        Command::Stop => "stop",
        Command::EnterPreOperational => "enter Pre-operational",
        Command::ResetNode => "reset node",
        Command::ResetCommunication => "reset communication",
    }
}

pub(super) fn sync(frame: &Frame) -> Words {
    match frame.data() {
        [counter] => Words::new(Service::Sync, None, format!("counter {counter}")),
        _ => Words::new(Service::Sync, None, "triggers synchronous PDOs"),
    }
}

pub(super) fn error_control(node: u8, frame: &Frame) -> Words {
    let words = |text: String| Words::new(Service::ErrorControl, Some(node), text);
    if frame.is_remote() {
        return words("node guarding request".into());
    }
    match frame.data() {
        [0] => words("boot-up".into()),
        [byte] => match State::from_code(byte & 0x7F) {
            Some(state) if byte & 0x80 != 0 => words(format!("{state} (guarding, toggle 1)")),
            Some(state) => words(state.to_string()),
            None => words(format!("unknown state {byte:02X}h")).error(),
        },
        _ => words("one byte is required".into()).error(),
    }
}
