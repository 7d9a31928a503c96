//! Inputs of a bench: all actions of its user.

use std::prelude::v1::*;

use od_wire::{CanId, Frame, Instant};

use super::choice::choice;
use super::parts::{Dip, Rate, Source};

choice! {
    /// A change of a bench. A journal keeps every input with its virtual time, so that a run can be repeated: for a
    /// step back, from a link, after a reload. The first device has the number 0; station 0 is the outside.
    Input by "op" {
        /// A device is added to the bus, or replaces the one at `place`.
        "add" Add {
            "source" source: Source,
            "nodeId" node_id: u8,
            "place" place: Option<u8>,
        }
        /// A device is removed from the bus.
        "remove" Remove { "node" node: u8, }
        /// A frame is sent from outside. A remote frame has no data: `data` gives its DLC by its length.
        "send" Send {
            "id" id: u32,
            "data" data: Vec<u8>,
            "extended" extended: bool,
            "remote" remote: bool,
        }
        /// A frame is sent at this interval in microseconds; 0 ends it. `key` identifies the periodic frame.
        "repeat" Repeat {
            "key" key: u32,
            "id" id: u32,
            "data" data: Vec<u8>,
            "extended" extended: bool,
            "remote" remote: bool,
            "micros" micros: u32,
        }
        /// The power is switched on or off.
        "power" Power { "node" node: u8, "on" on: bool, }
        /// The shaft is turned to a number of revolutions from the sensor's zero point.
        "turn" Turn { "node" node: u8, "turns" turns: f64, }
        /// The shaft gets a speed in revolutions per minute.
        "rpm" Rpm { "node" node: u8, "rpm" rpm: f64, }
        /// The shaft follows a profile: pairs of rpm and milliseconds.
        "follow" Follow { "node" node: u8, "steps" steps: Vec<f64>, "repeats" repeats: bool, }
        /// The rotary switches of the node ID or a DIP switch of the bit rate are set.
        "switches" Switches { "node" node: u8, "id" id: Option<u8>, "dip" dip: Option<Dip>, }
        /// A fault begins or ends.
        "fault" Fault { "node" node: u8, "name" name: String, "on" on: bool, }
        /// The bus line is configured.
        "line" Line { "real" real: bool, "terminators" terminators: u8, "rate" rate: Rate, }
        /// The random disturbances of the bus line get a seed.
        "seed" Seed { "seed" seed: u32, }
        /// A station is connected or disconnected.
        "plug" Plug { "station" station: u8, "on" on: bool, }
        /// The CAN controller of a station starts again after bus-off.
        "restart" Restart { "station" station: u8, }
        /// The power fails in the middle of the next save, after this number of bytes.
        "cut" Cut { "node" node: u8, "bytes" bytes: u32, }
        /// The EEPROM gets these bytes.
        "eeprom" Eeprom { "node" node: u8, "bytes" bytes: Vec<u8>, }
        /// One device receives a frame that is not on the bus.
        "deliver" Deliver { "node" node: u8, "id" id: u32, "data" data: Vec<u8>, }
        /// A lesson starts: its bench replaces the current one.
        "lesson" Lesson { "text" text: String, }
        /// The lesson ends; its bench stays.
        "leave" Leave {}
        /// The lines of a script run, such as the solution of a step.
        "script" Script { "text" text: String, }
    }
}

impl Input {
    /// Sends a frame from outside.
    pub fn send(frame: &Frame) -> Self {
        let data = if frame.is_remote() {
            std::vec![0; frame.dlc().into()]
        } else {
            frame.data().to_vec()
        };
        Self::Send {
            id: frame.id().raw(),
            data,
            extended: frame.id().is_extended(),
            remote: frame.is_remote(),
        }
    }
}

/// A frame from its parts; a remote frame has the length of `data` as its DLC. `None` for more than
/// eight bytes.
pub fn frame(id: u32, data: &[u8], extended: bool, remote: bool) -> Option<Frame> {
    let id = if extended {
        CanId::extended(id)
    } else {
        CanId::standard(id as u16)
    };
    if remote {
        Frame::remote(id, u8::try_from(data.len()).ok()?)
    } else {
        Frame::new(id, data)
    }
}

/// An input and its time.
#[derive(Clone, PartialEq, Debug)]
pub struct Entry {
    /// Time of the input.
    pub at: Instant,
    /// The input.
    pub input: Input,
}
