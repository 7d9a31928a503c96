//! Commands of clients, and the responses.

use std::string::ToString;

use super::*;

struct Client {
    session: Session,
    now: Instant,
}

impl Client {
    fn new() -> Self {
        Self {
            session: Session::default(),
            now: Instant::ZERO,
        }
    }

    /// Answers; frames are in parentheses, a pause is `|`.
    fn say(&mut self, text: &str) -> String {
        let mut steps = Vec::new();
        self.session.receive(text.as_bytes(), self.now, &mut steps);
        shown(steps)
    }

    fn hear(&mut self, frame: Frame) -> String {
        let mut out = Vec::new();
        self.session.encode(&frame, self.now, 23_424_242, &mut out);
        String::from_utf8(out).expect("text")
    }

    fn wait(&mut self, micros: u64) -> String {
        let end = self.now.plus_micros(micros);
        let mut all = String::new();
        while let Some(at) = self.session.deadline().filter(|at| *at <= end) {
            self.now = at;
            let mut steps = Vec::new();
            self.session.wake(at, 1_000_000, &mut steps);
            assert!(!steps.is_empty(), "a deadline without a cause");
            all.push_str(&shown(steps));
        }
        self.now = end;
        all
    }
}

fn shown(steps: Vec<Step>) -> String {
    let mut text = String::new();
    for step in steps {
        match step {
            Step::Reply(bytes) => text.push_str(&String::from_utf8_lossy(&bytes)),
            Step::Frame(frame) => text.push_str(&format!("({frame})")),
            Step::Line(_) | Step::Open | Step::Status => unreachable!("socketcand has none"),
            Step::Pause => text.push('|'),
            Step::Leave => text.push('!'),
        }
    }
    text
}

fn frame(data: &[u8]) -> Frame {
    Frame::new(CanId::standard(0x123), data).unwrap()
}

fn open(mode: &str) -> Client {
    let mut client = Client::new();
    assert_eq!(client.say("< open can0 >"), "< ok >");
    if !mode.is_empty() {
        let answer = client.say(mode);
        assert!(answer.starts_with("< ok >"), "{answer}");
    }
    client
}

#[test]
fn python_can_opens_like_this() {
    let mut client = Client::new();
    assert_eq!(client.hear(frame(&[1])), "");
    assert_eq!(client.say("< rawmode >"), "< error unknown command >");
    assert_eq!(client.say("< open vcan0 >"), "< ok >");
    assert_eq!(client.hear(frame(&[1])), "", "BCM mode hears nothing");
    assert_eq!(client.say("< rawmode >"), "< ok >|");
    assert_eq!(
        client.say("< send 601 8 40 4 60 0 0 0 0 0 >"),
        "(601#4004600000000000)"
    );
    assert_eq!(client.say("< send 080 0  >"), "(080#)");
    assert_eq!(
        client.hear(frame(&[1, 0xAB])),
        "< frame 123 23.424242 01AB >"
    );
    assert_eq!(client.hear(frame(&[])), "< frame 123 23.424242  >");
    assert_eq!(
        client.hear(Frame::of(CanId::extended(0x123), &[1])),
        "< frame 00000123 23.424242 01 >"
    );
    assert_eq!(
        client.hear(Frame::remote(CanId::standard(0x701), 4).unwrap()),
        "< rtr 701 23.424242 4 >"
    );
}

#[test]
fn commands_come_in_pieces_and_together() {
    let mut client = Client::new();
    let mut all = String::new();
    for byte in "junk< open can0 >\r\n< echo >< bcmmode >>< sendrtr 1AAAAAAA 2 >".chars() {
        all.push_str(&client.say(&byte.to_string()));
    }
    assert_eq!(all, "< ok >< echo >< ok >(1AAAAAAA#R2)");
    assert_eq!(
        client.say("< rawmode >< send 1AAAAAAA 2 1 F1 >< echo >"),
        "< ok >|(1AAAAAAA#01F1)< echo >"
    );
    // A command without an end is dropped for the next one.
    assert_eq!(client.say("< send 123 < echo >"), "< echo >");
    let long = format!("< send {} >", "1 ".repeat(100_000));
    assert_eq!(client.say(&long), "< error syntax error >");
    assert_eq!(client.say("< echo >"), "< echo >");
}

#[test]
fn a_wrong_command_sends_nothing() {
    for wrong in [
        "< send >",
        "< send 123 >",
        "< send 800 0 >",
        "< send 1234 0 >",
        "< send 20000000 0 >",
        "< send -12 0 >",
        "< send 123 9 1 2 3 4 5 6 7 8 9 >",
        "< send 123 2 11 >",
        "< send 123 1 11 22 >",
        "< send 123 1 100 >",
        "< send 123 1 +1 >",
        "< send 123 1 xy >",
        "< sendrtr 123 >",
        "< add 0 123 0 >",
        "< add 0 -1 123 0 >",
        "< add 1.5 0 123 0 >",
        "< update 123 >",
        "< delete 123 4 >",
        "< subscribe 0 0 >",
        "< filter 0 0 123 1 >",
        "< unsubscribe >",
    ] {
        assert_eq!(open("").say(wrong), "< error syntax error >", "{wrong}");
    }
    for unknown in [
        "< >",
        "<>",
        "< SEND 123 0 >",
        "< fdsend 123 0 0 >",
        "< isotpmode >",
        "< ä >",
    ] {
        assert_eq!(
            open("").say(unknown),
            "< error unknown command >",
            "{unknown}"
        );
    }
    // RAW mode has no jobs.
    assert_eq!(
        open("< rawmode >").say("< add 1 0 123 0 >"),
        "< error unknown command >"
    );
    let name = "< open a-name-that-is-too-long >";
    assert_eq!(Client::new().say(name), "< error syntax error >");
}

#[test]
fn jobs_continue_until_they_are_deleted() {
    let mut client = open("");
    assert_eq!(client.say("< add 0 20000 123 2 42 43 >"), "(123#4243)");
    assert_eq!(client.wait(45_000), "(123#4243)(123#4243)");
    assert_eq!(client.say("< update 123 1 5 >"), "");
    assert_eq!(client.wait(20_000), "(123#05)", "the timer continues");
    assert_eq!(client.say("< add 0 0 124 0 >"), "(124#)", "once");
    assert_eq!(client.say("< delete 123 >"), "");
    assert_eq!(client.wait(100_000), "");
    assert_eq!(client.say("< add 0 1 123 0 >"), "(123#)");
    assert_eq!(
        client.wait(3000),
        "(123#)".repeat(3),
        "not faster than 1 ms"
    );
    client.now = client.now.plus_micros(10_000_000);
    let mut steps = Vec::new();
    client.session.wake(client.now, 0, &mut steps);
    assert_eq!(
        shown(steps),
        "(123#)",
        "what was missed does not come in a heap"
    );
    assert_eq!(client.say("< bcmmode >"), "< ok >");
    assert_eq!(client.wait(10_000), "", "a mode takes its jobs along");
    for number in 0..256 {
        assert_eq!(
            client.say(&format!("< add 1 0 {number:x} 0 >")),
            format!("({number:03X}#)")
        );
    }
    assert_eq!(client.say("< add 1 0 700 0 >"), "< error too many jobs >");
}

#[test]
fn bcm_mode_receives_its_subscriptions() {
    let mut client = open("");
    assert_eq!(client.say("< subscribe 0 0 123 >"), "");
    assert_eq!(
        client.hear(frame(&[1, 2])),
        "< frame 123 23.424242 01 02  >"
    );
    assert_eq!(
        client.hear(frame(&[1, 2])),
        "< frame 123 23.424242 01 02  >"
    );
    assert_eq!(client.hear(Frame::standard(0x124, &[])), "");
    assert_eq!(client.say("< unsubscribe 123 >"), "");
    assert_eq!(client.hear(frame(&[1])), "");
    // Only changes of the first byte count.
    assert_eq!(client.say("< filter 0 0 123 1 F0 >"), "");
    assert_eq!(
        client.hear(frame(&[0x10, 1])),
        "< frame 123 23.424242 10 01  >"
    );
    assert_eq!(client.hear(frame(&[0x1F, 2])), "");
    assert_eq!(
        client.hear(frame(&[0x20, 2])),
        "< frame 123 23.424242 20 02  >"
    );
    // At most every 10 ms, and then the newest.
    assert_eq!(client.say("< subscribe 0 10000 123 >"), "");
    assert_eq!(client.hear(frame(&[1])), "< frame 123 23.424242 01  >");
    assert_eq!(client.hear(frame(&[2])), "");
    assert_eq!(client.hear(frame(&[3])), "");
    assert_eq!(client.wait(9_999), "");
    assert_eq!(client.wait(1), "< frame 123 1.000000 03  >");
    assert_eq!(client.wait(50_000), "");
}
