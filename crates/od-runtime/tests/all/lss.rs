//! LSS slave (CiA 305), with the addresses and tables of the bus-cover manual (000, chapter 4.3.7).

use crate::support::{Bench, rows, unsigned};
use od_model::{Access, Address, DataType};
use od_runtime::{Application, Event, LssProfile, NoApplication, NodeId, Profile, Store};

/// A device that starts with the node ID in 2101h.
struct Device;

impl Application for Device {
    fn node_id(&self, store: &Store<'_>) -> Option<NodeId> {
        NodeId::new(store.unsigned(0x2101, 0) as u8)
    }
}

fn bench(lss: LssProfile) -> Bench<Device> {
    bench_of(lss, Device)
}

fn bench_of<A: Application>(lss: LssProfile, application: A) -> Bench<A> {
    use Access::*;
    use DataType::*;
    let mut all = rows();
    all.extend([
        (0x1018, 0, Unsigned8, Const, false, unsigned(4)),
        (0x1018, 1, Unsigned32, Ro, false, unsigned(0xEC)),
        (0x1018, 2, Unsigned32, Ro, false, unsigned(0x0A)),
        (0x1018, 3, Unsigned32, Ro, false, unsigned(0x0001_0000)),
        (0x1018, 4, Unsigned32, Ro, false, unsigned(0x1234)),
        (0x2100, 0, Unsigned8, Rw, false, unsigned(2)),
        (0x2101, 0, Unsigned8, Rw, false, unsigned(1)),
        (0x2300, 0, Unsigned8, Rw, false, unsigned(7)),
    ]);
    let mut bench = Bench::with(all, application);
    bench.node.device_mut().profile = Profile {
        lss: Some(lss),
        ..Profile::CIA301
    };
    bench.power_on();
    bench.send("000#0201");
    bench
}

const RATES: [Option<u8>; 9] = [
    Some(8),
    Some(7),
    Some(6),
    Some(5),
    Some(4),
    Some(3),
    Some(2),
    None,
    None,
];

const ALL: LssProfile = LssProfile {
    stopped_only: true,
    node_id: Address::new(0x2101, 0),
    bit_rate: Address::new(0x2100, 0),
    bit_rates: RATES,
    identify_remote: true,
    non_configured: true,
    fastscan: true,
    inquire_node_id: true,
    second_delay: false,
    shows_state: true,
};

fn select(bench: &mut Bench<Device>) {
    for frame in ["40EC00000000", "410A00000000", "420000010000"] {
        assert!(bench.send(&format!("7E5#{frame}0000")).is_empty());
    }
    assert_eq!(bench.ask("7E5#4334120000000000"), "7E4#4401000000000000");
}

#[test]
fn only_the_addressed_slave_is_selected() {
    let mut bench = bench(ALL);
    for frame in [
        "40EC00000000",
        "410A00000000",
        "420000010000",
        "433512000000",
    ] {
        assert!(bench.send(&format!("7E5#{frame}0000")).is_empty());
    }
    assert!(
        bench.send("7E5#5E00000000000000").is_empty(),
        "still waiting"
    );
    select(&mut bench);
    assert_eq!(bench.ask("7E5#5A00000000000000"), "7E4#5AEC000000000000");
    assert_eq!(bench.ask("7E5#5B00000000000000"), "7E4#5B0A000000000000");
    assert_eq!(bench.ask("7E5#5C00000000000000"), "7E4#5C00000100000000");
    assert_eq!(bench.ask("7E5#5D00000000000000"), "7E4#5D34120000000000");
    assert_eq!(bench.ask("7E5#5E00000000000000"), "7E4#5E01000000000000");
    assert!(bench.send("7E5#0400000000000000").is_empty());
    assert!(
        bench.send("7E5#5E00000000000000").is_empty(),
        "waiting again"
    );
}

#[test]
fn lss_works_in_stopped_only() {
    let mut bench = bench(ALL);
    bench.send("7E5#0401000000000000");
    assert_eq!(bench.send("7E5#5E00000000000000").len(), 1);
    bench.send("000#8001");
    assert!(bench.send("7E5#5E00000000000000").is_empty());
    bench.send("000#0201");
    assert!(
        bench.send("7E5#5E00000000000000").is_empty(),
        "leaving Stopped leaves configuration"
    );
}

/// The host of this device sets its node ID, although LSS can write 2101h.
#[test]
fn with_objects_a_pending_configuration_is_lost_unless_stored() {
    let mut bench = bench_of(ALL, NoApplication);
    for reset in ["000#8201", "000#8101"] {
        bench.send("000#0201");
        bench.send("7E5#0401000000000000");
        assert_eq!(bench.ask("7E5#1109000000000000"), "7E4#1100000000000000");
        assert_eq!(bench.send(reset), ["701#00"]);
    }
}

#[test]
fn stored_node_id_and_bit_rate_take_effect_at_the_next_start() {
    for stored in [true, false] {
        let mut bench = bench(ALL);
        bench.send("000#8001");
        bench.ask("601#2F00230009000000");
        bench.send("000#0201");
        bench.send("7E5#0401000000000000");
        assert_eq!(bench.ask("7E5#1102000000000000"), "7E4#1100000000000000");
        assert_eq!(bench.ask("7E5#1300030000000000"), "7E4#1300000000000000");
        assert_eq!(
            bench.ask("7E5#5E00000000000000"),
            "7E4#5E02000000000000",
            "pending"
        );
        if stored {
            assert_eq!(bench.ask("7E5#1700000000000000"), "7E4#1700000000000000");
        }
        let boot = bench.send("000#8100");
        let (boot_up, rate) = if stored { ("702#00", 5) } else { ("701#00", 2) };
        assert_eq!(boot, [boot_up]);
        assert_eq!(bench.value(0x2100, 0), rate);
        assert_eq!(bench.value(0x2300, 0), 7, "17h saves nothing else");
    }
}

#[test]
fn a_node_id_that_was_not_saved_is_lost_at_the_next_reset() {
    for reset in ["81", "82"] {
        let mut bench = bench(ALL);
        bench.send("000#8001");
        bench.ask("601#2F01210005000000");
        assert_eq!(bench.send(&format!("000#{reset}01")), ["701#00"]);
        assert_eq!(bench.value(0x2101, 0), 1);
    }
}

#[test]
fn values_out_of_range_have_their_error_codes() {
    let mut bench = bench(ALL);
    bench.send("7E5#0401000000000000");
    for (request, error) in [
        ("1100", "01"),
        ("1180", "01"),
        ("117F", "00"),
        ("11FF", "00"),
        ("130000", "00"),
        ("130006", "00"),
        ("130007", "01"),
        ("130009", "01"),
        ("130100", "01"),
    ] {
        let answer = bench.ask(&format!("7E5#{request:0<16}"));
        assert_eq!(
            answer,
            format!("7E4#{}{error}000000000000", &request[..2]),
            "{request}"
        );
    }
}

#[test]
fn a_bit_rate_is_activated_after_silence() {
    let mut bench = bench(ALL);
    bench.send("000#8001");
    bench.ask("601#2B17100064000000");
    bench.send("000#0201");
    bench.send("7E5#0401000000000000");
    bench.ask("7E5#1300020000000000");
    while bench.node.poll_event().is_some() {}
    assert!(bench.send("7E5#152C010000000000").is_empty());
    assert!(bench.send("7E5#5E00000000000000").is_empty(), "silent");
    let beats = bench.wait(400);
    assert!(beats.iter().all(|(at, _)| *at >= 300), "{beats:?}");
    assert_eq!(bench.node.poll_event(), Some(Event::BitRate(6)));
    assert_eq!(bench.send("7E5#5E00000000000000").len(), 1);
}

#[test]
fn ranges_identify_this_slave() {
    let ask = |low: &str, high: &str| {
        let mut bench = bench(ALL);
        let mut out = Vec::new();
        for frame in [
            "46EC000000",
            "470A000000",
            "4800000000",
            "49FFFFFFFF",
            low,
            high,
        ] {
            out.extend(bench.send(&format!("7E5#{frame}000000")));
        }
        out
    };
    assert_eq!(ask("4A34120000", "4B34120000"), ["7E4#4F00000000000000"]);
    assert!(ask("4A35120000", "4BFFFFFFFF").is_empty());
    assert!(ask("4A00000000", "4B33120000").is_empty());
}

#[test]
fn slaves_with_ffh_are_non_configured() {
    let mut bench = bench(ALL);
    assert!(bench.send("7E5#4C00000000000000").is_empty());
    bench.send("7E5#0401000000000000");
    bench.ask("7E5#11FF000000000000");
    assert_eq!(bench.ask("7E5#4C00000000000000"), "7E4#5000000000000000");
}

#[test]
fn services_that_a_family_lacks_have_no_response() {
    let less = LssProfile {
        identify_remote: false,
        non_configured: false,
        fastscan: false,
        inquire_node_id: false,
        ..ALL
    };
    let mut bench = bench(less);
    bench.send("7E5#0401000000000000");
    for request in [
        "5100000000800000",
        "5E00000000000000",
        "4C00000000000000",
        "FF00000000000000",
    ] {
        assert!(
            bench.send(&format!("7E5#{request}")).is_empty(),
            "{request}"
        );
    }
    bench.send("7E5#0400000000000000");
    for step in [
        "46EC000000",
        "470A000000",
        "4800000000",
        "49FFFFFFFF",
        "4A00000000",
        "4BFFFFFFFF",
    ] {
        assert!(
            bench.send(&format!("7E5#{step}000000")).is_empty(),
            "{step}"
        );
    }
    assert!(bench.send("7E5#040100").is_empty() && bench.send("7E5#R8").is_empty());
}

#[test]
fn fastscan_does_not_find_a_slave_twice() {
    let mut bench = bench(ALL);
    let begin = "7E5#5100000000800000";
    assert_eq!(bench.ask(begin), "7E4#4F00000000000000");
    bench.send("7E5#0401000000000000");
    assert!(bench.send(begin).is_empty(), "in configuration state");
    bench.send("7E5#0400000000000000");
    assert_eq!(bench.ask(begin), "7E4#4F00000000000000");
}

#[test]
fn a_family_may_be_silent_for_two_switch_delays() {
    let two = LssProfile {
        second_delay: true,
        ..ALL
    };
    let mut bench = bench(two);
    bench.send("7E5#0401000000000000");
    bench.ask("7E5#1300020000000000");
    while bench.node.poll_event().is_some() {}
    bench.send("7E5#150A000000000000");
    bench.wait(9);
    assert_eq!(bench.node.poll_event(), None);
    bench.wait(1);
    assert_eq!(bench.node.poll_event(), Some(Event::BitRate(6)));
    assert!(
        bench.send("7E5#5E00000000000000").is_empty(),
        "still silent"
    );
    bench.wait(10);
    assert_eq!(bench.ask("7E5#5E00000000000000"), "7E4#5E01000000000000");
}

/// CiA 305 reserves byte 1 of the response; two manuals show the state there (MANUALS.md C-GX-40).
#[test]
fn a_family_without_a_state_in_the_response_sends_0() {
    let mut bench = bench(LssProfile {
        shows_state: false,
        ..ALL
    });
    for frame in ["40EC00000000", "410A00000000", "420000010000"] {
        assert!(bench.send(&format!("7E5#{frame}0000")).is_empty());
    }
    assert_eq!(bench.ask("7E5#4334120000000000"), "7E4#4400000000000000");
}
