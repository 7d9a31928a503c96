//! `odkit sim` and its clients: several links, floods, and how it ends.

mod support;

use std::io::{Read, Write};
use std::time::Duration;

use support::odkit;
use support::sim::{Sim, say};

#[test]
fn socketcand_speaks_to_clients_that_compare_what_they_read() {
    let mut sim = Sim::start(&["gxmm", "--link", "socketcand:127.0.0.1:0"]);
    let slcan = sim.port;
    sim.port = sim.port_of("socketcand on 127.0.0.1:");
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
    // Each acknowledgement comes before the response to its frame.
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
    assert!(asked.elapsed() < Duration::from_secs(5));
    for flood in floods {
        flood.join().expect("no panic");
    }
}
