//! Functions without a bench: typed frames, values as bytes and back,
//! services, and transfers of several frames.

use od_model::DataType;
use od_runtime::NodeId;
use od_sim::line::bits::{Bit, Part, bits};
use od_sim::script::{LineContext, frame_of, typed};
use od_sim::words::fold::{Folder, State};
use od_sim::words::{TAGS, tag};
use wasm_bindgen::prelude::*;

use crate::crossing::{Absent, Bytes, Crosses, choice, record, words};
use crate::record::{bytes, integer};
use crate::{packed, values};

#[wasm_bindgen]
extern "C" {
    /// Returns the type of an object.
    #[wasm_bindgen(typescript_type = "{ typeOf(index: number, sub: number): string | undefined }")]
    pub type Objects;

    #[wasm_bindgen(method, structural, js_name = typeOf)]
    fn type_of(this: &Objects, index: u16, sub: u8) -> Option<String>;
}

choice! {
    /// A typed frame, or the error in it.
    LineResult {
        TypedFrame,
        TypingError,
    }
}

record! {
    TypedFrame {
        id: u32,
        extended: bool,
        remote: bool,
        /// A remote frame has as many zeros as bytes it requests.
        data: Bytes,
        error: Absent,
    }

    TypingError {
        error: String,
        /// Position in the text, from 0.
        at: usize,
    }

    /// A segmented or block transfer.
    Transfer {
        /// Numbers of its frames.
        frames: Vec<u32>,
        node: u8,
        index: u16,
        sub: u8,
        "isWrite" is_write: bool,
        /// The bytes transferred so far.
        bytes: Bytes,
        state: TransferState,
    }
}

words! {
    TransferState {
        UnderWay = "under way",
        Done = "done",
        Aborted = "aborted",
    }
}

/// Short names of the services, such as `PDO1`, in the order of `tags`.
#[wasm_bindgen(js_name = tagNames)]
pub fn tag_names() -> Vec<String> {
    TAGS.into_iter().map(String::from).collect()
}

/// Count of numbers for each frame in `tags`.
pub(crate) const TAG_LEN: usize = 2;
/// Position of the node ID in the first number; below it is the place in `tagNames`.
pub(crate) const TAG_NODE: u32 = 8;
/// Position of the bit in the first number that says whether the frame names an object.
pub(crate) const TAG_OBJECT: u32 = 16;

/// For each packed frame two numbers: its place in `tagNames`, its node ID (0: none, or all) and whether it
/// names an object; and this object as `index * 256 + sub`.
#[wasm_bindgen]
pub fn tags(frames: &[u8]) -> Vec<u32> {
    let of = |packed: &[u8]| {
        let tag = packed::frame(packed).map(|frame| tag(&frame));
        let object = tag.and_then(|tag| tag.object);
        let first = tag.map_or(0, |tag| {
            u32::from(tag.tag) | u32::from(tag.node) << TAG_NODE
        });
        let first = first | u32::from(object.is_some()) << TAG_OBJECT;
        [first, object.map_or(0, packed::object)] as [u32; TAG_LEN]
    };
    frames.chunks_exact(packed::LEN).flat_map(of).collect()
}

/// Parses a typed frame, or a line of a script or a log that is one frame.
/// `objects` gives the types of the objects of the node.
#[wasm_bindgen(js_name = readLine, unchecked_return_type = "LineResult")]
pub fn read_line(text: &str, node_id: u8, objects: &Objects) -> JsValue {
    let known = LineContext {
        node: NodeId::new(node_id).unwrap_or(NodeId::ONE),
        type_of: &|at| named(&objects.type_of(at.index, at.sub)?),
        real: &real,
    };
    let result = match frame_of(text, &known) {
        Ok(frame) => {
            let mut data = [0; 8];
            let len = usize::from(frame.dlc());
            let sent = if frame.is_remote() {
                &[][..]
            } else {
                frame.data()
            };
            for (to, from) in data.iter_mut().zip(sent) {
                *to = *from;
            }
            LineResult::TypedFrame(TypedFrame {
                id: frame.id().raw(),
                extended: frame.id().is_extended(),
                remote: frame.is_remote(),
                data: data.get(..len).unwrap_or_default().into(),
                error: Absent,
            })
        }
        Err(problem) => LineResult::TypingError(TypingError {
            error: problem.message,
            at: problem.column.saturating_sub(1),
        }),
    };
    result.value()
}

/// The bytes of a value that a user typed for an object of this type, such as `UNSIGNED32`.
///
/// # Errors
/// The error in the text.
#[wasm_bindgen(js_name = encodeValue)]
pub fn encode_value(type_name: &str, text: &str) -> Result<Vec<u8>, JsError> {
    let data_type = named(type_name).unwrap_or(DataType::Domain);
    Ok(typed::value(data_type, text, real)?)
}

/// The value in the bytes of an object of this type.
#[wasm_bindgen(js_name = decodeValue, unchecked_return_type = "Value")]
pub fn decode_value(type_name: &str, raw: &[u8]) -> JsValue {
    match named(type_name) {
        Some(data_type) => values::value(data_type, raw),
        None => bytes(raw),
    }
}

/// The minimum and the maximum of an integer type; empty for others.
#[wasm_bindgen(js_name = typeRange, unchecked_return_type = "Value[]")]
pub fn type_range(type_name: &str) -> Vec<JsValue> {
    let range = named(type_name).and_then(DataType::integer_range);
    range.map_or(Vec::new(), |(low, high)| vec![integer(low), integer(high)])
}

#[wasm_bindgen]
extern "C" {
    /// Converts a text to a number; NaN if it is not one.
    #[wasm_bindgen(js_name = Number)]
    fn number(text: &str) -> f64;
}

fn real(text: &str) -> Option<f64> {
    Some(number(text))
}

pub(crate) fn named(name: &str) -> Option<DataType> {
    DataType::ALL.into_iter().find(|one| one.name() == name)
}

/// Joins SDO transfers of several frames.
#[wasm_bindgen]
#[derive(Default)]
pub struct Transfers(Folder);

#[wasm_bindgen]
impl Transfers {
    /// No frame was seen yet.
    #[wasm_bindgen(constructor)]
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds the next packed frame; returns the number of the first frame of its transfer,
    /// or nothing if it has a row of its own.
    pub fn take(&mut self, frame: &[u8], number: u32) -> Option<u32> {
        self.0.take(&packed::frame(frame)?, number)
    }

    /// The transfer that starts with this frame; `null` if it has only this one.
    #[wasm_bindgen(unchecked_return_type = "Transfer | null")]
    pub fn transfer(&self, first: u32) -> JsValue {
        let transfer = self.0.fold(first).map(|fold| Transfer {
            frames: fold.frames.to_vec(),
            node: fold.node,
            index: fold.object.index,
            sub: fold.object.sub,
            is_write: fold.is_write,
            bytes: fold.bytes.as_slice().into(),
            state: match fold.state {
                State::UnderWay => TransferState::UnderWay,
                State::Done => TransferState::Done,
                State::Aborted => TransferState::Aborted,
            },
        });
        transfer.value()
    }

    /// Removes transfers that start before this frame.
    #[wasm_bindgen(js_name = forgetBefore)]
    pub fn forget_before(&mut self, number: u32) {
        self.0.forget_before(number);
    }

    /// Removes everything.
    pub fn clear(&mut self) {
        self.0.clear();
    }
}

/// Flags of a bit in [`frame_bits`].
pub(crate) const RECESSIVE: u8 = 0x80;
pub(crate) const STUFFED: u8 = 0x40;
/// Numbers of two of its fields.
pub(crate) const CRC: u8 = 8;
pub(crate) const DATA: u8 = 16;

/// The bits of a packed frame on the bus line, a byte each: 128 if it is recessive, 64 if it was stuffed, and the number of
/// its field: 0 start of frame, 1 identifier, 2 SRR, 3 IDE, 4 identifier extension, 5 RTR, 6 reserved, 7 DLC, 8 CRC,
/// 9 CRC delimiter, 10 acknowledge slot, 11 acknowledge delimiter, 12 end of frame, 16 and more a data byte.
#[wasm_bindgen(js_name = frameBits)]
pub fn frame_bits(frame: &[u8]) -> Vec<u8> {
    let flag = |on, flag| if on { flag } else { 0 };
    let part = |part| match part {
        Part::Start => 0,
        Part::Identifier => 1,
        Part::Substitute => 2,
        Part::Extension => 3,
        Part::IdentifierExtension => 4,
        Part::Remote => 5,
        Part::Reserved => 6,
        Part::Length => 7,
        Part::Crc => CRC,
        Part::CrcDelimiter => 9,
        Part::Acknowledge => 10,
        Part::AcknowledgeDelimiter => 11,
        Part::End => 12,
        Part::Data(number) => DATA + number,
    };
    let code =
        |bit: &Bit| flag(bit.recessive, RECESSIVE) | flag(bit.stuffed, STUFFED) | part(bit.part);
    packed::frame(frame).map_or(Vec::new(), |frame| bits(&frame).iter().map(code).collect())
}
