//! The workspace for a board: device, firmware, simulation and tests.

use od_runtime::encoder::Total;

use super::device::DeviceFile;
use super::origin::Origin;
use super::template::{Template, fill, text};

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
    /// Any board with a driver for embedded-can; the generated program runs in QEMU
    #[value(name = "generic")]
    Generic,
}

/// The files that do not depend on the board.
const FILES: [Template; 13] = [
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
    (
        "firmware/build.rs",
        include_str!("template/workspace/build.rs.in"),
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
    /// Linker scripts in addition to that of `cortex-m-rt`.
    link: &'static str,
    dependencies: &'static str,
    main: &'static str,
    board: &'static str,
    memory: &'static str,
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
            _ => {
                "cargo run     # simulates it, with an slcan port; `cargo run -- --help` lists the other links\n  \
                 cd firmware && cargo run --release    # flashes the board with probe-rs and runs it"
            }
        }
    }

    const fn parts(self) -> Parts {
        const EMBASSY: &str = include_str!("template/workspace/embassy.rs.in");
        match self {
            Self::Stm32G0 => Parts {
                title: "an STM32G0B1",
                target: "thumbv6m-none-eabi",
                runner: "probe-rs run --chip STM32G0B1RETx",
                link: "",
                dependencies: include_str!("template/stm32g0/dependencies.toml.in"),
                main: EMBASSY,
                board: include_str!("template/stm32g0/board.rs.in"),
                memory: include_str!("template/stm32g0/memory.x"),
                about: "An STM32G0B1RE with a crystal of 8 MHz; FDCAN1 in classic mode, RX on PB8, TX on PB9.",
            },
            Self::Stm32F4 => Parts {
                title: "an STM32F405",
                target: "thumbv7em-none-eabi",
                runner: "probe-rs run --chip STM32F405RGTx",
                link: "",
                dependencies: include_str!("template/stm32f4/dependencies.toml.in"),
                main: EMBASSY,
                board: include_str!("template/stm32f4/board.rs.in"),
                memory: include_str!("template/stm32f4/memory.x"),
                about: "An STM32F405RG with a crystal of 8 MHz; CAN1, RX on PB8, TX on PB9.",
            },
            Self::Rp2040 => Parts {
                title: "an RP2040 with an MCP2515",
                target: "thumbv6m-none-eabi",
                runner: "probe-rs run --chip RP2040",
                link: "    println!(\"cargo::rustc-link-arg-bins=-Tlink-rp.x\");\n",
                dependencies: include_str!("template/rp2040/dependencies.toml.in"),
                main: EMBASSY,
                board: include_str!("template/rp2040/board.rs.in"),
                memory: include_str!("template/rp2040/memory.x"),
                about: "An RP2040 with 2 MB of flash, and an MCP2515 with a crystal of 16 MHz: MISO on GP4, CS on GP5, \
                        SCK on GP6, MOSI on GP7, INT on GP21.",
            },
            Self::Generic => Parts {
                title: "any board",
                target: "thumbv7m-none-eabi",
                runner: "qemu-system-arm -M lm3s6965evb -nographic -monitor none -serial stdio -kernel",
                link: "",
                dependencies: include_str!("template/generic/dependencies.toml.in"),
                main: include_str!("template/generic/main.rs.in"),
                board: include_str!("template/generic/board.rs.in"),
                memory: include_str!("template/generic/memory.x"),
                about: include_str!("template/generic/about.md.in"),
            },
        }
    }
}

/// Paths and contents.
pub(super) fn files(
    name: &str,
    device: &DeviceFile,
    origin: &Origin,
    board: Board,
) -> Vec<(String, Vec<u8>)> {
    let mut gaps = device.gaps(name);
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
    let dependencies = [("od-bench", ", features = [\"serve\"]"), ("odkit", "")];
    let dependencies = dependencies.map(|(name, features)| origin.dependency(name, features));
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
        ]
        .map(|(name, text)| (name, text.to_owned())),
    );
    gaps.push(("about", text(parts.about.trim_end(), &gaps)));
    let own = [
        (
            "firmware/Cargo.toml",
            include_str!("template/workspace/firmware.toml.in"),
        ),
        (
            "firmware/.cargo/config.toml",
            include_str!("template/workspace/config.toml.in"),
        ),
        ("firmware/memory.x", parts.memory),
        ("firmware/src/main.rs", parts.main),
        ("firmware/src/board.rs", parts.board),
    ];
    let mut files = fill(&FILES, &gaps);
    files.extend(fill(&own, &gaps));
    if encoder.is_some() {
        let sensor = include_str!("template/workspace/sensor.rs.in");
        files.extend(fill(&[("firmware/src/sensor.rs", sensor)], &gaps));
    }
    let eds = format!("device/{name}.{}", device.ending);
    files.push((eds, device.bytes.clone()));
    files.extend(origin.files());
    files
}
