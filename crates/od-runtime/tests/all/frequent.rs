//! The most frequent frames: an upload of a number, a SYNC, and the TPDOs that follow it.

use crate::support::{Bench, rows};
use od_model::Address;
use od_runtime::{AbortCode, Application, Context, Emcy};

/// 2001h counts how often it is read.
#[derive(Default)]
struct Counter {
    reads: u64,
    /// Number of requests for an object of the services.
    strange: u64,
    fails: bool,
    raises: bool,
}

impl Application for Counter {
    fn is_live(&self, address: Address) -> bool {
        address.index == 0x2001
    }

    fn refresh(&mut self, cx: &mut Context<'_, '_>, address: Address) -> Result<(), AbortCode> {
        if address.index != 0x2001 {
            self.strange += u64::from(address.index < 0x2000);
            return Ok(());
        }
        self.reads += 1;
        cx.store.set_unsigned(address, self.reads);
        if self.raises {
            cx.signals.raise(Emcy {
                code: 0x5000,
                register: 0x01,
                info: [0; 5],
            });
        }
        if self.fails {
            Err(AbortCode::DeviceState)
        } else {
            Ok(())
        }
    }
}

/// Both TPDOs are sent at each SYNC; the second one carries 2001h.
fn synchronous() -> Bench<Counter> {
    let mut bench = Bench::with(rows(), Counter::default());
    bench.node.device_mut().profile.pdo.event_on_change = false;
    bench.power_on();
    for request in [
        "2F00180201000000",
        "2301180181020080",
        "2F011A0000000000",
        "23011A0110000120",
        "2F011A0001000000",
        "2F01180201000000",
        "2301180181020000",
    ] {
        let answer = bench.ask(&format!("601#{request}"));
        assert_eq!(&answer[4..6], "60", "{request} -> {answer}");
    }
    assert_eq!(bench.send("000#0101"), [""; 0]);
    bench
}

#[test]
fn each_upload_of_a_live_number_reads_it_once() {
    let mut bench = Bench::with(rows(), Counter::default());
    bench.power_on();
    assert_eq!(bench.send("601#4001200000000000"), ["581#4B01200001000000"]);
    assert_eq!(bench.send("601#4001200000000000"), ["581#4B01200002000000"]);
    assert_eq!(bench.send("601#4000100000000000"), ["581#4300100096010200"]);
    assert_eq!(bench.send("601#4006200000000000"), ["581#4F06200000000000"]);
    bench.node.application.fails = true;
    assert_eq!(bench.send("601#4001200000000000"), ["581#8001200022000008"]);
    bench.node.application = Counter {
        reads: 6,
        raises: true,
        ..Counter::default()
    };
    assert_eq!(
        bench.send("601#4001200000000000"),
        ["581#4B01200007000000", "081#0050010000000000"],
        "the response, then what the application has to say"
    );
    assert_eq!(bench.node.application.reads, 7);
}

/// The node keeps the set of live values by the low bits of their indices; those of 1001h and 2001h
/// are equal.
#[test]
fn an_application_is_not_asked_for_objects_of_the_services() {
    let mut bench = Bench::with(rows(), Counter::default());
    bench.power_on();
    assert_eq!(bench.ask("601#4001100000000000"), "581#4F01100000000000");
    assert_eq!(bench.node.application.strange, 0);
}

#[test]
fn a_block_has_the_current_value_of_a_live_number() {
    let mut bench = Bench::with(rows(), Counter::default());
    bench.power_on();
    for reads in ["01", "02"] {
        let start = bench.ask("601#A00120007F000000");
        assert_eq!(start, "581#C601200002000000");
        let segment = bench.ask("601#A300000000000000");
        assert_eq!(segment, format!("581#81{reads}000000000000"));
        bench.send("601#8001200000000008");
    }
    bench.node.application.fails = true;
    let refused = bench.ask("601#A00120007F000000");
    assert_eq!(refused, "581#8001200022000008");
}

#[test]
fn an_upload_replaces_a_segmented_transfer() {
    let mut bench = Bench::new();
    bench.power_on();
    assert_eq!(bench.ask("601#4002200000000000"), "581#4102200005000000");
    assert_eq!(bench.ask("601#4000200000000000"), "581#4300200005000000");
    assert_eq!(
        bench.ask("601#6000000000000000"),
        "581#8000000001000405",
        "no segments any more"
    );
}

#[test]
fn a_response_that_waits_is_sent_before_the_next_one() {
    let mut bench = Bench::new();
    bench.power_on();
    bench.hear("601#4000200000000000");
    bench.hear("601#4000100000000000");
    assert_eq!(
        bench.drain(),
        ["581#4300200005000000", "581#4300100096010200"]
    );
}

#[test]
fn a_sync_sends_all_its_tpdos() {
    let mut bench = synchronous();
    for reads in 2..5 {
        let live = format!("281#0{reads}00");
        assert_eq!(bench.send("080#"), ["181#05000000", live.as_str()]);
    }
    bench.node.application.raises = true;
    assert_eq!(
        bench.send("080#"),
        ["181#05000000", "281#0500", "081#0050010000000000"],
        "the error that the application reports about the value of a PDO follows the PDO"
    );
}

#[test]
fn tpdos_of_a_sync_wait_for_a_slow_host() {
    let mut bench = synchronous();
    bench.hear("080#");
    let at = bench.node.poll_timeout();
    assert!(at.is_some_and(|at| at <= bench.now), "{at:?}");
    bench.hear("080#");
    bench.hear("601#2300200006000000");
    bench.hear("601#4000200000000000");
    assert_eq!(
        bench.drain(),
        [
            "581#6000200000000000",
            "581#4300200006000000",
            "181#06000000",
            "281#0200"
        ]
    );
    bench.hear("080#");
    bench.hear("601#4000200000000000");
    assert_eq!(
        bench.drain(),
        ["581#4300200006000000", "181#06000000", "281#0300"]
    );
}

#[test]
fn tpdos_of_a_sync_end_with_operational() {
    let mut bench = synchronous();
    bench.hear("080#");
    assert_eq!(bench.send("000#8001"), [""; 0]);
    assert_eq!(bench.send("080#"), [""; 0]);
    assert_eq!(bench.send("000#0101"), [""; 0]);
    bench.hear("080#");
    let booted = bench.power_cycle();
    assert_eq!(booted, ["701#00"]);
}

#[test]
fn a_sync_longer_than_a_counter_is_ignored() {
    let mut bench = synchronous();
    assert_eq!(bench.send("080#0102"), ["081#4082110000000000"], "8240h");
    assert_eq!(bench.send("080#R0"), [""; 0]);
    assert_eq!(
        bench.send("080#01"),
        ["181#05000000", "281#0200", "081#0000000000000000"]
    );
    assert_eq!(
        bench.send("601#R8"),
        [""; 0],
        "a remote frame is not a request"
    );
}
