//! An EDS learned from a device equals the EDS of the device.

use std::collections::VecDeque;

use od_eds::Tables;
use od_eds::diff::Difference;
use od_model::{Access, Dictionary};
use od_sim::{EdsOptions, VirtualDevice};
use od_tools::Error;
use od_tools::bench::OnBench;
use od_tools::compare::compare;
use od_tools::learn::{Options, Stored, Today, learn, stored};
use od_tools::link::{Heard, Link};
use od_tools::master::Master;
use od_wire::nmt::Command;
use od_wire::{Frame, Instant, NodeId};

use crate::simulated::{alone, bus};

/// Values whose presence, type or access differs in a learned dictionary.
fn wrong(right: Dictionary<'_>, made: Dictionary<'_>) -> Vec<String> {
    let mut wrong = Vec::new();
    for entry in right.entries() {
        let address = entry.address;
        match made.find(address) {
            Err(_) => wrong.push(format!("{address} is missing")),
            Ok(got) if got.data_type != entry.data_type => {
                let types = (entry.data_type, got.data_type);
                wrong.push(format!("{address} {types:?}"));
            }
            Ok(got)
                if got.access.writable() != entry.access.writable()
                    || got.access.readable() != entry.access.readable() =>
            {
                wrong.push(format!("{address} {} {}", entry.access, got.access));
            }
            Ok(_) => {}
        }
    }
    let more = made
        .entries()
        .filter(|one| right.find(one.address).is_err());
    wrong.extend(more.map(|one| format!("{} is not there", one.address)));
    wrong
}

#[test]
fn the_twelve_devices_are_learned_and_can_be_replaced() {
    for kind in od_devices::DEVICES {
        let name = kind.name;
        let mut bus = bus(name);
        let made = learn(OnBench(&mut bus), NodeId::ONE, Options::default(), |_| {});
        let text = od_eds::write(&made.expect("a device that answers").description);
        assert!(text.contains("\nParameterName=Device type"), "{text}");
        let loaded = od_eds::load(&text);
        let errors = loaded.findings.iter().filter(|one| one.is_error());
        let errors: Vec<_> = errors.map(|one| (one.code(), one.object)).collect();
        assert!(errors.is_empty(), "{name}: {errors:?}");
        let tables = Tables::new(&loaded.description);
        let made = tables.dictionary();
        let all = kind.dictionary.len();
        let wrong = wrong(kind.dictionary, made);
        assert!(wrong.len() * 100 <= all, "{name}, {all}: {wrong:?}");
        let mut original = Master::new(OnBench(bus), NodeId::ONE);
        let differences = compare(made, &mut original, true).expect("a device that answers");
        // The time stamp of an EAM changes.
        let is_still = |one: &Difference| !(name.starts_with("eam") && one.index == 0x2120);
        let changed: Vec<_> = differences.into_iter().filter(is_still).collect();
        assert!(changed.is_empty(), "{name}: {changed:?}");
        // The learned file replaces the device.
        let device = VirtualDevice::from_eds(&text, EdsOptions::default()).expect("a device");
        let mut twin = Master::new(OnBench(alone(device)), NodeId::ONE);
        for entry in made.entries().filter(|one| one.access == Access::Const) {
            let bytes = original.upload(entry.address);
            let same = twin.upload(entry.address);
            assert_eq!(bytes, same, "{name}: {}", entry.address);
        }
        let differences = compare(made, &mut twin, false).expect("a device that answers");
        assert!(differences.is_empty(), "{name}: {differences:?}");
    }
}

#[test]
fn limits_are_probed_and_values_restored() {
    let mut bus = bus("en580c");
    let options = Options {
        writes: true,
        ..Options::default()
    };
    let made = learn(OnBench(&mut bus), NodeId::ONE, options, |_| {}).expect("a device");
    assert_eq!(made.left, None);
    let made = made.description;
    let limited = made
        .entries()
        .filter(|(_, entry)| entry.high.is_some())
        .count();
    assert!(limited > 3, "{limited} limits");
    let mut master = Master::new(OnBench(&mut bus), NodeId::ONE);
    for (address, entry) in made.entries().filter(|(_, entry)| entry.access.writable()) {
        if let (Ok(bytes), Some(default)) = (master.upload(address), &entry.default)
            && let Some(wanted) = default.value.integer(1)
        {
            assert_eq!(bytes, wanted.to_le_bytes()[..bytes.len()], "{address}");
        }
    }
}

/// A slave with node ID 1 that responds at once; `answer` may keep a state.
struct Odd<F> {
    now: Instant,
    answers: VecDeque<[u8; 8]>,
    answer: F,
}

impl<F: FnMut(&[u8; 8]) -> Option<[u8; 8]>> Link for Odd<F> {
    fn now(&self) -> Instant {
        self.now
    }

    fn send(&mut self, frame: &Frame) -> Result<(), Error> {
        if frame.id().as_standard() == Some(0x601) {
            self.answers.extend((self.answer)(frame.bytes()));
        }
        Ok(())
    }

    fn receive(&mut self, until: Instant) -> Result<Option<Heard>, Error> {
        match self.answers.pop_front() {
            Some(bytes) => {
                let frame = Frame::standard(0x581, &bytes);
                Ok(Some(Heard {
                    at: self.now,
                    frame,
                }))
            }
            None => {
                self.now = self.now.max(until);
                Ok(None)
            }
        }
    }
}

/// Behaviour in which the slave of a test differs from others.
#[derive(Clone, Copy, Default)]
struct Ways {
    /// Aborts an initiate while a segmented upload is open.
    minds_open: bool,
    /// Responds to every sub-index of a VAR.
    ignores_sub: bool,
    /// Confirms the start of any download, and checks the access at its end.
    checks_late: bool,
    /// Stops responding when 1017h is written.
    dies: bool,
}

/// A slave with 1000h, 1001h, 1008h, 1017h (rw), 1018h, 2100h (10 bytes), 2200h (rw).
fn odd(ways: Ways) -> Odd<impl FnMut(&[u8; 8]) -> Option<[u8; 8]>> {
    let value = move |index: u16, sub: u8| -> Option<Vec<u8>> {
        let is_var = !matches!(index, 0x1018);
        Some(
            match (index, if is_var && ways.ignores_sub { 0 } else { sub }) {
                (0x1000, 0) => vec![0; 4],
                (0x1001, 0) => vec![0],
                (0x1008, 0) => b"A device name of 29 characters".to_vec(),
                (0x1017, 0) => vec![0xE8, 3],
                (0x1018, 0) => vec![4],
                (0x1018, 1..=4) => vec![sub, 1, 0, 0],
                (0x2100, 0) => vec![0; 10],
                (0x2200, 0) => vec![7, 0],
                _ => return None,
            },
        )
    };
    let mut open: Option<(Vec<u8>, u8)> = None;
    let mut is_dead = false;
    let mut begun = [0; 3];
    let answer = move |request: &[u8; 8]| {
        let [command, low, high, sub, data @ ..] = *request;
        let index = u16::from_le_bytes([low, high]);
        let about = |command: u8, data: [u8; 4]| {
            let [a, b, c, d] = data;
            Some([command, low, high, sub, a, b, c, d])
        };
        let abort = |code: u32| about(0x80, code.to_le_bytes());
        if is_dead {
            return None;
        }
        if matches!(command >> 5, 1 | 2) && open.take().is_some() && ways.minds_open {
            return abort(0x0504_0001);
        }
        let found = value(index, sub);
        match command >> 5 {
            4 => {
                open = None;
                None
            }
            2 => match found {
                None if (0..=4).any(|sub| value(index, sub).is_some()) => abort(0x0609_0011),
                None => abort(0x0602_0000),
                Some(bytes) if bytes.len() <= 4 => {
                    let mut wide = [0; 4];
                    wide[..bytes.len()].copy_from_slice(&bytes);
                    about(0x43 | ((4 - bytes.len() as u8) << 2), wide)
                }
                Some(bytes) => {
                    let len = (bytes.len() as u32).to_le_bytes();
                    open = Some((bytes, 0));
                    about(0x41, len)
                }
            },
            3 => {
                let (mut bytes, toggle) = open.take()?;
                let rest = bytes.split_off(bytes.len().min(7));
                let last = u8::from(rest.is_empty());
                let mut answer = [0; 8];
                answer[0] = toggle | ((7 - bytes.len() as u8) << 1) | last;
                answer[1..=bytes.len()].copy_from_slice(&bytes);
                open = (!rest.is_empty()).then_some((rest, toggle ^ 0x10));
                Some(answer)
            }
            0 => {
                let [low, high, sub] = begun;
                Some([0x80, low, high, sub, 2, 0, 1, 6])
            }
            1 => {
                begun = [low, high, sub];
                let is_writable = matches!(index, 0x1017 | 0x2200);
                let is_end = command & 2 != 0;
                is_dead = ways.dies && index == 0x1017 && is_end && data[..2] != [0xE8, 3];
                match found {
                    None => abort(0x0602_0000),
                    Some(_) if is_writable || ways.checks_late && !is_end => about(0x60, [0; 4]),
                    Some(_) => abort(0x0601_0002),
                }
            }
            _ => abort(0x0504_0001),
        }
    };
    Odd {
        now: Instant::ZERO,
        answers: VecDeque::new(),
        answer,
    }
}

/// The learned objects, with their access and sub-objects.
fn objects(ways: Ways, writes: bool) -> Vec<String> {
    let options = Options {
        writes,
        ..Options::default()
    };
    let made = learn(odd(ways), NodeId::ONE, options, |_| {}).expect("a device");
    let objects = made.description.objects.iter();
    assert_eq!(made.left, None);
    let shown = objects.map(|(index, object)| {
        let entries: Vec<_> = object.entries.values().collect();
        let access: Vec<_> = entries.iter().map(|entry| entry.access.name()).collect();
        let data_type = entries[0].data_type.map_or("", |known| known.name());
        format!("{index:04X} {data_type} {}", access.join(","))
    });
    shown.collect()
}

const ALL: [&str; 7] = [
    "1000 UNSIGNED32 ro",
    "1001 UNSIGNED8 ro",
    "1008 VISIBLE_STRING ro",
    "1017 UNSIGNED16 rw",
    "1018 UNSIGNED8 const,ro,ro,ro,ro",
    "2100 OCTET_STRING ro",
    "2200 UNSIGNED16 rw",
];

#[test]
fn each_transfer_ends_before_the_next_begins() {
    let ways = Ways {
        minds_open: true,
        ..Ways::default()
    };
    assert_eq!(objects(ways, false), ALL);
}

#[test]
fn a_device_that_ignores_the_sub_index_has_variables() {
    let ways = Ways {
        ignores_sub: true,
        ..Ways::default()
    };
    assert_eq!(objects(ways, false), ALL);
}

#[test]
fn a_confirmed_start_is_no_proof_of_access_if_the_node_checks_later() {
    let ways = Ways {
        checks_late: true,
        ..Ways::default()
    };
    // Unknown without a write, so the access is that of the standard, otherwise `ro`.
    let mut unknown = ALL.to_vec();
    unknown[6] = "2200 UNSIGNED16 ro";
    unknown[4] = "1018 UNSIGNED8 ro,ro,ro,ro,ro";
    assert_eq!(objects(ways, false), unknown);
    let mut written = ALL.to_vec();
    written[4] = unknown[4];
    assert_eq!(objects(ways, true), written);
}

#[test]
fn a_node_that_stops_while_limits_are_probed_is_still_learned() {
    let ways = Ways {
        dies: true,
        ..Ways::default()
    };
    let options = Options {
        writes: true,
        today: Some(Today {
            year: 2026,
            month: 11,
            day: 26,
            hour: 13,
            minute: 5,
        }),
    };
    let made = learn(odd(ways), NodeId::ONE, options, |_| {}).expect("a description");
    assert!(matches!(made.left, Some(Error::Node(_))), "{:?}", made.left);
    assert_eq!(made.description.objects.len(), 7);
    let text = od_eds::write(&made.description);
    for line in [
        "CreationDate=11-26-2026",
        "CreationTime=01:05PM",
        "ParameterName=Vendor-ID",
        "ParameterName=Product code",
        "LSS_Supported=0",
    ] {
        assert!(text.contains(line), "{line}: {text}");
    }
}

/// The lines about LSS in the file of this device, which then is in the same NMT state as before.
fn lss_lines(device: VirtualDevice, start: bool, writes: bool) -> Vec<String> {
    let mut bus = alone(device);
    // The start of the device.
    let now = bus.now();
    bus.advance(now.plus_millis(3000));
    if start {
        let start = od_client::nmt::frame(Some(NodeId::ONE), Command::Start);
        OnBench(&mut bus).send(&start).expect("a bench");
        let now = bus.now();
        bus.advance(now.plus_millis(10));
    }
    let before = bus.devices()[0].state();
    let options = Options {
        writes,
        ..Options::default()
    };
    let made = learn(OnBench(&mut bus), NodeId::ONE, options, |_| {}).expect("a device");
    let now = bus.now();
    bus.advance(now.plus_millis(10));
    assert_eq!(bus.devices()[0].state(), before);
    let text = od_eds::write(&made.description);
    let lines = text.lines().filter(|line| line.contains("LSS"));
    lines.map(|line| line.trim().to_owned()).collect()
}

/// The three families respond to LSS in Stopped only.
#[test]
fn lss_is_also_looked_for_in_stopped_if_the_node_may_be_stopped() {
    for name in ["gxmm", "eam_mt", "en580c"] {
        let device = || VirtualDevice::new(od_devices::find(name).expect("a device"), NodeId::ONE);
        assert_eq!(
            lss_lines(device(), false, true),
            ["LSS_Supported=1"],
            "{name}"
        );
        for (start, writes, why) in [
            (false, false, "--allow-writes"),
            (true, true, "did not show Pre-operational"),
        ] {
            let lines = lss_lines(device(), start, writes);
            let [supported, comment] = &lines[..] else {
                panic!("{name}: {lines:?}");
            };
            assert_eq!(supported, "LSS_Supported=0", "{name}");
            assert!(
                comment.contains("Not known: LSS") && comment.contains(why),
                "{name}: {comment}"
            );
        }
    }
}

#[test]
fn a_node_without_lss_and_one_with_lss_in_every_state_are_told_apart() {
    let text = include_str!("../../../../firmware/eds/ds301.eds");
    let lss = text.replace("LSS_Supported=0", "LSS_Supported=1");
    for (text, writes, wanted) in [
        (text, true, "LSS_Supported=0"),
        (&*lss, false, "LSS_Supported=1"),
    ] {
        let (device, _) = VirtualDevice::read_eds(
            text,
            EdsOptions {
                node_id: None,
                lenient: true,
            },
        );
        let lines = lss_lines(device.expect("a device"), false, writes);
        assert_eq!(lines, [wanted]);
    }
}

/// A node that stores a text in 1021h, in a format.
fn storing(text: &str, format: Option<u8>) -> VirtualDevice {
    let object = |index, name, kind, data_type, value| {
        format!(
            "[{index}]\nParameterName={name}\nObjectType={kind}\nDataType={data_type}\nAccessType=ro\n\
             DefaultValue={value}\n"
        )
    };
    let mut eds = object("1000", "Device type", 7, 7, "0".to_owned());
    let hex = text.bytes().map(|byte| format!("{byte:02X}")).collect();
    eds += &object("1021", "Store EDS", 2, 15, hex);
    if let Some(format) = format {
        eds += &object("1022", "Store format", 7, 6, format.to_string());
    }
    let options = EdsOptions {
        node_id: None,
        lenient: true,
    };
    VirtualDevice::read_eds(&eds, options).0.expect("a device")
}

#[test]
fn a_node_sends_the_eds_that_it_has_of_itself() {
    let own =
        "[1000]\nParameterName=Device type\nObjectType=7\nDataType=7\nAccessType=ro\n".repeat(3);
    let read = |text: &str, format| {
        let link = OnBench(alone(storing(text, format)));
        stored(link, NodeId::ONE).expect("a device that answers")
    };
    for format in [None, Some(0)] {
        assert_eq!(read(&own, format), Some(Stored::Eds(own.clone())));
    }
    let compressed = read(&own, Some(128));
    assert!(matches!(compressed, Some(Stored::Unreadable(why)) if why.contains("128")));
    let other = read("PK no EDS", Some(0));
    assert!(matches!(other, Some(Stored::Unreadable(why)) if why.contains("object")));
    let none = stored(OnBench(bus("gxmm")), NodeId::ONE);
    assert_eq!(none.expect("a device that answers"), None);
}
