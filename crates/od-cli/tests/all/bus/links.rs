//! Each kind of link, as a client; and what happens if the link is lost.

use std::io::{Read, Write};
use std::net::TcpListener;
use std::process::Stdio;
use std::thread;

use super::{done, fails};
use crate::support::quiet::Sim;
use crate::support::{command, odkit, temporary};

#[test]
fn each_link_reads_the_same_value() {
    let sim = Sim::start(&[
        "gxmm",
        "--link",
        "slcan:pty",
        "--link",
        "socketcand:127.0.0.1:0",
    ]);
    let link = |at: usize, place: &str, kind: &str| {
        let place = sim.ready["links"][at][place]
            .as_str()
            .expect("a place")
            .to_owned();
        format!("{kind}:{place}")
    };
    let links = [
        link(0, "address", "slcan"),
        link(1, "path", "slcan"),
        link(2, "address", "socketcand"),
        link(2, "address", "socketcand") + "/vcan7",
        link(1, "path", "slcan") + "@500000",
    ];
    for link in &links {
        let got = done(&["get", "1", "1000h", "--link", link]);
        assert!(got.contains("131478 (20196h)"), "{link}: {got}");
    }
    // The channel of the adapter is closed after each command, and opened again.
    done(&[
        "get",
        "1",
        "1000h",
        "--link",
        &links[1],
        "--bit-rate",
        "250",
    ]);
    fails(
        2,
        &[
            "get",
            "1",
            "1000h",
            "--link",
            &links[1],
            "--bit-rate",
            "123",
        ],
    );
    fails(
        2,
        &[
            "get",
            "1",
            "1000h",
            "--link",
            &links[2],
            "--bit-rate",
            "250",
        ],
    );
}

#[test]
fn the_default_is_the_running_sim() {
    let folder = temporary();
    let get = || {
        let mut get = command();
        get.args(["get", "5", "1000h"])
            .env("XDG_RUNTIME_DIR", folder.path());
        get.output().expect("odkit runs")
    };
    let nobody = get();
    let said = String::from_utf8_lossy(&nobody.stderr).into_owned();
    assert_eq!(nobody.status.code(), Some(1), "{said}");
    assert!(
        said.contains("no `odkit sim` runs") && said.contains("found"),
        "{said}"
    );
    let mut sim = command();
    sim.args([
        "sim",
        "gxmm",
        "--node-id",
        "5",
        "--slcan",
        "127.0.0.1:0",
        "--quiet",
    ]);
    sim.args(["--ready-file", "-"])
        .env("XDG_RUNTIME_DIR", folder.path());
    let mut sim = sim.stdout(Stdio::piped()).spawn().expect("odkit starts");
    let mut byte = [0];
    sim.stdout
        .as_mut()
        .expect("a pipe")
        .read_exact(&mut byte)
        .expect("a line");
    let found = get();
    assert_eq!(
        found.status.code(),
        Some(0),
        "{}",
        String::from_utf8_lossy(&found.stderr)
    );
    sim.kill().expect("it runs");
    sim.wait().expect("it ends");
    // The bench was killed, so its file still exists.
    assert_eq!(get().status.code(), Some(1));
}

/// A server that responds to the first bytes of a client, and then disconnects.
fn server(answer: &'static [u8]) -> String {
    let listener = TcpListener::bind("127.0.0.1:0").expect("a port");
    let port = listener.local_addr().expect("an address").port();
    thread::spawn(move || {
        let (mut client, _) = listener.accept().expect("a client");
        let mut bytes = [0; 64];
        let _ = client.read(&mut bytes);
        let _ = client.write_all(answer);
        // Waits until it has sent a request.
        let _ = client.read(&mut bytes);
    });
    port.to_string()
}

#[test]
fn a_lost_link_or_garbage_on_it_is_an_error_message() {
    for (kind, answer, words) in [
        ("slcan", &b"\r\r\r"[..], "closed the connection"),
        ("slcan", b"\r\r\rhello\r", "unexpected line `hello`"),
        ("slcan", b"\r\r\x07", "does not open its CAN channel"),
        ("slcan", &[b'x'; 600], "unexpected bytes"),
        ("socketcand", b"< hi >", "closed the connection"),
        ("socketcand", b"HTTP/1.1 400 >", "unexpected answer"),
        (
            "socketcand",
            b"< hi >< error could not open bus >",
            "could not open bus",
        ),
    ] {
        let link = format!("{kind}:{}", server(answer));
        let said = match kind {
            // This server sends first.
            "socketcand" => {
                let listener = TcpListener::bind("127.0.0.1:0").expect("a port");
                let port = listener.local_addr().expect("an address").port();
                let speaking = thread::spawn(move || {
                    let (mut client, _) = listener.accept().expect("a client");
                    let _ = client.write_all(answer);
                    let mut bytes = [0; 64];
                    let _ = client.read(&mut bytes);
                });
                let said = fails(
                    1,
                    &["get", "1", "1000h", "--link", &format!("{kind}:{port}")],
                );
                speaking.join().expect("a server");
                said
            }
            _ => fails(1, &["get", "1", "1000h", "--link", &link]),
        };
        assert!(said.contains(words), "{said}");
    }
    let gone = fails(1, &["scan", "--link", "slcan:127.0.0.1:1"]);
    assert!(gone.contains("odkit sim"), "{gone}");
    let nowhere = fails(1, &["scan", "--link", "slcan:/dev/odkit-is-not-here"]);
    assert!(nowhere.contains("does not exist"), "{nowhere}");
    for (wrong, right) in [
        ("can0", "socketcan:INTERFACE"),
        ("slcan:", "socketcan:INTERFACE"),
        ("udp:1:2", "socketcan:INTERFACE"),
        ("slcan:/dev/x@fast", "slcan:/dev/x@115200"),
        ("slcan:host", "HOST:PORT, such as 127.0.0.1:29536"),
    ] {
        let said = odkit(&["scan", "--link", wrong], "");
        assert_eq!(said.code, 2, "{wrong}: {}", said.err);
        assert!(said.err.contains(right), "{}", said.err);
    }
}
