//! Differences between the eight devices, from manual 000.

/// A device, by its cells in the tables.
pub(crate) struct Model {
    /// 1008h, in capitals (MANUALS.md C-GX-09).
    pub(crate) name: &'static str,
    pub(crate) family: &'static str,
    /// 1000h: 2 for a multiturn, 1 for a singleturn.
    pub(crate) device_type: u32,
    /// 1018h:02 (C-GX-30).
    pub(crate) product_code: u32,
    /// 6501h; also default and maximum of 6001h.
    pub(crate) resolution: u32,
    /// 6502h; also default and maximum of 6002h. In decimal, as in chapter 4.4.2, since some of
    /// the hexadecimal numbers beside it have lost a digit (C-GX-02 to C-GX-04).
    pub(crate) range: u32,
    /// 6502h / 6501h (C-GX-31).
    pub(crate) turns: u32,
    /// 6506h: bit 2 watchdog, bit 4 battery.
    pub(crate) warnings: u16,
}

impl Model {
    /// Its name on a command line.
    pub(crate) fn id(&self) -> String {
        self.name.to_lowercase()
    }

    pub(crate) fn is_multiturn(&self) -> bool {
        self.turns > 1
    }
}

const fn model(
    name: &'static str,
    family: &'static str,
    (device_type, product_code): (u32, u32),
    (resolution, range, turns): (u32, u32, u32),
    warnings: u16,
) -> Model {
    Model {
        name,
        family,
        device_type,
        product_code,
        resolution,
        range,
        turns,
        warnings,
    }
}

#[rustfmt::skip]
pub(crate) const MODELS: [Model; 8] = [
    model("GXMM", "multivo multiturn",       (0x0002_0196, 0x0A), (  8_192,   536_870_912, 65_536), 0x14),
    model("GXAM", "multivo singleturn",      (0x0001_0196, 0x0B), (  8_192,         8_192,      1), 0x04),
    model("GCMM", "magtivo multiturn",       (0x0002_0196, 0x0C), (  4_096,    67_108_864, 16_384), 0x14),
    model("GCAM", "magtivo singleturn",      (0x0001_0196, 0x0D), (  4_096,         4_096,      1), 0x04),
    model("GDMM", "activo multiturn",        (0x0002_0196, 0x0E), (262_144, 2_147_483_648,  8_192), 0x14),
    model("GDAM", "activo singleturn",       (0x0001_0196, 0x0F), (262_144,       262_144,      1), 0x04),
    model("GBMM", "multivoPlus multiturn",   (0x0002_0196, 0x0E), (262_144, 2_147_483_648,  8_192), 0x14),
    model("GBAM", "multivoPlus singleturn",  (0x0001_0196, 0x0F), (262_144,       262_144,      1), 0x04),
];
