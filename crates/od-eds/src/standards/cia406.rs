//! Objects of CiA 406: encoders.

use od_model::DataType::{
    Integer8, Integer16, Integer32, Unsigned8, Unsigned16, Unsigned32, Unsigned64,
};

use super::row::{Row, array, named, ro, ro_array, rw, rw_array, var};

/// The objects by ascending index.
#[rustfmt::skip]
pub(super) const TABLE: &[Row] = &[
    var(0x6000, &[Unsigned16], "Operating parameters"),
    rw(0x6001, &[Unsigned32], "Measuring units per revolution"),
    rw(0x6002, &[Unsigned32], "Total measuring range in measuring units"),
    rw(0x6003, &[Unsigned32], "Preset value"),
    ro(0x6004, &[Unsigned32], "Position value"),
    var(0x6005, &[Unsigned32], "Linear encoder measuring step settings"),
    ro(0x6008, &[Unsigned64], "High precision position value"),
    rw(0x6009, &[Unsigned64], "High precision preset value"),
    ro(0x600C, &[Unsigned32], "Position raw value"),
    named(0x6010, 0x6010, "Preset values for multi-sensor devices"),
    ro_array(0x6020, 0x6020, &[Integer32], "Position values for multi-sensor devices"),
    // The number of bits depends on the device.
    ro_array(0x6030, 0x6030, &[Integer16, Integer8, Integer32], "Speed value"),
    // The number of bits depends on the device.
    ro_array(0x6040, 0x6040, &[Integer16, Integer8, Integer32], "Acceleration value"),
    named(0x6050, 0x6050, "Jerk value"),
    var(0x6200, &[Unsigned16], "Cyclic timer"),
    ro_array(0x6300, 0x6300, &[Unsigned8], "CAM state register"),
    rw_array(0x6301, 0x6301, &[Unsigned8], "CAM enable register"),
    rw_array(0x6302, 0x6302, &[Unsigned8], "CAM polarity register"),
    rw_array(0x6310, 0x6317, &[Integer32], "CAM low limit"),
    rw_array(0x6320, 0x6327, &[Integer32], "CAM high limit"),
    rw_array(0x6330, 0x6337, &[Unsigned16], "CAM hysteresis"),
    ro_array(0x6400, 0x6400, &[Unsigned8], "Area state register"),
    array(0x6401, 0x6401, &[Integer32], "Work area low limit"),
    array(0x6402, 0x6402, &[Integer32], "Work area high limit"),
    ro(0x6500, &[Unsigned16], "Operating status"),
    ro(0x6501, &[Unsigned32], "Singleturn resolution and measuring step"),
    // 16 bits up to version 3, 32 bits since.
    ro(0x6502, &[Unsigned16, Unsigned32], "Number of distinguishable revolutions"),
    ro(0x6503, &[Unsigned16], "Alarms"),
    ro(0x6504, &[Unsigned16], "Supported alarms"),
    ro(0x6505, &[Unsigned16], "Warnings"),
    ro(0x6506, &[Unsigned16], "Supported warnings"),
    ro(0x6507, &[Unsigned32], "Profile and software version"),
    ro(0x6508, &[Unsigned32], "Operating time"),
    // An offset counts modulo 2^32, so its sign does not matter.
    ro(0x6509, &[Integer32, Unsigned32], "Offset value"),
    ro_array(0x650A, 0x650A, &[Integer32], "Module identification"),
    ro(0x650B, &[Unsigned32], "Serial number"),
    named(0x650C, 0x650C, "Offset values for multi-sensor devices").with(&[(1, 0xFE, Integer32)]),
];
