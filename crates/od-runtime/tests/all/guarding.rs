//! Node guarding, heartbeat consumer, error behaviour (CiA 301, chapter 7.2.8, object 1029h).

use crate::support::{Bench, rows, unsigned};
use od_model::{Access, DataType};
use od_runtime::{NoApplication, Profile};
use od_wire::nmt::State;

/// Node 1 with 100Ch, 100Dh, 1016h of two entries, and 1029h:01 with this value.
fn bench(behaviour: u64) -> Bench {
    use Access::*;
    use DataType::*;
    let mut all = rows();
    all.extend([
        (0x100C, 0, Unsigned16, Rw, false, unsigned(0)),
        (0x100D, 0, Unsigned8, Rw, false, unsigned(0)),
        (0x1016, 0, Unsigned8, Const, false, unsigned(2)),
        (0x1016, 1, Unsigned32, Rw, false, unsigned(0)),
        (0x1016, 2, Unsigned32, Rw, false, unsigned(0)),
        (0x1029, 0, Unsigned8, Const, false, unsigned(1)),
        (0x1029, 1, Unsigned8, Rw, false, unsigned(behaviour)),
        (0x2110, 0, Unsigned32, Rw, false, unsigned(8)),
    ]);
    let mut bench = Bench::with(all, NoApplication);
    bench.node.device_mut().profile.pdo.event_on_change = false;
    bench.power_on();
    bench
}

#[test]
fn guarding_answers_toggle_from_0_with_any_dlc_in_any_state() {
    let mut bench = bench(1);
    assert_eq!(bench.send("701#R"), ["701#7F"]);
    assert_eq!(bench.send("701#R1"), ["701#FF"]);
    bench.send("000#0101");
    assert_eq!(bench.send("701#R8"), ["701#05"]);
    bench.send("000#0201");
    assert_eq!(bench.send("701#R"), ["701#84"]);
    assert!(bench.send("702#R").is_empty(), "another node");
    bench.send("000#8201");
    assert_eq!(bench.send("701#R"), ["701#7F"], "reset: from 0 again");
}

#[test]
fn heartbeat_has_priority_over_guarding() {
    let mut bench = bench(1);
    bench.ask("601#2B17100064000000");
    assert!(bench.send("701#R").is_empty());
    bench.ask("601#2B17100000000000");
    assert_eq!(bench.send("701#R"), ["701#7F"]);
}

#[test]
fn a_family_may_have_a_switch_for_guarding() {
    let mut bench = bench(1);
    bench.node.device_mut().profile = Profile {
        guarding_switch: Some((0x2110, 0x20)),
        ..bench.node.device_mut().profile
    };
    bench.send("000#8101");
    bench.ask("601#2B17100064000000");
    assert!(bench.send("701#R").is_empty());
    bench.ask("601#2310210028000000");
    assert_eq!(bench.send("701#R"), ["701#7F"]);
    assert!(bench.wait(500).is_empty(), "no heartbeat beside it");
    bench.ask("601#2310210008000000");
    assert_eq!(bench.wait(100), [(600, "701#7F".into())]);
}

#[test]
fn a_guarding_master_that_stops_is_lost_after_its_life_time() {
    let mut bench = bench(1);
    bench.ask("601#2B0C100064000000");
    bench.ask("601#2F0D100003000000");
    assert!(
        bench.wait(1000).is_empty(),
        "it begins with the first request"
    );
    bench.send("701#R");
    bench.wait(299);
    bench.send("701#R");
    assert_eq!(bench.wait(1000), [(1599, "081#3081110000000000".into())]);
    assert_eq!(bench.ask("601#4003100100000000"), "581#4303100130810000");
    let back = bench.send("701#R");
    assert_eq!(back, ["701#7F", "081#0000000000000000"]);
    bench.ask("601#2B0C100000000000");
    assert!(bench.wait(1000).is_empty(), "guard time 0");
}

#[test]
fn a_node_whose_heartbeat_stops_is_lost() {
    let mut bench = bench(1);
    bench.ask("601#2316100164000500");
    bench.ask("601#23161002C8000600");
    assert!(
        bench.wait(1000).is_empty(),
        "it begins with the first heartbeat"
    );
    bench.send("705#00");
    bench.send("706#05");
    bench.wait(90);
    bench.send("705#7F");
    assert_eq!(
        bench.wait(500),
        [(1190, "081#3081110000000000".into())],
        "node 5; node 6 adds nothing"
    );
    assert!(bench.send("705#05").is_empty(), "node 6 is still lost");
    assert_eq!(bench.send("706#05"), ["081#0000000000000000"]);
    bench.ask("601#2316100100000000");
    bench.ask("601#2316100200000000");
    assert!(bench.wait(1000).is_empty(), "nobody is watched any more");
}

#[test]
fn the_reaction_of_1029h_in_each_state() {
    use State::*;
    for (behaviour, from, to) in [
        (0, Operational, PreOperational),
        (0, PreOperational, PreOperational),
        (0, Stopped, Stopped),
        (1, Operational, Operational),
        (2, Operational, Stopped),
        (2, PreOperational, Stopped),
        (3, Operational, PreOperational),
    ] {
        let mut bench = bench(behaviour);
        bench.ask("601#2316100164000500");
        bench.send("705#05");
        let command = match from {
            Operational => "01",
            Stopped => "02",
            _ => "80",
        };
        bench.send(&format!("000#{command}01"));
        let out = bench.wait(200);
        assert_eq!(bench.node.state(), to, "1029h:01 = {behaviour} from {from}");
        let boots = out.iter().filter(|(_, frame)| frame == "701#00").count();
        assert_eq!(boots, usize::from(behaviour == 3));
    }
}

#[test]
fn the_reaction_repeats_with_nmt_start_while_the_error_lasts() {
    let mut bench = bench(0);
    bench.ask("601#2316100164000500");
    bench.send("705#05");
    bench.send("000#0101");
    bench.wait(200);
    bench.send("000#0101");
    assert_eq!(bench.node.state(), State::PreOperational);
    bench.send("705#05");
    bench.send("000#0101");
    assert_eq!(bench.node.state(), State::Operational);
}

#[test]
fn a_node_has_one_heartbeat_time() {
    let mut bench = bench(1);
    bench.ask("601#23161001C8000500");
    assert_eq!(
        bench.ask("601#2316100264000500"),
        "581#8016100243000406",
        "CiA 301, chapter 7.5.2.13: 06040043h"
    );
    // Time 0 monitors no node; another entry may name another node, and an entry may be written
    // again.
    for (sub, value) in [(2, "00000500"), (2, "64000600"), (1, "64000500")] {
        let answer = bench.ask(&format!("601#231610{sub:02X}{value}"));
        assert_eq!(answer, format!("581#601610{sub:02X}00000000"));
    }
}

#[test]
fn reserved_bits_of_1016h_are_not_part_of_the_node_id() {
    let mut bench = bench(1);
    assert_eq!(bench.ask("601#2316100164000501"), "581#6016100100000000");
    for (value, answer) in [
        ("64000500", "581#8016100243000406"),
        ("64000502", "581#8016100243000406"),
        ("C8000500", "581#8016100243000406"),
        ("00000500", "581#6016100200000000"),
        ("64000600", "581#6016100200000000"),
        ("64000000", "581#6016100200000000"),
        ("64008000", "581#6016100200000000"),
        ("64007F00", "581#6016100200000000"),
    ] {
        assert_eq!(bench.ask(&format!("601#23161002{value}")), answer);
    }
}
