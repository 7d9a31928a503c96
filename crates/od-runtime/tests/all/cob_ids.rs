//! A node never sends with a CAN-ID that it may not use, wherever the COB-ID comes from (CiA 301,
//! table 40: restricted CAN-IDs; chapters 7.5.2.5 to 7.5.2.37: the COB-ID objects). The fuzz target
//! `cob_ids` tries more of them, with saved images, RPDOs and LSS.

use std::collections::BTreeMap;

use crate::support::{Bench, Random, Row, rows, unsigned};
use od_eds::Value;
use od_model::{Access, DataType};
use od_runtime::{Application, Context, Emcy, Event, Instant, NodeId, TimeOfDay};

/// Raises an error and sends a TIME message at each request.
#[derive(Default)]
struct Talker {
    is_on: bool,
}

impl Application for Talker {
    fn tick(&mut self, cx: &mut Context<'_, '_>) -> Option<Instant> {
        self.is_on = !self.is_on;
        let error = Emcy {
            code: 0x4200,
            register: 0x09,
            info: [0xEE; 5],
        };
        if self.is_on {
            cx.signals.raise(error);
        } else {
            cx.signals.clear(error.code, error.info);
        }
        cx.signals.send_time();
        None
    }

    fn time(&mut self, _: &mut Context<'_, '_>) -> Option<TimeOfDay> {
        Some(TimeOfDay { days: 1, millis: 2 })
    }
}

/// The rows of a device with every service that has a COB-ID; `cob_ids` replaces defaults.
fn device(cob_ids: &[((u16, u8), Value)]) -> Vec<Row> {
    use Access::{Const, Rw};
    use DataType::{Unsigned8, Unsigned32};
    let mut rows = rows();
    rows.extend([
        (0x1006, 0, Unsigned32, Rw, false, unsigned(0)),
        (0x1012, 0, Unsigned32, Rw, false, unsigned(0x4000_0100)),
        (0x1201, 0, Unsigned8, Const, false, unsigned(2)),
        (0x1201, 1, Unsigned32, Rw, false, unsigned(0x8000_0000)),
        (0x1201, 2, Unsigned32, Rw, false, unsigned(0x8000_0000)),
    ]);
    // The data shows whether a frame is TPDO 1 or TPDO 2.
    rows.push((0x2007, 0, Unsigned32, Rw, true, unsigned(7)));
    for row in &mut rows {
        if (row.0, row.1) == (0x1A01, 1) {
            row.5 = unsigned(0x2007_0020);
        }
        let of_row = |((index, sub), _): &&((u16, u8), Value)| (*index, *sub) == (row.0, row.1);
        if let Some((_, value)) = cob_ids.iter().find(of_row) {
            row.5 = Some(value.clone());
        }
    }
    rows
}

/// All frames that a node sends from power-on to some SYNCs, remote frames, errors and a TIME
/// message.
fn all_frames(bench: &mut Bench<Talker>) -> Vec<String> {
    let own = bench.node.node_id().raw();
    let mut all = bench.power_on();
    all.extend(bench.send(&format!("000#01{own:02X}")));
    for round in 0..2 {
        all.extend(bench.change());
        all.extend(bench.send("080#"));
        all.extend(bench.send(&format!("{:03X}#4000100000000000", 0x600 + u16::from(own))));
        for id in (0..0x800).step_by(1 + round * 6) {
            all.extend(bench.send(&format!("{id:03X}#R8")));
        }
        // A request for 2000h to each SDO server except the default one.
        all.extend(bench.send("5F0#4000200000000000"));
        all.extend(bench.send("6A0#4000200000000000"));
        all.extend(bench.wait(20).into_iter().map(|(_, frame)| frame));
    }
    all
}

fn refused(bench: &mut Bench<Talker>) -> Vec<u16> {
    core::iter::from_fn(|| bench.node.poll_event())
        .filter_map(|event| match event {
            Event::CobIdRefused(index) => Some(index),
            _ => None,
        })
        .collect()
}

#[test]
fn a_cob_id_outside_the_11_bits_makes_its_service_not_valid() {
    // 790h + 112 = 800h, whose 11 bits are those of NMT.
    for node_id in [111, 112, 127] {
        let mut bench = Bench::with(
            device(&[((0x1800, 1), Value::NodeId(0x790))]),
            Talker::default(),
        );
        bench = bench.at(NodeId::new(node_id).unwrap());
        bench.power_on();
        assert_eq!(refused(&mut bench), [0x1800], "node {node_id}");
        let out = all_frames(&mut bench);
        assert!(!out.iter().any(|it| it.ends_with("#05000000")), "{out:?}");
        assert!(out.iter().any(|it| it.ends_with("#07000000")), "{out:?}");
        assert!(
            out.iter().all(|frame| !frame.starts_with("000#")),
            "{out:?}"
        );
    }
}

#[test]
fn only_the_service_with_a_refused_cob_id_is_not_valid() {
    let emcy = |frame: &String| frame.ends_with("EEEEEEEEEE");
    type Case<'c> = (&'c [((u16, u8), Value)], &'c [u16]);
    let cases: [Case<'_>; 8] = [
        (&[], &[]),
        (&[((0x1014, 0), Value::Unsigned(0x7E4))], &[0x1014]),
        (&[((0x1014, 0), Value::NodeId(0x800))], &[0x1014]),
        (&[((0x1014, 0), Value::Unsigned(0x80))], &[0x1014]),
        (&[((0x1005, 0), Value::Unsigned(0x601))], &[0x1005]),
        (&[((0x1012, 0), Value::Unsigned(0x4000_0001))], &[0x1012]),
        (&[((0x1400, 1), Value::Unsigned(0x601))], &[0x1400]),
        // The second TPDO would send with the CAN-ID of the first one.
        (&[((0x1801, 1), Value::NodeId(0x180))], &[0x1801]),
    ];
    for (cob_ids, expected) in cases {
        let mut bench = Bench::with(device(cob_ids), Talker::default());
        bench.power_on();
        assert_eq!(refused(&mut bench), expected, "{cob_ids:?}");
        let out = all_frames(&mut bench);
        let is_refused = |index| expected.contains(&index);
        assert_eq!(
            out.iter().any(emcy),
            !is_refused(0x1014),
            "{cob_ids:?}: {out:?}"
        );
        let time = |frame: &String| frame.len() == 4 + 12;
        assert_eq!(
            out.iter().any(time),
            !is_refused(0x1012),
            "{cob_ids:?}: {out:?}"
        );
    }
}

#[test]
fn a_released_cob_id_is_usable_again() {
    let cob_ids = [((0x1801, 1), Value::NodeId(0x180))];
    let mut bench = Bench::with(device(&cob_ids), Talker::default());
    bench.power_on();
    assert_eq!(refused(&mut bench), [0x1801]);
    bench.send("000#0101");
    assert_eq!(bench.send("181#R8"), ["181#05000000"]);
    // 1800h:01 becomes not valid, so 181h is free for TPDO 2; then a valid TPDO 1 takes it again.
    bench.ask("601#2300180181010080");
    assert_eq!(refused(&mut bench), [] as [u16; 0]);
    assert_eq!(bench.send("181#R8"), ["181#07000000"]);
    bench.ask("601#2300180181010000");
    assert_eq!(refused(&mut bench), [0x1801]);
    assert_eq!(bench.send("181#R8"), ["181#05000000"]);
}

/// A COB-ID that is wrong more often than at random, fixed or with the node ID.
fn cob_id(random: &mut Random) -> Value {
    let id = random.pick(&[
        0x000,
        0x001,
        0x07F,
        0x080,
        0x0FF,
        0x100,
        0x101,
        0x180,
        0x181,
        0x200,
        0x580,
        0x581,
        0x5FF,
        0x600,
        0x601,
        0x67F,
        0x6A0,
        0x6E0,
        0x6FF,
        0x700,
        0x701,
        0x780,
        0x790,
        0x7E5,
        0x7FF,
        0x800,
        0xFFF,
        0x1_0181,
        0x1FFF_FFFF,
    ]);
    let flags = random.pick(&[0, 0, 0, 1 << 29, 1 << 30, 3 << 29, 1 << 31, 7 << 29]);
    if random.next().is_multiple_of(2) {
        Value::NodeId(id | flags)
    } else {
        Value::Unsigned(u64::from(id | flags))
    }
}

/// The service that sent a frame, by its CAN-ID (services with a fixed one) or its data.
fn service(frame: &str, own: u8) -> &'static str {
    let (id, data) = frame.split_once('#').expect("id#data");
    let is_standard = id.len() == 3;
    let id = u32::from_str_radix(id, 16).expect("hex");
    if is_standard && id == 0x700 + u32::from(own) && data.len() == 2 {
        return "error control";
    }
    if is_standard && id == 0x580 + u32::from(own) {
        return "default SDO";
    }
    assert!(
        !(is_standard && od_model::is_restricted(id)),
        "node {own} sends {frame}"
    );
    match data {
        "" => "SYNC",
        "000000000100" | "020000000100" => "TIME",
        "05000000" => "TPDO 1",
        "07000000" => "TPDO 2",
        _ if data.ends_with("EEEEEEEEEE") => "EMCY",
        // An RPDO that is shorter than its mapping (8210h).
        _ if data.len() == 16 && data.ends_with("110000000000") => "EMCY",
        _ if data.len() == 16 => "SDO server 1",
        _ => panic!("node {own} sends {frame}"),
    }
}

#[test]
fn no_node_sends_with_a_restricted_can_id_or_one_of_another_service() {
    let mut random = Random(0x9E37_79B9_7F4A_7C15);
    let mut seen = BTreeMap::<&'static str, u32>::new();
    for _ in 0..600 {
        let objects = [
            (0x1005, 0),
            (0x1012, 0),
            (0x1014, 0),
            (0x1201, 1),
            (0x1201, 2),
            (0x1400, 1),
            (0x1401, 1),
            (0x1800, 1),
            (0x1801, 1),
        ];
        let mut cob_ids = vec![((0x1006, 0), Value::Unsigned(10_000))];
        for address in objects {
            if !random.next().is_multiple_of(4) {
                cob_ids.push((address, cob_id(&mut random)));
            }
        }
        let mut rows = device(&cob_ids);
        for row in &mut rows {
            if matches!((row.0, row.1), (0x1800 | 0x1801, 2)) {
                row.5 = unsigned(random.pick(&[1, 253, 255]));
            }
        }
        let own = random.pick(&[1, 2, 16, 96, 111, 112, 126, 127]);
        let mut bench = Bench::with(rows, Talker::default());
        bench = bench.at(NodeId::new(own).unwrap());
        let mut owners = BTreeMap::new();
        for frame in all_frames(&mut bench) {
            let service = service(&frame, own);
            *seen.entry(service).or_default() += 1;
            let (id, _) = frame.split_once('#').unwrap();
            let owner = *owners.entry(id.to_string()).or_insert(service);
            assert_eq!(owner, service, "node {own}, {cob_ids:?}: {frame}");
        }
    }
    // Each service sent at least one frame.
    assert_eq!(seen.len(), 8, "{seen:?}");
}
