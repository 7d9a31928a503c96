//! Events for a host, and objects that a node reads again after a write.

use crate::support::{Bench, rows, unsigned};
use od_model::{Access, DataType};
use od_runtime::{NoApplication, Restore};
use od_wire::nmt::State;

fn bench() -> Bench {
    use Access::{Const, Rw};
    use DataType::{Unsigned8, Unsigned16, Unsigned32};
    let mut rows = rows();
    let heartbeat = rows.iter_mut().find(|row| row.0 == 0x1017);
    heartbeat.expect("1017h").5 = unsigned(100);
    rows.extend([
        (0x1006, 0, Unsigned32, Rw, false, unsigned(0)),
        (0x1012, 0, Unsigned32, Rw, false, unsigned(0x8000_0100)),
        (0x1016, 0, Unsigned8, Const, false, unsigned(1)),
        (0x1016, 1, Unsigned32, Rw, false, unsigned(0x0005_0064)),
        (0x1029, 0, Unsigned8, Const, false, unsigned(1)),
        (0x1029, 1, Unsigned8, Rw, false, unsigned(0)),
        (0x2110, 0, Unsigned16, Rw, false, unsigned(0)),
    ]);
    let mut bench = Bench::with(rows, NoApplication);
    bench.node.device_mut().profile.pdo.event_on_change = false;
    bench.power_on();
    bench
}

fn ids(bench: &mut Bench) -> Option<Vec<u32>> {
    let ids = bench.node.poll_wanted_ids()?;
    let mut ids: Vec<u32> = ids.map(|id| id.raw()).collect();
    ids.sort_unstable();
    ids.dedup();
    Some(ids)
}

#[test]
fn a_host_learns_of_changed_can_ids() {
    let mut bench = bench();
    let first = ids(&mut bench).expect("power came");
    assert_eq!(
        first,
        [
            0, 0x80, 0x100, 0x181, 0x201, 0x281, 0x301, 0x601, 0x701, 0x705
        ]
    );
    assert_eq!(ids(&mut bench), None, "once");
    for (request, is_news) in [
        ("2300200006000000", false),
        ("2B17106400000000", false),
        ("2B10210001000000", false),
        ("2F29100101000000", false),
        ("2306100000000000", true),
        ("2312100000010000", true),
        ("2316100164000600", true),
        ("2300180181010080", true),
        ("2301140101030080", true),
        ("2305100081000000", true),
    ] {
        let answer = bench.ask(&format!("601#{request}"));
        if request != "2B17106400000000" {
            assert_eq!(&answer[4..6], "60", "{request} {answer}");
        }
        assert_eq!(ids(&mut bench).is_some(), is_news, "{request}");
    }
    let last = ids(&mut bench);
    assert_eq!(last, None);
    bench.send("000#8201");
    assert!(ids(&mut bench).is_some(), "a reset");
}

#[test]
fn after_an_immediate_restore_services_read_their_objects_again() {
    let mut bench = bench();
    bench.node.device_mut().profile.store.restore = Restore::AtOnce;
    for request in [
        "2B17100000000000",
        "2316100100000000",
        "2305100090000000",
        "2F00180201000000",
    ] {
        assert_eq!(&bench.ask(&format!("601#{request}"))[4..6], "60");
    }
    assert_eq!(bench.wait(300), [], "no heartbeat");
    bench.send("705#05");
    bench.wait(300);
    assert_eq!(bench.ask("601#231110016C6F6164"), "581#6011100100000000");
    assert_eq!(bench.value(0x1017, 0), 100);
    bench.send("000#0101");
    bench.send("705#05");
    let sent = bench.wait(150);
    assert!(sent.iter().any(|(_, frame)| frame == "701#05"), "{sent:?}");
    assert_eq!(bench.node.state(), State::PreOperational, "node 5 is lost");
}

#[test]
fn inhibit_time_and_sync_start_value_change_only_while_the_pdo_is_not_valid() {
    const DONE: &str = "60";
    let mut bench = bench();
    for (request, answer) in [
        ("2B00180364000000", "581#8000180330000906"),
        ("2F00180603000000", "581#8000180630000906"),
        ("2B00180300000000", DONE), // the value that it has
        ("2F00180600000000", DONE),
        ("2300180181010080", DONE),
        ("2B00180364000000", DONE),
        ("2F001806F0000000", DONE),
        ("2F001806F1000000", "581#8000180630000906"), // 241 is not a counter of SYNC
    ] {
        let got = bench.ask(&format!("601#{request}"));
        let got = if answer == DONE { &got[4..6] } else { &got };
        assert_eq!(got, answer, "{request}");
    }
    bench.node.device_mut().profile.pdo.direct_cob_id = true;
    bench.ask("601#2300180181010000");
    assert_eq!(bench.ask("601#2B00180365000000"), "581#6000180300000000");
    let mut rows = rows();
    rows.retain(|row| (row.0, row.1) != (0x1800, 1));
    let mut bench = Bench::with(rows, NoApplication);
    bench.power_on();
    let answer = bench.ask("601#2B00180364000000");
    assert_eq!(
        answer, "581#6000180300000000",
        "without a COB-ID it sends none"
    );
}

#[test]
fn an_rpdo_may_skip_bits_and_a_tpdo_may_not() {
    const DONE: &str = "60";
    let mut bench = bench();
    for request in [
        "2300140101020080",
        "2300180181010080",
        "2F00160000000000",
        "2F001A0000000000",
    ] {
        assert_eq!(&bench.ask(&format!("601#{request}"))[4..6], DONE);
    }
    for (request, answer) in [
        ("2300160108000500", DONE), // UNSIGNED8
        ("2300160110000600", DONE),
        ("2300160120000700", DONE),
        ("2300160101000100", DONE), // BOOLEAN
        ("2300160110000500", "80"), // the wrong length
        ("2300160108000800", "80"), // no such dummy
        ("2300160108010500", "80"), // sub-index 1
        ("23001A0108000500", "80"),
        ("2300160110000120", DONE),
        ("2300160120000120", "80"),
        ("2300160120000020", DONE),
        ("23001A0120000020", DONE),
        ("23001A0120000010", "80"), // not mappable
    ] {
        let got = bench.ask(&format!("601#{request}"));
        assert_eq!(&got[4..6], answer, "{request} {got}");
    }
}

#[test]
fn a_new_period_of_sync_keeps_the_counter() {
    let mut rows = rows();
    let sync = rows.iter_mut().find(|row| row.0 == 0x1005);
    sync.expect("1005h").5 = unsigned(0x4000_0080);
    rows.extend([
        (
            0x1006,
            0,
            DataType::Unsigned32,
            Access::Rw,
            false,
            unsigned(100_000),
        ),
        (
            0x1019,
            0,
            DataType::Unsigned8,
            Access::Rw,
            false,
            unsigned(10),
        ),
    ]);
    let mut bench = Bench::with(rows, NoApplication);
    bench.power_on();
    assert_eq!(bench.wait(200).len(), 2);
    bench.ask("601#2306100050C30000");
    assert_eq!(bench.wait(60), [(250, "080#03".to_owned())]);
    bench.ask("601#2306100000000000");
    assert_eq!(bench.wait(500), []);
    bench.ask("601#2306100050C30000");
    assert_eq!(bench.wait(60), [(810, "080#01".to_owned())]);
}
