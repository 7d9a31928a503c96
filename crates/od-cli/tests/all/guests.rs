//! Clients that `odkit sim` accepts or refuses, and refusals of the system.

use std::io::{ErrorKind, Read, Write};
use std::net::TcpStream;
use std::time::{Duration, Instant};

use crate::support::sim::{Sim, say};

/// Reads the rest of a connection; a reset counts as its end.
fn rest(client: &mut TcpStream) -> String {
    let mut text = Vec::new();
    match client.read_to_end(&mut text) {
        Err(error) if error.kind() != ErrorKind::ConnectionReset => panic!("{error}"),
        _ => String::from_utf8_lossy(&text).into_owned(),
    }
}

/// A web page can make a browser send these bytes to any port of the computer.
#[test]
fn a_browser_cannot_drive_the_bus() {
    let mut sim = Sim::start_heard(&["gxmm", "--link", "socketcand:127.0.0.1:0"]);
    let mut witness = sim.client();
    say(&mut witness, "O\r", "\r");
    let ports = [sim.port, sim.port_of("socketcand on 127.0.0.1:")];
    let lines = "\rC\rS6\rO\rt60182B171000E8030000\r";
    let commands = "< open can0 >< rawmode >< send 601 8 2B 17 10 00 E8 03 00 00 >";
    for (port, body) in ports.into_iter().zip([lines, commands]) {
        for method in ["POST", "GET", "OPTIONS"] {
            sim.port = port;
            let mut browser = sim.client();
            let request = format!("{method} / HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n{body}");
            let (first, second) = request.split_at(2);
            browser.write_all(first.as_bytes()).expect("it reads");
            // The connection may be reset before the second half is sent.
            let _ = browser.write_all(second.as_bytes());
            assert!(!rest(&mut browser).contains("581"), "{method}");
            sim.told("it sent an HTTP request");
        }
    }
    // No frame reached the bus, and 1017h has its earlier value.
    say(
        &mut witness,
        "t60184017100000000000\r",
        "z\rt58184B17100000000000\r",
    );
}

#[test]
fn one_client_too_many_is_refused() {
    let args = [
        "gxmm",
        "--max-clients",
        "2",
        "--link",
        "socketcand:127.0.0.1:0",
    ];
    let mut sim = Sim::start_heard(&args);
    let (slcan, socketcand) = (sim.port, sim.port_of("socketcand on 127.0.0.1:"));
    let mut clients = [sim.client(), sim.client()];
    for client in &mut clients {
        say(client, "O\r", "\r");
    }
    let refusal = "the limit is 2 clients; raise it with `--max-clients`";
    assert_eq!(rest(&mut sim.client()), format!("\x07odkit: {refusal}\r"));
    sim.told(&format!("was refused: {refusal}"));
    // The clients of both links count.
    sim.port = socketcand;
    assert_eq!(rest(&mut sim.client()), format!("< error {refusal} >"));
    sim.told(&format!("was refused: {refusal}"));
    // A client that disconnects makes room.
    drop(clients);
    sim.told(" left");
    sim.told(" left");
    sim.port = slcan;
    say(&mut sim.client(), "V\r", "V1013\r");
}

#[test]
fn a_disconnected_client_makes_room_at_once() {
    let sim = Sim::start(&["gxmm", "--max-clients", "1"]);
    for _ in 0..50 {
        let mut client = sim.client();
        say(&mut client, "V\r", "V1013\r");
        client.write_all(b"O\r").expect("it reads");
    }
}

#[cfg(unix)]
#[test]
fn a_client_is_refused_if_the_system_has_no_file_handle() {
    let mut sim = Sim::start_under("ulimit -n 40; exec \"$@\"", &["gxmm"]);
    let mut clients: Vec<TcpStream> = Vec::new();
    let refused = loop {
        assert!(clients.len() < 40, "nobody is refused");
        let mut client = sim.client();
        client.write_all(b"V\r").expect("it connects");
        let mut answer = [0; 1];
        client.read_exact(&mut answer).expect("an answer");
        if answer == *b"\x07" {
            break rest(&mut client);
        }
        say(&mut client, "", "1013\r");
        clients.push(client);
    };
    assert!(refused.contains("too many open files"), "{refused}");
    sim.told("was refused: too many open files");
    assert!(clients.len() > 10, "{}", clients.len());
    // The others continue, and a client that disconnects makes room.
    say(&mut clients[0], "V\r", "V1013\r");
    drop(clients.pop());
    sim.told(" left");
    say(&mut sim.client(), "V\r", "V1013\r");
}

/// Configures a PDO every millisecond on the bus of this client, and no other frame.
#[cfg(unix)]
fn pdos(client: &mut TcpStream) -> impl FnMut(usize) + '_ {
    say(client, "O\r", "\r");
    client
        .write_all(b"t60182B00180501000000\rt00020101\r")
        .expect("it reads");
    let mut reader = std::io::BufReader::new(client);
    move |count| {
        let mut heard = 0;
        while heard < count {
            let mut line = Vec::new();
            let len = std::io::BufRead::read_until(&mut reader, b'\r', &mut line);
            assert_ne!(len.expect("a frame"), 0);
            heard += usize::from(line.starts_with(b"t1814"));
        }
    }
}

#[cfg(unix)]
#[test]
fn frames_missed_by_a_suspended_bench_are_not_sent() {
    let mut sim = Sim::start_heard(&["gxmm"]);
    let mut client = sim.client();
    let mut wait_for = pdos(&mut client);
    wait_for(20);
    sim.suspend();
    // The bench is stopped for this time; the test waits for nothing else.
    std::thread::sleep(Duration::from_millis(600));
    // Taken before it continues: on a busy computer `kill` may return long after the signal arrived.
    let start = Instant::now();
    sim.signal("-CONT");
    // A tenth of the frames may have been in transit, or within the 50 ms that are made up for.
    wait_for(400);
    let took = start.elapsed();
    assert!(took > Duration::from_millis(250), "{took:?}");
    // A busy computer may have been late before, but not by this much.
    let mut late = 0;
    while late < 500 {
        let line = sim.told("the bus continues from the present time");
        let mut words = line.split_whitespace();
        late = words.find_map(|word| word.parse().ok()).expect("a number");
    }
}

/// `nohup` ignores SIGHUP, does not redirect a pipe, and expects that its program continues.
#[cfg(unix)]
#[test]
fn nohup_keeps_it_running_without_a_terminal() {
    let mut sim = Sim::start_under("exec nohup \"$@\"", &["gxmm"]);
    sim.signal("-HUP");
    say(&mut sim.client(), "V\r", "V1013\r");
    sim.signal("-HUP");
    say(&mut sim.client(), "V\r", "V1013\r");
    sim.signal("-INT");
    assert_eq!(sim.child.wait().expect("it ends").code(), Some(0));
    // Without nohup it ends cleanly with the terminal. The tests themselves may run under nohup.
    let plain = if cfg!(target_os = "linux") {
        "exec env --default-signal=HUP \"$@\""
    } else {
        "exec \"$@\""
    };
    let mut sim = Sim::start_under(plain, &["gxmm"]);
    sim.signal("-HUP");
    assert_eq!(sim.child.wait().expect("it ends").code(), Some(0));
}
