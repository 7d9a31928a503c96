//! The trace of manual 000, chapter 6.4: a gxmm with node ID 1 whose sensor rests at 79592h.
//!
//! Values that the print has lost are restored as in MANUALS.md C-GX-52.

use od_devices::find;
use odkit::storage::{Memory, image};
use odkit::{CanId, Frame, Instant, Node, NodeId};

/// Frames of the bus in order: CAN-ID, data, and `<` if the encoder sends it.
const TRACE: &str = "
701 < 00
601 > 40026000          581 < 4302600000000020
601 > 2202600000000010  581 < 6002600000000000
601 > 40016000          581 < 4301600000200000
601 > 2201600000100000  581 < 6001600000000000
601 > 40046000          581 < 43046000C9CA0300
601 > 2203600000000000  581 < 6003600000000000
601 > 4000620000        581 < 4B00620003020000
601 > 2B00620005000000  581 < 6000620000000000
601 > 40012100          581 < 4F01210001000000
601 > 2B01210002000000  581 < 6001210000000000
601 > 4000210000000000  581 < 4F00210002000000
601 > 2B00210005000000  581 < 6000210000000000
601 > 2310100173617665  581 < 6010100100000000
601 > 231110016C6F6164  581 < 6011100100000000
601 > 4003650000000000  581 < 4B03650000000000
601 > 4005650000000000  581 < 4B05650000000000
000 > 0101
181 < 92950700
181 < 92950700
000 > 8001
000 > 0201
000 > 8101
701 < 00
";

#[test]
fn every_response_is_the_printed_one() {
    let kind = find("gxmm").unwrap();
    let storage = Memory::new(vec![0xFF; image::capacity_needed(&kind.dictionary)]);
    let mut encoder = crate::bench::encoder(kind);
    encoder
        .shaft
        .set_raw(Instant::ZERO, encoder.sensor(), 0x7_9592);
    let mut node = Node::new(*kind, NodeId::ONE, encoder, storage);
    let mut now = Instant::ZERO;
    node.power_on(now);
    let mut words = TRACE.split_whitespace();
    while let (Some(id), Some(direction), Some(hex)) = (words.next(), words.next(), words.next()) {
        let id = CanId::standard(u16::from_str_radix(id, 16).unwrap());
        let data: Vec<u8> = (0..hex.len() / 2)
            .map(|at| u8::from_str_radix(&hex[2 * at..2 * at + 2], 16).unwrap())
            .collect();
        let frame = Frame::new(id, &data).unwrap();
        if direction == ">" {
            assert_eq!(node.poll_transmit(now), None, "before {frame:?}");
            node.handle_frame(now, &frame);
            continue;
        }
        // A PDO is sent when its time has come.
        let sent = loop {
            match (node.poll_transmit(now), node.poll_timeout()) {
                (Some(sent), _) => break sent,
                (None, Some(next)) => now = next,
                (None, None) => panic!("silence where {frame:?} is due"),
            }
            node.handle_timeout(now);
        };
        assert_eq!(sent, frame, "at {now:?}");
    }
    assert_eq!(now, Instant::from_millis(2 * 0x203), "PDOs of 1800h:05");
}
