//! NMT states, boot-up and heartbeat (CiA 301, chapters 7.2.8 and 7.3.2).

use crate::support::Bench;
use od_runtime::Instant;
use od_wire::nmt::State;

#[test]
fn a_node_boots_up_into_pre_operational() {
    let mut bench = Bench::new();
    assert_eq!(
        bench.send("601#4000100000000000"),
        [""; 0],
        "no power, no answer"
    );
    assert_eq!(bench.power_on(), ["701#00"]);
    assert_eq!(bench.node.state(), State::PreOperational);
    assert!(!bench.node.may_transmit(), "all is out");
}

#[test]
fn without_power_nothing_is_sent_and_nothing_is_due() {
    let mut bench = Bench::new();
    bench.power_on();
    bench.ask("601#2B17100064000000"); // a heartbeat every 100 ms
    bench.hear("601#2300200009000000"); // its response was not sent yet
    bench.node.power_off();
    assert!(!bench.node.may_transmit());
    assert_eq!(bench.drain(), [""; 0]);
    assert_eq!(bench.node.poll_timeout(), None);
    assert_eq!(bench.wait(1000), []);
}

#[test]
fn every_command_from_every_state_to_this_node_and_to_all() {
    let commands = [
        ("01", State::Operational),
        ("02", State::Stopped),
        ("80", State::PreOperational),
        ("81", State::PreOperational),
        ("82", State::PreOperational),
    ];
    for node in ["01", "00"] {
        for (from, _) in commands {
            for (command, state) in commands {
                let mut bench = Bench::new();
                bench.node.device_mut().profile.pdo.event_on_change = false;
                bench.power_on();
                bench.send(&format!("000#{from}{node}"));
                let out = bench.send(&format!("000#{command}{node}"));
                assert_eq!(bench.node.state(), state, "{from} then {command}");
                let boots: &[&str] = if command > "80" { &["701#00"] } else { &[] };
                assert_eq!(out, boots, "{from} then {command}");
            }
        }
    }
}

#[test]
fn commands_for_other_nodes_and_broken_commands_are_ignored() {
    let mut bench = Bench::new();
    bench.power_on();
    for frame in [
        "000#0102",
        "000#01",
        "000#010100",
        "000#0501",
        "000#",
        "000#R2",
    ] {
        assert!(bench.send(frame).is_empty());
        assert_eq!(bench.node.state(), State::PreOperational, "{frame}");
    }
}

#[test]
fn in_stopped_only_nmt_and_heartbeat_work() {
    let mut bench = Bench::new();
    bench.power_on();
    assert_eq!(bench.ask("601#2B17100064000000"), "581#6017100000000000");
    bench.send("000#0201");
    assert!(bench.send("601#4000100000000000").is_empty());
    assert_eq!(
        bench.wait(250),
        [(100, "701#04".into()), (200, "701#04".into())]
    );
}

#[test]
fn heartbeat_follows_1017h_at_once() {
    let mut bench = Bench::new();
    bench.power_on();
    assert!(bench.wait(1000).is_empty());
    bench.ask("601#2B17100064000000");
    assert_eq!(
        bench.wait(200),
        [(1100, "701#7F".into()), (1200, "701#7F".into())]
    );
    bench.send("000#0101");
    assert_eq!(bench.wait(100), [(1300, "701#05".into())]);
    bench.ask("601#2B17100000000000");
    assert!(bench.wait(1000).is_empty());
}

#[test]
fn reset_communication_restores_only_the_communication_objects() {
    let mut bench = Bench::new();
    bench.power_on();
    bench.ask("601#2B17100064000000");
    bench.ask("601#2300200009000000");
    bench.send("000#8201");
    assert_eq!((bench.value(0x1017, 0), bench.value(0x2000, 0)), (0, 9));
    bench.send("000#8101");
    assert_eq!(bench.value(0x2000, 0), 5);
}

#[test]
fn saved_values_are_loaded_until_a_restore() {
    let mut bench = Bench::new();
    bench.power_on();
    bench.ask("601#2300200009000000");
    assert_eq!(
        bench.ask("601#2310100100000000"),
        "581#8010100120000008",
        "wrong signature"
    );
    assert_eq!(bench.ask("601#2310100173617665"), "581#6010100100000000");
    bench.ask("601#230020000A000000");
    bench.node.power_off();
    bench.power_on();
    assert_eq!(bench.value(0x2000, 0), 9);
    assert_eq!(bench.ask("601#231110016C6F6164"), "581#6011100100000000");
    assert_eq!(
        bench.value(0x2000, 0),
        9,
        "CiA 301: defaults act after the reset"
    );
    bench.send("000#8101");
    assert_eq!(bench.value(0x2000, 0), 5);
}

#[test]
fn nothing_is_due_at_the_last_instant() {
    let mut bench = Bench::new();
    bench.power_on();
    bench.ask("601#2B17100064000000");
    bench.send("000#0101");
    bench.now = Instant::MAX;
    // A host at this time is not called without end.
    let late = bench.wait(0);
    assert_eq!(late.len(), 1, "{late:?}");
    assert_eq!(late[0].1, "701#05");
    assert_eq!(bench.node.poll_timeout(), None);
}
