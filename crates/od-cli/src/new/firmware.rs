//! The workspace for a board: device, firmware, simulation and tests.

use clap::ValueEnum;
use od_runtime::encoder::Total;

use super::device::{BIT_RATES, DeviceFile};
use super::memory::{Layout, Memory, Need, Place};
use super::origin::Origin;
use super::template::{Gap, Template, fill, text};

/// A board with its CAN controller.
#[derive(Clone, Copy, PartialEq, Eq, Debug, clap::ValueEnum)]
pub(super) enum Board {
    /// STM32G0B1 with FDCAN, on embassy
    #[value(name = "stm32g0")]
    Stm32G0,
    /// STM32F405 with bxCAN, on embassy
    #[value(name = "stm32f4")]
    Stm32F4,
    /// RP2040 with an MCP2515 on SPI, on embassy
    #[value(name = "rp2040+mcp2515")]
    Rp2040,
    /// ESP32-C3 with TWAI, on esp-hal and embassy
    #[value(name = "esp32c3")]
    Esp32C3,
    /// Any board with a driver for embedded-can; the generated program runs in QEMU
    #[value(name = "generic")]
    Generic,
}

/// The files that do not depend on the board.
const FILES: [Template; 12] = [
    (
        "Cargo.toml",
        include_str!("template/workspace/Cargo.toml.in"),
    ),
    (".gitignore", "/target\n"),
    ("README.md", include_str!("template/workspace/README.md.in")),
    (
        "device/Cargo.toml",
        include_str!("template/workspace/device.toml.in"),
    ),
    (
        "device/src/lib.rs",
        include_str!("template/workspace/device.rs.in"),
    ),
    (
        "sim/Cargo.toml",
        include_str!("template/workspace/sim.toml.in"),
    ),
    (
        "sim/src/lib.rs",
        include_str!("template/workspace/sim.rs.in"),
    ),
    (
        "sim/src/main.rs",
        include_str!("template/workspace/sim_main.rs.in"),
    ),
    (
        "tests/Cargo.toml",
        include_str!("template/workspace/tests.toml.in"),
    ),
    ("tests/src/lib.rs", TESTS),
    ("tests/scripts.rs", include_str!("template/scripts.rs.in")),
    (
        "tests/scripts/boot-up.script",
        include_str!("template/boot-up.script.in"),
    ),
];
/// Build script and linker script of a firmware for a Cortex-M.
const CORTEX_M: [Template; 2] = [
    (
        "firmware/build.rs",
        include_str!("template/workspace/build.rs.in"),
    ),
    (
        "firmware/no-panic.x",
        include_str!("template/workspace/no-panic.x"),
    ),
];
const ESP32_C3: [Template; 2] = [
    (
        "firmware/build.rs",
        include_str!("template/esp32c3/build.rs.in"),
    ),
    (
        "firmware/partitions.csv",
        include_str!("template/esp32c3/partitions.csv.in"),
    ),
];
const TESTS: &str = "//! The scripts of this package are in `scripts`; `scripts.rs` runs them.\n";

/// Differences between the boards.
struct Parts {
    /// Name to display.
    title: &'static str,
    target: &'static str,
    /// Command with which `cargo run` flashes the board.
    runner: &'static str,
    /// Bit rates of the CAN controller with the clock of the board, in kbit/s.
    bit_rates: &'static [u16],
    /// Linker scripts in addition to that of `cortex-m-rt`.
    link: &'static str,
    dependencies: &'static str,
    board: &'static str,
    /// The place of the program, for the linker; `None` if the HAL knows it.
    memory: Option<&'static str>,
    about: &'static str,
}

impl Board {
    /// The line about `cargo run` in the last message.
    pub(super) const fn next(self) -> &'static str {
        match self {
            Self::Generic => {
                "cargo run     # simulates it, with an slcan port; `cargo run -- --help` lists the other links\n  \
                 cd firmware && cargo run --release    # runs the firmware in QEMU"
            }
            Self::Esp32C3 => {
                "cargo run     # simulates it, with an slcan port; `cargo run -- --help` lists the other links\n  \
                 cd firmware && cargo run --release    # flashes the board with espflash and runs it"
            }
            _ => {
                "cargo run     # simulates it, with an slcan port; `cargo run -- --help` lists the other links\n  \
                 cd firmware && cargo run --release    # flashes the board with probe-rs and runs it"
            }
        }
    }

    const fn parts(self) -> Parts {
        /// 800 kbit/s needs a clock that the others lack.
        const MOST: &[u16] = &[1000, 500, 250, 125, 50, 20, 10];
        match self {
            Self::Stm32G0 => Parts {
                title: "an STM32G0B1",
                target: "thumbv6m-none-eabi",
                runner: "probe-rs run --chip STM32G0B1RETx",
                bit_rates: &BIT_RATES,
                link: "",
                dependencies: include_str!("template/stm32g0/dependencies.toml.in"),
                board: include_str!("template/stm32g0/board.rs.in"),
                memory: Some(include_str!("template/stm32g0/memory.x.in")),
                about: "An STM32G0B1RE with a crystal of 8 MHz; FDCAN1 in classic mode, RX on PB8, TX on PB9.",
            },
            Self::Stm32F4 => Parts {
                title: "an STM32F405",
                target: "thumbv7em-none-eabi",
                runner: "probe-rs run --chip STM32F405RGTx",
                bit_rates: MOST,
                link: "",
                dependencies: include_str!("template/stm32f4/dependencies.toml.in"),
                board: include_str!("template/stm32f4/board.rs.in"),
                memory: Some(include_str!("template/stm32f4/memory.x.in")),
                about: "An STM32F405RG with a crystal of 8 MHz; CAN1, RX on PB8, TX on PB9.",
            },
            Self::Rp2040 => Parts {
                title: "an RP2040 with an MCP2515",
                target: "thumbv6m-none-eabi",
                runner: "probe-rs run --chip RP2040",
                bit_rates: MOST,
                link: "    println!(\"cargo::rustc-link-arg-bins=-Tlink-rp.x\");\n",
                dependencies: include_str!("template/rp2040/dependencies.toml.in"),
                board: include_str!("template/rp2040/board.rs.in"),
                memory: Some(include_str!("template/rp2040/memory.x.in")),
                about: "An RP2040 with 2 MB of flash, and an MCP2515 with a crystal of 16 MHz: MISO on GP4, CS on GP5, \
                        SCK on GP6, MOSI on GP7, INT on GP21.",
            },
            Self::Esp32C3 => Parts {
                title: "an ESP32-C3",
                target: "riscv32imc-unknown-none-elf",
                runner: "espflash flash --monitor --chip esp32c3 --partition-table partitions.csv",
                bit_rates: &BIT_RATES,
                link: "",
                dependencies: include_str!("template/esp32c3/dependencies.toml.in"),
                board: include_str!("template/esp32c3/board.rs.in"),
                memory: None,
                about: include_str!("template/esp32c3/about.md.in"),
            },
            Self::Generic => Parts {
                title: "any board",
                target: "thumbv7m-none-eabi",
                runner: "qemu-system-arm -M lm3s6965evb -nographic -monitor none -serial stdio -kernel",
                bit_rates: &BIT_RATES,
                link: "",
                dependencies: include_str!("template/generic/dependencies.toml.in"),
                board: include_str!("template/generic/board.rs.in"),
                memory: Some(include_str!("template/generic/memory.x.in")),
                about: include_str!("template/generic/about.md.in"),
            },
        }
    }
}

impl Board {
    const fn memory(self) -> Memory {
        const KIB: usize = 1024;
        let (flash, ram, saved) = match self {
            Self::Stm32G0 => (512, 144, Place::End { page: 2 * KIB }),
            // The larger sectors take a second to erase.
            Self::Stm32F4 => {
                let (page, range) = (16 * KIB, 16 * KIB..64 * KIB);
                (1024, 128, Place::Sectors { page, range })
            }
            Self::Rp2040 => (2048, 256, Place::End { page: 4 * KIB }),
            Self::Esp32C3 => (4096, 320, Place::End { page: 4 * KIB }),
            Self::Generic => (256, 64, Place::Ram),
        };
        Memory {
            flash: flash * KIB,
            ram: ram * KIB,
            saved,
        }
    }

    /// Returns how the memory of the board is divided for a device.
    ///
    /// # Errors
    /// A sentence with what it needs, what the board has, and what to do.
    fn fits(self, device: &DeviceFile) -> Result<(Layout, u16), String> {
        let need = Need::of(device);
        let layout = self.memory().layout(&need);
        let rate = device.bit_rate(self.parts().bit_rates);
        match (layout, rate) {
            (Ok(layout), Ok(rate)) => Ok((layout, rate)),
            (Err(why), _) | (_, Err(why)) => Err(why),
        }
    }

    /// The boards that a device fits, for the help of an error.
    fn others(device: &DeviceFile) -> String {
        let names = Self::value_variants().iter();
        let names = names.filter(|board| board.fits(device).is_ok());
        let names = names.filter_map(|board| {
            Some(format!(
                "`--firmware {}`",
                board.to_possible_value()?.get_name()
            ))
        });
        names.collect::<Vec<_>>().join(" or ")
    }
}

/// The gaps about saved values.
fn storage_gaps(layout: &Layout, device: &DeviceFile) -> Vec<Gap> {
    const KIB: usize = 1024;
    let program = layout.program / KIB;
    let mut gaps = vec![
        ("program", program.to_string()),
        // A boot loader is in the first 64 KiB.
        ("app", program.saturating_sub(64).to_string()),
    ];
    if !device.saves() {
        let storage = "/// The device saves nothing.\npub type Storage = NoStorage;\n";
        gaps.extend([
            ("memory", "NoStorage".into()),
            ("storage", storage.into()),
            ("new_storage", "NoStorage".into()),
        ]);
        return gaps;
    }
    gaps.extend([
        ("memory", "Memory".into()),
        ("use_len", "\nuse {{crate}}::storage_len;\n".into()),
        (
            "storage",
            include_str!("template/generic/storage.rs.in").into(),
        ),
        (
            "new_storage",
            "Memory::new([0xFF; storage_len(0, 1)])".into(),
        ),
        (
            "storage_len",
            include_str!("template/workspace/storage_len.rs.in").into(),
        ),
    ]);
    let Some(saved) = &layout.saved else {
        return gaps;
    };
    let (from, to) = (saved.range.start / KIB, saved.range.end / KIB);
    let place = format!(
        "/// Place of the saved values, which the program leaves free.\n\
         pub const SAVED: core::ops::Range<u32> = {from} * 1024..{to} * 1024;\n"
    );
    let (adapters, flash) = match saved.joined {
        1 => ("{Log, Mirror, Steps}".into(), "Steps(flash)".into()),
        joined => (
            "{Joined, Log, Mirror, Steps}".into(),
            format!("Joined::<_, {joined}>(Steps(flash))"),
        ),
    };
    let sectors = "/* Sector 0 has the vector table; saved values are in sectors 1 to 3, the program follows. */\n\
                   _stext = 0x08010000;\n";
    gaps.extend([
        ("saved", place),
        ("adapters", adapters),
        ("flash", flash),
        (
            "kept",
            format!(", the last {} KiB for saved values", to - from),
        ),
        ("sectors", sectors.into()),
        (
            "partition",
            format!("saved,    data, 0x40,    {from}K,    {}K", to - from),
        ),
    ]);
    gaps
}

/// Paths and contents.
///
/// # Errors
/// A sentence, if the device does not fit the board.
pub(super) fn files(
    name: &str,
    device: &DeviceFile,
    origin: &Origin,
    board: Board,
) -> Result<Vec<(String, Vec<u8>)>, String> {
    let (layout, bit_rate) = board.fits(device).map_err(|why| {
        let others = Board::others(device);
        if others.is_empty() {
            format!("{why}; remove objects from a copy of the file, or write a firmware for a larger board")
        } else {
            format!("{why}; use {others}")
        }
    })?;
    let mut gaps = device.gaps(name, bit_rate);
    let storage = storage_gaps(&layout, device);
    let storage = storage
        .into_iter()
        .map(|(name, content)| (name, text(&content, &gaps)));
    let storage: Vec<Gap> = storage.collect();
    gaps.extend(storage);
    let main = match board {
        Board::Generic => include_str!("template/generic/main.rs.in"),
        _ if device.saves() => include_str!("template/workspace/embassy_saves.rs.in"),
        _ => include_str!("template/workspace/embassy.rs.in"),
    };
    let encoder = device.encoder();
    let (behaviour, sim, modules, application) = match encoder {
        Some(_) => (
            include_str!("template/workspace/device_encoder.rs.in"),
            include_str!("template/workspace/sim_encoder.rs.in"),
            "mod sensor;\n",
            "{{crate}}::behaviour(sensor::shaft())",
        ),
        None => (
            include_str!("template/workspace/device_plain.rs.in"),
            include_str!("template/workspace/sim_plain.rs.in"),
            "",
            "{{crate}}::Behaviour::default()",
        ),
    };
    let parts = board.parts();
    let has_thumb = parts.target.starts_with("thumbv7");
    let mut dependencies = vec![("od-sim", ", features = [\"serve\"]")];
    dependencies.extend(has_thumb.then_some(("od-thumb", "")));
    dependencies.push(("odkit", ""));
    let dependencies = dependencies.iter();
    let dependencies = dependencies.map(|(name, features)| origin.dependency(name, features));
    let dependencies: Vec<String> = dependencies.collect();
    gaps.extend([
        ("behaviour", text(behaviour.trim_end(), &gaps)),
        ("sim", text(sim.trim_end(), &gaps)),
        ("application", text(application, &gaps)),
        ("host", text("{{crate}}_sim", &gaps)),
        ("scripts", String::from("scripts")),
        ("dependencies", dependencies.join("\n")),
        ("exclude", origin.exclude().to_owned()),
        ("vendor", origin.about()),
    ]);
    let uses = match encoder {
        None => "",
        Some(Total::Steps) => "use odkit::encoder::{Encoder, EncoderProfile, Motion, Total};\n",
        Some(_) => "use odkit::encoder::{Encoder, EncoderProfile, Motion};\n",
    };
    gaps.extend(
        [
            ("uses", uses),
            ("modules", modules),
            ("board", parts.title),
            ("target", parts.target),
            ("runner", parts.runner),
            ("link", parts.link),
            ("crates", parts.dependencies.trim_end()),
            (
                "thumb",
                if has_thumb {
                    "use od_thumb as _;\n"
                } else {
                    ""
                },
            ),
            // The drivers of the others panic.
            (
                "default",
                if board == Board::Generic {
                    "\"no-panic\""
                } else {
                    ""
                },
            ),
        ]
        .map(|(name, text)| (name, text.to_owned())),
    );
    gaps.push(("about", text(parts.about.trim_end(), &gaps)));
    let (linker, entry, features, rust_version) = match board {
        // esp-hal needs a newer compiler than odkit.
        Board::Esp32C3 => (&ESP32_C3, "esp_hal", "", "rust-version = \"1.95\""),
        _ => (
            &CORTEX_M,
            "embassy_executor",
            include_str!("template/workspace/features.toml.in"),
            "rust-version.workspace = true",
        ),
    };
    gaps.extend([
        ("entry", entry.to_owned()),
        ("features", text(features, &gaps)),
        ("firmware_rust_version", rust_version.to_owned()),
    ]);
    let own = [
        (
            "firmware/Cargo.toml",
            include_str!("template/workspace/firmware.toml.in"),
        ),
        (
            "firmware/.cargo/config.toml",
            include_str!("template/workspace/config.toml.in"),
        ),
        ("firmware/src/main.rs", main),
        ("firmware/src/board.rs", parts.board),
    ];
    let mut files = fill(&FILES, &gaps);
    files.extend(fill(&own, &gaps));
    files.extend(fill(linker, &gaps));
    if let Some(memory) = parts.memory {
        files.extend(fill(&[("firmware/memory.x", memory)], &gaps));
    }
    if encoder.is_some() {
        let sensor = include_str!("template/workspace/sensor.rs.in");
        files.extend(fill(&[("firmware/src/sensor.rs", sensor)], &gaps));
    }
    let eds = format!("device/{name}.{}", device.ending);
    files.push((eds, device.bytes.clone()));
    files.extend(origin.files());
    Ok(files)
}

/// Checks how a device fits each board: saved values are whole pages beside the program, and a set fits into a page
/// of the log. Returns why boards are refused.
#[cfg(test)]
pub(super) fn check(device: &DeviceFile) -> Vec<String> {
    let set = Need::of(device).set();
    let mut refused = Vec::new();
    for board in Board::value_variants() {
        let memory = board.memory();
        let layout = match board.fits(device) {
            Ok((layout, _)) => layout,
            Err(why) => {
                refused.push(why);
                continue;
            }
        };
        assert!(layout.program <= memory.flash);
        let page = match memory.saved {
            Place::End { page } | Place::Sectors { page, .. } => page,
            Place::Ram => {
                assert_eq!(layout.saved, None);
                continue;
            }
        };
        assert_eq!(layout.saved.is_some(), device.saves());
        let Some(saved) = layout.saved else { continue };
        assert!(saved.range.end <= memory.flash && saved.range.len() >= 3 * saved.joined * page);
        assert_eq!((saved.range.start % page, saved.range.end % page), (0, 0));
        if let Place::End { .. } = memory.saved {
            assert_eq!(saved.range.start, layout.program);
        }
        assert!(set + 128 <= saved.joined * page && set + 128 > (saved.joined - 1) * page);
    }
    refused
}
