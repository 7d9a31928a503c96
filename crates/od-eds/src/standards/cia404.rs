//! Objects of CiA 404: measuring devices and closed-loop controllers.

use od_model::DataType;
use od_model::DataType::{
    Integer16, Integer24, Integer32, Real32, Unsigned8, Unsigned16, Unsigned32,
};

use super::row::{Row, array, named, ro_array, rw_array};

/// The parameters of a channel, which have one type, and its values, which have a type in each
/// range.
pub(super) const TABLES: &[&[Row]] = &[
    PARAMETERS,
    &values(0x6000, &[Real32]),
    &values(0x7000, &[Integer16]),
    &values(0x8000, &[Integer24]),
    &values(0x9000, &[Integer32]),
];

/// The objects by ascending index.
#[rustfmt::skip]
const PARAMETERS: &[Row] = &[
    rw_array(0x6110, 0x6110, &[Unsigned16], "AI sensor type"),
    named(0x6111, 0x6111, "AI autocalibration"),
    array(0x6112, 0x6112, &[Unsigned8], "AI operating mode"),
    named(0x6113, 0x6113, "AI ADC sample rate"),
    // Devices have 16 and 32 bits.
    named(0x6114, 0x6114, "AI ADC sample rate").with(&[(1, 0xFE, Unsigned32)]),
    array(0x6125, 0x6125, &[Unsigned32], "AI autozero"),
    array(0x6126, 0x6126, &[Real32], "AI scaling factor"),
    array(0x6127, 0x6127, &[Real32], "AI scaling offset"),
    array(0x6131, 0x6131, &[Unsigned32], "AI physical unit PV"),
    array(0x6132, 0x6132, &[Unsigned8], "AI decimal digits PV"),
    ro_array(0x6150, 0x6150, &[Unsigned8], "AI status"),
    array(0x61A0, 0x61A0, &[Unsigned8], "AI filter type"),
    array(0x61A1, 0x61A1, &[Unsigned8], "AI filter constant"),
    array(0x6301, 0x6301, &[Unsigned32], "AO physical unit PV"),
    array(0x6302, 0x6302, &[Unsigned8], "AO decimal digits PV"),
    array(0x6310, 0x6310, &[Unsigned16], "AO output type"),
    array(0x6340, 0x6340, &[Unsigned8], "AO fault mode"),
];

/// Field and process values of one type: 6000h are REAL32, 7000h INTEGER16, 8000h INTEGER24 and 9000h INTEGER32.
#[rustfmt::skip]
const fn values(range: u16, types: &'static [DataType]) -> [Row; 18] {
    const fn at(index: u16, types: &'static [DataType], name: &'static str) -> Row {
        array(index, index, types, name)
    }
    [
        ro_array(range + 0x100, range + 0x100, types, "AI input FV"),
        at(range + 0x120, types, "AI input scaling 1 FV"),
        at(range + 0x121, types, "AI input scaling 1 PV"),
        at(range + 0x122, types, "AI input scaling 2 FV"),
        at(range + 0x123, types, "AI input scaling 2 PV"),
        at(range + 0x124, types, "AI input offset"),
        ro_array(range + 0x130, range + 0x130, types, "AI input PV"),
        at(range + 0x133, types, "AI interrupt delta input PV"),
        at(range + 0x134, types, "AI interrupt lower limit input PV"),
        at(range + 0x135, types, "AI interrupt upper limit input PV"),
        at(range + 0x136, types, "AI interrupt hysteresis input PV"),
        at(range + 0x148, types, "AI span start"),
        at(range + 0x149, types, "AI span end"),
        rw_array(range + 0x300, range + 0x300, types, "AO output PV"),
        at(range + 0x320, types, "AO output scaling 1 PV"),
        at(range + 0x321, types, "AO output scaling 1 FV"),
        at(range + 0x330, types, "AO output FV"),
        at(range + 0x341, types, "AO fault FV"),
    ]
}
