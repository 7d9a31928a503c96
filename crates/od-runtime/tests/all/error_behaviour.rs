//! 1029h by the bits of 1001h (manual 001, chapters 8.4 and 9.3; CiA 301, chapter 7.5.2.32).

use crate::support::{Bench, rows, unsigned};
use od_model::{Access, DataType};
use od_runtime::{Application, BusEvent, Context, Emcy, ErrorReset, Instant};
use od_wire::nmt::State;

#[derive(Default)]
struct Faults {
    raise: Vec<Emcy>,
    clear: Vec<u16>,
}

impl Application for Faults {
    fn tick(&mut self, cx: &mut Context<'_, '_>) -> Option<Instant> {
        self.raise
            .drain(..)
            .for_each(|error| cx.signals.raise(error));
        self.clear
            .drain(..)
            .for_each(|code| cx.signals.clear(code, [0; 5]));
        None
    }
}

/// Node 1 in Operational with 1029h:01 to 03: communication bit 4, generic bit 0, temperature
/// bit 3.
fn bench(values: [u64; 3], operational_only: bool) -> Bench<Faults> {
    use Access::*;
    use DataType::*;
    let mut all = rows();
    all.push((0x1029, 0, Unsigned8, Const, false, unsigned(3)));
    for (sub, value) in (1..).zip(values) {
        all.push((0x1029, sub, Unsigned8, Rw, false, unsigned(value)));
    }
    let mut bench = Bench::with(all, Faults::default());
    bench.node.device_mut().profile.pdo.event_on_change = false;
    bench.node.device_mut().profile.errors.behaviour = &[(0x10, 1), (0x01, 2), (0x08, 3)];
    bench.node.device_mut().profile.errors.operational_only = operational_only;
    bench.power_on();
    bench.send("000#0101");
    bench
}

fn raise(bench: &mut Bench<Faults>, code: u16, register: u8) -> Vec<String> {
    bench.node.application.raise.push(Emcy {
        code,
        register,
        info: [0; 5],
    });
    bench.change()
}

fn clear(bench: &mut Bench<Faults>, code: u16) -> Vec<String> {
    bench.node.application.clear.push(code);
    bench.change()
}

#[test]
fn each_bit_has_its_sub_index() {
    for (register, state) in [
        (0x01, State::PreOperational),
        (0x08, State::Stopped),
        (0x10, State::Operational),
        (0x80, State::Operational),
        (0x09, State::Stopped), // both act, and the more severe one decides
    ] {
        let mut bench = bench([1, 0, 2], true);
        assert_eq!(
            raise(&mut bench, 0x4200, register),
            [format!("081#0042{register:02X}0000000000")],
            "the EMCY goes out before the state changes"
        );
        assert_eq!(bench.node.state(), state, "{register:02X}");
    }
}

#[test]
fn it_acts_when_the_bit_becomes_set_and_at_each_start_while_it_is_set() {
    let mut bench = bench([1, 0, 1], true);
    raise(&mut bench, 0x5100, 0x01);
    assert_eq!(bench.node.state(), State::PreOperational);
    bench.send("000#0101");
    assert_eq!(
        bench.node.state(),
        State::PreOperational,
        "chapter 9.3, step 2"
    );
    bench.ask("601#2F29100201000000");
    bench.send("000#0101");
    assert_eq!(bench.node.state(), State::Operational);
    bench.ask("601#2F29100200000000");
    raise(&mut bench, 0xFF01, 0x01);
    assert_eq!(
        bench.node.state(),
        State::Operational,
        "the bit was set already"
    );
    clear(&mut bench, 0x5100);
    clear(&mut bench, 0xFF01);
    assert_eq!(bench.value(0x1001, 0), 0);
    raise(&mut bench, 0xFF01, 0x01);
    assert_eq!(bench.node.state(), State::PreOperational);
    clear(&mut bench, 0xFF01);
    bench.send("000#0101");
    assert_eq!(bench.node.state(), State::Operational);
}

#[test]
fn outside_operational_it_acts_if_the_family_says_so() {
    for (only, state) in [(true, State::PreOperational), (false, State::Stopped)] {
        let mut bench = bench([1, 2, 1], only);
        bench.send("000#8001");
        raise(&mut bench, 0x5100, 0x01);
        assert_eq!(bench.node.state(), state);
    }
}

#[test]
fn an_error_reset_may_wait_for_the_last_error() {
    for (reset, first) in [
        (ErrorReset::EachError, vec!["081#0000010000000000"]),
        (ErrorReset::LastError, vec![]),
    ] {
        let mut bench = bench([1, 1, 1], true);
        bench.node.device_mut().profile.errors.reset = reset;
        raise(&mut bench, 0x5100, 0x01);
        raise(&mut bench, 0xFF00, 0x00);
        raise(&mut bench, 0x4200, 0x09);
        assert_eq!(clear(&mut bench, 0x4200), first);
        assert_eq!(bench.value(0x1001, 0), 1);
        clear(&mut bench, 0x5100);
        assert_eq!(
            clear(&mut bench, 0xFF00),
            ["081#0000000000000000"],
            "a warning is an error here, too"
        );
    }
}

#[test]
fn many_errors_at_once_are_all_reported() {
    let mut bench = bench([1, 1, 1], true);
    for code in 0..20 {
        bench.node.application.raise.push(Emcy {
            code: 0xFF00 + code,
            register: 1,
            info: [0; 5],
        });
    }
    assert_eq!(bench.change().len(), 16, "as many as can wait");
    bench.node.application.clear.extend(0xFF00..0xFF14);
    assert_eq!(bench.change().len(), 16);
    assert_eq!(bench.value(0x1001, 0), 0, "but none is forgotten");
}

#[test]
fn a_bus_off_acts_by_the_bits_that_become_set() {
    for (was_set, state) in [(false, State::Stopped), (true, State::Operational)] {
        let mut bench = bench([1, 1, 1], false);
        bench.node.device_mut().profile.errors.bus_off = 0x08;
        if was_set {
            raise(&mut bench, 0x4200, 0x08);
        }
        bench.ask("601#2F29100302000000");
        bench.bus(BusEvent::Off);
        assert_eq!(bench.node.state(), state, "set before: {was_set}");
    }
}

#[test]
fn a_reset_ends_the_monitoring_of_a_node() {
    let mut all = rows();
    all.push((
        0x1016,
        0,
        DataType::Unsigned8,
        Access::Const,
        false,
        unsigned(1),
    ));
    let watch = unsigned(0x0005_0064);
    all.push((0x1016, 1, DataType::Unsigned32, Access::Rw, false, watch));
    for reset in ["000#8101", "000#8201"] {
        let mut bench = Bench::with(all.clone(), Faults::default());
        bench.power_on();
        bench.send("705#05");
        assert_eq!(bench.send(reset), ["701#00"]);
        assert!(bench.wait(1_000).is_empty(), "not heard since then");
        bench.send("705#05");
        let late = [(1_100, String::from("081#3081110000000000"))];
        assert_eq!(bench.wait(1_000), late, "100 ms without a heartbeat");
    }
}
