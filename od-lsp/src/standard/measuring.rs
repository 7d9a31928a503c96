//! Objects of CiA 404: measuring devices and closed-loop controllers.

use crate::standard::Row;

/// By ascending index.
#[rustfmt::skip]
pub(super) const TABLE: &[Row] = &[
    (0x6100, 0x6100, "AI input FV"),
    (0x6110, 0x6110, "AI sensor type"),
    (0x6112, 0x6112, "AI operating mode"),
    (0x6114, 0x6114, "AI ADC sample rate"),
    (0x6120, 0x6120, "AI input scaling 1 FV"),
    (0x6121, 0x6121, "AI input scaling 1 PV"),
    (0x6122, 0x6122, "AI input scaling 2 FV"),
    (0x6123, 0x6123, "AI input scaling 2 PV"),
    (0x6124, 0x6124, "AI input offset"),
    (0x6125, 0x6125, "AI autozero"),
    (0x6130, 0x6130, "AI input PV"),
    (0x6131, 0x6131, "AI physical unit PV"),
    (0x6132, 0x6132, "AI decimal digits PV"),
    (0x6133, 0x6133, "AI interrupt delta input PV"),
    (0x6134, 0x6134, "AI interrupt lower limit input PV"),
    (0x6135, 0x6135, "AI interrupt upper limit input PV"),
    (0x6136, 0x6136, "AI interrupt hysteresis input PV"),
    (0x6148, 0x6148, "AI span start"),
    (0x6149, 0x6149, "AI span end"),
    (0x6150, 0x6150, "AI status"),
    (0x61A0, 0x61A0, "AI filter type"),
    (0x61A1, 0x61A1, "AI filter constant"),
    (0x7100, 0x7100, "AI input FV (INTEGER16)"),
    (0x7130, 0x7130, "AI input PV (INTEGER16)"),
    (0x9100, 0x9100, "AI input FV (INTEGER32)"),
    (0x9130, 0x9130, "AI input PV (INTEGER32)"),
];
