//! LSS slave of a device without objects for node ID and bit rate (CiA 305 in full; MANUALS.md U-43).

use crate::support::{Bench, rows, unsigned};
use od_model::{Access, DataType};
use od_runtime::storage::{Memory, image};
use od_runtime::{Event, LssProfile, NoApplication, NodeId, Profile};

/// A device that starts with this node ID, and has another saved value besides those of LSS.
fn bench(node_id: Option<NodeId>) -> Bench<NoApplication> {
    use Access::*;
    use DataType::*;
    let mut all = rows();
    all.extend([
        (0x1018, 0, Unsigned8, Const, false, unsigned(4)),
        (0x1018, 1, Unsigned32, Ro, false, unsigned(0xEC)),
        (0x1018, 2, Unsigned32, Ro, false, unsigned(0x0A)),
        (0x1018, 3, Unsigned32, Ro, false, unsigned(0x0001_0000)),
        (0x1018, 4, Unsigned32, Ro, false, unsigned(0x1234)),
    ]);
    let mut bench = Bench::with(all, NoApplication);
    bench.node.device_mut().profile = Profile {
        lss: Some(LssProfile::CIA305),
        ..Profile::CIA301
    };
    let capacity =
        image::capacity_needed(&bench.node.device().tables.dictionary()) + image::OWN_CAPACITY;
    bench.node.storage = Memory::new(vec![0xFF; capacity]);
    bench.node.set_node_id(node_id);
    bench
}

const CONFIGURATION: &str = "7E5#0401000000000000";
const WAITING: &str = "7E5#0400000000000000";
const NON_CONFIGURED: &str = "7E5#4C00000000000000";
const ANYBODY: &str = "7E5#5100000000800000";

#[test]
fn without_a_node_id_only_lss_works() {
    let mut bench = bench(None);
    assert!(bench.power_on().is_empty(), "no boot-up message");
    assert!(!bench.node.is_configured());
    for frame in [
        "000#0100",
        "000#8200",
        "601#4000100000000000",
        "67F#4000100000000000",
        "701#R",
        "77F#R",
        "080#",
    ] {
        assert!(bench.send(frame).is_empty(), "{frame}");
    }
    bench.wait(60_000);
    assert_eq!(bench.ask(NON_CONFIGURED), "7E4#5000000000000000");
    assert_eq!(bench.ask(ANYBODY), "7E4#4F00000000000000");
    bench.send(CONFIGURATION);
    assert_eq!(bench.ask("7E5#5E00000000000000"), "7E4#5EFF000000000000");
}

#[test]
fn a_slave_with_a_new_node_id_starts_in_the_waiting_state() {
    let mut bench = bench(None);
    bench.power_on();
    bench.send(CONFIGURATION);
    assert_eq!(bench.ask("7E5#1105000000000000"), "7E4#1100000000000000");
    assert!(bench.send("605#4000100000000000").is_empty(), "not yet");
    assert_eq!(bench.ask(WAITING), "705#00");
    assert_eq!(bench.ask("605#4000100000000000"), "585#4300100096010200");
    // It has a node ID now, so a scan for slaves without one does not find it.
    assert!(bench.send(NON_CONFIGURED).is_empty());
    assert!(bench.send(ANYBODY).is_empty());
    // A value that was not stored is lost without power.
    bench.node.power_off();
    assert!(bench.power_on().is_empty());
    assert!(!bench.node.is_configured());
}

#[test]
fn a_stored_node_id_survives_a_power_cycle_and_a_restore() {
    let mut bench = bench(None);
    bench.power_on();
    bench.send(CONFIGURATION);
    bench.ask("7E5#1105000000000000");
    bench.ask("7E5#1300030000000000");
    assert_eq!(bench.ask("7E5#1700000000000000"), "7E4#1700000000000000");
    bench.ask(WAITING);
    bench.ask("605#2300200007000000");
    bench.ask("605#2310100173617665");
    while bench.node.poll_event().is_some() {}
    bench.node.power_off();
    assert_eq!(bench.power_on(), ["705#00"]);
    let events: Vec<_> = std::iter::from_fn(|| bench.node.poll_event()).collect();
    assert!(events.contains(&Event::BitRate(3)), "{events:?}");
    assert_eq!(bench.ask("605#4000200000000000"), "585#4300200007000000");
    // 1011h restores objects, not the values of LSS.
    assert_eq!(bench.ask("605#231110016C6F6164"), "585#6011100100000000");
    assert_eq!(bench.ask("000#8105"), "705#00");
    assert_eq!(bench.ask("605#4000200000000000"), "585#4300200005000000");
}

#[test]
fn ffh_makes_a_slave_unconfigured_again() {
    let mut bench = bench(NodeId::new(7));
    assert_eq!(bench.power_on(), ["707#00"]);
    // LSS works in every NMT state (U-43).
    for command in ["000#0107", "000#8007", "000#0207"] {
        bench.send(command);
        bench.send(CONFIGURATION);
        assert_eq!(bench.ask("7E5#5E00000000000000"), "7E4#5E07000000000000");
        bench.send(WAITING);
    }
    bench.send(CONFIGURATION);
    assert_eq!(bench.ask("7E5#11FF000000000000"), "7E4#1100000000000000");
    assert_eq!(bench.ask("7E5#1180000000000000"), "7E4#1101000000000000");
    assert_eq!(bench.ask("7E5#1700000000000000"), "7E4#1700000000000000");
    bench.send(WAITING);
    assert!(bench.send(NON_CONFIGURED).is_empty(), "it still has its ID");
    assert!(bench.send("000#8107").is_empty());
    assert_eq!(bench.ask(NON_CONFIGURED), "7E4#5000000000000000");
    bench.node.power_off();
    assert!(bench.power_on().is_empty(), "stored");
}

#[test]
fn reset_communication_makes_the_pending_node_id_the_active_one() {
    let mut bench = bench(NodeId::new(7));
    bench.power_on();
    bench.send(CONFIGURATION);
    bench.ask("7E5#1108000000000000");
    bench.send(WAITING);
    assert_eq!(bench.ask("607#4000100000000000"), "587#4300100096010200");
    assert_eq!(bench.ask("000#8207"), "708#00");
    assert_eq!(bench.ask("000#8108"), "707#00", "it was not stored");
}

#[test]
fn the_configuration_state_survives_nmt_commands() {
    let mut bench = bench(NodeId::new(7));
    bench.power_on();
    bench.send(CONFIGURATION);
    for command in ["000#0207", "000#0107", "000#8007", "000#0207", "000#8007"] {
        bench.send(command);
        assert_eq!(bench.ask("7E5#5E00000000000000"), "7E4#5E07000000000000");
    }
}

#[test]
fn only_the_last_stored_values_are_kept() {
    let mut bench = bench(NodeId::new(7));
    bench.power_on();
    for next in 10..20 {
        bench.send(CONFIGURATION);
        bench.ask(&format!("7E5#11{next:02X}000000000000"));
        bench.ask(&format!("7E5#1300{:02X}0000000000", next % 7));
        // There is room for exactly two records of each.
        assert_eq!(bench.ask("7E5#1700000000000000"), "7E4#1700000000000000");
        bench.node.power_off();
        assert_eq!(bench.power_on(), [format!("7{next:02X}#00")]);
    }
}
