//! `odkit sim` and its clients: several links, floods, and how it ends.

use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::process::Stdio;
use std::time::Duration;

#[cfg(unix)]
use crate::support::quiet::until;
use crate::support::sim::{Sim, say};
use crate::support::{command, odkit, temporary};

#[test]
fn socketcand_clients_get_the_exact_responses() {
    let mut sim = Sim::start(&["gxmm", "--link", "socketcand:127.0.0.1:0"]);
    let slcan = sim.port;
    sim.port = sim.port_of("socketcand on 127.0.0.1:");
    let mut client = sim.client();
    say(&mut client, "", "< hi >");
    say(&mut client, "< open can0 >", "< ok >");
    // The frame after the response is a message of its own.
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
    // A host connects, disconnects, and connects again.
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

/// A pseudo-terminal stands for a serial line here; it disappears with its owner.
#[cfg(unix)]
#[test]
fn a_lost_link_is_reported_and_the_last_one_ends_the_bench() {
    let mut other = Sim::start(&["gxmm", "--link", "slcan:pty"]);
    let path = other.greeting.split("slcan on /").nth(1).expect("a path");
    let path = format!("/{}", path.split([',', '\n', ' ']).next().expect("a path"));
    let link = format!("slcan:{path}");
    let mut last = command()
        .args(["sim", "gxmm", "--link", &link])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("odkit starts");
    let mut greeting = BufReader::new(last.stdout.take().expect("a pipe")).lines();
    assert!(greeting.any(|line| line.is_ok_and(|line| line.contains("Ctrl-C"))));
    let mut first = Sim::start_heard(&["gxmm", "--link", &link]);
    other.child.kill().expect("it runs");
    let ended = last.wait_with_output().expect("it ends");
    let said = String::from_utf8_lossy(&ended.stderr).into_owned();
    assert_eq!(ended.status.code(), Some(1), "{said}");
    assert!(said.contains(&format!("{path} is lost: ")), "{said}");
    assert!(said.contains("the last link is lost"), "{said}");
    // A link that still works continues.
    first.told(&format!("{path} is lost: "));
    say(&mut first.client(), "V\r", "V1013\r");
}

#[cfg(target_os = "linux")]
#[test]
fn standard_output_that_fails_is_a_lost_link() {
    for input in [Stdio::piped(), Stdio::null()] {
        let full = std::fs::File::create("/dev/full").expect("a full device");
        let mut sim = command()
            .args(["sim", "gxmm", "--link", "-"])
            .stdin(input)
            .stdout(full)
            .stderr(Stdio::piped())
            .spawn()
            .expect("odkit starts");
        // The boot-up message cannot be written, whether the input is open or at its end.
        let open = sim.stdin.take();
        let ended = sim.wait_with_output().expect("it ends");
        drop(open);
        let said = String::from_utf8_lossy(&ended.stderr).into_owned();
        assert_eq!(ended.status.code(), Some(1), "{said}");
        let lost = "standard input and output is lost: ";
        assert!(said.contains(lost), "{said}");
    }
}

#[test]
fn the_end_of_standard_input_does_not_end_a_server() {
    let reports = temporary();
    let mut child = command()
        .args(["sim", "gxmm", "--link", "-", "--slcan", "127.0.0.1:0"])
        .env("XDG_RUNTIME_DIR", reports.path())
        .stdin(Stdio::null())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("odkit starts");
    let errors = BufReader::new(child.stderr.take().expect("a pipe")).lines();
    let mut errors = errors.map(|line| line.expect("UTF-8"));
    let line = errors.find(|line| line.contains("slcan on 127.0.0.1:"));
    let port = line
        .as_deref()
        .and_then(|line| line.rsplit("127.0.0.1:").next());
    let digits = port.map(|text| text.split(',').next().unwrap_or_default());
    let port: u16 = digits
        .and_then(|text| text.trim().parse().ok())
        .expect("a port");
    // Standard output still gets frames.
    let mut frames = BufReader::new(child.stdout.take().expect("a pipe")).lines();
    for frame in ["701#00", "601#4000100000000000", "581#4300100096010200"] {
        let line = frames.next().expect("a frame").expect("UTF-8");
        assert!(line.ends_with(frame), "{line}");
        if frame == "701#00" {
            let mut client = TcpStream::connect(("127.0.0.1", port)).expect("it listens");
            client
                .write_all(b"O\rt60184000100000000000\r")
                .expect("it reads");
        }
    }
    child.kill().expect("it runs");
    child.wait().expect("it ends");
}

#[test]
fn a_port_in_use_is_reported_with_a_help() {
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

#[cfg(unix)]
#[test]
fn ctrl_c_ends_it_cleanly() {
    let mut sim = Sim::start(&["gxmm"]);
    sim.signal("-INT");
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
    // Each acknowledgement is sent before the response to its frame.
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
fn a_client_that_closes_its_half_still_gets_responses() {
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

/// A program that sends an NMT command and ends has seldom read all heartbeats: the system then resets its connection.
#[cfg(unix)]
#[test]
fn the_last_frames_of_a_client_that_resets_its_connection_reach_the_bus() {
    let sim = Sim::start(&["gxmm"]);
    let mut client = sim.client();
    // 1017h: a heartbeat every 10 ms, which the client never reads.
    let response = "\rz\rt58186017100000000000\r";
    say(&mut client, "O\rt60182B1710000A000000\r", response);
    let mut witness = sim.client();
    say(&mut witness, "O\r", "\r");
    client.set_read_timeout(None).expect("no time limit");
    client.peek(&mut [0]).expect("a heartbeat");
    // The bench finds the command and the reset at the same time, and has heartbeats to send.
    sim.suspend();
    client.write_all(b"t00020101\r").expect("it connects");
    drop(client);
    sim.signal("-CONT");
    let mut heard = String::new();
    until("Operational", || {
        let mut bytes = [0; 256];
        let len = witness.read(&mut bytes).expect("a frame");
        heard += &String::from_utf8_lossy(&bytes[..len]);
        heard.contains("t701105\r").then_some(())
    });
}

#[cfg(unix)]
#[test]
fn ctrl_c_ends_it_under_a_flood() {
    let mut sim = Sim::start(&["gxmm"]);
    let (flooding, is_flooding) = std::sync::mpsc::channel();
    let floods: Vec<_> = (0..4)
        .map(|_| {
            let (mut client, flooding) = (sim.client(), flooding.clone());
            std::thread::spawn(move || {
                let requests = "t60184000100000000000\r".repeat(2000);
                say(&mut client, &format!("O\r{requests}"), "\r");
                let _ = flooding.send(());
                while client.write_all(requests.as_bytes()).is_ok() {}
            })
        })
        .collect();
    for _ in &floods {
        let answered = is_flooding.recv_timeout(Duration::from_secs(10));
        answered.expect("a client that is answered");
    }
    sim.signal("-INT");
    let asked = std::time::Instant::now();
    assert_eq!(sim.child.wait().expect("it ends").code(), Some(0));
    // A busy computer takes seconds; a bench that answers the flood first would never end.
    assert!(asked.elapsed() < Duration::from_secs(20));
    for flood in floods {
        flood.join().expect("no panic");
    }
}
