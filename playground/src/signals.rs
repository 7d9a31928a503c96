//! Values in captured frames, as numbers.

use od_model::{Address, DataType};
use od_sim::signal::{Place, Signal};
use od_wire::{CanId, NodeId};
use wasm_bindgen::prelude::*;

use crate::codec::named;
use crate::packed;

/// The values of a mapped object in packed frames: three numbers each, index of the frame in the batch, microseconds,
/// value.
#[wasm_bindgen(js_name = mappedValues)]
pub fn mapped_values(
    frames: &[u8],
    id: u32,
    extended: bool,
    first: u8,
    bits: u8,
    type_name: &str,
) -> Vec<f64> {
    let id = if extended {
        CanId::extended(id)
    } else {
        CanId::standard(id as u16)
    };
    values(frames, Some(Place::Mapped { id, first, bits }), type_name)
}

/// The values of an object in SDO responses among packed frames, as in [`mapped_values`].
#[wasm_bindgen(js_name = readValues)]
pub fn read_values(frames: &[u8], node: u8, index: u16, sub: u8, type_name: &str) -> Vec<f64> {
    let address = Address::new(index, sub);
    let place = NodeId::new(node).map(|node| Place::Read { node, address });
    values(frames, place, type_name)
}

fn values(frames: &[u8], place: Option<Place>, type_name: &str) -> Vec<f64> {
    let data_type = named(type_name).unwrap_or(DataType::Unsigned64);
    let Some(signal) = place.map(|place| Signal { place, data_type }) else {
        return Vec::new();
    };
    let mut all = Vec::new();
    for (number, one) in frames.chunks_exact(packed::LEN).enumerate() {
        let frame = packed::frame(one).filter(|_| !packed::is_disturbed(one));
        let value = frame.and_then(|frame| signal.value(&frame));
        if let (Some(value), Some(micros)) = (value, packed::micros(one)) {
            all.extend_from_slice(&[number as f64, micros, value]);
        }
    }
    all
}
