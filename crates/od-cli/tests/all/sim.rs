//! `odkit sim` as a process: its greeting, its devices, its console, its refusals.

use crate::support::sim::{Sim, say};
use crate::support::{file, fresh, odkit, repository};

#[test]
fn it_prints_how_to_connect_and_responds() {
    let sim = Sim::start(&["gxmm", "--node-id", "5", "--position", "0x79592"]);
    for line in [
        "node 5",
        "python-canopen",
        "network.connect(",
        "cansend can0 605#40",
    ] {
        assert!(sim.greeting.contains(line), "{line}\n{}", sim.greeting);
    }
    let mut client = sim.client();
    say(&mut client, "C\rS6\r\rO\rO\r", "\r\r\r\r\r");
    say(
        &mut client,
        "t60584004600000000000\r",
        "z\rt58584304600092950700\r",
    );
    say(&mut client, "t6058\r", "\x07");
}

#[test]
fn every_eds_file_is_a_device() {
    let sim = Sim::start(&[&repository("tests/interop/strings.eds")]);
    assert!(
        sim.greeting.contains("Transfers, node 7"),
        "{}",
        sim.greeting
    );
    let mut client = sim.client();
    say(
        &mut client,
        "O\rt60784000100000000000\r",
        "\rz\rt58784300100000000000\r",
    );
}

/// 1,025 bytes for 2002h, a DOMAIN, by block download: two blocks and the end.
fn long_download() -> String {
    let value = [7; 1025];
    let mut frames = String::from("607#C602200001040000\n");
    for (at, bytes) in value.chunks(7).enumerate() {
        let last = if at == 146 { 0x80 } else { 0 };
        let mut data = bytes.to_vec();
        data.resize(7, 0);
        let hex: String = data.iter().map(|byte| format!("{byte:02X}")).collect();
        frames += &format!("607#{:02X}{hex}\n", last | (at % 127 + 1));
    }
    let crc = od_wire::sdo::crc16(&value).to_le_bytes();
    let head = 0xC1 | od_wire::sdo::unused(value.len()) << 2;
    frames + &format!("607#{head:02X}{:02X}{:02X}0000000000\n", crc[0], crc[1])
}

#[test]
fn the_option_sets_the_size_of_a_domain() {
    let eds = repository("tests/interop/strings.eds");
    let read = "607#4002200000000000\n";
    let input = format!("{}{read}", long_download());
    for args in [&[&eds[..]][..], &[&eds, "--domain-size", "1025"]] {
        let sim = console(args, &input);
        for frame in [
            "587#A40220007F000000",
            "587#A27F7F0000000000",
            "587#A1000000",
            "587#4102200001040000",
        ] {
            assert!(sim.out.contains(frame), "{frame}\n{}", sim.out);
        }
    }
    // The option applies to strings, too. A transfer that announces too many bytes is aborted at
    // once.
    let text = "607#2101200001040000\n";
    assert!(console(&[&eds], text).out.contains("587#6001200000000000"));
    let sim = console(&[&eds, "--domain-size", "1KiB"], &format!("{input}{text}"));
    for frame in ["587#8002200012000706", "587#8001200012000706"] {
        assert!(sim.out.contains(frame), "{frame}\n{}", sim.out);
    }
    let wrong = odkit(&["sim", "gxmm", "--domain-size", "1GB"], "");
    assert_eq!(wrong.code, 2);
    assert!(wrong.err.contains("64KiB or 1MiB"), "{}", wrong.err);
}

#[test]
fn several_devices_share_the_bus() {
    let sim = Sim::start(&["gxmm@5,gcam", "--device", "gxam@7"]);
    for line in [
        "3 devices",
        "node 5 ",
        "node 6 ",
        "node 7 ",
        "cansend can0 605#40",
    ] {
        assert!(sim.greeting.contains(line), "{line}\n{}", sim.greeting);
    }
    let mut client = sim.client();
    say(&mut client, "O\rt0002010", "\r");
    say(
        &mut client,
        "5\rt60584000100000000000\rt60684000100000000000\rt60784000100000000000\r",
        "z\rz\rt58584300100096010200\rz\rt58684300100096010100\rz\rt58784300100096010100\r",
    );
    for (args, why) in [
        (
            &["gxmm@128"][..],
            "`gxmm@128`: write a node ID from 1 to 127",
        ),
        (&["gxmm@5", "--node-id", "6"], "write one of them"),
    ] {
        let wrong = odkit(&[&["sim"], args].concat(), "");
        assert_eq!(wrong.code, 2);
        assert!(wrong.err.contains(why), "{}", wrong.err);
    }
}

#[test]
fn a_redundant_encoder_is_two_nodes_on_one_shaft() {
    let sim = console(
        &["eam_red", "gxmm", "--position", "0x2000"],
        "601#4004600000000000\n602#4004600000000000\nshaft turn 1\n602#4004600000000000\n\
         602#4018100400000000\n603#4004600000000000",
    );
    for frame in [
        "581#4304600000080000",
        "582#4304600000080000",
        "582#4304600000480000",
        "582#4318100402000000",
        "583#4304600000200000",
    ] {
        assert!(sim.out.contains(frame), "{frame}\n{}", sim.out);
    }
    let sim = console(&["eam_red", "--node-id", "7", "--node-id", "9"], "");
    assert!(
        sim.err.contains("node 7 ") && sim.err.contains("node 9 "),
        "{}",
        sim.err
    );
}

/// Runs `odkit sim … --link -` with these lines.
fn console(args: &[&str], lines: &str) -> crate::support::Done {
    odkit(&[&["sim"], args, &["--link", "-"]].concat(), lines)
}

#[test]
fn standard_input_takes_frames_and_actions() {
    let lines = "601#4000100000000000\nnmt stop\npower cycle 20ms\n# a remark\nuse 2\n\
                 602#4000100000000000\nexpect 701#00\nhello\nnmt reset 2";
    let sim = console(&["gxmm", "gxmm"], lines);
    assert_eq!(sim.code, 0, "{}", sim.err);
    let frames: Vec<&str> = sim
        .out
        .lines()
        .filter_map(|line| line.split(' ').nth(2))
        .collect();
    assert_eq!(
        frames,
        [
            "701#00",
            "702#00",
            "581#4300100096010200",
            "701#00",
            "582#4300100096010200",
            "702#00"
        ],
        "{}",
        sim.out
    );
    assert!(sim.out.starts_with("(0.0"), "{}", sim.out);
    for said in [
        "line 7:1: this line works only in a script",
        "line 8:1: `hello` is not a verb or a frame",
    ] {
        assert!(sim.err.contains(said), "{said}: {}", sim.err);
    }
    assert!(!sim.err.contains("have node ID"), "{}", sim.err);
    assert!(
        sim.err.contains("2 devices; standard input and output"),
        "{}",
        sim.err
    );
}

#[test]
fn the_seed_sets_the_start_of_the_shafts() {
    let position = |seed: &str| {
        let sim = console(&["gxmm", "--seed", seed], "601#4004600000000000\n");
        let answer = sim
            .out
            .split_whitespace()
            .find(|word| word.starts_with("581#"));
        answer.unwrap_or_default().to_owned()
    };
    assert!(
        position("1").starts_with("581#43046000"),
        "{}",
        position("1")
    );
    assert_eq!(position("1"), position("1"));
    assert_ne!(position("1"), position("2"));
}

/// MANUALS.md U-43.
#[test]
fn an_eds_with_lss_starts_without_a_node_id() {
    let eds = repository("devices/eds/GXMM.eds");
    let lines = "601#4000100000000000\n7E5#4C00000000000000\n7E5#0401000000000000\n\
                 7E5#5D00000000000000\n7E5#1105000000000000\n7E5#0400000000000000\n\
                 605#4018100400000000";
    let sim = console(&[&eds, "--node-id", "none", "--serial", "0x1268"], lines);
    assert_eq!(sim.code, 0, "{}", sim.err);
    let frames: Vec<&str> = sim
        .out
        .lines()
        .filter_map(|line| line.split(' ').nth(2))
        .collect();
    assert_eq!(
        frames,
        [
            "7E4#5000000000000000",
            "7E4#5D68120000000000",
            "7E4#1100000000000000",
            "705#00",
            "585#4318100468120000"
        ],
        "{}",
        sim.out
    );
    for said in [
        "no node ID; standard input",
        "services: ",
        "LSS slave (CiA 305)",
    ] {
        assert!(sim.err.contains(said), "{said}: {}", sim.err);
    }
}

#[test]
fn nodes_of_one_type_have_serial_numbers_of_their_own() {
    let read = "601#4018100400000000\n602#4018100400000000\n603#4018100400000000";
    for (args, serials) in [
        (&["gxmm", "gxmm", "gxam"][..], ["01", "02", "01"]),
        (
            &["gxmm", "gxmm", "gxmm", "--serial", "7"],
            ["07", "01", "08"],
        ),
    ] {
        let sim = console(args, read);
        for (node, serial) in (1..).zip(serials) {
            let answer = format!("58{node}#43181004{serial}000000");
            assert!(sim.out.contains(&answer), "{answer}: {}", sim.out);
        }
    }
}

#[test]
fn two_devices_with_one_node_id_get_a_warning() {
    let args = [
        "gxmm",
        "gxmm",
        "gxmm",
        "--node-id",
        "5",
        "--node-id",
        "6",
        "--node-id",
        "5",
    ];
    let sim = console(&args, "");
    assert_eq!(sim.code, 0, "{}", sim.err);
    let warning = "warning: 2 devices have node ID 5, and their frames collide";
    assert!(sim.err.contains(warning), "{}", sim.err);
    assert!(!sim.err.contains("have node ID 6"), "{}", sim.err);
}

/// Opening a FIFO blocks until another program opens its other end.
#[cfg(unix)]
#[test]
fn a_fifo_is_not_an_eeprom() {
    let path = fresh("eeprom.fifo");
    let made = std::process::Command::new("mkfifo").arg(&path).status();
    assert!(made.expect("mkfifo").success());
    let sim = odkit(
        &["sim", "gxmm", "--eeprom", &path.display().to_string()],
        "",
    );
    assert_eq!(sim.code, 2);
    assert!(sim.err.contains("names a device or FIFO"), "{}", sim.err);
}

#[test]
fn wrong_usage_is_reported_in_one_line() {
    for (args, code, why) in [
        (&["sim", "gxmx"][..], 1, "no built-in device or file"),
        (
            &["sim", "gxmm", "--slcan", "nowhere"],
            2,
            "is not a valid address",
        ),
        (
            &["sim", "gxmm", "--link", "slcan:127.0.0.1:99999"],
            2,
            "'--link <LINK>': port 99999 of `127.0.0.1:99999` is outside the range",
        ),
        (
            &["sim", "gxmm", "--position", "north"],
            2,
            "a number of steps",
        ),
        (&["sim", "gxmm", "--rpm", "fast"], 2, "--rpm"),
        (&["sim"], 2, "DEVICE|FILE"),
        (
            &["sim", "gxmm", "--link", "udp:1"],
            2,
            "is not a valid link; write slcan:",
        ),
        (
            &["sim", "gxmm", "--link", "-", "--link", "-"],
            2,
            "can be given only once",
        ),
        (
            &["sim", "gxmm", "--link", "slcan:/dev/nothing"],
            1,
            "serial port /dev/nothing does not exist",
        ),
        (
            &["sim", "gxmm", "--link", "socketcan:vcan77"],
            1,
            "SocketCAN",
        ),
        (
            &["sim", "gxmm", "--node-id", "1", "--node-id", "2"],
            2,
            "`--node-id` is given 2 times for 1 device",
        ),
        (
            &["sim", "gxmm", "--node-id", "none"],
            2,
            "only if its EDS says `LSS_Supported=1`",
        ),
        (
            &["sim", "gxmm", "--rpm", "inf"],
            2,
            "a number of revolutions per minute",
        ),
        (
            &["sim", "drive,io", "--rpm", "60"],
            2,
            "no device has a shaft of its own for `--rpm`",
        ),
    ] {
        let sim = odkit(args, "");
        assert_eq!(sim.code, code, "{args:?}: {}", sim.err);
        assert!(sim.err.contains(why), "{args:?}: {}", sim.err);
    }
    let folder = env!("CARGO_TARGET_TMPDIR");
    let sim = odkit(&["sim", "gxmm", "--eeprom", folder], "");
    assert_eq!(sim.code, 2);
    assert!(sim.err.contains("names a directory"), "{}", sim.err);
    let foreign = file("letter.txt", "Dear somebody").display().to_string();
    let sim = odkit(&["sim", "gxmm", "--eeprom", &foreign], "");
    assert_eq!(sim.code, 1);
    assert!(sim.err.contains("not an EEPROM file"), "{}", sim.err);
}

#[test]
fn a_restore_keeps_the_node_id_of_the_command_line() {
    // The rotary switches take precedence over saved values (manual 000, 7.2.1; manual 003, 5.1.10); the EAM has
    // none. A save and a start take their time (MANUALS.md U-39).
    for (device, saved, time) in [
        ("gxmm", 5, "1ms"),
        ("eam_mt", 9, "250ms"),
        ("en580c", 5, "550ms"),
    ] {
        let lines = format!(
            "605#2F01210009000000\n605#2310100173617665\nwait {time}\n000#8105\nwait {time}\n\
             605#231110016C6F6164\n609#231110016C6F6164\n000#8100\nwait {time}\n"
        );
        let sim = console(&[device, "--node-id", "5"], &lines);
        let boot_ups: Vec<&str> = (sim.out.lines())
            .filter_map(|line| line.split(' ').nth(2))
            .filter(|frame| frame.starts_with('7'))
            .collect();
        let expected = [&*format!("70{saved}#00"), "705#00"];
        assert!(boot_ups.ends_with(&expected), "{device}: {}", sim.out);
    }
}
