//! Requests that are accepted or refused, and frames in messages.

use super::*;

const TOKEN: &str = "0123456789abcdef";

fn gate() -> Gate {
    Gate::new(TOKEN.into(), vec!["https://example.org".into()])
}

fn request(path: &str, more: &str) -> String {
    format!(
        "GET {path} HTTP/1.1\r\nHost: 127.0.0.1:29538\r\nConnection: Upgrade\r\nUpgrade: websocket\r\n\
         Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n{more}\r\n"
    )
}

/// Answers to separate pieces of bytes.
fn say(codec: &mut WebSocket<'_>, bytes: &[u8]) -> Vec<Step> {
    let mut steps = Vec::new();
    codec.receive(bytes, Instant::ZERO, &mut steps);
    steps
}

fn answer(gate: &Gate, request: &str) -> String {
    let steps = say(&mut WebSocket::new(gate), request.as_bytes());
    let Some(Step::Reply(bytes)) = steps.first() else {
        panic!("{steps:?}");
    };
    let text = String::from_utf8_lossy(bytes).into_owned();
    let ends = steps.last() == Some(&Step::Leave);
    assert_eq!(ends, !text.starts_with("HTTP/1.1 101"), "{text}");
    text
}

/// A message of a client: 6 bytes, then the text, with a mask without effect.
fn message(text: &str) -> Vec<u8> {
    let mut bytes = vec![
        0x81,
        0x80 | u8::try_from(text.len()).expect("short"),
        0,
        0,
        0,
        0,
    ];
    bytes.extend_from_slice(text.as_bytes());
    bytes
}

#[test]
fn the_token_and_the_origin_decide() {
    let gate = gate();
    let good = format!("/?token={TOKEN}");
    let origin = |origin: &str| format!("Origin: {origin}\r\n");
    for (path, more, status) in [
        (&*good, String::new(), "101"),
        (&good, origin("http://127.0.0.1:8080"), "101"),
        (&good, origin("http://localhost"), "101"),
        (&good, origin("http://[::1]:1"), "101"),
        (&good, origin("https://example.org"), "101"),
        (&good, origin("https://example.org.evil"), "403"),
        (&good, origin("http://127.0.0.1.evil:80"), "403"),
        (&good, origin("http://localhost@evil"), "403"),
        (&good, origin("null"), "403"),
        ("/", String::new(), "403"),
        ("/?token=", String::new(), "403"),
        ("/?token=0123456789abcdeF", String::new(), "403"),
        ("/?x=1&token=0123456789abcdef", String::new(), "101"),
    ] {
        let said = answer(&gate, &request(path, &more));
        let head = format!("HTTP/1.1 {status}");
        assert!(said.starts_with(&head), "{path} {more}: {said}");
    }
    // RFC 6455, clause 1.3: the key in the response.
    let said = answer(&gate, &request(&good, "")).to_ascii_lowercase();
    assert!(
        said.contains("sec-websocket-accept: s3pplmbitxaq9kygzzhzrbk+xoo="),
        "{said}"
    );
}

#[test]
fn other_bytes_are_refused_and_memory_stays_bounded() {
    let gate = gate();
    let plain = format!("GET /?token={TOKEN} HTTP/1.1\r\nHost: a\r\n\r\n");
    assert!(answer(&gate, &plain).starts_with("HTTP/1.1 426"));
    assert!(answer(&gate, "C\rO\rt1230\r\n\r\n").starts_with("HTTP/1.1 400"));
    let mut codec = WebSocket::new(&gate);
    let mut steps = Vec::new();
    for _ in 0..1000 {
        codec.receive(&[b'x'; 100], Instant::ZERO, &mut steps);
    }
    assert!(codec.head.len() <= HEAD + 100);
    assert!(steps.len() <= 2, "{steps:?}");
}

#[test]
fn frames_go_both_ways_in_any_pieces() {
    let gate = gate();
    let mut codec = WebSocket::new(&gate);
    let mut bytes = request(&format!("/?token={TOKEN}"), "").into_bytes();
    bytes.extend(message("S6\rO\rt12320A0B\r"));
    let mut steps = Vec::new();
    for byte in bytes {
        codec.receive(&[byte], Instant::ZERO, &mut steps);
    }
    let frame = Frame::standard(0x123, &[10, 11]);
    assert!(steps.contains(&Step::Frame(frame)), "{steps:?}");
    let replies = steps.iter().filter(|step| matches!(step, Step::Reply(_)));
    assert!(
        replies.count() >= 2,
        "101, then what the adapter says: {steps:?}"
    );
    assert_eq!(codec.form(), Some("slcan in a WebSocket"));
    let mut out = Vec::new();
    codec.encode(&Frame::standard(0x181, &[1]), Instant::ZERO, 0, &mut out);
    assert_eq!(out, b"\x81\x08t181101\r");
    // A page sends a close frame, and gets its answer.
    let steps = say(&mut codec, &[0x88, 0x80, 0, 0, 0, 0]);
    assert_eq!(steps, [Step::Reply(vec![0x88, 0]), Step::Leave]);
    out.clear();
    codec.encode(&frame, Instant::ZERO, 0, &mut out);
    assert!(out.is_empty());
}

#[test]
fn garbage_ends_the_connection() {
    let gate = gate();
    for bytes in [
        &b"\x01\x02\x03\x04\x05\x06"[..],
        &[0xFF; 64],
        &[
            0x82, 0xFF, 0x7F, 255, 255, 255, 255, 255, 255, 255, 0, 0, 0, 0,
        ],
    ] {
        let mut codec = WebSocket::new(&gate);
        say(
            &mut codec,
            request(&format!("/?token={TOKEN}"), "").as_bytes(),
        );
        let steps = say(&mut codec, bytes);
        assert_eq!(steps.last(), Some(&Step::Leave), "{bytes:?}");
    }
}

#[test]
fn a_page_that_asks_for_the_reason_gets_a_close_frame() {
    let gate = gate();
    let foreign = "Origin: https://elsewhere.example\r\n";
    for (path, more, why) in [
        ("/?token=wrong&why", "", "the token is wrong"),
        ("/?why", "", "the token is wrong"),
        (
            "/?token=0123456789abcdef&why",
            foreign,
            "name it with --origin",
        ),
    ] {
        let mut codec = WebSocket::new(&gate);
        let steps = say(&mut codec, request(path, more).as_bytes());
        let [Step::Reply(bytes), Step::Leave] = &*steps else {
            panic!("{path}: {steps:?}");
        };
        assert!(bytes.starts_with(b"HTTP/1.1 101"), "{path}");
        let end = bytes.windows(4).position(|four| four == b"\r\n\r\n");
        let frame = &bytes[end.expect("a head") + 4..];
        // A close frame (RFC 6455, clause 5.5.1) with status 1008, policy violation.
        assert_eq!(frame[0], 0x88, "{path}");
        assert_eq!(frame[2..4], 1008u16.to_be_bytes(), "{path}");
        assert!(String::from_utf8_lossy(&frame[4..]).contains(why), "{path}");
        assert_eq!(say(&mut codec, &message("O\rt1230\r")), [], "{path}");
    }
}

#[test]
fn a_request_has_ten_seconds() {
    let gate = gate();
    let begin = Instant::from_micros(5_000_000);
    for (bytes, ends) in [
        (String::new(), true),
        (String::from("GET / HTTP/1.1\r\nHost: a\r\n"), true),
        (request(&format!("/?token={TOKEN}"), ""), false),
    ] {
        let mut codec = WebSocket::new(&gate);
        assert_eq!(codec.deadline(), Some(Instant::ZERO), "at once");
        let mut steps = Vec::new();
        codec.wake(begin, 0, &mut steps);
        assert_eq!(codec.deadline(), Some(begin + HANDSHAKE));
        say(&mut codec, bytes.as_bytes());
        codec.wake(begin + HANDSHAKE, 0, &mut steps);
        assert_eq!(steps == [Step::Leave], ends, "{bytes}");
        assert_eq!(codec.deadline(), None);
    }
}
