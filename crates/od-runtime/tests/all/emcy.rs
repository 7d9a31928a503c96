//! EMCY, 1001h and 1003h (CiA 301, chapters 7.2.7 and 7.5.2.2 to 7.5.2.4).

use crate::support::{Bench, Row, rows, unsigned};
use od_model::{Access, DataType};
use od_runtime::{Application, Context, Emcy, Event, Instant};

/// A device whose faults the test sets from outside.
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
            .for_each(|code| cx.signals.clear(code, [9; 5]));
        None
    }
}

fn bench(more: &[Row]) -> Bench<Faults> {
    let mut all = rows();
    all.extend_from_slice(more);
    let mut bench = Bench::with(all, Faults::default());
    bench.power_on();
    bench
}

fn error(code: u16, register: u8) -> Emcy {
    Emcy {
        code,
        register,
        info: [1, 2, 3, 4, 5],
    }
}

#[test]
fn errors_set_and_clear_their_bits() {
    let mut bench = bench(&[]);
    bench.node.application.raise.push(error(0x5530, 0x01));
    assert_eq!(bench.change(), ["081#3055010102030405"]);
    bench.node.application.raise.push(error(0xFF00, 0x81));
    assert_eq!(bench.change(), ["081#00FF810102030405"]);
    bench.node.application.raise.push(error(0xFF00, 0x81));
    assert!(bench.change().is_empty(), "it is there already");
    assert_eq!(bench.ask("601#4001100000000000"), "581#4F01100081000000");
    assert_eq!(bench.ask("601#4003100000000000"), "581#4F03100002000000");
    assert_eq!(bench.ask("601#4003100100000000"), "581#4303100100FF0000");
    assert_eq!(bench.ask("601#4003100200000000"), "581#4303100230550000");
    bench.node.application.clear.push(0xFF00);
    assert_eq!(
        bench.change(),
        ["081#0000010909090909"],
        "the other one is left"
    );
    bench.node.application.clear.extend([0x5530, 0x1234]);
    assert_eq!(
        bench.change(),
        ["081#0000000909090909"],
        "one that never came cannot go"
    );
}

#[test]
fn the_history_keeps_the_newest() {
    let mut bench = bench(&[]);
    for code in [0x1000, 0x5530, 0x6010] {
        bench.node.application.raise.push(error(code, 1));
        bench.change();
    }
    assert_eq!(
        bench.ask("601#4003100000000000"),
        "581#4F03100002000000",
        "room for two"
    );
    assert_eq!(bench.ask("601#4003100100000000"), "581#4303100110600000");
    assert_eq!(bench.ask("601#4003100200000000"), "581#4303100230550000");
    assert_eq!(bench.ask("601#2F03100000000000"), "581#6003100000000000");
    assert_eq!(bench.ask("601#4003100100000000"), "581#8003100124000008");
    for sub in 0..=2 {
        assert_eq!(bench.value(0x1003, sub), 0, "a host sees none either");
    }
}

#[test]
fn inhibit_time_and_1014h_delay_the_message_not_the_history() {
    let inhibit = (
        0x1015,
        0,
        DataType::Unsigned16,
        Access::Rw,
        false,
        unsigned(500),
    );
    let mut bench = bench(&[inhibit]);
    bench
        .node
        .application
        .raise
        .extend([error(0x1000, 1), error(0x5530, 1)]);
    assert_eq!(bench.change(), ["081#0010010102030405"]);
    assert_eq!(
        bench.wait(100),
        [(50, "081#3055010102030405".into())],
        "500 x 100 us"
    );
    bench.ask("601#2314100081000080");
    bench.node.application.raise.push(error(0x6010, 1));
    assert!(bench.change().is_empty(), "1014h bit 31");
    assert_eq!(bench.ask("601#4003100100000000"), "581#4303100110600000");
}

#[test]
fn an_error_in_stopped_is_in_the_history_without_a_message() {
    let mut bench = bench(&[]);
    bench.send("000#0201");
    bench.node.application.raise.push(error(0x1000, 1));
    assert!(bench.change().is_empty());
    assert_eq!(bench.send("000#8001"), [""; 0]);
    assert_eq!(bench.ask("601#4003100100000000"), "581#4303100100100000");
}

#[test]
fn an_emcy_that_waits_is_sent_after_the_boot_up() {
    let inhibit = (
        0x1015,
        0,
        DataType::Unsigned16,
        Access::Rw,
        false,
        unsigned(500),
    );
    let mut bench = bench(&[inhibit]);
    bench.node.device_mut().profile.nmt.reset_communication_us = 60_000;
    bench
        .node
        .application
        .raise
        .extend([error(0x1000, 1), error(0x5530, 1)]);
    assert_eq!(bench.change(), ["081#0010010102030405"]);
    bench.send("000#8201");
    assert_eq!(
        bench.wait(100),
        [(60, "701#00".into()), (60, "081#3055010102030405".into()),],
        "the inhibit time ends at 50 ms, while the node initialises"
    );
}

#[test]
fn messages_keep_their_order_during_the_inhibit_time() {
    // 100 ms, in units of 100 us.
    let mut bench = bench(&[(
        0x1015,
        0,
        DataType::Unsigned16,
        Access::Rw,
        false,
        unsigned(1000),
    )]);
    let message = |code: u16| format!("081#{:04X}010102030405", code.swap_bytes());
    let mut dropped = Vec::new();
    for code in 0x2001..=0x2014u16 {
        bench.node.application.raise.push(error(code, 1));
        let sent = bench.change();
        assert_eq!(sent.len(), usize::from(code == 0x2001), "{code:X}");
        while let Some(event) = bench.node.poll_event() {
            dropped.extend((event == Event::EmcyDropped).then_some(code));
        }
    }
    // 16 wait, and an event reports each one that is dropped.
    assert_eq!(dropped, [0x2012, 0x2013, 0x2014]);
    let later = (0x2002..=0x2011).map(|code| (u64::from(code - 0x2001) * 100, message(code)));
    assert_eq!(bench.wait(10_000), later.collect::<Vec<_>>());
    assert_eq!(
        bench.ask("601#4003100100000000"),
        "581#4303100114200000",
        "the log has it"
    );
}

#[test]
fn the_inhibit_time_is_in_units_of_100_microseconds() {
    let mut bench = bench(&[(
        0x1015,
        0,
        DataType::Unsigned16,
        Access::Rw,
        false,
        unsigned(25),
    )]);
    bench
        .node
        .application
        .raise
        .extend([error(0x2001, 1), error(0x2002, 1)]);
    assert_eq!(bench.change().len(), 1);
    let at = bench.node.poll_timeout();
    assert_eq!(at, Some(bench.now.plus_micros(2_500)));
}

#[test]
fn a_reset_removes_errors_and_waiting_messages() {
    // 50 ms, in units of 100 us.
    let word = DataType::Unsigned16;
    let inhibit = (0x1015, 0, word, Access::Rw, false, unsigned(500));
    for start in ["reset node", "power"] {
        let mut bench = bench(std::slice::from_ref(&inhibit));
        let both = [error(0x1000, 1), error(0x5530, 0x81)];
        bench.node.application.raise.extend(both);
        assert_eq!(bench.change(), ["081#0010010102030405"]);
        let out = match start {
            "power" => bench.power_cycle(),
            _ => bench.send("000#8101"),
        };
        assert_eq!(out, ["701#00"], "{start}");
        assert!(
            bench.wait(200).is_empty(),
            "{start}: the second waits no more"
        );
        assert_eq!(bench.ask("601#4001100000000000"), "581#4F01100000000000");
        bench.node.application.raise.push(error(0x1000, 1));
        assert_eq!(bench.change(), ["081#0010010102030405"], "{start}");
        assert_eq!(bench.ask("601#4001100000000000"), "581#4F01100001000000");
    }
}
