//! Monitoring of PDOs and SYNC of other nodes: deadlines of RPDOs (CiA 301, object 1400h, sub-index
//! 5) and the length of SYNC (object 1019h); and the node's own event timer (chapter 7.2.2.3).

use crate::support::{Bench, Row, rows, unsigned};
use od_model::{Access, DataType};
use od_runtime::{EventTimer, NoApplication};

const LATE: &str = "081#5082110000000000";
const LENGTH: &str = "081#4082110000000000";
const OVER: &str = "081#0000000000000000";

fn operational(more: Vec<Row>) -> Bench {
    let mut all = rows();
    all.extend(more);
    let mut bench = Bench::with(all, NoApplication);
    bench.node.device_mut().profile.pdo.event_on_change = false;
    bench.power_on();
    bench.send("000#0101");
    bench
}

/// RPDO 1 is late 20 ms after its last frame.
fn watched() -> Bench {
    use Access::Rw;
    operational(vec![
        (0x1400, 5, DataType::Unsigned16, Rw, false, unsigned(20)),
        (0x1401, 5, DataType::Unsigned16, Rw, false, unsigned(0)),
    ])
}

#[test]
fn an_rpdo_is_monitored_from_its_first_frame_on() {
    let mut bench = watched();
    assert!(bench.wait(100).is_empty(), "no frame has come yet");
    bench.send("201#0700");
    assert!(bench.wait(19).is_empty());
    bench.send("201#0700");
    assert_eq!(bench.wait(100), [(139, LATE.into())], "once");
    // Frames of the other RPDO do not end the error.
    assert!(bench.send("301#0700").is_empty());
    assert_eq!(bench.send("201#0800"), [OVER]);
    assert_eq!(bench.value(0x2001, 0), 8);
    assert_eq!(bench.wait(100), [(239, LATE.into())]);
}

#[test]
fn an_rpdo_is_not_monitored_outside_operational_or_without_a_time() {
    let mut bench = watched();
    bench.send("201#0700");
    bench.send("000#8001");
    assert!(bench.wait(100).is_empty(), "Pre-operational");
    bench.send("000#0101");
    assert!(bench.wait(100).is_empty(), "no frame since");
    bench.send("201#0700");
    bench.ask("601#2B00140500000000");
    assert!(bench.wait(100).is_empty(), "1400h:05 is 0");
    // A frame that is too short does not count (8210h).
    bench.ask("601#2B00140514000000");
    assert_eq!(bench.send("201#07"), ["081#1082110000000000"]);
    assert!(bench.wait(100).is_empty());
}

#[test]
fn the_length_of_sync_is_that_of_1019h() {
    let with = |overflow| {
        let row = (
            0x1019,
            0,
            DataType::Unsigned8,
            Access::Rw,
            false,
            unsigned(overflow),
        );
        operational(vec![row])
    };
    for (overflow, right, wrong) in [(0, "080#", "080#01"), (10, "080#01", "080#")] {
        let mut bench = with(overflow);
        assert!(bench.send(right).is_empty(), "{overflow}");
        assert_eq!(bench.send(wrong), [LENGTH], "{overflow}");
        assert!(bench.send(wrong).is_empty(), "it is active already");
        assert_eq!(bench.send(right), [OVER]);
    }
    // Without 1019h the node does not know whether SYNC has a counter, and two bytes are never
    // right.
    let mut bench = operational(Vec::new());
    assert!(bench.send("080#").is_empty() && bench.send("080#05").is_empty());
    assert_eq!(bench.send("080#0000"), [LENGTH]);
    // A family whose manual accepts any length.
    let mut bench = with(0);
    bench.node.device_mut().profile.errors.watches_sync_length = false;
    assert!(bench.send("080#01").is_empty());
}

#[test]
fn an_rpdo_that_is_not_monitored_any_more_is_not_late() {
    let mut bench = watched();
    bench.send("201#0700");
    assert_eq!(bench.wait(100), [(20, LATE.into())]);
    // 1400h:05 = 0
    assert_eq!(
        bench.send("601#2B00140500000000"),
        ["581#6000140500000000", OVER]
    );
}

#[test]
fn a_host_that_is_late_does_not_shift_the_event_timer() {
    let mut bench = operational(Vec::new());
    bench.ask("601#2B00180564000000");
    let mut sent = Vec::new();
    for _ in 0..3 {
        let due = bench.node.poll_timeout().expect("the event timer runs");
        bench.now = due.plus_millis(7);
        bench.node.handle_timeout(bench.now);
        sent.push((due.as_micros() / 1000, bench.drain().len()));
    }
    assert_eq!(sent, [(100, 1), (200, 1), (300, 1)]);
}

#[test]
fn the_event_timer_elapses_after_the_last_transmission() {
    for (timer, expected) in [
        (EventTimer::SinceTransmission, [130, 230]),
        (EventTimer::Cyclic, [100, 200]),
    ] {
        let mut bench = operational(Vec::new());
        bench.node.device_mut().profile.pdo.event_timer = timer;
        bench.ask("601#2B00180564000000");
        // A remote frame is another event in between.
        assert!(bench.wait(30).is_empty());
        assert_eq!(bench.send("181#R").len(), 1);
        let sent = bench.wait(210);
        let moments: Vec<u64> = sent.iter().map(|(at, _)| *at).collect();
        assert_eq!(moments, expected, "{timer:?}");
    }
}
