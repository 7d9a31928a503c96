//! A node without a service: the objects of the service are plain values, and its frames are
//! ignored.

use crate::support::{Bench, Row, rows, unsigned};
use crate::table::{With, on};
use od_model::{Access, Address, DataType};
use od_runtime::{
    AbortCode, Application, Chunk, Context, Emcy, Halt, LssProfile, NoApplication, Stream,
};
use od_wire::nmt::State;

type Of<const SERVICES: u16> = Bench<NoApplication, With<SERVICES>>;

/// Objects of all services, with values that the rules of the services would refuse.
fn all() -> Vec<Row> {
    use Access::Rw;
    use DataType::{Unsigned8, Unsigned16, Unsigned32};
    let mut all = rows();
    let node_id = |cob_id| Some(od_eds::Value::NodeId(cob_id));
    all.extend([
        (0x100C, 0, Unsigned16, Rw, false, unsigned(100)),
        (0x100D, 0, Unsigned8, Rw, false, unsigned(3)),
        (0x1006, 0, Unsigned32, Rw, false, unsigned(0)),
        (0x1012, 0, Unsigned32, Rw, false, unsigned(0x8000_0100)),
        (0x1016, 0, Unsigned8, Access::Const, false, unsigned(2)),
        (0x1016, 1, Unsigned32, Rw, false, unsigned(0x0005_0064)),
        (0x1016, 2, Unsigned32, Rw, false, unsigned(0)),
        (0x1029, 0, Unsigned8, Access::Const, false, unsigned(1)),
        (0x1029, 1, Unsigned8, Rw, false, unsigned(0)),
        (0x1201, 0, Unsigned8, Access::Const, false, unsigned(2)),
        (0x1201, 1, Unsigned32, Rw, false, node_id(0x69F)),
        (0x1201, 2, Unsigned32, Rw, false, node_id(0x6BF)),
    ]);
    all
}

fn bench<const SERVICES: u16>() -> Of<SERVICES> {
    let mut bench: Of<SERVICES> = Bench::of_device(all(), NoApplication);
    bench.node.device_mut().profile.pdo.event_on_change = false;
    assert_eq!(bench.power_on(), ["701#00"]);
    bench
}

const NONE: u16 = 0;
const DONE: &str = "60";
const REFUSED: &str = "80";

/// First byte of the response to an expedited download.
fn write<const SERVICES: u16>(bench: &mut Of<SERVICES>, request: &str) -> String {
    bench.ask(&format!("601#{request}"))[4..6].to_owned()
}

/// The responses of a node with only this service, and of one without services.
fn both<const SERVICE: u16>(request: &str) -> [String; 2] {
    [
        write(&mut bench::<SERVICE>(), request),
        write(&mut bench::<NONE>(), request),
    ]
}

#[test]
fn objects_of_an_absent_service_accept_any_value() {
    let time = both::<{ on::TIME }>;
    assert_eq!(time("2312100001060000"), [REFUSED, DONE], "an SDO's COB-ID");
    assert_eq!(time("2312100001010080"), [REFUSED, DONE], "in use");
    assert_eq!(
        time("2312100000010000"),
        [DONE, DONE],
        "not in use any more"
    );
    let watches = both::<{ on::CONSUMER }>;
    assert_eq!(watches("2316100264000500"), [REFUSED, DONE], "watched");
    assert_eq!(watches("2316100264000600"), [DONE, DONE]);
    let behaves = both::<{ on::BEHAVIOUR }>;
    assert_eq!(behaves("2F29100104000000"), [REFUSED, DONE]);
    assert_eq!(behaves("2F2910017F000000"), [REFUSED, DONE]);
    assert_eq!(behaves("2F29100103000000"), [DONE, DONE]);
    assert_eq!(behaves("2F29100180000000"), [DONE, DONE]);
    let serves = both::<{ on::SERVERS }>;
    assert_eq!(serves("2301120101060000"), [REFUSED, DONE]);
    assert_eq!(serves("2301120201060000"), [REFUSED, DONE]);
    let receives = both::<{ on::RPDOS }>;
    assert_eq!(receives("2300140101060000"), [REFUSED, DONE]);
    assert_eq!(receives("2F001402F1000000"), [REFUSED, DONE]);
    assert_eq!(receives("2F001402FD000000"), [REFUSED, DONE]);
    assert_eq!(receives("2F001402F0000000"), [DONE, DONE]);
    assert_eq!(receives("2F001402FE000000"), [DONE, DONE]);
    let stores = both::<{ on::STORAGE }>;
    assert_eq!(stores("2310100178787878"), [REFUSED, DONE], "no signature");
    assert_eq!(stores("2311100178787878"), [REFUSED, DONE]);
    let syncs = both::<{ on::SYNC_PRODUCER }>;
    assert_eq!(
        syncs("2305100080000040"),
        [DONE, REFUSED],
        "it would produce"
    );
    assert_eq!(syncs("2305100081000000"), [DONE, DONE]);
}

#[test]
fn a_produced_sync_keeps_its_can_id() {
    let mut bench = bench::<{ on::SYNC_PRODUCER }>();
    for (request, answer) in [
        ("2305100080000040", DONE),
        ("2305100081000040", REFUSED),
        ("2305100080000040", DONE),
        ("2305100081000000", DONE),
        ("2305100082000000", DONE),
        ("2305100082000040", DONE),
        ("2305100082000000", DONE),
    ] {
        assert_eq!(write(&mut bench, request), answer, "{request}");
    }
}

#[test]
fn transfers_of_an_absent_service_are_unknown_commands() {
    const SEGMENTED: u16 = on::SEGMENTED;
    const BLOCK: u16 = on::BLOCK;
    fn ask<const SERVICES: u16>(request: &str) -> String {
        bench::<SERVICES>().ask(&format!("601#{request}"))
    }
    const NO_COMMAND: [&str; 2] = ["01000405", "581#80"];
    let is_refused = |answer: &str, index: &str| {
        let [code, abort] = NO_COMMAND;
        answer == format!("{abort}{index}{code}")
    };
    let text = "4002200000000000";
    assert_eq!(ask::<SEGMENTED>(text), "581#4102200005000000");
    assert_eq!(ask::<NONE>(text), "581#8002200000000106");
    assert_eq!(ask::<BLOCK>(text), "581#8002200000000106");
    let download = "2103200009000000";
    assert_eq!(ask::<SEGMENTED>(download), "581#6003200000000000");
    assert!(is_refused(&ask::<NONE>(download), "032000"));
    assert!(is_refused(&ask::<BLOCK>(download), "032000"));
    for request in ["A00220007F000000", "C603200009000000"] {
        let index = &request[2..8];
        assert!(!ask::<BLOCK>(request).starts_with("581#80"));
        assert!(is_refused(&ask::<SEGMENTED>(request), index), "{request}");
        assert!(is_refused(&ask::<NONE>(request), index), "{request}");
    }
}

#[test]
fn frames_of_an_absent_service_are_ignored() {
    fn answers<const SERVICES: u16>(frame: &str) -> usize {
        let mut bench = bench::<SERVICES>();
        bench.node.device_mut().profile.lss = Some(LssProfile::CIA305);
        bench.power_cycle();
        bench.send("000#0101");
        bench.send(frame).len()
    }
    const ALL: u16 = u16::MAX;
    let guard = "701#R1";
    assert_eq!(answers::<{ on::GUARDING }>(guard), 1);
    assert_eq!(answers::<{ ALL ^ on::GUARDING }>(guard), 0);
    let server = "6A0#4000100000000000";
    assert_eq!(answers::<{ on::SERVERS }>(server), 1);
    assert_eq!(answers::<{ ALL ^ on::SERVERS }>(server), 0);
    let identify = "7E5#4C00000000000000";
    assert_eq!(answers::<{ ALL ^ on::LSS }>(identify), 0);
}

#[test]
fn missing_rpdos_are_not_received() {
    fn value<const SERVICES: u16>() -> u64 {
        let mut bench = bench::<SERVICES>();
        bench.send("000#0101");
        assert_eq!(bench.send("201#3412"), [""; 0]);
        bench.value(0x2001, 0)
    }
    assert_eq!(value::<{ on::RPDOS }>(), 0x1234);
    assert_eq!(value::<{ u16::MAX ^ on::RPDOS }>(), 0xFFFE);
}

#[test]
fn changes_are_sent_only_with_the_service_for_changes() {
    fn sent<const SERVICES: u16>() -> usize {
        let mut bench = bench::<SERVICES>();
        bench.node.device_mut().profile.pdo.event_on_change = true;
        bench.power_cycle();
        bench.send("000#0101");
        bench.send("601#2300200006000000").len()
    }
    assert_eq!(sent::<{ on::CHANGES }>(), 3, "the response and two TPDOs");
    assert_eq!(sent::<{ u16::MAX ^ on::CHANGES }>(), 1);
}

#[test]
fn a_node_without_events_reports_none() {
    let mut bench = bench::<{ u16::MAX ^ on::EVENTS }>();
    bench.send("601#2300200006000000");
    assert_eq!(bench.node.poll_event(), None);
    let mut bench = self::bench::<{ on::EVENTS }>();
    assert!(bench.node.poll_event().is_some());
}

/// Raises an error, and streams 2002h.
struct Noisy;

impl Application for Noisy {
    fn written(&mut self, cx: &mut Context<'_, '_>, _: Address) {
        let info = [0; 5];
        cx.signals.raise(Emcy {
            code: 0x5000,
            register: 0x11,
            info,
        });
    }

    fn stream(&mut self, address: Address) -> Option<&mut dyn Stream> {
        if address.index == 0x2002 {
            Some(self)
        } else {
            None
        }
    }
}

impl Stream for Noisy {
    fn begin_download(
        &mut self,
        _: &mut Context<'_, '_>,
        _: Address,
        _: Option<u32>,
    ) -> Result<(), Halt> {
        Err(AbortCode::DeviceState.into())
    }

    fn write(&mut self, _: &mut Context<'_, '_>, _: Address, _: Chunk<'_>) -> Result<(), Halt> {
        Ok(())
    }

    fn begin_upload(&mut self, _: &mut Context<'_, '_>, _: Address) -> Result<u32, Halt> {
        Ok(2)
    }

    fn read(
        &mut self,
        _: &mut Context<'_, '_>,
        _: Address,
        _: u32,
        to: &mut [u8],
    ) -> Result<(), Halt> {
        to.fill(b'x');
        Ok(())
    }
}

fn noisy<const SERVICES: u16>() -> Bench<Noisy, With<SERVICES>> {
    let mut bench: Bench<Noisy, With<SERVICES>> = Bench::of_device(all(), Noisy);
    bench.node.device_mut().profile.pdo.event_on_change = false;
    bench.node.device_mut().profile.errors.behaviour = &[(0x01, 1)];
    bench.power_on();
    bench.send("000#0101");
    bench
}

#[test]
fn an_error_has_no_effect_without_error_behaviour() {
    fn state<const SERVICES: u16>() -> State {
        let mut bench = noisy::<SERVICES>();
        let sent = bench.send("601#2300200006000000");
        assert!(
            sent.contains(&"081#0050110000000000".to_owned()),
            "{sent:?}"
        );
        bench.node.state()
    }
    assert_eq!(state::<{ on::BEHAVIOUR }>(), State::PreOperational);
    assert_eq!(state::<{ u16::MAX ^ on::BEHAVIOUR }>(), State::Operational);
}

#[test]
fn without_streams_a_value_is_in_the_store() {
    const REST: u16 = u16::MAX ^ on::STREAMS;
    let upload = "601#4002200000000000";
    let streamed = noisy::<{ on::STREAMS }>().ask(upload);
    assert_eq!(streamed, "581#4B02200078780000");
    assert_eq!(noisy::<REST>().ask(upload), "581#4102200005000000");
    let download = "601#2B02200041420000";
    let refused = noisy::<{ on::STREAMS }>().ask(download);
    assert_eq!(refused, "581#8002200022000008");
    let written = noisy::<REST>().send(download);
    assert_eq!(written[0], "581#6002200000000000");
}

#[test]
fn a_block_ends_where_the_client_ends_it() {
    fn answers<const SERVICES: u16>() -> Vec<(u64, String)> {
        let mut bench = bench::<SERVICES>();
        bench.ask("601#C603200009000000");
        bench.wait(6_000)
    }
    let timeout = "581#8003200000000405".to_owned();
    assert_eq!(answers::<{ on::BLOCK }>(), [(5_000, timeout.clone())]);
    assert_eq!(answers::<{ on::BLOCK | on::STREAMS }>(), [(5_000, timeout)]);
    assert_eq!(answers::<{ on::STREAMS | on::SEGMENTED }>(), []);
    let mut bench = bench::<{ on::BLOCK }>();
    bench.ask("601#C603200009000000");
    bench.send("601#8003200000000008");
    assert_eq!(bench.wait(6_000), []);
    bench.ask("601#C603200009000000");
    bench.ask("601#8103200000000008");
}

#[test]
fn a_save_with_a_duration_is_answered_without_streams_too() {
    let mut bench = bench::<{ on::STORAGE }>();
    bench.node.device_mut().profile.store.answer = od_runtime::SaveAnswer::AfterStoring;
    bench.node.device_mut().profile.store.duration_us = 50_000;
    let saved = (50, "581#6010100100000000".to_owned());
    assert_eq!(bench.send("601#2310100173617665"), [""; 0]);
    assert_eq!(bench.send("601#4000100000000000"), [""; 0], "not yet");
    assert_eq!(bench.send("601#2300200007000000"), [""; 0]);
    let written = (50, "581#6000200000000000".to_owned());
    assert_eq!(bench.wait(60), [saved, written]);
    assert_eq!(bench.value(0x2000, 0), 7);
}
