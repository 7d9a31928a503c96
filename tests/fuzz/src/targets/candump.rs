//! candump text: a parsed frame that is written again parses to the same frame, and an error
//! points into the line.

use od_runtime::Instant;
use od_sim::logs::candump::{format_line, parse_frame, parse_line};

use crate::target::Target;

pub(super) const TARGET: Target = Target {
    name: "candump",
    run,
    seeds: || {
        [
            "(0.100000) can0 601#4004600000000000\n",
            "601#40.04.60.00\n1F334455#11\n701#R4\n080#\n",
            "  can0  601   [8]  40 04 60 00 00 00 00 00\n (003.1)  can0  701   [0]  remote request\n",
            "(1600000000.5)  vcan1  701#R R\n123##1AABB\n",
        ]
        .map(|text| text.as_bytes().to_vec())
        .to_vec()
    },
    words: &[
        "(",
        ")",
        "can0 ",
        "#",
        "##",
        "R",
        "T",
        "[8]",
        "[0]",
        "remote request",
        " ",
        ".",
        "601",
        "FFFFFFFF",
        "20000000",
        "ä",
        "\u{0}",
        "\u{2028}",
        "\t",
        "(99999999999999999999.9) ",
    ],
    is_text: true,
    longest: 1024,
    ..Target::PLAIN
};

fn run(input: &[u8]) {
    let text = String::from_utf8_lossy(input);
    for line in text.lines() {
        let columns = line.chars().count() + 1;
        match parse_line(line) {
            Ok(read) => {
                let at = read.at.unwrap_or(Instant::ZERO);
                let written = format_line(at, "can0", &read.frame);
                let again = parse_line(&written).expect("what was written can be read");
                assert_eq!(
                    again.frame, read.frame,
                    "{line:?} was written as {written:?}"
                );
                assert_eq!(again.at, Some(at), "{line:?} was written as {written:?}");
            }
            Err(error) => assert!(
                (1..=columns).contains(&error.column),
                "{line:?}: column {}: {}",
                error.column,
                error.message
            ),
        }
        if let Ok(frame) = parse_frame(line) {
            assert_eq!(parse_frame(&frame.to_string()), Ok(frame), "{line:?}");
        }
    }
}
