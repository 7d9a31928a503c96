//! Reports of the CAN controller: warning, passive, bus-off, overrun (CiA 301, table 26;
//! manual 001, table 9.5; 2110h bit 3 of all three manuals).

use crate::support::{Bench, rows, unsigned};
use od_model::{Access, DataType};
use od_runtime::{
    BusEvent, BusOffProfile, ErrorProfile, ErrorReset, Event, NoApplication, Notice, Profile,
};
use od_wire::nmt::State;

const fn notice(code: u16, register: u8) -> Option<Notice> {
    Some(Notice { code, register })
}

/// The errors of manual 001: one bit for all errors of the bus, three sub-indices of 1029h.
const MANUAL_001: ErrorProfile = ErrorProfile {
    lost: Notice {
        code: 0x8130,
        register: 0,
    },
    bus_warning: notice(0x8100, 0x10),
    bus_passive: notice(0x8120, 0x10),
    bus_off: 0x10,
    bus_recovered: None,
    watches_sync_length: false,
    overrun: notice(0x8110, 0x10),
    reset: ErrorReset::LastError,
    behaviour: &[(0x10, 1), (0x01, 2), (0x08, 3)],
    operational_only: true,
    off: BusOffProfile {
        restart: Some((0x2110, 8)),
        boots: true,
        behaviour_if_off: true,
    },
};

/// The errors of manual 000.
const MANUAL_000: ErrorProfile = ErrorProfile {
    bus_passive: None,
    bus_recovered: None,
    behaviour: &[(0x10, 1)],
    off: BusOffProfile {
        restart: Some((0x2110, 8)),
        boots: false,
        behaviour_if_off: false,
    },
    ..Profile::CIA301.errors
};

/// Node 1 with 1029h:01 = `behaviour`, 2110h = `options` and TPDO 1 every 100 ms.
fn bench(errors: ErrorProfile, behaviour: u64, options: u64) -> Bench {
    use Access::*;
    use DataType::*;
    let mut all = rows();
    all.extend([
        (0x1029, 0, Unsigned8, Const, false, unsigned(3)),
        (0x1029, 1, Unsigned8, Rw, false, unsigned(behaviour)),
        (0x1029, 2, Unsigned8, Rw, false, unsigned(1)),
        (0x1029, 3, Unsigned8, Rw, false, unsigned(1)),
        (0x2110, 0, Unsigned16, Rw, false, unsigned(options)),
    ]);
    let mut bench = Bench::with(all, NoApplication);
    bench.node.device_mut().profile.pdo.event_on_change = false;
    bench.node.device_mut().profile.errors = errors;
    bench.node.device_mut().profile.nmt.reset_communication_us = 5_000;
    bench.power_on();
    bench.ask("601#2B00180564000000");
    bench.send("000#0101");
    bench
}

fn events(bench: &mut Bench) -> Vec<Event> {
    std::iter::from_fn(|| bench.node.poll_event()).collect()
}

#[test]
fn warning_and_passive_begin_and_end_as_in_manual_001() {
    let mut bench = bench(MANUAL_001, 1, 8);
    assert_eq!(bench.bus(BusEvent::Warning), ["081#0081100000000000"]);
    assert!(bench.bus(BusEvent::Warning).is_empty(), "no news");
    assert_eq!(bench.bus(BusEvent::Passive), ["081#2081100000000000"]);
    assert_eq!(bench.value(0x1001, 0), 0x10);
    assert!(
        bench.bus(BusEvent::Warning).is_empty(),
        "an error reset when no more errors are present"
    );
    assert_eq!(bench.bus(BusEvent::Active), ["081#0000000000000000"]);
    assert_eq!(bench.value(0x1001, 0), 0);
    assert_eq!(bench.value(0x1003, 1), 0x8120);
    assert_eq!(bench.value(0x1003, 2), 0x8100);
}

#[test]
fn an_overrun_lasts_until_the_controller_is_active() {
    let mut bench = bench(MANUAL_001, 1, 8);
    assert_eq!(bench.bus(BusEvent::Overrun), ["081#1081100000000000"]);
    assert!(bench.bus(BusEvent::Overrun).is_empty());
    assert_eq!(bench.bus(BusEvent::Active), ["081#0000000000000000"]);
}

#[test]
fn a_family_without_codes_for_these_states_sends_nothing() {
    let mut bench = bench(MANUAL_000, 0, 8);
    assert!(bench.bus(BusEvent::Warning).is_empty());
    assert!(bench.bus(BusEvent::Passive).is_empty());
    assert_eq!(bench.value(0x1001, 0), 0);
    assert_eq!(bench.bus(BusEvent::Overrun), ["081#1081110000000000"]);
    assert_eq!(
        bench.node.state(),
        State::PreOperational,
        "1029h:01 = 0, and bit 4 became set"
    );
}

#[test]
fn a_node_is_silent_in_bus_off() {
    let mut bench = bench(MANUAL_000, 1, 8);
    events(&mut bench);
    assert!(bench.bus(BusEvent::Off).is_empty());
    assert!(bench.node.is_bus_off());
    assert_eq!(bench.value(0x1001, 0), 0x11);
    assert!(bench.send("601#4000100000000000").is_empty());
    assert!(bench.send("000#8201").is_empty());
    assert!(bench.wait(1_000).is_empty());
    assert_eq!(
        bench.node.poll_timeout(),
        None,
        "there is nothing to wake for"
    );
    assert!(bench.bus(BusEvent::Warning).is_empty());
    assert!(bench.node.is_bus_off(), "that is not the way back");
    assert!(bench.bus(BusEvent::Active).is_empty(), "no boot-up");
    assert_eq!(bench.value(0x1001, 0), 0);
    assert_eq!(bench.node.state(), State::Operational);
    assert_eq!(
        bench.wait(100),
        [(1_100, "181#05000000".to_owned())],
        "a period after it came back"
    );
    assert_eq!(
        events(&mut bench),
        [Event::BusOff { restarts: true }, Event::BusOn]
    );
}

#[test]
fn without_the_option_the_device_stays_off_until_a_power_cycle() {
    let mut bench = bench(MANUAL_000, 1, 0);
    bench.bus(BusEvent::Off);
    bench.bus(BusEvent::Active);
    assert!(bench.node.is_bus_off());
    assert!(bench.send("601#4000100000000000").is_empty());
    assert_eq!(bench.power_cycle(), ["701#00"]);
    assert!(!bench.node.is_bus_off());
    assert_eq!(bench.ask("601#4001100000000000"), "581#4F01100000000000");
}

#[test]
fn bus_off_is_a_communication_error_to_1029h() {
    for (value, state) in [
        (0, State::PreOperational),
        (1, State::Operational),
        (2, State::Stopped),
    ] {
        let mut bench = bench(MANUAL_000, value, 8);
        bench.bus(BusEvent::Off);
        assert_eq!(bench.node.state(), state, "{value}");
        bench.bus(BusEvent::Active);
        assert_eq!(bench.node.state(), state, "{value}");
    }
    let mut bench = bench(MANUAL_000, 3, 0);
    assert_eq!(
        bench.bus(BusEvent::Off),
        ["701#00"],
        "reset node restarts the CAN controller"
    );
}

#[test]
fn in_manual_001_the_device_restarts_or_does_what_1029h_says() {
    let mut restarting = bench(MANUAL_001, 2, 8);
    restarting.ask("601#2B17100020030000");
    restarting.bus(BusEvent::Off);
    assert_eq!(
        restarting.node.state(),
        State::Operational,
        "1029h is for a device that does not restart"
    );
    assert!(restarting.bus(BusEvent::Active).is_empty());
    assert_eq!(restarting.wait(5), [(5, "701#00".to_owned())]);
    assert_eq!(restarting.node.state(), State::PreOperational);
    assert_eq!(restarting.value(0x1017, 0), 0, "it was not saved");

    let mut staying = bench(MANUAL_001, 2, 0);
    staying.bus(BusEvent::Off);
    assert_eq!(staying.node.state(), State::Stopped);
    staying.bus(BusEvent::Active);
    assert!(staying.node.is_bus_off());
}

#[test]
fn cia_301_reports_the_end_of_bus_off() {
    let mut bench = bench(Profile::CIA301.errors, 1, 0);
    bench.bus(BusEvent::Off);
    assert_eq!(
        bench.bus(BusEvent::Active),
        ["081#4081110000000000", "081#0000000000000000"]
    );
}

#[test]
fn reset_communication_restarts_the_controller() {
    let mut bench = bench(MANUAL_001, 1, 8);
    bench.bus(BusEvent::Passive);
    bench.send("000#8201");
    assert_eq!(bench.wait(5), [(5, "701#00".to_owned())]);
    assert_eq!(bench.value(0x1001, 0), 0);
    assert_eq!(
        bench.bus(BusEvent::Passive),
        ["081#2081100000000000"],
        "it is news again"
    );
}

#[test]
fn an_error_of_the_bus_that_improves_ends() {
    let mut bench = bench(MANUAL_001, 1, 8);
    events(&mut bench);
    bench.bus(BusEvent::Passive);
    assert!(matches!(events(&mut bench)[..], [Event::Error(error)] if error.code == 0x8120));
    bench.bus(BusEvent::Warning);
    assert_eq!(events(&mut bench), [Event::ErrorCleared(0x8120)]);
    bench.bus(BusEvent::Passive);
    assert!(matches!(events(&mut bench)[..], [Event::Error(error)] if error.code == 0x8120));
    bench.bus(BusEvent::Overrun);
    bench.bus(BusEvent::Active);
    let cleared = [0x8110, 0x8120].map(Event::ErrorCleared);
    let mut events = events(&mut bench);
    events.retain(|event| cleared.contains(event));
    assert_eq!(events.len(), 2);
}

#[test]
fn reset_communication_ends_only_communication_errors() {
    use od_runtime::Emcy;
    let after = |codes: &[(u16, u8)]| {
        let mut errors = MANUAL_001;
        errors.bus_recovered = notice(0x8140, 0x10);
        errors.behaviour = &[];
        let mut bench = bench(errors, 1, 8);
        for (code, register) in codes {
            let (code, register, info) = (*code, *register, [0; 5]);
            let error = Emcy {
                code,
                register,
                info,
            };
            assert!(bench.node.raise(bench.now, error));
        }
        bench.send("000#8201");
        bench.wait(5);
        bench.value(0x1001, 0)
    };
    for code in [
        0x8130, 0x8100, 0x8120, 0x8110, 0x8140, 0x8210, 0x8240, 0x8250,
    ] {
        assert_eq!(after(&[(code, 0x10)]), 0, "{code:X}");
        assert_eq!(after(&[(code, 0x10), (0x5000, 2)]), 2, "{code:X}");
    }
    assert_eq!(after(&[(0x5000, 2), (0x8111, 0x10)]), 0x12);
}
