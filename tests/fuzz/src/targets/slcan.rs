//! slcan: the same bytes in several parts mean the same, and every frame is written as it was read.

use od_runtime::Instant;
use od_sim::links::{Codec, Step, slcan};

use crate::target::Target;

pub(super) const TARGET: Target = Target {
    name: "slcan",
    run,
    seeds: || {
        [
            "C\rS6\r\rO\rO\rt60184004600000000000\r",
            "O\rT1ffffff02aaBB\rr7018\rR000007013\rZ1\rt0800\rt08010512AB\r",
            "V\rv\rN\rF\rM00000000\rm000000FF\rs0314\rW2\rX1\rU3\rQ1\rP\rA\rL\rt601140\rC\r",
        ]
        .map(|text| text.as_bytes().to_vec())
        .to_vec()
    },
    words: &[
        "\r",
        "\n",
        "O\r",
        "C\r",
        "L\r",
        "Z1\r",
        "Z0\r",
        "S6",
        "t6018",
        "T000006018",
        "r701",
        "R00000701",
        "40046000",
        "t7FF0\r",
        "t8000\r",
        "V\r",
        "F\r",
        "\u{7}",
        "+1",
        "FFFF",
    ],
    ..Target::PLAIN
};

fn take(channel: &mut slcan::Channel, pieces: &[&[u8]]) -> Vec<Step> {
    let mut all: Vec<Step> = Vec::new();
    for piece in pieces {
        let mut steps = Vec::new();
        channel.receive(piece, Instant::ZERO, &mut steps);
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
    let (mut whole, mut parts) = (slcan::Channel::default(), slcan::Channel::default());
    let steps = take(&mut whole, &[input]);
    let pieces: Vec<&[u8]> = input.chunks(1 + input.len() % 7).collect();
    assert_eq!(
        steps,
        take(&mut parts, &pieces),
        "in pieces it means something else"
    );
    let lines = input.iter().filter(|byte| **byte == b'\r').count();
    let answers = steps.iter().filter_map(|step| match step {
        Step::Reply(bytes) => Some(bytes.iter().filter(|b| matches!(b, b'\r' | 7)).count()),
        // The host of the channel answers with the state of the controller.
        Step::Status => Some(1),
        _ => None,
    });
    assert_eq!(answers.sum::<usize>(), lines, "each line has one answer");
    for step in steps {
        if let Step::Frame(frame) = step {
            let mut channel = slcan::Channel::default();
            let _ = take(&mut channel, &[b"O\r"]);
            let mut out = Vec::new();
            channel.encode(&frame, Instant::ZERO, 0, &mut out);
            let again = take(&mut channel, &[&out]);
            assert!(
                again.contains(&Step::Frame(frame)),
                "{frame} went out as {again:?}"
            );
        }
    }
}
