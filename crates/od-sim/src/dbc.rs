//! Signals of DBC files: names, values and units for the bytes of frames.
//!
//! ```
//! use od_sim::dbc::Database;
//! let text = "VERSION \"\"\n\nBS_:\n\nBU_: A\n\nBO_ 389 Drive: 8 A\n SG_ Speed : 0|16@1- (0.5,0) [0|0] \"rpm\" A\n";
//! let database = Database::read(text.as_bytes()).expect("a DBC file");
//! let frame = od_wire::Frame::standard(0x185, &[0xF6, 0xFF]);
//! assert_eq!(database.words(&frame).as_deref(), Some("Drive: Speed -5.0 rpm"));
//! ```

use std::collections::BTreeMap;
use std::format;
use std::prelude::v1::*;

use can_dbc::{
    ByteOrder, Dbc, DbcError, MessageId, MultiplexIndicator, SignalExtendedValueType,
    ValueDescription, ValueType,
};
use od_model::Refused;
use od_wire::Frame;

/// Longest file, in bytes; a longer one is refused.
const LONGEST: usize = 2 * 1024 * 1024;
/// The message of signals that belong to no frame.
const NO_FRAME: &str = "VECTOR__INDEPENDENT_SIG_MSG";
/// Maximum number of digits after the point of a value.
const MOST_DIGITS: usize = 9;

/// The messages of a DBC file.
#[derive(Clone, Debug, Default)]
pub struct Database {
    /// By CAN-ID, and whether it has 29 bits.
    messages: BTreeMap<(u32, bool), Message>,
    left_out: usize,
}

#[derive(Clone, Debug)]
struct Message {
    name: String,
    signals: Vec<Signal>,
}

#[derive(Clone, Debug)]
struct Signal {
    name: String,
    unit: String,
    start: usize,
    size: usize,
    order: ByteOrder,
    kind: Kind,
    factor: f64,
    offset: f64,
    is_multiplexor: bool,
    /// The multiplexor and the ranges of its values with which the signal is in the frame; `None`: always.
    within: Option<(String, Vec<(u64, u64)>)>,
    /// Texts of values.
    texts: BTreeMap<i64, String>,
}

#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Kind {
    Unsigned,
    Signed,
    Float,
    Double,
}

/// A signal with its value in a frame.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Value {
    /// Name of the signal.
    pub name: String,
    /// The value, scaled, or its text.
    pub value: String,
    /// Unit; may be empty.
    pub unit: String,
}

impl Database {
    /// Reads a DBC file in UTF-8 or Latin-1.
    ///
    /// # Errors
    /// The reason why it is not a DBC file, with the line.
    pub fn read(bytes: &[u8]) -> Result<Self, Refused> {
        if bytes.len() > LONGEST {
            return Err("the file is longer than 2 MiB".into());
        }
        let latin = || bytes.iter().map(|byte| char::from(*byte)).collect();
        let text = match core::str::from_utf8(bytes) {
            Ok(text) => String::from(text.trim_start_matches('\u{feff}')),
            Err(_) => latin(),
        };
        // The parser looks at the rest of the file again for each line without content.
        let lines: Vec<(usize, &str)> = (1..)
            .zip(text.lines())
            .filter(|(_, line)| !line.trim().is_empty())
            .collect();
        let mut dense = String::with_capacity(text.len());
        for (_, line) in &lines {
            dense.push_str(line);
            dense.push('\n');
        }
        let dbc = Dbc::try_from(dense.as_str()).map_err(|error| reason(&error, &lines))?;
        if dbc.messages.is_empty() {
            return Err("the file has no message (`BO_`)".into());
        }
        Ok(Self::of(&dbc))
    }

    fn of(dbc: &Dbc) -> Self {
        let mut messages = BTreeMap::new();
        let mut left_out = 0;
        for message in dbc.messages.iter().filter(|one| one.name != NO_FRAME) {
            let main = message
                .signals
                .iter()
                .find(|one| one.multiplexer_indicator == MultiplexIndicator::Multiplexor);
            let main = main.map(|signal| signal.name.as_str());
            let signals = message.signals.iter().map(|one| signal(one, main));
            let signals: Vec<Signal> = signals.filter(Signal::fits).collect();
            left_out += message.signals.len() - signals.len();
            let name = message.name.clone();
            messages.insert(key(message.id), Message { name, signals });
        }
        let mut of = |id: MessageId, name: &str, change: &mut dyn FnMut(&mut Signal)| {
            let message = messages.get_mut(&key(id));
            let mut signals = message
                .into_iter()
                .flat_map(|one: &mut Message| &mut one.signals);
            if let Some(signal) = signals.find(|signal| signal.name == name) {
                change(signal);
            }
        };
        for one in &dbc.value_descriptions {
            let ValueDescription::Signal {
                message_id,
                name,
                value_descriptions,
            } = one
            else {
                continue;
            };
            let texts = value_descriptions
                .iter()
                .map(|one| (one.id, one.description.clone()));
            of(*message_id, name, &mut |signal| {
                signal.texts.extend(texts.clone())
            });
        }
        for one in &dbc.signal_extended_value_type_list {
            let kind = match one.signal_extended_value_type {
                SignalExtendedValueType::IEEEfloat32Bit => Kind::Float,
                SignalExtendedValueType::IEEEdouble64bit => Kind::Double,
                SignalExtendedValueType::SignedOrUnsignedInteger => continue,
            };
            of(one.message_id, &one.signal_name, &mut |signal| {
                signal.kind = kind
            });
        }
        for one in &dbc.extended_multiplex {
            let ranges = one
                .mappings
                .iter()
                .map(|one| (one.min_value, one.max_value));
            let within = (
                one.multiplexor_signal_name.clone(),
                ranges.collect::<Vec<_>>(),
            );
            of(one.message_id, &one.signal_name, &mut |signal| {
                signal.within = Some(within.clone());
            });
        }
        Self { messages, left_out }
    }

    /// Number of messages.
    pub fn len(&self) -> usize {
        self.messages.len()
    }

    /// Returns whether it has no message.
    pub fn is_empty(&self) -> bool {
        self.messages.is_empty()
    }

    /// Number of signals that no classic frame can hold: they have no bit, more than 64 bits, or end after byte 8.
    pub fn left_out(&self) -> usize {
        self.left_out
    }

    /// The name of the message of a frame.
    pub fn message(&self, frame: &Frame) -> Option<&str> {
        self.find(frame).map(|message| message.name.as_str())
    }

    /// The signals in a frame, in the order of the file; signals beyond its bytes are left out.
    pub fn signals(&self, frame: &Frame) -> Vec<Value> {
        let Some(message) = self.find(frame) else {
            return Vec::new();
        };
        let data = frame.data();
        let is_there = |signal: &&Signal| message.contains(signal, data, message.signals.len());
        let value = |signal: &Signal| signal.value(data);
        message
            .signals
            .iter()
            .filter(is_there)
            .filter_map(value)
            .collect()
    }

    /// The message and its signals in words; `None` if the file does not describe the frame.
    pub fn words(&self, frame: &Frame) -> Option<String> {
        let name = self.message(frame)?;
        let signals: Vec<_> = self
            .signals(frame)
            .iter()
            .map(ToString::to_string)
            .collect();
        if signals.is_empty() {
            return Some(name.to_owned());
        }
        Some(format!("{name}: {}", signals.join(", ")))
    }

    fn find(&self, frame: &Frame) -> Option<&Message> {
        if frame.is_remote() {
            return None;
        }
        self.messages
            .get(&(frame.id().raw(), frame.id().is_extended()))
    }
}

impl Message {
    /// Returns whether a signal is in a frame with these bytes. Multiplexors may depend on others, up to `depth`.
    fn contains(&self, signal: &Signal, data: &[u8], depth: usize) -> bool {
        let Some((name, ranges)) = &signal.within else {
            return true;
        };
        let Some(switch) = self
            .signals
            .iter()
            .find(|one| one.is_multiplexor && one.name == *name)
        else {
            return false;
        };
        let Some(depth) = depth.checked_sub(1) else {
            return false;
        };
        let chosen = switch.raw(data);
        chosen.is_some_and(|value| {
            ranges
                .iter()
                .any(|(from, to)| (*from..=*to).contains(&value))
        }) && self.contains(switch, data, depth)
    }
}

impl Signal {
    /// Returns whether a frame of eight bytes can hold the signal.
    fn fits(&self) -> bool {
        (1..=64).contains(&self.size) && self.raw(&[0; 8]).is_some()
    }

    /// The bits of the signal; `None` if the frame is too short.
    fn raw(&self, data: &[u8]) -> Option<u64> {
        let bit = |place: usize| Some(u64::from(data.get(place / 8)? >> (place % 8) & 1));
        let mut raw = 0;
        match self.order {
            ByteOrder::LittleEndian => {
                for place in 0..self.size {
                    raw |= bit(self.start.checked_add(place)?)? << place;
                }
            }
            // The start is the highest bit; the next byte follows its lowest one.
            ByteOrder::BigEndian => {
                let mut place = self.start;
                for _ in 0..self.size {
                    raw = raw << 1 | bit(place)?;
                    place = if place.is_multiple_of(8) {
                        place.checked_add(15)?
                    } else {
                        place - 1
                    };
                }
            }
        }
        Some(raw)
    }

    fn value(&self, data: &[u8]) -> Option<Value> {
        let raw = self.raw(data)?;
        let unused = 64 - self.size as u32;
        let integer = match self.kind {
            Kind::Signed => i128::from((raw << unused) as i64 >> unused),
            _ => i128::from(raw),
        };
        let number = match self.kind {
            Kind::Float => f64::from(f32::from_bits(raw as u32)),
            Kind::Double => f64::from_bits(raw),
            _ => integer as f64,
        };
        let is_integer = matches!(self.kind, Kind::Unsigned | Kind::Signed);
        let text = i64::try_from(integer)
            .ok()
            .and_then(|value| self.texts.get(&value));
        let value = match text.filter(|_| is_integer) {
            Some(text) => text.clone(),
            None if is_integer && self.factor == 1.0 && self.offset == 0.0 => integer.to_string(),
            None if is_integer => {
                let digits = digits(self.factor).max(digits(self.offset));
                format!("{:.digits$}", number * self.factor + self.offset)
            }
            None => format!("{}", number * self.factor + self.offset),
        };
        Some(Value {
            name: self.name.clone(),
            value,
            unit: self.unit.clone(),
        })
    }
}

impl core::fmt::Display for Value {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        let Self { name, value, unit } = self;
        let between = if unit.is_empty() { "" } else { " " };
        write!(f, "{name} {value}{between}{unit}")
    }
}

fn key(id: MessageId) -> (u32, bool) {
    match id {
        MessageId::Standard(id) => (id.into(), false),
        MessageId::Extended(id) => (id, true),
    }
}

fn signal(one: &can_dbc::Signal, main: Option<&str>) -> Signal {
    let with = |value: u64| {
        let name = String::from(main.unwrap_or_default());
        Some((name, Vec::from([(value, value)])))
    };
    let (is_multiplexor, within) = match one.multiplexer_indicator {
        MultiplexIndicator::Plain => (false, None),
        MultiplexIndicator::Multiplexor => (true, None),
        MultiplexIndicator::MultiplexedSignal(value) => (false, with(value)),
        MultiplexIndicator::MultiplexorAndMultiplexedSignal(value) => (true, with(value)),
    };
    Signal {
        name: one.name.clone(),
        unit: one.unit.clone(),
        start: usize::try_from(one.start_bit).unwrap_or(usize::MAX),
        size: usize::try_from(one.size).unwrap_or(usize::MAX),
        order: one.byte_order,
        kind: match one.value_type {
            ValueType::Signed => Kind::Signed,
            ValueType::Unsigned => Kind::Unsigned,
        },
        factor: one.factor,
        offset: one.offset,
        is_multiplexor,
        within,
        texts: BTreeMap::new(),
    }
}

/// Digits after the point that a number needs.
fn digits(number: f64) -> usize {
    let text = format!("{number}");
    let after = text.split_once('.').map_or(0, |(_, after)| after.len());
    after.min(MOST_DIGITS)
}

/// The reason in one sentence, with the line of the file.
fn reason(error: &DbcError, lines: &[(usize, &str)]) -> String {
    let DbcError::Pest(error) = error else {
        return format!("not a DBC file: {error}");
    };
    // The place is only in the message: ` --> line:column`.
    let text = error.to_string();
    let place = text.split_once("-->").map_or("", |(_, rest)| rest);
    let place = place.lines().next().unwrap_or_default().trim();
    let number = place
        .split_once(':')
        .and_then(|(line, _)| line.parse::<usize>().ok());
    let line = number.and_then(|number| lines.get(number.checked_sub(1)?));
    let Some((number, text)) = line else {
        return String::from("the file ends too early");
    };
    let text: String = text.trim().chars().take(60).collect();
    format!("line {number}: `{text}` is not a line of a DBC file")
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "VERSION \"\"\n\nNS_ :\n\nBS_:\n\nBU_: Drive Panel\n\n\
        BO_ 389 Motion: 8 Drive\n\
        \x20SG_ Speed : 0|16@1- (0.5,0) [-1000|1000] \"rpm\" Panel\n\
        \x20SG_ Heat : 23|12@0+ (1,-40) [0|0] \"\u{b0}C\" Panel\n\
        \x20SG_ Mode : 36|4@1+ (1,0) [0|15] \"\" Panel\n\n\
        BO_ 2566844926 Wide: 8 Drive\n\
        \x20SG_ Ratio : 0|32@1- (1,0) [0|0] \"\" Panel\n\n\
        BO_ 512 Many: 8 Panel\n\
        \x20SG_ Page M : 0|8@1+ (1,0) [0|0] \"\" Drive\n\
        \x20SG_ Volt m0 : 8|16@1+ (0.01,0) [0|0] \"V\" Drive\n\
        \x20SG_ Amp m1 : 8|16@1- (0.01,0) [0|0] \"A\" Drive\n\n\
        BO_ 3221225472 VECTOR__INDEPENDENT_SIG_MSG: 0 Vector__XXX\n\
        \x20SG_ Loose : 0|8@1+ (1,0) [0|0] \"\" Vector__XXX\n\n\
        VAL_ 389 Mode 0 \"off\" 3 \"torque\" ;\n\
        SIG_VALTYPE_ 2566844926 Ratio : 1;\n";

    fn words(id: u16, data: &[u8]) -> Option<String> {
        let database = Database::read(TEXT.as_bytes()).expect("a DBC file");
        let frame = Frame::new(od_wire::CanId::standard(id), data);
        database.words(&frame.expect("at most eight bytes"))
    }

    #[test]
    fn signals_have_names_scaled_values_units_and_texts() {
        let motion = words(0x185, &[0xF6, 0xFF, 0x01, 0x90, 0x30, 0, 0, 0]);
        // 12 bits from bit 23 on, high bit first: 01h and the upper half of 90h.
        assert_eq!(
            motion.as_deref(),
            Some("Motion: Speed -5.0 rpm, Heat -15 \u{b0}C, Mode torque")
        );
        // A frame that is shorter has fewer signals.
        assert_eq!(
            words(0x185, &[2, 0]).as_deref(),
            Some("Motion: Speed 1.0 rpm")
        );
        assert_eq!(words(0x185, &[]).as_deref(), Some("Motion"));
        assert_eq!(words(0x186, &[2, 0]), None);
        let database = Database::read(TEXT.as_bytes()).expect("a DBC file");
        let wide = od_wire::CanId::extended(2_566_844_926 & 0x1FFF_FFFF);
        let frame = Frame::new(wide, &1.5_f32.to_le_bytes()).expect("four bytes");
        assert_eq!(database.words(&frame).as_deref(), Some("Wide: Ratio 1.5"));
        assert_eq!((database.len(), database.is_empty()), (3, false));
    }

    #[test]
    fn a_multiplexor_chooses_signals() {
        assert_eq!(
            words(0x200, &[0, 0xD2, 4]).as_deref(),
            Some("Many: Page 0, Volt 12.34 V")
        );
        assert_eq!(
            words(0x200, &[1, 0xFF, 0xFF]).as_deref(),
            Some("Many: Page 1, Amp -0.01 A")
        );
        assert_eq!(words(0x200, &[7, 1, 2]).as_deref(), Some("Many: Page 7"));
    }

    #[test]
    fn a_text_that_is_not_a_dbc_file_is_refused_at_its_line() {
        for (text, why) in [
            (
                TEXT.replacen("(0.5,0)", "(0.5 0)", 1),
                "line 10: `SG_ Speed",
            ),
            (
                String::from("[FileInfo]\nFileName=a.eds\n"),
                "line 1: `[FileInfo]`",
            ),
            (
                String::from("VERSION \"\"\n"),
                "the file has no message (`BO_`)",
            ),
            ("\n".repeat(LONGEST + 1), "the file is longer than 2 MiB"),
            (String::from("BO_ 1 A: 8 B\n SG_ S : "), ""),
            (
                format!("BO_ 1 A: 8 B\n SG_ S : {}", "(".repeat(100_000)),
                "line 2: `SG_ S : ((((",
            ),
            ("\n".repeat(300_000), "the file has no message (`BO_`)"),
        ] {
            let wrong = Database::read(text.as_bytes()).expect_err(why);
            assert!(wrong.to_string().starts_with(why), "{wrong}");
        }
    }

    /// Sizes, places and multiplexors that no frame can have.
    #[test]
    fn hostile_signals_have_no_value() {
        let text = "BU_: A\n\nBO_ 1 M: 8 A\n SG_ Far : 18446744073709551615|64@1+ (1,0) [0|0] \"\" A\n \
                    SG_ Up : 18446744073709551615|64@0+ (1,0) [0|0] \"\" A\n SG_ Big : 0|65@1+ (1,0) [0|0] \"\" A\n \
                    SG_ None : 0|0@1+ (1,0) [0|0] \"\" A\n SG_ Self m1M : 0|8@1+ (1,0) [0|0] \"\" A\n \
                    SG_ All : 0|64@1- (1,0) [0|0] \"\" A\n\nSG_MUL_VAL_ 1 Self Self 0-255;\n";
        let database = Database::read(text.as_bytes()).expect("a DBC file");
        let frame = Frame::standard(1, &[0xFF; 8]);
        assert_eq!(database.words(&frame).as_deref(), Some("M: All -1"));
        // Far, Up, Big and None; Self has bits, but chooses itself.
        assert_eq!(database.left_out(), 4);
        // Any file either has messages or says why not.
        let mut mixed = TEXT.as_bytes().to_vec();
        for at in 0..mixed.len() {
            let kept = mixed[at];
            mixed[at] = b'"';
            if let Ok(database) = Database::read(&mixed) {
                let _ = database.words(&Frame::standard(0x185, &[0xFF; 8]));
            }
            mixed[at] = kept;
        }
    }
}
