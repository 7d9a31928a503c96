//! Time and starts: manual 001 objects 2120h and 6508h, manual 003 chapter 5.1.12.

use odkit::Event;
use odkit::encoder::Switches;

use crate::bench::{Bench, SAVE};

#[test]
fn eam_has_a_time_stamp_and_no_operating_time() {
    let mut bench = Bench::new("eam_mt");
    assert_eq!(bench.read(0x6508, 0), 0xFFFF_FFFF);
    bench.wait(65);
    assert_eq!(bench.read(0x2120, 0), 65_000);
    bench.wait(1);
    assert_eq!(bench.read(0x2120, 0), 66_000 - 65_536);
    assert_eq!(bench.read(0x2122, 0), 0);
    bench.wait(3_600_000);
    assert_eq!(bench.read(0x6508, 0), 0xFFFF_FFFF);
}

#[test]
fn en_counts_seconds_tenths_of_hours_and_starts() {
    let mut bench = Bench::new("en580c");
    let life = |bench: &mut Bench| {
        [(0x2A00, 1), (0x2A00, 2), (0x2A01, 0), (0x6508, 0)].map(|(i, s)| bench.read(i, s))
    };
    assert_eq!(life(&mut bench), [0, 0, 1, 0]);
    bench.wait(719_999);
    assert_eq!(life(&mut bench), [719, 719, 1, 1]);
    bench.wait(1);
    assert_eq!(life(&mut bench), [720, 720, 1, 2]);
    bench.power_cycle(600_000, 0);
    // Power was switched off two seconds later.
    assert_eq!(life(&mut bench), [0, 722, 2, 2]);
    bench.wait(10_000);
    bench.nmt(0x81);
    let [current, total, cycles, _] = life(&mut bench);
    assert!(current <= 1, "{current}");
    assert_eq!(
        (total - current, cycles),
        (732, 2),
        "a reset is not a power-on"
    );
    bench
        .write(0x1011, 1, u32::from_le_bytes(*b"load"))
        .unwrap();
    bench.power_cycle(1, 0);
    assert_eq!(bench.read(0x2A01, 0), 3);
}

#[test]
fn en_switches_take_precedence_if_their_bit_rate_exists() {
    let mut bench = Bench::new("en580c");
    for (node_id, bit_rate, expected) in [
        (0, 7, 250),
        (1, 0, 250),
        (1, 1, 250),
        (1, 2, 50),
        (1, 3, 125),
        (1, 4, 250),
        (1, 5, 500),
        (1, 6, 800),
        (1, 7, 1000),
    ] {
        bench
            .node
            .application
            .set_switches(Switches { node_id, bit_rate });
        bench.power_cycle(1, 0);
        assert_eq!(
            bench.node.application.bit_rate(),
            Some(expected),
            "{node_id} {bit_rate}"
        );
    }
}

#[test]
fn eam_has_no_switches() {
    let mut bench = Bench::new("eam_mt");
    bench.node.application.set_switches(Switches {
        node_id: 9,
        bit_rate: 7,
    });
    bench.power_cycle(1, 0);
    assert_eq!(bench.read(0x2101, 0), 1);
    assert_eq!(bench.node.application.bit_rate(), Some(50));
}

/// MANUALS.md U-40: the node tells its host that an NMT reset interrupted a save, and what it loaded.
#[test]
fn a_save_that_a_reset_interrupts_is_reported() {
    for command in [0x81, 0x82] {
        let mut bench = Bench::new("en580c");
        bench.write(0x2300, 1, 11).unwrap();
        bench.write(0x1010, 1, SAVE).unwrap();
        bench.wait(1_000);
        bench.write(0x1010, 1, SAVE).unwrap();
        bench.events();
        bench.nmt(command);
        let cuts = |events: Vec<Event>| {
            let is_cut = |event: &Event| matches!(event, Event::SaveCut { .. });
            events.into_iter().filter(is_cut).collect::<Vec<_>>()
        };
        assert_eq!(cuts(bench.events()), [Event::SaveCut { factory: true }]);
        // A complete save causes no event.
        bench.write(0x1010, 1, SAVE).unwrap();
        bench.wait(1_000);
        bench.nmt(command);
        assert_eq!(cuts(bench.events()), []);
    }
}
