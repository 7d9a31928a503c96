//! `odkit bridge` and the WebSocket of `odkit sim`.

use std::io::{Read, Write};
use std::net::TcpStream;
use std::time::Duration;

use crate::support::odkit;
use crate::support::quiet::Sim;

const TOKEN: &str = "0123456789abcdef";

/// A minimal page that sends `token`.
fn page(place: &str, token: &str, origin: &str) -> TcpStream {
    let mut stream = TcpStream::connect(place).expect("it listens");
    let patience = Some(Duration::from_secs(10));
    stream.set_read_timeout(patience).expect("a time limit");
    let head = format!(
        "GET /?token={token} HTTP/1.1\r\nHost: {place}\r\nOrigin: {origin}\r\nConnection: Upgrade\r\n\
         Upgrade: websocket\r\nSec-WebSocket-Version: 13\r\n\
         Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n"
    );
    stream.write_all(head.as_bytes()).expect("it reads");
    stream
}

/// Reads up to `end`, and returns the bytes.
#[track_caller]
fn read_to(stream: &mut TcpStream, end: &[u8]) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut byte = [0];
    while !bytes.ends_with(end) {
        let shown = String::from_utf8_lossy(&bytes).into_owned();
        let count = stream.read(&mut byte).expect("more bytes");
        assert_eq!(count, 1, "it ended after {shown:?}");
        bytes.push(byte[0]);
    }
    bytes
}

/// Sends a message with a mask of zeros.
fn send(stream: &mut TcpStream, text: &str) {
    let mut bytes = vec![0x81, 0x80 | u8::try_from(text.len()).expect("short")];
    bytes.extend([0; 4]);
    bytes.extend(text.as_bytes());
    stream.write_all(&bytes).expect("it reads");
}

/// The address of a link in the ready file.
fn place(sim: &Sim, link: usize) -> String {
    let link = &sim.ready["links"][link];
    let url = link["url"].as_str().map(|url| {
        let place = url.strip_prefix("ws://").expect("a WebSocket");
        let (place, token) = place.split_once("/?token=").expect("a token");
        assert_eq!(token, TOKEN);
        place
    });
    String::from(url.or(link["address"].as_str()).expect("a place"))
}

#[test]
fn a_bridge_has_no_node_and_frames_go_both_ways() {
    let ws = format!("ws:127.0.0.1:0?token={TOKEN}");
    let sim = Sim::run(&["bridge", "--link", "slcan:127.0.0.1:0", "--link", &ws]);
    assert_eq!(sim.ready["nodes"].as_array().map(Vec::len), Some(0));
    let mut host = sim.client();
    host.write_all(b"O\r").expect("it reads");
    read_to(&mut host, b"\r");
    let mut page = page(&place(&sim, 1), TOKEN, "http://127.0.0.1:8080");
    let head = read_to(&mut page, b"\r\n\r\n");
    assert!(head.starts_with(b"HTTP/1.1 101"));
    send(&mut page, "O\r");
    read_to(&mut page, b"\x81\x01\r");
    send(
        &mut page,
        "t6018401810010000000 0\r".replace(' ', "").as_str(),
    );
    let heard = read_to(&mut host, b"t60184018100100000000\r");
    assert_eq!(heard, b"t60184018100100000000\r", "nobody else sends");
    host.write_all(b"t58184318100196010000\r")
        .expect("it reads");
    read_to(&mut page, b"\x81\x16t58184318100196010000\r");
}

#[test]
fn a_page_needs_the_token_to_reach_a_node() {
    let ws = format!("ws:127.0.0.1:0?token={TOKEN}");
    let sim = Sim::start(&["gxmm", "--link", &ws]);
    let place = place(&sim, 1);
    for (token, origin) in [
        ("0123456789abcdee", "http://localhost:8080"),
        (TOKEN, "https://example.org"),
    ] {
        let mut stranger = page(&place, token, origin);
        let mut said = String::new();
        // It receives the reason, and the connection ends.
        stranger.read_to_string(&mut said).expect("an end");
        assert!(said.starts_with("HTTP/1.1 403"), "{said}");
    }
    let mut page = page(&place, TOKEN, "http://localhost:8080");
    read_to(&mut page, b"\r\n\r\n");
    send(&mut page, "O\r");
    send(&mut page, "t60184000100000000000\r");
    // 1000h of a GXMM: a multiturn encoder of CiA 406.
    read_to(&mut page, b"t58184300100096010200\r");
}

#[test]
fn a_bridge_has_two_ends() {
    let done = odkit(&["bridge", "--link", "ws:1"], "");
    assert_eq!(done.code, 2);
    assert!(done.err.contains("give --link twice"), "{}", done.err);
}
