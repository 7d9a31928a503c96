use std::collections::BTreeMap;

use od_devices::DEVICES;
use od_model::Address;

use super::*;
use crate::rig::LineEvent;

/// Fields by name, like those of an outside program.
#[derive(Clone, Default, PartialEq, Debug)]
struct Record(BTreeMap<String, Value>);

impl Fields for Record {
    fn get(&self, key: &str) -> Value {
        self.0.get(key).cloned().unwrap_or(Value::Missing)
    }
}

impl Sink for Record {
    fn put(&mut self, key: &str, value: Value) {
        self.0.insert(key.into(), value);
    }
}

fn add(name: &str, node_id: u8) -> Input {
    let name = name.into();
    Input::Add {
        source: Source::Builtin { name },
        node_id,
        place: None,
    }
}

/// A bench on a real line, with these inputs, a millisecond after each.
fn bench(inputs: Vec<Input>) -> Journal {
    let mut journal = Journal::new(DEVICES);
    journal.restore(Vec::new(), false);
    for input in inputs {
        journal.act(input);
        journal.advance(1000, usize::MAX);
    }
    journal
}

fn frames(journal: &mut Journal) -> Vec<String> {
    let line = |seen: LineEvent| match seen {
        LineEvent::Frame { at, frame, .. } | LineEvent::Heard { at, frame, .. } => {
            Some(format!("{} {frame}", at.as_micros()))
        }
        LineEvent::Disturbed(..) => None,
    };
    journal.rig.drain().into_iter().filter_map(line).collect()
}

#[test]
fn every_input_is_read_as_written() {
    let text = || String::from("text");
    let source = Source::Eds {
        name: "ü.eds".into(),
        text: text(),
        lenient: true,
    };
    let place = Some(1);
    let all = [
        add("gxmm", 5),
        Input::Add {
            source,
            node_id: 6,
            place,
        },
        Input::Remove { node: 1 },
        Input::Send {
            id: 0x605,
            data: vec![0x40, 4],
            extended: false,
            remote: true,
        },
        Input::Repeat {
            key: 3,
            id: 0x80,
            data: Vec::new(),
            extended: true,
            remote: false,
            micros: 500,
        },
        Input::Power { node: 0, on: false },
        Input::Turn {
            node: 0,
            turns: -1.25,
        },
        Input::Rpm { node: 0, rpm: 60.0 },
        Input::Follow {
            node: 0,
            steps: vec![60.0, 2000.0],
            repeats: true,
        },
        Input::Switches {
            node: 0,
            id: Some(7),
            dip: None,
        },
        Input::Switches {
            node: 0,
            id: None,
            dip: Some(Dip { bit: 4, on: true }),
        },
        Input::Fault {
            node: 0,
            name: text(),
            on: true,
        },
        Input::Line {
            real: true,
            terminators: 1,
            rate: Rate(None),
        },
        Input::Line {
            real: true,
            terminators: 1,
            rate: Rate(Some(500)),
        },
        Input::Seed { seed: u32::MAX },
        Input::Plug {
            station: 0,
            on: false,
        },
        Input::Restart { station: 1 },
        Input::Cut { node: 0, bytes: 9 },
        Input::Eeprom {
            node: 0,
            bytes: vec![255; 3],
        },
        Input::Deliver {
            node: 0,
            id: 0,
            data: vec![1, 0],
        },
        Input::Lesson { text: text() },
        Input::Leave {},
        Input::Script { text: text() },
    ];
    for input in all {
        let mut record = Record::default();
        input.clone().write(&mut record);
        let Value::Text(op) = record.get("op") else {
            panic!("{input:?} has no name");
        };
        assert_eq!(Input::read(&op, &record), Ok(input.clone()));
        // Every field that is not optional must be present, with a value of its type.
        for key in record.0.keys().filter(|key| *key != "op") {
            let mut other = record.clone();
            other.put(key, Value::Numbers(vec![f64::NAN]));
            assert!(Input::read(&op, &other).is_err(), "{input:?}: {key}");
        }
    }
}

#[test]
fn numbers_have_a_range() {
    let turn = |node: f64, turns: f64| {
        let mut record = Record::default();
        record.put("node", Value::Number(node));
        record.put("turns", Value::Number(turns));
        Input::read("turn", &record)
    };
    assert_eq!(
        turn(255.0, -1e9),
        Ok(Input::Turn {
            node: 255,
            turns: -1e9
        })
    );
    for (node, turns) in [
        (-1.0, 0.0),
        (0.5, 0.0),
        (256.0, 0.0),
        (0.0, 1e300),
        (0.0, f64::NAN),
    ] {
        assert_eq!(
            turn(node, turns),
            Err(Error::InvalidField),
            "{node} {turns}"
        );
    }
    assert_eq!(
        Input::read("explode", &Record::default()),
        Err(Error::Newer)
    );
}

#[test]
fn a_run_is_repeated_frame_by_frame() {
    let sync = Input::Repeat {
        key: 1,
        id: 0x80,
        data: Vec::new(),
        extended: false,
        remote: false,
        // A SYNC takes 1 ms at 50 kbit/s, and so does the response.
        micros: 7000,
    };
    let start = Input::Send {
        id: 0,
        data: vec![1, 0],
        extended: false,
        remote: false,
    };
    let mut first = bench(vec![
        add("gxmm", 5),
        start,
        sync,
        Input::Rpm { node: 0, rpm: 30.0 },
    ]);
    // Frames of the SDO client are part of the run.
    let node = NodeId::new(5).unwrap();
    first.rig.write(node, Address::new(0x1017, 0), &[5, 0]);
    first.send_requests();
    first.advance(200_000, usize::MAX);
    assert!(first.rig.outcome().is_some_and(|one| one.result.is_ok()));
    let run = frames(&mut first);
    assert!(
        run.len() > 30
            && run
                .iter()
                .any(|line| line.ends_with("605#2B17100005000000"))
    );

    let mut second = Journal::new(DEVICES);
    second.restore(first.entries().to_vec(), false);
    second.advance(first.rig.bus.now().as_micros(), usize::MAX);
    assert_eq!(frames(&mut second), run);

    // After a step back the rest comes again, until there is a new input.
    let half = Instant::from_micros(second.rig.bus.now().as_micros() / 2);
    second.rewind(half);
    assert!(frames(&mut second).is_empty());
    second.advance(first.rig.bus.now().micros_since(half), usize::MAX);
    let rest: Vec<_> = run
        .iter()
        .filter(|line| {
            let at: u64 = line.split(' ').next().unwrap().parse().unwrap();
            at > half.as_micros()
        })
        .cloned()
        .collect();
    assert_eq!(frames(&mut second), rest);
    second.rewind(Instant::ZERO);
    assert!(second.to_come() > 0);
    second.act(Input::Power { node: 0, on: false });
    assert_eq!(second.to_come(), 0);
}

#[test]
fn news_come_once_and_begin_at_the_first_difference() {
    let mut journal = bench(vec![add("gxmm", 5), Input::Seed { seed: 1 }]);
    assert_eq!(
        journal.news().map(|(from, all)| (from, all.len())),
        Some((0, 2))
    );
    assert_eq!(journal.news(), None);
    journal.rewind(Instant::ZERO);
    journal.act(Input::Seed { seed: 2 });
    assert_eq!(
        journal.news().map(|(from, all)| (from, all.len())),
        Some((1, 1))
    );
    assert!(journal.act(add("none", 5)).node.is_none());
    assert!(matches!(
        journal.act(add("gxmm", 0)).problem,
        InputProblem::Message(_)
    ));
    assert_eq!(journal.news(), None);
}

#[test]
fn a_bench_without_its_history_is_the_same() {
    let write = Input::Send {
        id: 0x605,
        data: vec![0x2B, 0x17, 0x10, 0, 0xF4, 1, 0, 0],
        extended: false,
        remote: false,
    };
    let start = Input::Send {
        id: 0,
        data: vec![1, 5],
        extended: false,
        remote: false,
    };
    let mut first = bench(vec![
        add("gxmm", 5),
        Input::Turn {
            node: 0,
            turns: 3.25,
        },
        Input::Switches {
            node: 0,
            id: None,
            dip: Some(Dip { bit: 2, on: true }),
        },
        Input::Fault {
            node: 0,
            name: "battery-low".into(),
            on: true,
        },
        write,
        start,
        Input::Plug {
            station: 0,
            on: false,
        },
    ]);
    first.advance(1_000_000, usize::MAX);
    let entries = first.setup().expect("devices in order");
    let mut second = Journal::new(DEVICES);
    second.restore(entries, true);
    assert!(frames(&mut second).is_empty());
    let seen = |journal: &mut Journal| {
        let plugged = journal.rig.bus.line.is_plugged(0);
        let device = &journal.rig.bus.devices()[0];
        let shaft = device.shaft(journal.rig.bus.now()).unwrap().turns;
        let values = [0x1017, 0x6004].map(|index| device.stored(index, 0));
        (
            device.state(),
            device.switches(),
            device.is_broken("battery-low"),
            shaft,
            values,
            plugged,
        )
    };
    assert_eq!(seen(&mut first), seen(&mut second));
    // A channel that does not follow its encoder cannot be added again.
    let mut moved = bench(vec![
        add("gmm_r", 5),
        add("gxmm", 9),
        Input::Remove { node: 0 },
    ]);
    let channels = moved
        .devices()
        .iter()
        .filter(|one| one.name.contains('.'))
        .count();
    assert_eq!(moved.setup().is_none(), channels > 0);
}

/// Changes that a script made to the master and the bus line are part of the bench without its history.
#[cfg(all(feature = "lessons", feature = "training"))]
#[test]
fn a_bench_without_its_history_has_the_list_of_the_master_and_the_physics_of_the_line() {
    let text = "line real\nline length 120\nline short\nline sample-point 75\nline sjw 2\nuse 2\nline clock -1.5\nmaster slave 5\n\
                master write 5 1017h = 100\nmaster heartbeat 5 250ms\nmaster sync 50ms";
    let script = Input::Script { text: text.into() };
    let mut first = bench(vec![add("gxmm", 5), add("gxmm", 6), script]);
    let entries = first.setup().expect("devices in order");
    let mut second = Journal::new(DEVICES);
    second.restore(entries, true);
    second.advance(1000, usize::MAX);
    assert!(second.refused().is_empty());
    let seen = |journal: &Journal| {
        let bus = &journal.rig.bus;
        let list = bus.master().map(|master| master.plan().lines());
        (list, bus.line.cable.clone())
    };
    assert_eq!(seen(&first), seen(&second));
    assert_eq!(seen(&second).0.map_or(0, |list| list.len()), 4);
    assert_eq!(seen(&second).1.deviation(2), -15_000);
    // A bench without them has no script, which the first module of the page could not run.
    let plain = bench(vec![add("gxmm", 5)])
        .setup()
        .expect("devices in order");
    assert!(
        !plain
            .iter()
            .any(|entry| matches!(entry.input, Input::Script { .. }))
    );
}

/// The nodes run, so the master must not boot them again, but watch them, and produce SYNC.
#[cfg(all(feature = "lessons", feature = "training"))]
#[test]
fn a_bench_without_its_history_has_the_nodes_that_its_master_has_started() {
    use crate::master::BootState;

    let text = "master slave 5\nmaster write 5 1017h = 100\nmaster heartbeat 5 250ms\nmaster slave 6\nmaster expect 6 1018h:02 = 99\nmaster boot";
    let script = Input::Script { text: text.into() };
    let mut first = bench(vec![add("gxmm", 5), add("gxmm", 6), script]);
    first.advance(2_000_000, usize::MAX);
    let state = |journal: &Journal, node: u8| {
        let node = od_runtime::NodeId::new(node).expect("1 to 127");
        let boot = journal.rig.bus.master().and_then(|it| it.boot(node));
        boot.map(|boot| boot.state)
    };
    assert_eq!(state(&first, 5), Some(BootState::Started));
    let mut second = Journal::new(DEVICES);
    second.restore(first.setup().expect("devices in order"), true);
    second.advance(1_000_000, usize::MAX);
    assert!(second.refused().is_empty());
    assert_eq!(state(&second, 5), Some(BootState::Started));
    assert_eq!(state(&second, 6), None, "it waits for the next boot");
    second.act(Input::Power { node: 0, on: false });
    second.advance(2_000_000, usize::MAX);
    assert_eq!(state(&second, 5), Some(BootState::Lost));
}

#[test]
fn the_bus_has_room_for_16_devices_in_a_repeated_run_too() {
    let mut journal = bench((0..20).map(|_| add("gxmm", 5)).collect());
    assert_eq!(journal.devices().len(), 16);
    let added = journal.act(add("gxmm", 5));
    assert!(matches!(added.problem, InputProblem::Message(why) if why.contains("16 devices")));
    assert_eq!(
        journal.act(in_place(0)).node,
        Some(0),
        "a replacement does not add one"
    );
    let entry = |input| Entry {
        at: Instant::ZERO,
        input,
    };
    journal.restore((0..17).map(|_| entry(add("gxmm", 5))).collect(), true);
    assert_eq!(journal.devices().len(), 16);
    assert_eq!(journal.refused().len(), 1);
    assert_eq!(journal.refused().len(), 0);
}

fn in_place(place: u8) -> Input {
    let name = "gxmm".into();
    Input::Add {
        source: Source::Builtin { name },
        node_id: 1,
        place: Some(place),
    }
}
