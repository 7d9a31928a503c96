//! Objects of CiA 404: measuring devices and closed-loop controllers.

use od_model::DataType;
use od_model::DataType::{Integer16, Integer24, Integer32, Real32};

use super::row::{Row, named};

/// By ascending index.
#[rustfmt::skip]
pub(super) const TABLE: &[Row] = &[
    named(0x6100, 0x6100, "AI input FV"),
    named(0x6110, 0x6110, "AI sensor type"),
    named(0x6112, 0x6112, "AI operating mode"),
    named(0x6114, 0x6114, "AI ADC sample rate"),
    named(0x6120, 0x6120, "AI input scaling 1 FV"),
    named(0x6121, 0x6121, "AI input scaling 1 PV"),
    named(0x6122, 0x6122, "AI input scaling 2 FV"),
    named(0x6123, 0x6123, "AI input scaling 2 PV"),
    named(0x6124, 0x6124, "AI input offset"),
    named(0x6125, 0x6125, "AI autozero"),
    named(0x6130, 0x6130, "AI input PV"),
    named(0x6131, 0x6131, "AI physical unit PV"),
    named(0x6132, 0x6132, "AI decimal digits PV"),
    named(0x6133, 0x6133, "AI interrupt delta input PV"),
    named(0x6134, 0x6134, "AI interrupt lower limit input PV"),
    named(0x6135, 0x6135, "AI interrupt upper limit input PV"),
    named(0x6136, 0x6136, "AI interrupt hysteresis input PV"),
    named(0x6148, 0x6148, "AI span start"),
    named(0x6149, 0x6149, "AI span end"),
    named(0x6150, 0x6150, "AI status"),
    named(0x61A0, 0x61A0, "AI filter type"),
    named(0x61A1, 0x61A1, "AI filter constant"),
    named(0x7100, 0x7100, "AI input FV (INTEGER16)"),
    named(0x7130, 0x7130, "AI input PV (INTEGER16)"),
    named(0x9100, 0x9100, "AI input FV (INTEGER32)"),
    named(0x9130, 0x9130, "AI input PV (INTEGER32)"),
];

/// Process and field values, in each of the ranges 6000h (REAL32), 7000h (INTEGER16), 8000h (INTEGER24) and
/// 9000h (INTEGER32): first and last index without the range.
const VALUES: [(u16, u16); 6] = [
    (0x100, 0x100),
    (0x120, 0x127),
    (0x130, 0x130),
    (0x133, 0x137),
    (0x148, 0x149),
    (0x300, 0x330),
];

/// The type of a process or field value; `None` for another object.
pub(super) fn value_type(index: u16) -> Option<DataType> {
    let offset = index & 0xFFF;
    let is_here = |(first, last): &(u16, u16)| (*first..=*last).contains(&offset);
    let range = VALUES.iter().any(is_here).then_some(index >> 12)?;
    match range {
        6 => Some(Real32),
        7 => Some(Integer16),
        8 => Some(Integer24),
        9 => Some(Integer32),
        _ => None,
    }
}
