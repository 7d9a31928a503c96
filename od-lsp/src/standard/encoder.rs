//! Objects of CiA 406: encoders.

use crate::standard::Row;

/// By ascending index.
#[rustfmt::skip]
pub(super) const TABLE: &[Row] = &[
    (0x6000, 0x6000, "Operating parameters"),
    (0x6001, 0x6001, "Measuring units per revolution"),
    (0x6002, 0x6002, "Total measuring range in measuring units"),
    (0x6003, 0x6003, "Preset value"),
    (0x6004, 0x6004, "Position value"),
    (0x6005, 0x6005, "Linear encoder measuring step settings"),
    (0x6008, 0x6008, "High precision position value"),
    (0x6009, 0x6009, "High precision preset value"),
    (0x600C, 0x600C, "Position raw value"),
    (0x6010, 0x6010, "Preset values for multi-sensor devices"),
    (0x6020, 0x6020, "Position values for multi-sensor devices"),
    (0x6030, 0x6030, "Speed value"),
    (0x6040, 0x6040, "Acceleration value"),
    (0x6050, 0x6050, "Jerk value"),
    (0x6200, 0x6200, "Cyclic timer"),
    (0x6300, 0x6300, "CAM state register"),
    (0x6301, 0x6301, "CAM enable register"),
    (0x6302, 0x6302, "CAM polarity register"),
    (0x6310, 0x6317, "CAM low limit"),
    (0x6320, 0x6327, "CAM high limit"),
    (0x6330, 0x6337, "CAM hysteresis"),
    (0x6400, 0x6400, "Area state register"),
    (0x6401, 0x6401, "Work area low limit"),
    (0x6402, 0x6402, "Work area high limit"),
    (0x6500, 0x6500, "Operating status"),
    (0x6501, 0x6501, "Singleturn resolution and measuring step"),
    (0x6502, 0x6502, "Number of distinguishable revolutions"),
    (0x6503, 0x6503, "Alarms"),
    (0x6504, 0x6504, "Supported alarms"),
    (0x6505, 0x6505, "Warnings"),
    (0x6506, 0x6506, "Supported warnings"),
    (0x6507, 0x6507, "Profile and software version"),
    (0x6508, 0x6508, "Operating time"),
    (0x6509, 0x6509, "Offset value"),
    (0x650A, 0x650A, "Module identification"),
    (0x650B, 0x650B, "Serial number"),
];
