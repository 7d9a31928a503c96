//! `odkit sim` as a process: its greeting, a client, and how it ends.

mod support;

use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::process::{Child, Stdio};
use std::time::Duration;

use support::{command, file, odkit, repository};

struct Sim {
    child: Child,
    greeting: String,
    port: u16,
}

impl Sim {
    fn start(args: &[&str]) -> Self {
        let mut child = command()
            .arg("sim")
            .args(args)
            .args(["--slcan", "127.0.0.1:0"])
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .expect("odkit starts");
        let mut lines = BufReader::new(child.stdout.take().expect("a pipe"));
        let mut greeting = String::new();
        while !greeting.contains("Ctrl-C") {
            assert_ne!(
                lines.read_line(&mut greeting).expect("a greeting"),
                0,
                "{greeting}"
            );
        }
        let after = greeting.split("127.0.0.1:").nth(1).expect("an address");
        let digits: String = after.chars().take_while(char::is_ascii_digit).collect();
        let port = digits.parse().expect("a port");
        Self {
            child,
            greeting,
            port,
        }
    }

    fn client(&self) -> TcpStream {
        let client = TcpStream::connect(("127.0.0.1", self.port)).expect("it listens");
        client
            .set_read_timeout(Some(Duration::from_secs(10)))
            .expect("a time limit");
        client
    }
}

impl Drop for Sim {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

#[track_caller]
fn say(client: &mut TcpStream, sent: &str, expected: &str) {
    client.write_all(sent.as_bytes()).expect("it reads");
    let mut answer = vec![0; expected.len()];
    client.read_exact(&mut answer).expect("an answer");
    assert_eq!(String::from_utf8_lossy(&answer), expected, "{sent:?}");
}

#[test]
fn it_says_how_to_connect_and_answers() {
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

#[test]
fn several_devices_share_the_bus() {
    let sim = Sim::start(&["gxmm", "gcam", "--device", "gxam", "--node-id", "5"]);
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

/// Runs `odkit sim … --link -` on these lines.
fn console(args: &[&str], lines: &str) -> support::Done {
    odkit(&[&["sim"], args, &["--link", "-"]].concat(), lines)
}

#[test]
fn standard_input_takes_frames_and_the_world_outside() {
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
        "line 7:1: only a script can do that",
        "line 8:1: `hello` is not a verb or a frame",
    ] {
        assert!(sim.err.contains(said), "{said}: {}", sim.err);
    }
    assert!(
        sim.err.contains("2 devices; standard input and output"),
        "{}",
        sim.err
    );
}

#[test]
fn shafts_start_where_the_seed_says() {
    let position = |seed: &str| {
        let sim = console(&["gxmm", "--seed", seed], "601#4004600000000000\n");
        sim.out.split(' ').nth(2).unwrap_or_default().to_owned()
    };
    assert!(
        position("1").starts_with("581#43046000"),
        "{}",
        position("1")
    );
    assert_eq!(position("1"), position("1"));
    assert_ne!(position("1"), position("2"));
}

#[test]
fn socketcand_speaks_to_clients_that_compare_what_they_read() {
    let mut sim = Sim::start(&["gxmm", "--link", "socketcand:127.0.0.1:0"]);
    let after = sim
        .greeting
        .split("socketcand on 127.0.0.1:")
        .nth(1)
        .expect("an address");
    let digits: String = after.chars().take_while(char::is_ascii_digit).collect();
    let slcan = sim.port;
    sim.port = digits.parse().expect("a port");
    let mut client = sim.client();
    say(&mut client, "", "< hi >");
    say(&mut client, "< open can0 >", "< ok >");
    // What follows the answer comes in a message of its own.
    client
        .write_all(b"< rawmode >< send 601 8 40 0 10 0 0 0 0 0 >")
        .expect("it reads");
    let mut buffer = [0; 256];
    let len = client.read(&mut buffer).expect("an answer");
    assert_eq!(&buffer[..len], b"< ok >");
    let len = client.read(&mut buffer).expect("a frame");
    let text = String::from_utf8_lossy(&buffer[..len]).into_owned();
    assert!(
        text.starts_with("< frame 581 ") && text.ends_with(" 4300100096010200 >"),
        "{text}"
    );
    // Links share the bus.
    sim.port = slcan;
    let mut other = sim.client();
    say(&mut other, "O\rt12310A\r", "\rz\r");
    let len = client.read(&mut buffer).expect("a frame");
    assert!(buffer[..len].starts_with(b"< frame 123 "));
}

#[cfg(unix)]
#[test]
fn a_pseudo_terminal_is_an_adapter() {
    let sim = Sim::start(&["gxmm", "--link", "slcan:pty"]);
    let path = sim.greeting.split("slcan on /").nth(1).expect("a path");
    let path = format!("/{}", path.split([',', '\n', ' ']).next().expect("a path"));
    let open = || {
        std::fs::OpenOptions::new()
            .read(true)
            .write(true)
            .open(&path)
            .expect("it is there")
    };
    // A host comes, goes, and comes again.
    for _ in 0..2 {
        let mut host = open();
        host.write_all(b"C\rO\rt60184000100000000000\r")
            .expect("it reads");
        let mut answer = vec![0; b"\r\rz\rt58184300100096010200\r".len()];
        host.read_exact(&mut answer).expect("an answer");
        assert_eq!(
            String::from_utf8_lossy(&answer),
            "\r\rz\rt58184300100096010200\r"
        );
    }
}

#[test]
fn a_port_in_use_is_said_with_what_to_do() {
    let sim = Sim::start(&["gxmm"]);
    let address = format!("127.0.0.1:{}", sim.port);
    let second = odkit(&["sim", "gxmm", "--slcan", &address], "");
    assert_eq!(second.code, 1);
    assert!(
        second.err.contains(&format!("{address} is in use")),
        "{}",
        second.err
    );
    assert!(second.err.contains("--slcan 127.0.0.1:0"), "{}", second.err);
}

#[test]
fn what_cannot_be_is_said_in_one_line() {
    for (args, code, why) in [
        (&["sim", "gxmx"][..], 1, "is no built-in device"),
        (
            &["sim", "gxmm", "--slcan", "nowhere"],
            2,
            "is no address to listen on",
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
            "is no link; there are slcan:",
        ),
        (
            &["sim", "gxmm", "--link", "-", "--link", "-"],
            2,
            "one standard input",
        ),
        (
            &["sim", "gxmm", "--link", "slcan:/dev/nothing"],
            1,
            "no serial port /dev/nothing",
        ),
        (
            &["sim", "gxmm", "--link", "socketcan:vcan77"],
            1,
            "SocketCAN",
        ),
        (
            &["sim", "gxmm", "--node-id", "1", "--node-id", "2"],
            2,
            "--node-id stands there 2 times, and there is 1 device",
        ),
        (
            &["sim", "gxmm", "--rpm", "inf"],
            2,
            "no shaft that could stand or turn so",
        ),
    ] {
        let sim = odkit(args, "");
        assert_eq!(sim.code, code, "{args:?}: {}", sim.err);
        assert!(sim.err.contains(why), "{args:?}: {}", sim.err);
    }
    let foreign = file("letter.txt", "Dear somebody").display().to_string();
    let sim = odkit(&["sim", "gxmm", "--eeprom", &foreign], "");
    assert_eq!(sim.code, 1);
    assert!(sim.err.contains("not an EEPROM file"), "{}", sim.err);
}

#[cfg(unix)]
#[test]
fn ctrl_c_ends_it_cleanly() {
    let mut sim = Sim::start(&["gxmm"]);
    let pid = sim.child.id().to_string();
    let kill = std::process::Command::new("kill")
        .args(["-INT", &pid])
        .status();
    assert!(kill.expect("kill").success());
    assert_eq!(sim.child.wait().expect("it ends").code(), Some(0));
}

#[test]
fn a_flood_reaches_every_client_in_order() {
    const REQUEST: &str = "t60184000100000000000\r";
    const ANSWER: &str = "t58184300100096010200\r";
    let sim = Sim::start(&["gxmm"]);
    let mut listeners: Vec<_> = (0..20).map(|_| sim.client()).collect();
    for listener in &mut listeners {
        say(listener, "O\r", "\r");
    }
    let mut talker = sim.client();
    say(&mut talker, "O\r", "\r");
    // Each acknowledgement stands before the answer that its frame brings about.
    let sent = format!("{REQUEST}V\r").repeat(1000);
    say(
        &mut talker,
        &sent,
        &format!("z\r{ANSWER}V1013\r").repeat(1000),
    );
    for listener in &mut listeners {
        say(listener, "", &format!("{REQUEST}{ANSWER}").repeat(1000));
    }
}

#[test]
fn who_has_said_all_still_gets_the_answers() {
    let sim = Sim::start(&["gxmm"]);
    let mut client = sim.client();
    client
        .write_all(b"O\rt60184000100000000000\r")
        .expect("it reads");
    client
        .shutdown(std::net::Shutdown::Write)
        .expect("half of it ends");
    let mut answer = String::new();
    client.read_to_string(&mut answer).expect("an answer");
    assert_eq!(answer, "\rz\rt58184300100096010200\r");
}

#[cfg(unix)]
#[test]
fn ctrl_c_ends_it_under_a_flood() {
    let mut sim = Sim::start(&["gxmm"]);
    let floods: Vec<_> = (0..4)
        .map(|_| {
            let mut client = sim.client();
            std::thread::spawn(move || {
                let requests = "t60184000100000000000\r".repeat(2000);
                let _ = client.write_all(b"O\r");
                while client.write_all(requests.as_bytes()).is_ok() {}
            })
        })
        .collect();
    std::thread::sleep(Duration::from_millis(300));
    let pid = sim.child.id().to_string();
    let kill = std::process::Command::new("kill")
        .args(["-INT", &pid])
        .status();
    assert!(kill.expect("kill").success());
    let asked = std::time::Instant::now();
    assert_eq!(sim.child.wait().expect("it ends").code(), Some(0));
    assert!(asked.elapsed() < Duration::from_secs(5));
    for flood in floods {
        flood.join().expect("no panic");
    }
}
