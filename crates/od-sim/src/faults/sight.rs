//! Observations of a probe, rounded so that two readings differ only if a person sees it, with words in English and German.

use std::format;
use std::prelude::v1::*;

use od_model::Address;
use od_runtime::Frame;
use od_wire::nmt::State;

use crate::device::leds::Led;

/// Language of the words.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub enum Language {
    /// English.
    #[default]
    English,
    /// German.
    German,
}

impl Language {
    /// Chooses one of two texts.
    pub(super) fn of(self, english: String, german: String) -> String {
        match self {
            Self::English => english,
            Self::German => german,
        }
    }
}

/// An object as people write it: a VAR without its sub-index.
pub(super) fn named(object: Address) -> String {
    match object.sub {
        0 => format!("{:04X}h", object.index),
        _ => object.to_string(),
    }
}

/// A kind of frame: what a trace shows in one line of a summary.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub enum Subject {
    /// SYNC.
    Sync,
    /// EMCY message of a node with an error code.
    Emcy(u8, u16),
    /// PDO with a CAN-ID.
    Pdo(u16),
    /// Boot-up message of a node.
    BootUp(u8),
    /// Heartbeat of a node with its NMT state as on the bus.
    Heartbeat(u8, u8),
    /// Any other CAN-ID.
    Other(u32),
}

impl Subject {
    /// The subject of a frame of a device; `None` for a remote frame.
    pub(super) fn of(frame: &Frame) -> Option<Self> {
        if frame.is_remote() {
            return None;
        }
        let id = frame.id().raw();
        let node = (id & 0x7F) as u8;
        Some(match (id, frame.data()) {
            (0x080, _) => Self::Sync,
            (0x081..=0x0FF, [low, high, ..]) => Self::Emcy(node, u16::from_le_bytes([*low, *high])),
            (0x181..=0x57F, _) => Self::Pdo(id as u16),
            (0x701..=0x77F, [0]) => Self::BootUp(node),
            (0x701..=0x77F, [state]) => Self::Heartbeat(node, state & 0x7F),
            _ => Self::Other(id),
        })
    }

    fn words(self, language: Language) -> String {
        let (english, german) = match self {
            Self::Sync => ("080h: SYNC".into(), "080h: SYNC".into()),
            Self::Emcy(node, code) => {
                let id = 0x080 + u16::from(node);
                let text = format!("{id:03X}h: EMCY {code:04X}h, ");
                (format!("{text}node {node}"), format!("{text}Knoten {node}"))
            }
            Self::Pdo(id) => (format!("{id:03X}h: PDO"), format!("{id:03X}h: PDO")),
            Self::BootUp(node) => {
                let id = 0x700 + u16::from(node);
                (
                    format!("{id:03X}h: boot-up message, node {node}"),
                    format!("{id:03X}h: Boot-up-Nachricht, Knoten {node}"),
                )
            }
            Self::Heartbeat(node, code) => {
                let id = 0x700 + u16::from(node);
                let state = State::from_code(code).map_or("?".into(), |state| state.to_string());
                (
                    format!("{id:03X}h: heartbeat {state}, node {node}"),
                    format!("{id:03X}h: Heartbeat {state}, Knoten {node}"),
                )
            }
            Self::Other(id) => (format!("{id:03X}h"), format!("{id:03X}h")),
        };
        language.of(english, german)
    }
}

/// Rate of frames.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub enum Often {
    /// Once.
    Once,
    /// About this number per second: 1, 2, 5, 10, 20, 50 …; 0 is less than one.
    PerSecond(u32),
}

impl Often {
    pub(super) fn of(count: u32, micros: u64) -> Self {
        if count <= 1 {
            return Self::Once;
        }
        let per_second = u64::from(count) * 1_000_000 / micros.max(1);
        let steps = [1000, 500, 200, 100, 50, 20, 10, 5, 2, 1];
        let near = steps.iter().find(|step| per_second * 4 >= **step * 3);
        Self::PerSecond(near.map_or(0, |step| *step as u32))
    }

    fn words(self, language: Language) -> String {
        let (english, german) = match self {
            Self::Once => ("once".into(), "einmal".into()),
            Self::PerSecond(0) => (
                "less than once per second".into(),
                "seltener als einmal je Sekunde".into(),
            ),
            Self::PerSecond(often) => (
                format!("about {often} per second"),
                format!("etwa {often} je Sekunde"),
            ),
        };
        language.of(english, german)
    }
}

/// The share of error frames among all frames.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub enum Share {
    /// No error frame.
    None,
    /// Fewer than half.
    Some,
    /// Half or more.
    Most,
}

impl Share {
    pub(super) fn of(failed: usize, all: usize) -> Self {
        match failed {
            0 => Self::None,
            _ if failed * 2 < all => Self::Some,
            _ => Self::Most,
        }
    }
}

/// A response of an SDO server.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Answer {
    /// Value of up to 4 bytes, little endian.
    Value(u32),
    /// Number of bytes of a longer value.
    Long(u32),
    /// Abort code.
    Abort(u32),
}

impl Answer {
    pub(super) fn of(frame: &Frame) -> Option<Self> {
        let [command, _, _, _, a, b, c, d] = *frame.data() else {
            return None;
        };
        let value = u32::from_le_bytes([a, b, c, d]);
        Some(match command {
            0x80 => Self::Abort(value),
            0x41 => Self::Long(value),
            0x42 | 0x43 => Self::Value(value),
            0x47 => Self::Value(value & 0x00FF_FFFF),
            0x4B => Self::Value(value & 0xFFFF),
            0x4F => Self::Value(value & 0xFF),
            _ => return None,
        })
    }

    fn words(self, language: Language) -> String {
        match self {
            Self::Value(value) => format!("{value} ({value:X}h)"),
            Self::Long(bytes) => language.of(format!("{bytes} bytes"), format!("{bytes} Bytes")),
            Self::Abort(code) => {
                language.of(format!("abort {code:08X}h"), format!("Abbruch {code:08X}h"))
            }
        }
    }
}

/// One line of a reading.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum Sight {
    /// Frames came.
    Frames {
        /// Kind of frames.
        subject: Subject,
        /// Their rate.
        often: Often,
        /// Whether their data changed.
        changes: bool,
    },
    /// No device sent a frame that came through.
    NoFrames,
    /// Error frames.
    ErrorFrames {
        /// Their share.
        share: Share,
        /// Whether most of them are missing acknowledgements.
        unacknowledged: bool,
    },
    /// The different responses to an SDO upload; empty without one.
    Answers {
        /// Node that was asked.
        node: u8,
        /// Object that was read.
        object: Address,
        /// Responses.
        answers: Vec<Answer>,
    },
    /// Two readings of an object.
    Compared {
        /// Node that was asked.
        node: u8,
        /// Object that was read.
        object: Address,
        /// Whether both have the same response, or none.
        same: bool,
    },
    /// Ohms between CAN_H and CAN_L; `None`: more than can be measured.
    Resistance(Option<u16>),
    /// The shape of the bits.
    Edges(Edges),
    /// Bits of a sender: bit rate in kbit/s, and tenths of a percent by which they are longer.
    BitTime {
        /// Bit rate in kbit/s.
        rate: u16,
        /// Tenths of a percent.
        tenths: i32,
    },
    /// Bit rate in kbit/s that the interface on the desk found.
    BitRate(u16),
    /// Length of the line in metres; 0: a short one.
    Metres(u16),
    /// Supply voltage.
    Supply {
        /// The node.
        node: u8,
        /// Whether it has power.
        on: bool,
    },
    /// Switches of a bus cover.
    Switches {
        /// Node ID of the rotary switches.
        id: u8,
        /// Bit rate in kbit/s of the DIP switches.
        rate: u16,
    },
    /// LEDs of a bus cover.
    Leds {
        /// The green one.
        green: Led,
        /// The red one.
        red: Led,
    },
    /// The position value changed by this number of steps; `None`: it could not be read.
    Turned {
        /// The node.
        node: u8,
        /// Steps.
        by: Option<i64>,
    },
    /// Whether a device responds to its LSS address.
    Selected(bool),
}

/// The shape of the bits on an oscilloscope.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Edges {
    /// Clean edges and the full level.
    Clean,
    /// The edges ring: reflections.
    Ringing,
    /// The dominant level is too low.
    Low,
    /// CAN_H and CAN_L have the same level all the time.
    Flat,
}

impl Sight {
    /// The line in words.
    pub fn words(&self, language: Language) -> String {
        let (english, german) = match self {
            Self::Frames {
                subject,
                often,
                changes,
            } => {
                let line = |language: Language| {
                    format!("{}, {}", subject.words(language), often.words(language))
                };
                let [mut english, mut german] = [Language::English, Language::German].map(line);
                if *changes {
                    english.push_str(", its data change");
                    german.push_str(", die Daten ändern sich");
                }
                (english, german)
            }
            Self::NoFrames => (
                "no frame comes through".into(),
                "kein Frame kommt durch".into(),
            ),
            Self::ErrorFrames {
                share,
                unacknowledged,
            } => {
                let (mut english, mut german) = match share {
                    Share::None => (
                        String::from("no error frames"),
                        String::from("keine Error-Frames"),
                    ),
                    Share::Some => ("some error frames".into(), "einige Error-Frames".into()),
                    Share::Most => (
                        "most attempts end in error frames".into(),
                        "die meisten Versuche enden in Error-Frames".into(),
                    ),
                };
                if *unacknowledged {
                    english.push_str(": no node acknowledges");
                    german.push_str(": kein Knoten bestätigt");
                }
                (english, german)
            }
            Self::Answers {
                node,
                object,
                answers,
            } => {
                let line = |language: Language, nothing: &str, of: &str| match answers.as_slice() {
                    [] => format!("{of} {node}: {nothing}"),
                    all => {
                        let words = all.iter().map(|answer| answer.words(language));
                        let words: Vec<_> = words.collect();
                        format!("{}, {of} {node}: {}", named(*object), words.join(" / "))
                    }
                };
                (
                    line(Language::English, "no response", "node"),
                    line(Language::German, "keine Antwort", "Knoten"),
                )
            }
            Self::Compared { node, object, same } => {
                let (english, german) = if *same {
                    ("stays the same", "bleibt gleich")
                } else {
                    ("changes", "ändert sich")
                };
                let object = named(*object);
                (
                    format!("{object}, node {node}: {english}"),
                    format!("{object}, Knoten {node}: {german}"),
                )
            }
            Self::Resistance(None) => ("more than 10 kΩ".into(), "mehr als 10 kΩ".into()),
            Self::Resistance(Some(ohms)) => (format!("{ohms} Ω"), format!("{ohms} Ω")),
            Self::Edges(Edges::Clean) => (
                "clean edges, full level".into(),
                "saubere Flanken, voller Pegel".into(),
            ),
            Self::Edges(Edges::Ringing) => {
                ("the edges ring".into(), "die Flanken schwingen nach".into())
            }
            Self::Edges(Edges::Flat) => (
                "CAN_H and CAN_L have the same level all the time".into(),
                "CAN_H und CAN_L haben immer denselben Pegel".into(),
            ),
            Self::Edges(Edges::Low) => (
                "the dominant level is too low".into(),
                "der dominante Pegel ist zu niedrig".into(),
            ),
            Self::BitTime { rate, tenths } => {
                let micros = 1000.0 / f64::from(*rate) * (1.0 + f64::from(*tenths) / 1000.0);
                let text = format!("{micros:.3}");
                (
                    format!("a bit takes {text} µs"),
                    format!("ein Bit dauert {} µs", text.replace('.', ",")),
                )
            }
            Self::BitRate(rate) => (
                format!("it sends with {rate} kbit/s"),
                format!("er sendet mit {rate} kbit/s"),
            ),
            Self::Metres(0) => ("less than 10 m".into(), "weniger als 10 m".into()),
            Self::Metres(metres) => (format!("{metres} m"), format!("{metres} m")),
            Self::Supply { node, on } => {
                let volts = if *on { 24 } else { 0 };
                (
                    format!("node {node}: {volts} V"),
                    format!("Knoten {node}: {volts} V"),
                )
            }
            Self::Switches { id, rate } => (
                format!("rotary switches {id}, DIP switches {rate} kbit/s"),
                format!("Drehschalter {id}, DIP-Schalter {rate} kbit/s"),
            ),
            Self::Leds { green, red } => {
                let word = |led: Led| match led {
                    Led::Off => ("off", "aus"),
                    Led::Flashing => ("flashing", "blinkt"),
                    Led::On => ("on", "an"),
                };
                let (green, red) = (word(*green), word(*red));
                (
                    format!("green {}, red {}", green.0, red.0),
                    format!("grün {}, rot {}", green.1, red.1),
                )
            }
            Self::Selected(false) => ("no response".into(), "keine Antwort".into()),
            Self::Selected(true) => (
                "response 44h: it is selected".into(),
                "Antwort 44h: Er ist ausgewählt".into(),
            ),
            Self::Turned { node, by: None } => (
                format!("node {node}: the position value cannot be read"),
                format!("Knoten {node}: Der Positionswert lässt sich nicht lesen"),
            ),
            Self::Turned { node, by: Some(by) } => (
                format!("node {node}: the position value changes by {by}"),
                format!("Knoten {node}: Der Positionswert ändert sich um {by}"),
            ),
        };
        language.of(english, german)
    }
}
