//! SYNC producer (CiA 301, chapter 7.2.5, and objects 1005h, 1006h, 1019h).

use crate::support::{Bench, Row, rows, unsigned};
use od_model::{Access, DataType};
use od_runtime::{BusEvent, NoApplication};

fn producer(cob_id: u64, period_us: u64, overflow: u64) -> Vec<Row> {
    let mut rows = rows();
    let sync = rows.iter_mut().find(|row| row.0 == 0x1005);
    sync.expect("1005h").5 = unsigned(cob_id);
    rows.extend([
        (
            0x1006,
            0,
            DataType::Unsigned32,
            Access::Rw,
            false,
            unsigned(period_us),
        ),
        (
            0x1019,
            0,
            DataType::Unsigned8,
            Access::Rw,
            false,
            unsigned(overflow),
        ),
    ]);
    rows
}

fn bench(cob_id: u64, period_us: u64, overflow: u64) -> Bench {
    let mut bench = Bench::with(producer(cob_id, period_us, overflow), NoApplication);
    assert_eq!(bench.power_on(), ["701#00"]);
    bench
}

const ON: u64 = 0x4000_0080;

fn frames(ticks: &[(u64, &str)]) -> Vec<(u64, String)> {
    ticks
        .iter()
        .map(|(ms, frame)| (*ms, (*frame).into()))
        .collect()
}

/// Writes a value of `len` bytes. Returns the abort code in the byte order of the bus, or nothing.
fn write(bench: &mut Bench, index: u16, len: u8, value: u32) -> String {
    let place = format!("{:04X}00", index.swap_bytes());
    let command = 0x23 | (4 - len) << 2;
    let answers = bench.send(&format!(
        "601#{command:02X}{place}{:08X}",
        value.swap_bytes()
    ));
    let [answer] = &answers[..] else {
        panic!("{answers:?}");
    };
    let abort = answer.strip_prefix(&format!("581#80{place}"));
    abort.unwrap_or_default().into()
}

const RANGE: &str = "30000906";
const STATE: &str = "22000008";

#[test]
fn sync_is_sent_every_period_in_pre_operational_and_operational() {
    let mut bench = bench(ON, 10_000, 0);
    assert_eq!(bench.wait(25), frames(&[(10, "080#"), (20, "080#")]));
    bench.send("000#0101");
    assert_eq!(bench.wait(10), frames(&[(30, "080#")]));
    // Stopped has no SYNC; the first one follows a period after Stopped.
    bench.send("000#0201");
    assert_eq!(bench.wait(100), []);
    bench.send("000#8001");
    assert_eq!(bench.wait(25), frames(&[(145, "080#"), (155, "080#")]));
    // A reset starts the producer again.
    assert_eq!(bench.send("000#8201"), ["701#00"]);
    assert_eq!(bench.wait(15), frames(&[(170, "080#")]));
}

#[test]
fn each_start_of_the_producer_begins_a_period() {
    let mut bench = bench(0x80, 0, 0);
    assert_eq!(bench.wait(100), []);
    // Bit 30 without a period: the node does not send SYNC yet.
    assert_eq!(write(&mut bench, 0x1005, 4, 0x4000_0080), "");
    assert_eq!(bench.wait(100), []);
    assert_eq!(write(&mut bench, 0x1006, 4, 20_000), "");
    assert_eq!(bench.wait(45), frames(&[(220, "080#"), (240, "080#")]));
    // Writing the same period again changes nothing, another one restarts the producer.
    assert_eq!(write(&mut bench, 0x1006, 4, 20_000), "");
    assert_eq!(bench.wait(20), frames(&[(260, "080#")]));
    assert_eq!(write(&mut bench, 0x1006, 4, 5_000), "");
    assert_eq!(bench.wait(10), frames(&[(270, "080#"), (275, "080#")]));
    assert_eq!(write(&mut bench, 0x1006, 4, 0), "");
    assert_eq!(bench.wait(100), []);
    assert_eq!(write(&mut bench, 0x1006, 4, 5_000), "");
    assert_eq!(write(&mut bench, 0x1005, 4, 0x80), "");
    assert_eq!(bench.wait(100), []);
}

#[test]
fn the_counter_runs_from_1_to_1019h() {
    let mut bench = bench(ON, 1_000, 3);
    let counted = |first: u64, counters: &[u8]| -> Vec<(u64, String)> {
        let each = counters.iter().zip(first..);
        each.map(|(counter, ms)| (ms, format!("080#{counter:02X}")))
            .collect()
    };
    assert_eq!(bench.wait(5), counted(1, &[1, 2, 3, 1, 2]));
    // The counter begins at 1 whenever the producer starts.
    bench.send("000#0201");
    bench.send("000#0101");
    assert_eq!(bench.wait(2), counted(6, &[1, 2]));
    assert_eq!(write(&mut bench, 0x1006, 4, 0), "");
    assert_eq!(write(&mut bench, 0x1019, 1, 2), "");
    assert_eq!(write(&mut bench, 0x1006, 4, 1_000), "");
    assert_eq!(bench.wait(3), counted(8, &[1, 2, 1]));
}

#[test]
fn the_objects_follow_their_rules() {
    let mut bench = bench(0x80, 0, 0);
    for (index, len, value, expected) in [
        (0x1019, 1, 1, RANGE),
        (0x1019, 1, 241, RANGE),
        (0x1019, 1, 255, RANGE),
        (0x1019, 1, 2, ""),
        (0x1019, 1, 240, ""),
        (0x1006, 4, 1_000_000, ""),
        (0x1019, 1, 0, STATE),
        (0x1019, 1, 20, STATE),
        (0x1005, 4, 0x81, ""),
        (0x1005, 4, 0x4000_0081, ""),
        (0x1005, 4, 0x4000_0080, RANGE), // it produces: bits 0 to 29 stay
        (0x1005, 4, 0x6000_0081, RANGE),
        (0x1005, 4, 0x4000_0081, ""),
        (0x1005, 4, 0x81, ""),
        (0x1005, 4, 0x4000_0601, RANGE), // restricted
        (0x1005, 4, 0x4000_0800, RANGE), // 29 bits without bit 29
        (0x1005, 4, 0x6123_4567, ""),
        (0x1006, 4, 0, ""),
        (0x1019, 1, 0, ""),
    ] {
        let found = write(&mut bench, index, len, value);
        assert_eq!(found, expected, "{index:04X}h = {value:X}");
    }
    assert_eq!(write(&mut bench, 0x1006, 4, 7_000), "");
    assert_eq!(bench.wait(7), frames(&[(7, "01234567#")]));
}

#[test]
fn own_pdos_act_on_own_sync() {
    let mut rows = producer(ON, 10_000, 4);
    for (index, sub, value) in [(0x1800, 2, 2), (0x1400, 2, 0)] {
        let row = rows.iter_mut().find(|row| (row.0, row.1) == (index, sub));
        row.expect("a transmission type").5 = unsigned(value);
    }
    let mut bench = Bench::with(rows, NoApplication);
    bench.power_on();
    bench.send("000#0101");
    // RPDO 1 waits for SYNC; TPDO 1 is sent after every second SYNC.
    assert!(bench.send("201#3412").is_empty());
    assert_eq!(bench.value(0x2001, 0), 0xFFFE);
    assert_eq!(bench.wait(10), frames(&[(10, "080#01")]));
    assert_eq!(bench.value(0x2001, 0), 0x1234);
    assert_eq!(
        bench.wait(10),
        frames(&[(20, "080#02"), (20, "181#05000000")])
    );
    assert_eq!(bench.wait(10), frames(&[(30, "080#03")]));
}

#[test]
fn a_bus_off_node_sends_no_sync() {
    let mut bench = bench(ON, 10_000, 0);
    bench.bus(BusEvent::Off);
    assert_eq!(bench.wait(25), []);
    bench.bus(BusEvent::Active);
    assert_eq!(bench.wait(10), frames(&[(30, "080#")]));
}

#[test]
fn without_1006h_bit_30_cannot_be_set() {
    let mut bench = Bench::new();
    bench.power_on();
    assert_eq!(write(&mut bench, 0x1005, 4, 0x4000_0080), RANGE);
}

#[test]
fn a_late_host_gets_one_sync() {
    let mut bench = bench(ON, 10_000, 5);
    assert_eq!(bench.wait(10), frames(&[(10, "080#01")]));
    bench.now = bench.now.plus_millis(35);
    assert_eq!(bench.wait(10), frames(&[(45, "080#02"), (50, "080#03")]));
}
