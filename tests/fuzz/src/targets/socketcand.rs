//! socketcand: the same bytes in several parts mean the same, no time value causes a loop, and every frame
//! is written as it was read.

use od_runtime::{Frame, Instant};
use od_sim::links::socketcand::Session;
use od_sim::links::{Codec, Step};

use crate::target::Target;

pub(super) const TARGET: Target = Target {
    name: "socketcand",
    run,
    seeds: || {
        [
            "< open can0 >< rawmode >< send 601 8 40 4 60 0 0 0 0 0 >< echo >",
            "< open vcan0 >< add 0 20000 123 2 11 22 >< update 123 1 5 >< delete 123 >",
            "< open c >< subscribe 0 0 123 >< filter 1 500000 123 8 FF 0 F8 0 0 0 0 0 >\
             < unsubscribe 123 >< sendrtr 1AAAAAAA 2 >< bcmmode >",
        ]
        .map(|text| text.as_bytes().to_vec())
        .to_vec()
    },
    words: &[
        "<",
        ">",
        " ",
        "< open x >",
        "< rawmode >",
        "< bcmmode >",
        "< echo >",
        "< send ",
        "123",
        "1FFFFFFF ",
        "8 1 2 3 4 5 6 7 8 >",
        "< add 0 1 ",
        "< subscribe 0 1000 123 >",
        "< filter 0 0 123 2 FF FF >",
        "4294967295",
        "0",
        "-1",
        "+1",
    ],
    ..Target::PLAIN
};

fn take(session: &mut Session, pieces: &[&[u8]], now: Instant) -> Vec<Step> {
    let mut all: Vec<Step> = Vec::new();
    for piece in pieces {
        let mut steps = Vec::new();
        session.receive(piece, now, &mut steps);
        for step in steps {
            match (all.last_mut(), step) {
                (Some(Step::Reply(reply)), Step::Reply(more)) => reply.extend(more),
                (_, step) => all.push(step),
            }
        }
    }
    all
}

fn run(input: &[u8]) {
    let (mut whole, mut parts) = (Session::default(), Session::default());
    let mut now = Instant::ZERO;
    let steps = take(&mut whole, &[input], now);
    let pieces: Vec<&[u8]> = input.chunks(1 + input.len() % 7).collect();
    assert_eq!(
        steps,
        take(&mut parts, &pieces, now),
        "in pieces it means something else"
    );
    for step in &steps {
        if let Step::Frame(frame) = step {
            comes_back(frame);
        }
    }
    for round in 0..20 {
        let mut out = Vec::new();
        whole.encode(&Frame::standard(0x123, &[round, 2]), now, 0, &mut out);
        assert!(out.len() < 64);
        let Some(at) = whole.deadline() else {
            break;
        };
        assert!(at >= now, "a deadline in the past");
        now = at;
        let mut due = Vec::new();
        whole.wake(now, 0, &mut due);
        assert!(!due.is_empty(), "a deadline without a cause");
        assert!(
            whole.deadline().is_none_or(|next| next > now),
            "time does not pass"
        );
    }
}

fn comes_back(frame: &Frame) {
    let data: String = frame
        .data()
        .iter()
        .map(|byte| format!("{byte:x} "))
        .collect();
    let kind = if frame.is_remote() { "sendrtr" } else { "send" };
    let text = format!("< open x >< {kind} {} {} {data}>", frame.id(), frame.dlc());
    let steps = take(&mut Session::default(), &[text.as_bytes()], Instant::ZERO);
    assert!(
        steps.contains(&Step::Frame(*frame)),
        "{text} became {steps:?}"
    );
}
