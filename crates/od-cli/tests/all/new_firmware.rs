//! The output of `odkit new --firmware`. `cargo xtask test --only boards` builds it.

use std::fs;
use std::path::PathBuf;

use crate::support::{file, fresh, odkit, read, repository};

/// Boards, and texts that the files of each contain.
const BOARDS: [(&str, &str, &str); 5] = [
    ("stm32g0", "embassy-stm32", "thumbv6m-none-eabi"),
    ("stm32f4", "embassy-stm32", "thumbv7em-none-eabi"),
    ("rp2040+mcp2515", "mcp25xx", "thumbv6m-none-eabi"),
    ("esp32c3", "esp-hal", "riscv32imc-unknown-none-elf"),
    ("generic", "embedded-can", "thumbv7m-none-eabi"),
];

/// Creates a workspace with the name of its folder.
fn make(eds: &str, board: &str, name: &str) -> PathBuf {
    let folder = fresh(name);
    let path = folder.display().to_string();
    let arguments = ["new", eds, "--firmware", board, "--path", &path];
    let made = odkit(&[&arguments[..], &["--name", name]].concat(), "");
    assert_eq!(made.code, 0, "{}", made.err);
    assert!(made.out.contains("cd firmware"), "{}", made.out);
    folder
}

#[test]
fn a_workspace_has_device_firmware_simulation_and_tests() {
    let eds = repository("devices/eds/GXMM.eds");
    for (number, (board, crate_name, target)) in BOARDS.into_iter().enumerate() {
        let folder = make(&eds, board, &format!("board-{number}"));
        let manifest = read(&folder, "Cargo.toml");
        for line in [
            "members = [\"device\", \"firmware\", \"sim\", \"tests\"]",
            "default-members = [\"device\", \"sim\", \"tests\"]",
            "odkit = { path = 'vendor/odkit' }",
            "exclude = [\"vendor\"]",
        ] {
            assert!(manifest.contains(line), "{line}\n{manifest}");
        }
        let firmware = read(&folder, "firmware/Cargo.toml");
        assert!(firmware.contains(crate_name), "{firmware}");
        let config = read(&folder, "firmware/.cargo/config.toml");
        assert!(config.contains(target), "{config}");
        assert!(read(&folder, "README.md").contains(target));
        let device = read(&folder, "device/src/lib.rs");
        assert!(device.contains("#![no_std]") && device.contains("behaves = PROFILE;"));
        assert_eq!(
            read(&folder, &format!("device/board-{number}.eds")),
            fs::read_to_string(&eds).expect("the file")
        );
        // Both have the same device.
        assert!(
            read(&folder, "firmware/src/main.rs").contains("Node::new(dictionary::Device, NODE_ID")
        );
        assert!(read(&folder, "sim/src/lib.rs").contains("dictionary::Device,"));
        let script = read(&folder, "tests/scripts/boot-up.script");
        assert!(script.contains("expect 701#00"), "{script}");
        for name in ["device", "firmware", "sim", "tests"] {
            let text = read(&folder, &format!("{name}/Cargo.toml"));
            assert!(!text.contains("{{"), "{text}");
        }
    }
}

#[test]
fn the_device_has_the_services_of_its_file() {
    let text = "[DeviceInfo]\nProductName=Gate\nLSS_Supported=1\nBaudRate_125=1\nBaudRate_250=1\n\
                [1000]\nParameterName=Device type\nDataType=7\nAccessType=ro\nDefaultValue=0\n\
                [1001]\nParameterName=Error register\nDataType=5\nAccessType=ro\n\
                [1018]\nParameterName=Identity\nObjectType=9\nSubNumber=2\n\
                [1018sub0]\nParameterName=Highest\nDataType=5\nAccessType=ro\nDefaultValue=1\n\
                [1018sub1]\nParameterName=Vendor-ID\nDataType=7\nAccessType=ro\nDefaultValue=0x5F\n";
    let eds = file("new-lss.eds", text).display().to_string();
    let folder = make(&eds, "generic", "board-lss");
    let device = read(&folder, "device/src/lib.rs");
    for line in [
        "        without rpdos, guarding, consumer;\n",
        "BIT_RATE: u32 = 250;",
        "None, None, None, Some(3), None,",
    ] {
        assert!(device.contains(line), "{line}\n{device}");
    }
    // The same file without LSS saves nothing.
    let without = text.replace("LSS_Supported=1", "LSS_Supported=0");
    let eds = file("new-no-lss.eds", &without).display().to_string();
    let folder = make(&eds, "generic", "board-no-lss");
    let device = read(&folder, "device/src/lib.rs");
    let line = "        without lss, rpdos, guarding, consumer, storage;\n";
    assert!(device.contains(line), "{device}");
}

#[test]
fn a_workspace_that_cannot_be_made_leaves_no_file() {
    let eds = repository("devices/eds/GXMM.eds");
    let folder = fresh("board-not");
    let path = folder.display().to_string();
    let unknown = odkit(&["new", &eds, "--firmware", "avr", "--path", &path], "");
    assert_eq!(unknown.code, 2);
    for (board, ..) in BOARDS {
        assert!(unknown.err.contains(board), "{}", unknown.err);
    }
    let name = ["--name", "core", "--path", &path];
    let reserved = odkit(
        &[&["new", &eds, "--firmware", "generic"], &name[..]].concat(),
        "",
    );
    assert_eq!(reserved.code, 2, "{}", reserved.err);
    // One lacks an object, the other has all.
    let register = "[1001]\nParameterName=Error register\nDataType=5\nAccessType=ro\n";
    for (name, objects, said) in [("lacks", register, "--lossy"), ("empty", "", "E0210")] {
        let text = format!("{objects}[2001]\nParameterName=Nothing\nAccessType=rw\n");
        let eds = file(&format!("board-{name}.eds"), &text)
            .display()
            .to_string();
        let run = odkit(&["new", &eds, "--firmware", "generic", "--path", &path], "");
        assert_eq!(run.code, 1, "{}", run.err);
        assert!(run.err.contains(said), "{}", run.err);
    }
    assert!(!folder.exists());
}

/// A device with `count` values of the manufacturer that a master writes, and 1010h if it saves them.
fn device_with(count: u16, saves: bool, rate: u16) -> String {
    let mut text = format!(
        "[DeviceInfo]\nProductName=Store\nBaudRate_{rate}=1\n\
         [1000]\nParameterName=Device type\nDataType=7\nAccessType=ro\nDefaultValue=0\n\
         [1001]\nParameterName=Error register\nDataType=5\nAccessType=ro\n\
         [1018]\nParameterName=Identity\nObjectType=9\nSubNumber=2\n\
         [1018sub0]\nParameterName=Highest\nDataType=5\nAccessType=ro\nDefaultValue=1\n\
         [1018sub1]\nParameterName=Vendor-ID\nDataType=7\nAccessType=ro\nDefaultValue=0x5F\n"
    );
    if saves {
        text += "[1010]\nParameterName=Store\nObjectType=8\nSubNumber=2\n\
                 [1010sub0]\nParameterName=Highest\nDataType=5\nAccessType=ro\nDefaultValue=1\n\
                 [1010sub1]\nParameterName=All\nDataType=7\nAccessType=rw\nDefaultValue=1\n";
    }
    for index in 0x2000..0x2000 + count {
        text += &format!("[{index:X}]\nParameterName=Value {index:X}\nDataType=7\nAccessType=rw\n");
    }
    text
}

#[test]
fn a_device_that_saves_nothing_needs_no_flash() {
    let eds = file("new-saves-nothing.eds", &device_with(9, false, 500))
        .display()
        .to_string();
    for board in ["stm32g0", "generic"] {
        let folder = make(&eds, board, &format!("saves-nothing-{board}"));
        let files =
            ["main.rs", "board.rs"].map(|name| read(&folder, &format!("firmware/src/{name}")));
        let all = files.concat();
        assert!(
            all.contains("NoStorage") && !all.contains("storage_len") && !all.contains("SAVED"),
            "{all}"
        );
    }
    let folder = make(&eds, "stm32g0", "saves-nothing");
    assert!(read(&folder, "firmware/memory.x").contains("LENGTH = 512K"));
}

#[test]
fn a_set_that_is_longer_than_a_page_gets_pages_that_are_joined() {
    let eds = file("new-saves-much.eds", &device_with(300, true, 500))
        .display()
        .to_string();
    for (board, joined, range, memory, program) in [
        (
            "stm32g0",
            2,
            "500 * 1024..512 * 1024",
            "memory.x",
            "LENGTH = 500K",
        ),
        (
            "rp2040+mcp2515",
            1,
            "2032 * 1024..2048 * 1024",
            "memory.x",
            "LENGTH = 2032K - 0x100",
        ),
        (
            "stm32f4",
            1,
            "16 * 1024..64 * 1024",
            "memory.x",
            "_stext = 0x08010000",
        ),
        (
            "esp32c3",
            1,
            "4080 * 1024..4096 * 1024",
            "partitions.csv",
            "0x10000,  4016K\nsaved,    data, 0x40,    4080K,    16K",
        ),
    ] {
        let folder = make(&eds, board, "saves-much");
        let main = read(&folder, "firmware/src/main.rs");
        assert_eq!(
            main.contains("Joined::<_, 2>(Steps(flash))"),
            joined == 2,
            "{main}"
        );
        let code = read(&folder, "firmware/src/board.rs");
        assert!(code.contains(range), "{code}");
        let memory = read(&folder, &format!("firmware/{memory}"));
        assert!(memory.contains(program), "{memory}");
    }
}

#[test]
fn a_device_that_does_not_fit_is_refused_with_numbers_and_a_board_that_has_room() {
    let large = device_with(2500, true, 500);
    let fast = device_with(9, true, 800);
    let cases = [
        (
            "large",
            "stm32f4",
            &large,
            ["131072", "`--firmware rp2040+mcp2515`"],
        ),
        (
            "fast",
            "rp2040+mcp2515",
            &fast,
            [
                "800 kbit/s",
                "`--firmware stm32g0` or `--firmware esp32c3` or `--firmware generic`",
            ],
        ),
    ];
    for (name, board, text, told) in cases {
        let eds = file(&format!("new-{name}.eds"), text).display().to_string();
        let folder = fresh(&format!("new-{name}"));
        let path = folder.display().to_string();
        let run = odkit(&["new", &eds, "--firmware", board, "--path", &path], "");
        assert_eq!(run.code, 1, "{}", run.err);
        for told in told {
            assert!(run.err.contains(told), "{told}\n{}", run.err);
        }
        assert!(!folder.exists());
    }
}
