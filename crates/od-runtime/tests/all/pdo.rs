//! Process data and SYNC (CiA 301, chapters 7.2.2 and 7.2.5).

use crate::support::Bench;
use od_wire::nmt::State;

/// Node 1 in Operational with TPDO 2 and both RPDOs unchanged; `setup` is written before the start.
fn running(setup: &[&str]) -> Bench {
    let mut bench = Bench::new();
    bench.power_on();
    for request in setup {
        let answer = bench.ask(&format!("601#{request}"));
        assert_eq!(&answer[4..6], "60", "{request} -> {answer}");
    }
    // Event-driven PDOs are sent at the start.
    let started = bench.send("000#0101");
    assert!(
        started.iter().all(|frame| frame.contains("81#")),
        "{started:?}"
    );
    bench
}

#[test]
fn the_event_timer_sends_from_one_period_after_the_start() {
    let mut bench = running(&["2B00180564000000"]);
    let frame = "181#05000000".to_string();
    assert_eq!(bench.wait(250), [(100, frame.clone()), (200, frame)]);
    bench.send("000#8001");
    assert!(bench.wait(500).is_empty(), "no PDO in Pre-operational");
}

#[test]
fn an_event_driven_pdo_sends_changes_as_fast_as_the_inhibit_time_allows() {
    let mut bench = running(&["2300180181010080", "2B001803C8000000", "2300180181010000"]);
    bench.wait(20);
    assert_eq!(
        bench.send("601#2300200006000000"),
        ["581#6000200000000000", "181#06000000", "281#06000000"]
    );
    assert_eq!(
        bench.send("601#2300200007000000"),
        ["581#6000200000000000", "281#07000000"]
    );
    assert_eq!(
        bench.wait(50),
        [(40, "181#07000000".into())],
        "200 x 100 us"
    );
    assert_eq!(
        bench.send("601#2300200007000000"),
        ["581#6000200000000000"],
        "no change"
    );
}

#[test]
fn event_driven_pdos_are_sent_at_the_start() {
    let mut bench = Bench::new();
    bench.power_on();
    assert_eq!(bench.send("000#0101"), ["181#05000000", "281#05000000"]);
    bench.send("000#8001");
    bench.node.device_mut().profile.pdo.event_on_change = false;
    assert_eq!(bench.send("000#0101"), [""; 0]);
}

#[test]
fn every_nth_sync_counts_from_the_start() {
    let mut bench = running(&["2F00180203000000"]);
    for round in 0..3 {
        assert!(bench.send("080#").is_empty(), "{round}");
        assert!(bench.send("080#").is_empty(), "{round}");
        assert_eq!(bench.send("080#"), ["181#05000000"], "{round}");
    }
    assert!(bench.send("080#").is_empty());
    bench.send("000#8001");
    assert!(bench.send("080#").is_empty());
    bench.send("000#0101");
    bench.send("080#");
    assert!(bench.send("080#01").is_empty(), "the count starts again");
    assert_eq!(bench.send("080#02"), ["181#05000000"]);
    assert_eq!(
        bench.send("080#0102"),
        ["081#4082110000000000"],
        "two bytes are not a SYNC (CiA 301, table 26: 8240h)"
    );
}

#[test]
fn type_0_sends_changed_values_at_sync() {
    let mut bench = running(&["2F00180200000000", "2301180181020080"]);
    assert_eq!(bench.send("080#"), ["181#05000000"]);
    assert!(bench.send("080#").is_empty());
    bench.send("601#2300200006000000");
    assert_eq!(bench.send("080#"), ["181#06000000"]);
    assert!(bench.send("080#").is_empty());
}

#[test]
fn remote_frames_request_any_type() {
    let mut bench = running(&["2F001802FD000000", "2F011802FC000000"]);
    assert_eq!(bench.send("181#R"), ["181#05000000"]);
    assert_eq!(bench.send("080#"), [""; 0]);
    bench.send("601#2300200006000000");
    assert_eq!(
        bench.send("281#R8"),
        ["281#05000000"],
        "type 252: as the last SYNC saw it"
    );
    assert_eq!(
        bench.send("181#R4"),
        ["181#06000000"],
        "type 253: as it is now"
    );
    assert_eq!(bench.ask("601#2300180181010080"), "581#6000180100000000");
    assert_eq!(bench.ask("601#2300180181010040"), "581#6000180100000000");
    assert!(bench.send("181#R").is_empty(), "bit 30: no remote frames");
}

#[test]
fn a_cob_id_changes_only_while_the_pdo_is_not_valid() {
    let mut bench = running(&[]);
    assert_eq!(bench.ask("601#2300180187010000"), "581#8000180130000906");
    assert_eq!(bench.ask("601#2300180181010080"), "581#6000180100000000");
    assert_eq!(
        bench.ask("601#2300180101060000"),
        "581#8000180130000906",
        "an SDO's COB-ID"
    );
    assert_eq!(
        bench.send("601#2300180187010120"),
        ["581#6000180100000000"],
        "29 bits"
    );
    bench.ask("601#2B00180564000000");
    assert_eq!(bench.wait(100), [(100, "00010187#05000000".into())]);
}

#[test]
fn dynamic_mapping_needs_its_three_steps() {
    let mut bench = running(&["2300180181010080"]);
    assert_eq!(
        bench.ask("601#23001A0110000120"),
        "581#80001A0103000106",
        "sub-index 0 first"
    );
    assert_eq!(bench.ask("601#2F001A0000000000"), "581#60001A0000000000");
    for (entry, code) in [
        ("20000030", "00000206"), // 3000h does not exist
        ("20010020", "11000906"), // 2000h:01 does not exist
        ("20000820", "00000206"), // 2008h does not exist
        ("08000020", "41000406"), // 8 bits of a 32-bit object
        ("08000420", "41000406"), // write only, not mappable
        ("08000500", "41000406"), // a dummy in a TPDO
    ] {
        let answer = bench.ask(&format!("601#23001A01{entry}"));
        assert_eq!(answer, format!("581#80001A01{code}"), "{entry}");
    }
    for (sub, entry) in [("01", "10000120"), ("02", "20000020"), ("03", "40000520")] {
        assert_eq!(&bench.ask(&format!("601#23001A{sub}{entry}"))[4..6], "60");
    }
    assert_eq!(
        bench.ask("601#2F001A0003000000"),
        "581#80001A0042000406",
        "112 bits"
    );
    assert_eq!(bench.ask("601#2F001A0002000000"), "581#60001A0000000000");
    bench.ask("601#2300180181010000");
    assert_eq!(bench.send("601#2B01200001000000")[1], "181#010005000000");
}

#[test]
fn booleans_share_a_byte() {
    let mut bench = running(&[
        "2300180181010080",
        "2F001A0000000000",
        "23001A0101000620",
        "23001A0210000120",
        "2F001A0002000000",
        "2300180181010000",
    ]);
    assert_eq!(
        bench.send("601#2F06200001000000")[1],
        "181#FDFF01",
        "1 bit, then INTEGER16 -2"
    );
}

#[test]
fn an_rpdo_writes_at_once_or_at_sync() {
    let mut bench = running(&["2F01140201000000"]);
    bench.send("201#0700");
    assert_eq!(bench.value(0x2001, 0), 7);
    bench.send("301#0800");
    assert_eq!(bench.value(0x2001, 0), 7);
    bench.send("080#");
    assert_eq!(bench.value(0x2001, 0), 8);
}

#[test]
fn a_short_rpdo_is_an_error_and_a_good_one_ends_it() {
    let mut bench = running(&[]);
    assert_eq!(bench.send("201#07"), ["081#1082110000000000"]);
    assert_eq!(bench.ask("601#4001100000000000"), "581#4F01100011000000");
    assert_eq!(bench.ask("601#4003100100000000"), "581#4303100110820000");
    assert!(bench.send("201#07").is_empty(), "still the same error");
    assert_eq!(bench.send("201#0700"), ["081#0000000000000000"]);
    assert_eq!(bench.ask("601#4001100000000000"), "581#4F01100000000000");
    assert_eq!(bench.ask("601#2F03100000000000"), "581#6003100000000000");
    assert_eq!(bench.ask("601#4003100000000000"), "581#4F03100000000000");
}

#[test]
fn a_29_bit_can_id_of_0_is_valid() {
    let mut bench = running(&[]);
    bench.ask("601#2300140101020080");
    bench.ask("601#2300140100000020");
    bench.send("00000000#0201");
    assert_eq!(bench.value(0x2001, 0), 0x102);
    assert_eq!(bench.node.state(), State::Operational, "not NMT stop");
}

#[test]
fn a_frame_that_waits_for_sync_survives_a_change_of_another_pdo() {
    let mut bench = running(&["2F01140201000000"]);
    bench.send("301#0800");
    bench.ask("601#2B00180564000000");
    bench.send("080#");
    assert_eq!(bench.value(0x2001, 0), 8);
    bench.send("301#0900");
    bench.ask("601#2F011402FE000000");
    bench.send("080#");
    assert_eq!(bench.value(0x2001, 0), 8, "its own change ends the wait");
}

#[test]
fn a_remote_frame_before_the_first_sync_gets_the_current_value() {
    let mut bench = running(&["2F001802FC000000"]);
    bench.send("601#2300200006000000");
    assert_eq!(bench.send("181#R"), ["181#06000000"]);
    bench.send("080#");
    bench.send("601#2300200007000000");
    assert_eq!(bench.send("181#R"), ["181#06000000"], "what SYNC saw");
    bench.send("080#");
    assert_eq!(bench.send("181#R"), ["181#07000000"]);
}

#[test]
fn a_sync_start_value_waits_for_its_counter() {
    let setup = [
        "2300180181010080",
        "2F00180202000000",
        "2F00180603000000",
        "2300180181010000",
    ];
    let mut bench = running(&setup);
    let sent: Vec<_> = [1, 2, 3, 4, 5, 6]
        .map(|counter| bench.send(&format!("080#{counter:02X}")).len())
        .into();
    assert_eq!(sent, [0, 0, 1, 0, 1, 0], "SYNC 3 is the first of the count");
    // Without a counter in SYNC the node cannot wait for one.
    let mut bench = running(&setup);
    assert_eq!(bench.send("080#").len(), 1);
    assert_eq!(bench.send("080#").len(), 0);
}

#[test]
fn a_mapping_of_254_or_255_objects_is_too_long() {
    let mut bench = running(&["2300180181010080", "2F001A0000000000"]);
    for sub in 1..=8 {
        let answer = bench.ask(&format!("601#23001A{sub:02X}08000110"));
        assert_eq!(&answer[4..6], "60", "{answer}");
    }
    for count in [9, 64, 65, 253, 254, 255] {
        let answer = bench.ask(&format!("601#2F001A00{count:02X}000000"));
        assert_eq!(answer, "581#80001A0042000406", "{count}");
    }
    assert_eq!(bench.ask("601#2F001A0008000000"), "581#60001A0000000000");
}
