//! SDO servers besides the default one, and SDO clients (CiA 301, chapters 7.5.2.33 and 7.5.2.34).

use crate::support::{Bench, Row, rows, unsigned};
use od_model::{Access, Address, DataType};
use od_runtime::{Application, Chunk, Context, Halt, NoApplication, SaveAnswer, Stream, StreamEnd};

/// 1201h and 1203h; 1202h is missing.
fn servers() -> Vec<Row> {
    let mut rows = rows();
    for (index, request, response) in [(0x1201, 0x680, 0x6C0), (0x1203, 0x8000_0681, 0x8000_06C2)] {
        rows.extend([
            (
                index,
                0,
                DataType::Unsigned8,
                Access::Const,
                false,
                unsigned(2),
            ),
            (
                index,
                1,
                DataType::Unsigned32,
                Access::Rw,
                false,
                unsigned(request),
            ),
            (
                index,
                2,
                DataType::Unsigned32,
                Access::Rw,
                false,
                unsigned(response),
            ),
        ]);
    }
    rows
}

fn bench() -> Bench {
    let mut bench = Bench::with(servers(), NoApplication);
    bench.power_on();
    bench
}

/// Writes a COB-ID with the default server. Returns the abort code in the byte order of the bus, or
/// nothing.
fn write<A: Application>(bench: &mut Bench<A>, index: u16, sub: u8, value: u32) -> String {
    let place = format!("{:04X}{sub:02X}", index.swap_bytes());
    let answer = bench.ask(&format!("601#23{place}{:08X}", value.swap_bytes()));
    match answer.strip_prefix(&format!("581#80{place}")) {
        Some(code) => code.into(),
        None => String::new(),
    }
}

const RANGE: &str = "30000906";

#[test]
fn each_server_answers_on_its_own_channel() {
    let mut bench = bench();
    assert_eq!(bench.ask("601#4000200000000000"), "581#4300200005000000");
    assert_eq!(bench.ask("680#4000200000000000"), "6C0#4300200005000000");
    assert_eq!(bench.ask("680#4000300000000000"), "6C0#8000300000000206");
    assert!(bench.send("681#4000200000000000").is_empty(), "not valid");
    assert_eq!(write(&mut bench, 0x1203, 1, 0x681), "");
    assert!(
        bench.send("681#4000200000000000").is_empty(),
        "half of it is not valid"
    );
    assert_eq!(
        write(&mut bench, 0x1203, 2, 0x5C1),
        RANGE,
        "581h to 5FFh are restricted"
    );
    assert_eq!(write(&mut bench, 0x1203, 2, 0x6C1), "");
    assert_eq!(bench.ask("681#4000200000000000"), "6C1#4300200005000000");
    // SDO works in Pre-operational and Operational, not in Stopped.
    assert!(bench.send("000#0201").is_empty());
    assert!(bench.send("681#4000200000000000").is_empty());
    bench.send("000#0101");
    assert_eq!(bench.ask("681#4000200000000000"), "6C1#4300200005000000");
}

#[test]
fn transfers_run_side_by_side() {
    let mut bench = bench();
    // 1008h in segments on one, 2002h in segments and then in a block on the other.
    assert_eq!(bench.ask("601#4008100000000000"), "581#4108100011000000");
    assert_eq!(bench.ask("680#2102200009000000"), "6C0#6002200000000000");
    assert_eq!(bench.ask("601#6000000000000000"), "581#006F646B69742074");
    assert_eq!(bench.ask("680#0073696465206279"), "6C0#2000000000000000");
    assert_eq!(bench.ask("601#7000000000000000"), "581#1065737420646576");
    assert_eq!(bench.ask("680#1B20730000000000"), "6C0#3000000000000000");
    assert_eq!(bench.ask("601#6000000000000000"), "581#0969636500000000");
    assert_eq!(bench.ask("680#A402200005000000"), "6C0#C602200009000000");
    assert_eq!(bench.ask("601#4000200000000000"), "581#4300200005000000");
    assert_eq!(
        bench.send("680#A300000000000000"),
        ["6C0#0173696465206279", "6C0#8220730000000000"]
    );
    // A client that stopped is given up on its own channel.
    let abort = (5_000, String::from("6C0#8002200000000405"));
    assert_eq!(bench.wait(6_000), [abort]);
    assert_eq!(bench.ask("680#4000200000000000"), "6C0#4300200005000000");
}

#[test]
fn the_cob_ids_follow_their_rules() {
    let mut bench = bench();
    for (sub, value, expected) in [
        (1, 0x682, RANGE),       // it is valid, and would change
        (1, 0x680, ""),          // it would not
        (1, 0x8000_0682, ""),    // not valid any more, with other bits
        (1, 0x8000_0683, ""),    // not valid any more, so it can change
        (1, 0x0000_0801, RANGE), // bits 11 to 28 belong to a 29-bit CAN-ID
        (1, 0x601, RANGE),       // restricted
        (1, 0x0, RANGE),
        (1, 0x701, RANGE),
        (1, 0x2012_3456, ""), // 29 bits
        (1, 0xA012_3456, ""),
        (1, 0x4000_0683, ""), // assigned dynamically
        (2, 0x6C1, RANGE),
    ] {
        assert_eq!(
            write(&mut bench, 0x1201, sub, value),
            expected,
            "{sub}: {value:X}"
        );
    }
    assert_eq!(bench.ask("683#4000200000000000"), "6C0#4300200005000000");
}

#[test]
fn dynamically_assigned_cob_ids_are_not_saved() {
    let mut bench = bench();
    assert_eq!(write(&mut bench, 0x1203, 1, 0x4000_0690), "");
    assert_eq!(write(&mut bench, 0x1203, 2, 0x6D0), "");
    assert_eq!(bench.ask("690#4000200000000000"), "6D0#4300200005000000");
    assert_eq!(bench.ask("690#2310100173617665"), "6D0#6010100100000000");
    assert_eq!(bench.power_cycle(), ["701#00"]);
    assert!(bench.send("690#4000200000000000").is_empty());
    assert_eq!(bench.ask("601#4003120100000000"), "581#4303120181060080");
    assert_eq!(bench.ask("601#4003120200000000"), "581#43031202D0060000");
}

/// A node with the object of an SDO client, which is not valid.
fn client() -> Bench {
    let mut rows = rows();
    for sub in [1, 2] {
        let off = unsigned(0x8000_0000);
        rows.push((0x1280, sub, DataType::Unsigned32, Access::Rw, false, off));
    }
    let mut bench = Bench::with(rows, NoApplication);
    bench.power_on();
    bench
}

#[test]
fn the_cob_ids_of_a_client_follow_their_rules() {
    let mut bench = client();
    for (sub, value, expected) in [
        (1, 0x602, ""),       // the default SDO of node 2
        (2, 0x582, ""),       // with its response
        (1, 0x603, RANGE),    // it is valid, and would change
        (2, 0x583, RANGE),    // the other one, too
        (1, 0x2602, RANGE),   // each bit from 0 to 29 counts
        (1, 0x602, ""),       // it would not change
        (1, 0x4000_0602, ""), // bit 30 may change
        (1, 0x8000_0602, ""),
        (1, 0x0000_0603, ""),
        (1, 0x8000_0000, ""),
        (1, 0x0, RANGE), // restricted
        (1, 0x701, RANGE),
        (1, 0x801, RANGE), // bits 11 to 28 belong to a 29-bit CAN-ID
        (1, 0x640, ""),
    ] {
        assert_eq!(
            write(&mut bench, 0x1280, sub, value),
            expected,
            "{sub}: {value:X}"
        );
    }
    assert_eq!(bench.ask("601#4080120200000000"), "581#4380120282050000");
}

#[test]
fn a_client_that_was_assigned_dynamically_is_not_saved() {
    let mut bench = client();
    assert_eq!(write(&mut bench, 0x1280, 1, 0x4000_0602), "");
    assert_eq!(write(&mut bench, 0x1280, 2, 0x582), "");
    assert_eq!(bench.ask("601#2310100173617665"), "581#6010100100000000");
    assert_eq!(bench.power_cycle(), ["701#00"]);
    assert_eq!(bench.ask("601#4080120100000000"), "581#4380120100000080");
    assert_eq!(bench.ask("601#4080120200000000"), "581#4380120282050000");
}

#[test]
fn a_channel_that_becomes_not_valid_ends_its_transfer() {
    let mut bench = bench();
    assert_eq!(bench.ask("680#4008100000000000"), "6C0#4108100011000000");
    assert_eq!(bench.ask("680#6000000000000000"), "6C0#006F646B69742074");
    // Written with its own channel, whose response is still sent there.
    assert_eq!(bench.ask("680#2301120180060080"), "6C0#6001120100000000");
    assert_eq!(write(&mut bench, 0x1201, 1, 0x680), "");
    assert_eq!(bench.ask("680#7000000000000000"), "6C0#8000000001000405");
}

#[test]
fn the_number_of_servers_is_that_of_the_dictionary() {
    let bench = bench();
    let dictionary = bench.node.device().tables.dictionary();
    assert_eq!(dictionary.servers(), 3);
}

/// A log of 20 bytes at 2003h, which its application streams.
#[derive(Default)]
struct Log {
    ends: Vec<StreamEnd>,
}

impl Stream for Log {
    fn begin_download(
        &mut self,
        _: &mut Context<'_, '_>,
        _: Address,
        _: Option<u32>,
    ) -> Result<(), Halt> {
        Ok(())
    }

    fn write(&mut self, _: &mut Context<'_, '_>, _: Address, _: Chunk<'_>) -> Result<(), Halt> {
        Ok(())
    }

    fn begin_upload(&mut self, _: &mut Context<'_, '_>, _: Address) -> Result<u32, Halt> {
        Ok(20)
    }

    fn read(
        &mut self,
        _: &mut Context<'_, '_>,
        _: Address,
        at: u32,
        to: &mut [u8],
    ) -> Result<(), Halt> {
        to.fill(at as u8);
        Ok(())
    }

    fn end(&mut self, _: &mut Context<'_, '_>, _: Address, end: StreamEnd) {
        self.ends.push(end);
    }
}

impl Application for Log {
    fn stream(&mut self, address: Address) -> Option<&mut dyn Stream> {
        (address == Address::new(0x2003, 0)).then_some(self as _)
    }
}

#[test]
fn a_stream_is_read_by_one_server_at_a_time() {
    let mut bench = Bench::with(servers(), Log::default());
    bench.power_on();
    assert_eq!(bench.ask("680#4003200000000000"), "6C0#4103200014000000");
    for begin in [
        "601#4003200000000000",
        "601#A003200005000000",
        "601#2103200014000000",
        "601#C203200014000000",
    ] {
        assert_eq!(bench.ask(begin), "581#8003200022000008", "{begin}");
    }
    assert_eq!(bench.ask("680#6000000000000000"), "6C0#0000000000000000");
    // In the other direction, as soon as the stream is free.
    assert!(bench.send("680#8003200000000405").is_empty());
    assert_eq!(bench.ask("601#4003200000000000"), "581#4103200014000000");
    assert_eq!(bench.ask("680#4003200000000000"), "6C0#8003200022000008");
    bench.send("000#0201");
    let cancelled = StreamEnd::Cancelled(0x0504_0000);
    assert_eq!(bench.node.application.ends, [cancelled, StreamEnd::Cut]);
}

#[test]
fn the_response_to_a_save_is_on_the_channel_of_the_request() {
    let mut bench = bench();
    bench.node.device_mut().profile.store.answer = SaveAnswer::AfterStoring;
    bench.hear("680#2310100173617665");
    bench.hear("680#4000200000000000");
    let mut out = bench.drain();
    out.extend(bench.wait(1_000).into_iter().map(|(_, frame)| frame));
    assert_eq!(
        out,
        ["6C0#6010100100000000", "6C0#4300200005000000"],
        "and the request after it"
    );
}

#[test]
fn the_response_to_a_save_with_a_duration_is_on_that_channel_too() {
    let mut bench = bench();
    bench.node.device_mut().profile.store.answer = SaveAnswer::AfterStoring;
    bench.node.device_mut().profile.store.duration_us = 50_000;
    assert!(bench.send("680#2310100173617665").is_empty());
    assert!(bench.send("680#4000200000000000").is_empty(), "after it");
    let frames = ["6C0#6010100100000000", "6C0#4300200005000000"];
    assert_eq!(
        bench.wait(1_000),
        frames.map(|frame| (50, frame.to_owned()))
    );
}
