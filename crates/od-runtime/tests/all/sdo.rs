//! SDO server (CiA 301, chapter 7.2.4.3).

use crate::support::Bench;
use od_wire::sdo::crc16;

fn bench() -> Bench {
    let mut bench = Bench::new();
    bench.power_on();
    bench
}

#[test]
fn expedited_uploads_and_downloads_of_every_length() {
    let mut bench = bench();
    assert_eq!(bench.ask("601#4000100000000000"), "581#4300100096010200");
    assert_eq!(bench.ask("601#4001100000000000"), "581#4F01100000000000");
    assert_eq!(bench.ask("601#4001200000000000"), "581#4B012000FEFF0000");
    assert_eq!(bench.ask("601#2300200040420F00"), "581#6000200000000000");
    assert_eq!(
        bench.ask("601#2200200003000000"),
        "581#6000200000000000",
        "size not indicated"
    );
    assert_eq!(bench.ask("601#4000200000000000"), "581#4300200003000000");
    assert_eq!(bench.ask("601#2F06200001000000"), "581#6006200000000000");
}

#[test]
fn each_abort_code_has_a_request() {
    let mut bench = bench();
    for (request, code) in [
        ("4000300000000000", "00000206"), // the object does not exist
        ("4000200100000000", "11000906"), // the sub-index does not exist
        ("4004200000000000", "01000106"), // write only
        ("2300100000000000", "02000106"), // read only
        ("2308100000000000", "02000106"), // const
        ("2B00200000000000", "13000706"), // too short
        ("2301200000000000", "12000706"), // too long
        ("2300200041420F00", "31000906"), // above the upper limit
        ("2300200001000000", "32000906"), // below the lower limit
        ("2F06200002000000", "30000906"), // BOOLEAN 2
        ("2F03100001000000", "30000906"), // only 0 clears 1003h
        ("4003100100000000", "24000008"), // no error logged
        ("E000200000000000", "01000405"), // unknown command
        ("6000000000000000", "01000405"), // segment without a transfer
    ] {
        let answer = bench.ask(&format!("601#{request}"));
        assert_eq!(
            answer,
            format!("581#80{}{code}", &request[2..8]),
            "{request}"
        );
    }
    assert!(
        bench.send("601#8000200000000000").is_empty(),
        "an abort is not answered"
    );
    assert!(
        bench.send("601#40002000").is_empty(),
        "eight bytes, CiA 301 says"
    );
}

#[test]
fn segmented_upload_of_a_string() {
    let mut bench = bench();
    assert_eq!(bench.ask("601#4008100000000000"), "581#4108100011000000");
    assert_eq!(bench.ask("601#6000000000000000"), "581#006F646B69742074");
    assert_eq!(bench.ask("601#7000000000000000"), "581#1065737420646576");
    assert_eq!(bench.ask("601#6000000000000000"), "581#0969636500000000");
    assert_eq!(
        bench.ask("601#7000000000000000"),
        "581#8000000001000405",
        "the transfer is over"
    );
}

#[test]
fn a_toggle_bit_that_does_not_change_ends_the_transfer() {
    let mut bench = bench();
    bench.ask("601#4008100000000000");
    bench.ask("601#6000000000000000");
    assert_eq!(bench.ask("601#6000000000000000"), "581#8008100000000305");
}

#[test]
fn segmented_download_is_all_or_nothing() {
    let mut bench = bench();
    assert_eq!(bench.ask("601#2102200009000000"), "581#6002200000000000");
    assert_eq!(bench.ask("601#0061626364656667"), "581#2000000000000000");
    // A new request replaces the transfer, and the old value is unchanged.
    assert_eq!(bench.ask("601#4002200000000000"), "581#4102200005000000");
    assert_eq!(bench.ask("601#6000000000000000"), "581#0568656C6C6F0000");
    bench.ask("601#2102200009000000");
    bench.ask("601#0061626364656667");
    assert_eq!(bench.ask("601#1B68690000000000"), "581#3000000000000000");
    assert_eq!(bench.ask("601#4002200000000000"), "581#4102200009000000");
    // The string has room for 64 bytes, so 65 do not fit.
    assert_eq!(bench.ask("601#2102200041000000"), "581#8002200012000706");
    // Fewer bytes than announced.
    bench.ask("601#2102200009000000");
    assert_eq!(bench.ask("601#0161626364656667"), "581#8002200013000706");
}

#[test]
fn a_64_bit_number_goes_in_segments() {
    let mut bench = bench();
    assert_eq!(bench.ask("601#4005200000000000"), "581#4105200008000000");
    assert_eq!(bench.ask("601#6000000000000000"), "581#0008070605040302");
    assert_eq!(bench.ask("601#7000000000000000"), "581#1D01000000000000");
}

/// Downloads `data` into 2003h by blocks; the segment at `lost` is lost once.
fn block_download(bench: &mut Bench, data: &[u8], lost: Option<u8>) {
    let len = data.len() as u32;
    let [a, b, c, d] = len.to_le_bytes();
    let begun = bench.ask(&format!("601#C6032000{a:02X}{b:02X}{c:02X}{d:02X}"));
    assert_eq!(begun, "581#A403200049000000", "512 bytes are 73 segments");
    let mut lost = lost;
    let (mut done, mut size) = (0, 73u8);
    while done < data.len() {
        let mut answer = Vec::new();
        for (i, chunk) in data[done..].chunks(7).take(size.into()).enumerate() {
            let sequence = i as u8 + 1;
            let last = done + (i + 1) * 7 >= data.len();
            if lost == Some(sequence) {
                lost = None;
                continue;
            }
            let mut frame = format!("601#{:02X}", sequence | if last { 0x80 } else { 0 });
            (0..7).for_each(|i| frame += &format!("{:02X}", chunk.get(i).unwrap_or(&0)));
            answer = bench.send(&frame);
        }
        let answer = answer.pop().expect("the block's end is answered");
        let ack = u8::from_str_radix(&answer[6..8], 16).expect("hex");
        size = u8::from_str_radix(&answer[8..10], 16).expect("hex");
        done = (done + usize::from(ack) * 7).min(data.len());
    }
    let crc = crc16(data).to_le_bytes();
    let unused = (7 - data.len() % 7) % 7;
    let end = format!(
        "601#{:02X}{:02X}{:02X}0000000000",
        0xC1 | unused << 2,
        crc[0],
        crc[1]
    );
    assert_eq!(bench.ask(&end), "581#A100000000000000");
}

/// Uploads 2003h by blocks of `size`.
fn block_upload(bench: &mut Bench, size: u8) -> Vec<u8> {
    let begun = bench.ask(&format!("601#A4032000{size:02X}000000"));
    assert_eq!(&begun[..12], "581#C6032000");
    let mut frames = bench.send("601#A300000000000000");
    let mut data = Vec::new();
    loop {
        assert!(frames.len() <= usize::from(size));
        for frame in &frames {
            let bytes: Vec<u8> = (0..8)
                .map(|i| u8::from_str_radix(&frame[4 + 2 * i..6 + 2 * i], 16).unwrap())
                .collect();
            data.extend_from_slice(&bytes[1..]);
        }
        let ack = frames.len();
        frames = bench.send(&format!("601#A2{ack:02X}{size:02X}0000000000"));
        if let [end] = &frames[..] {
            let head = u8::from_str_radix(&end[4..6], 16).unwrap();
            if head & 0xE3 == 0xC1 {
                data.truncate(data.len() - usize::from(head >> 2 & 7));
                let crc = crc16(&data).to_le_bytes();
                assert_eq!(end[6..10], format!("{:02X}{:02X}", crc[0], crc[1]));
                assert!(bench.send("601#A100000000000000").is_empty());
                return data;
            }
        }
    }
}

#[test]
fn block_transfers_both_ways_at_awkward_lengths() {
    for len in [1, 6, 7, 8, 13, 14, 15, 100, 497, 504, 505, 511] {
        let mut bench = bench();
        let data: Vec<u8> = (0..len).map(|i| (i * 31 % 251) as u8).collect();
        block_download(&mut bench, &data, None);
        for size in [1, 2, 5, 127] {
            assert_eq!(
                block_upload(&mut bench, size),
                data,
                "{len} bytes, blocks of {size}"
            );
        }
    }
}

#[test]
fn a_lost_segment_is_sent_again() {
    for lost in [1, 5, 14] {
        let mut bench = bench();
        let data: Vec<u8> = (0..100).collect();
        block_download(&mut bench, &data, Some(lost));
        assert_eq!(block_upload(&mut bench, 127), data);
    }
}

#[test]
fn block_faults_have_their_codes() {
    let mut bench = bench();
    assert_eq!(
        bench.ask("601#A403200000000000"),
        "581#8003200002000405",
        "block size 0"
    );
    assert_eq!(
        bench.ask("601#A403200080000000"),
        "581#8003200002000405",
        "block size 128"
    );
    bench.ask("601#C603200007000000");
    bench.send("601#8101020304050607");
    assert_eq!(
        bench.ask("601#C1FFFF0000000000"),
        "581#8003200004000405",
        "checksum"
    );
    assert_eq!(bench.value(0x2003, 0), 0, "nothing was written");
    bench.ask("601#C603200007000000");
    assert_eq!(
        bench.ask("601#4A01020304050607"),
        "581#8003200003000405",
        "sequence number 74"
    );
    bench.ask("601#C603200007000000");
    assert_eq!(
        bench.wait(6000),
        [(5000, "581#8003200000000405".into())],
        "the client is gone"
    );
    assert_eq!(bench.ask("601#4000100000000000"), "581#4300100096010200");
}

#[test]
fn three_bytes_go_expedited_both_ways() {
    let mut bench = bench();
    assert_eq!(bench.ask("601#2702200061626300"), "581#6002200000000000");
    assert_eq!(bench.ask("601#4002200000000000"), "581#4702200061626300");
    // Bytes beyond the end of the frame were not given.
    bench.node.device_mut().profile.sdo.min_dlc = 4;
    assert_eq!(bench.ask("601#27022000414243"), "581#6002200000000000");
    assert_eq!(bench.ask("601#270220007172"), "581#8002200013000706");
    assert_eq!(bench.ask("601#4002200000000000"), "581#4702200041424300");
}

#[test]
fn unsupported_transfers_are_unknown_commands() {
    let mut bench = bench();
    bench.node.device_mut().profile.sdo.block = false;
    assert_eq!(bench.ask("601#A40320007F000000"), "581#8003200001000405");
    assert_eq!(bench.ask("601#C603200007000000"), "581#8003200001000405");
    // No block has begun, so this is a segment without a transfer.
    assert_eq!(bench.ask("601#0101020304050607"), "581#8001020301000405");
    assert_eq!(bench.ask("601#2102200003000000"), "581#6002200000000000");
    bench.node.device_mut().profile.sdo.segmented_download = false;
    assert_eq!(bench.ask("601#2102200003000000"), "581#8002200001000405");
    assert_eq!(bench.ask("601#0961626300000000"), "581#8061626301000405");
    assert_eq!(bench.ask("601#2702200061626300"), "581#6002200000000000");
}

#[test]
fn the_end_of_a_block_upload_is_sent_last() {
    for before in [&[][..], &["A300000000000000"]] {
        let mut bench = bench();
        bench.ask("601#A40220007F000000");
        for request in before {
            assert_eq!(bench.send(&format!("601#{request}")).len(), 1);
        }
        assert_eq!(bench.ask("601#A100000000000000"), "581#8002200001000405");
    }
}

#[test]
fn the_length_of_a_text_in_an_expedited_download() {
    for (request, text) in [
        ("2302200061626364", "581#4302200061626364"), // 4 bytes
        ("2702200061626364", "581#4702200061626300"), // 3
        ("2F02200061626364", "581#4F02200061000000"), // 1
        ("2202200061626364", "581#4302200061626364"), // no size: all bytes
    ] {
        let mut bench = Bench::new();
        bench.power_on();
        let answer = bench.ask(&format!("601#{request}"));
        assert_eq!(answer, "581#6002200000000000", "{request}");
        assert_eq!(bench.ask("601#4002200000000000"), text, "{request}");
    }
}

#[test]
fn ignored_bytes_may_be_missing() {
    let mut bench = Bench::new();
    bench.node.device_mut().profile.sdo.length.too_long = None;
    bench.node.device_mut().profile.sdo.min_dlc = 4;
    bench.power_on();
    // Four bytes for an UNSIGNED8, and one for an INTEGER16.
    assert_eq!(bench.ask("601#2304200007"), "581#6004200000000000");
    assert_eq!(bench.value(0x2004, 0), 7);
    assert!(bench.ask("601#2301200007").starts_with("581#80"));
    assert_eq!(bench.value(0x2001, 0), 0xFFFE);
}
