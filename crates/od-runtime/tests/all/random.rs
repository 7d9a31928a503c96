//! Any frame at any time: no panic, no response to frames for other nodes, no value outside its
//! limits.

use crate::support::{Bench, Random};
use od_wire::nmt::State;

/// A frame that means something more often than at random.
fn frame(random: &mut Random) -> String {
    let id = random.pick(&[
        0x000, 0x080, 0x201, 0x301, 0x601, 0x601, 0x601, 0x601, 0x181, 0x602, 0x7E5,
    ]);
    if random.next().is_multiple_of(50) {
        return format!("{id:03X}#R{}", random.next() % 9);
    }
    if id == 0 {
        // Usually Operational, so that PDOs take part.
        let command = random.pick(&[0x01, 0x01, 0x01, 0x02, 0x80, 0x81, 0x82, 0x55]);
        return format!("000#{command:02X}{:02X}", random.pick(&[0u8, 1, 1, 2]));
    }
    let short = random.next() as usize % 9;
    let len = random.pick(&[8, 8, 8, 8, 8, 8, short]);
    let mut bytes: Vec<u8> = (0..8).map(|_| random.next() as u8).collect();
    if id == 0x601 && !random.next().is_multiple_of(8) {
        bytes[0] = random.pick(&[
            0x22, 0x23, 0x27, 0x2B, 0x2F, 0x21, 0x20, 0x40, 0x60, 0x70, 0x00, 0x10, 0x01, 0x80,
            0xA0, 0xA4, 0xA3, 0xA2, 0xA1, 0xC0, 0xC2, 0xC6, 0xC1, 0x81, 0x01, 0x02, 0x03, bytes[0],
        ]);
        let index = random.pick(&[
            0x1000u16, 0x1003, 0x1005, 0x1008, 0x1010, 0x1011, 0x1014, 0x1017, 0x1400, 0x1600,
            0x1800, 0x1801, 0x1A00, 0x2000, 0x2001, 0x2002, 0x2003, 0x2005, 0x2006, 0x3000,
        ]);
        bytes[1..3].copy_from_slice(&index.to_le_bytes());
        bytes[3] = (random.next() % 4) as u8;
        if random.next().is_multiple_of(2) {
            bytes[4..].copy_from_slice(&random.pick(&[*b"save", *b"load", [1, 0, 0, 0], [0; 4]]));
        }
    }
    let data: String = bytes[..len]
        .iter()
        .map(|byte| format!("{byte:02X}"))
        .collect();
    format!("{id:03X}#{data}")
}

#[test]
fn two_hundred_thousand_random_frames() {
    for seed in 1..=4 {
        let mut random = Random(0x9E37_79B9_7F4A_7C15 ^ seed);
        let mut bench = Bench::new();
        bench.power_on();
        for step in 0..50_000 {
            let input = frame(&mut random);
            let stopped = bench.node.state() == State::Stopped;
            let out = bench.send(&input);
            if input.starts_with("602")
                || input.starts_with("7E5")
                || stopped && !input.starts_with("000")
            {
                assert!(
                    out.is_empty(),
                    "seed {seed}, step {step}: {input} -> {out:?}"
                );
            }
            // Each answer must follow an SDO request; segments of a block are answers, too.
            if out.iter().any(|frame| frame.starts_with("581#")) {
                assert!(
                    input.starts_with("601"),
                    "seed {seed}, step {step}: {input} -> {out:?}"
                );
            }
            if random.next().is_multiple_of(16) {
                let millis = random.next() % 40;
                bench.wait(millis);
            }
            let value = bench.value(0x2000, 0);
            assert!(
                (2..=1_000_000).contains(&value),
                "seed {seed}, step {step}: {input} made 2000h {value}"
            );
        }
    }
}
