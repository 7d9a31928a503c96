//! TIME consumer and producer (CiA 301, chapter 7.2.6, and object 1012h).

use crate::support::{Bench, rows, unsigned};
use od_model::{Access, DataType};
use od_runtime::{Application, Context, Instant, TimeOfDay};

/// A clock that does not run, and a button that sends its time.
#[derive(Default)]
struct Clock {
    time: Option<TimeOfDay>,
    told: Vec<TimeOfDay>,
    sends: bool,
}

impl Application for Clock {
    fn tick(&mut self, cx: &mut Context<'_, '_>) -> Option<Instant> {
        if core::mem::take(&mut self.sends) {
            cx.signals.send_time();
        }
        None
    }

    fn set_time(&mut self, _: &mut Context<'_, '_>, time: TimeOfDay) {
        self.told.push(time);
    }

    fn time(&mut self, _: &mut Context<'_, '_>) -> Option<TimeOfDay> {
        self.time
    }
}

fn bench(cob_id: u64) -> Bench<Clock> {
    let mut rows = rows();
    rows.push((
        0x1012,
        0,
        DataType::Unsigned32,
        Access::Rw,
        false,
        unsigned(cob_id),
    ));
    let mut bench = Bench::with(rows, Clock::default());
    bench.power_on();
    bench
}

fn press(bench: &mut Bench<Clock>) -> Vec<String> {
    bench.node.application.sends = true;
    bench.change()
}

const TIME: TimeOfDay = TimeOfDay {
    days: 0x3D32,
    millis: 0x0102_0304,
};

fn write(bench: &mut Bench<Clock>, value: u32) -> String {
    let answer = bench.ask(&format!("601#23121000{:08X}", value.swap_bytes()));
    let abort = answer.strip_prefix("581#80121000");
    abort.unwrap_or_default().into()
}

#[test]
fn a_consumer_receives_the_time() {
    let mut bench = bench(0x8000_0100);
    assert!(bench.send("100#04030201323D").is_empty());
    assert_eq!(bench.node.application.told, [TIME]);
    // Not a time: another length, more than a day, a remote frame.
    for frame in [
        "100#0403020132",
        "100#04030201323D00",
        "100#FFFFFFFF323D",
        "100#R6",
    ] {
        bench.send(frame);
    }
    bench.send("101#04030201323D");
    // Stopped has no TIME.
    bench.send("000#0201");
    bench.send("100#04030201323D");
    assert_eq!(bench.node.application.told.len(), 1);
    bench.send("000#0101");
    bench.send("100#04030201323D");
    assert_eq!(bench.node.application.told.len(), 2);
    assert_eq!(write(&mut bench, 0x100), "");
    bench.send("100#04030201323D");
    assert_eq!(bench.node.application.told.len(), 2, "bit 31 is clear");
}

#[test]
fn a_producer_sends_when_its_application_requests_it() {
    let mut bench = bench(0x4000_0100);
    assert!(press(&mut bench).is_empty(), "the clock has no time");
    bench.node.application.time = Some(TIME);
    assert_eq!(press(&mut bench), ["100#04030201323D"]);
    assert!(bench.change().is_empty(), "it is asked for once");
    bench.send("000#0201");
    assert!(press(&mut bench).is_empty(), "Stopped");
    bench.send("000#0101");
    assert_eq!(press(&mut bench), ["100#04030201323D"]);
    assert_eq!(write(&mut bench, 0x8000_0100), "");
    assert!(press(&mut bench).is_empty(), "bit 30 is clear");
    assert!(bench.node.application.told.is_empty());
}

#[test]
fn the_cob_id_follows_its_rules() {
    const RANGE: &str = "30000906";
    let mut bench = bench(0x100);
    for (value, expected) in [
        (0x101, RANGE), // restricted
        (0x181, ""),
        (0x0000_0900, RANGE), // 29 bits without bit 29
        (0x4000_0181, ""),
        (0x4000_0100, RANGE), // it exists: bits 0 to 29 stay
        (0x8000_0100, RANGE),
        (0xC000_0181, ""),
        (0x8000_0181, ""),
        (0xA000_0181, RANGE),
        (0x100, ""),
        (0xE012_3456, ""),
    ] {
        assert_eq!(write(&mut bench, value), expected, "{value:X}");
    }
    bench.node.application.time = Some(TIME);
    assert_eq!(press(&mut bench), ["00123456#04030201323D"]);
    bench.send("00123456#04030201323D");
    assert_eq!(bench.node.application.told, [TIME]);
}

#[test]
fn a_host_learns_whether_the_time_was_sent() {
    let send = |bench: &mut Bench<Clock>| {
        let sent = bench.node.send_time(bench.now);
        assert_eq!(sent, bench.drain() == ["100#04030201323D"]);
        sent
    };
    let mut bench = bench(0x4000_0100);
    assert!(!send(&mut bench), "the clock has no time");
    bench.node.application.time = Some(TIME);
    assert!(send(&mut bench));
    bench.send("000#0201");
    assert!(!send(&mut bench), "Stopped");
    bench.send("000#0101");
    assert!(send(&mut bench));
    assert_eq!(write(&mut bench, 0x100), "");
    assert!(!send(&mut bench), "bit 30 is clear");
    bench.node.power_off();
    assert!(!send(&mut bench), "no power");
}
