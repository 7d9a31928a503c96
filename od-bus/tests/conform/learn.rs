//! An EDS from a device says what the EDS says that the device was made from.

use od_bench::VirtualDevice;
use od_bench::bus::Bus;
use od_bus::bench::OnBench;
use od_bus::learn::{Options, learn};
use od_bus::master::Master;
use od_eds::{Finding, Tables};
use od_wire::NodeId;

fn bus(name: &str) -> Bus {
    let kind = od_devices::find(name).expect("a device");
    let mut bus = Bus::new();
    let number = bus.add(VirtualDevice::new(kind, NodeId::ONE));
    bus.start(number);
    bus
}

#[test]
fn objects_types_and_access_are_right() {
    for name in ["gxmm"] {
        let kind = od_devices::find(name).expect("a device");
        let made = learn(OnBench(bus(name)), NodeId::ONE, Options::default(), |_| {});
        let text = od_eds::write(&made.expect("a device that answers"));
        let loaded = od_eds::load(&text);
        let errors: Vec<_> = loaded
            .findings
            .iter()
            .filter(|one| one.is_error())
            .collect();
        assert!(errors.is_empty(), "{name}: {}", told(&errors));
        let tables = Tables::new(&loaded.description);
        let made = tables.dictionary();
        let (mut all, mut wrong) = (0, Vec::new());
        for entry in kind.dictionary.entries() {
            // Three facts: it is there, its type, its access.
            all += 3;
            let Ok(got) = made.find(entry.address) else {
                wrong.push(format!("{} is missing", entry.address));
                continue;
            };
            if got.data_type != entry.data_type {
                wrong.push(format!(
                    "{} {:?} {:?}",
                    entry.address, entry.data_type, got.data_type
                ));
            }
            let same = got.access.writable() == entry.access.writable()
                && got.access.readable() == entry.access.readable();
            if !same {
                wrong.push(format!("{} {} {}", entry.address, entry.access, got.access));
            }
        }
        let more = made.len().saturating_sub(kind.dictionary.len());
        assert_eq!(more, 0, "{name}: objects that it does not have");
        assert!(
            wrong.len() * 100 <= all,
            "{name}: {} of {all}: {wrong:?}",
            wrong.len()
        );
    }
}

fn told(errors: &[&Finding]) -> String {
    let lines: Vec<String> = errors
        .iter()
        .map(|one| format!("{} {:?}", one.code(), one.object))
        .collect();
    lines.join("\n")
}

#[test]
fn limits_are_probed_and_values_put_back() {
    let mut bus = bus("en580c");
    let options = Options { writes: true };
    let made = learn(OnBench(&mut bus), NodeId::ONE, options, |_| {}).expect("a device");
    let limited = made
        .entries()
        .filter(|(_, entry)| entry.high.is_some())
        .count();
    assert!(limited > 3, "{limited} limits");
    let mut master = Master::new(OnBench(&mut bus), NodeId::ONE);
    for (address, entry) in made.entries().filter(|(_, entry)| entry.access.writable()) {
        if let (Ok(bytes), Some(default)) =
            (master.upload(address).expect("an answer"), &entry.default)
            && let Some(wanted) = default.value.integer(1)
        {
            assert_eq!(bytes, wanted.to_le_bytes()[..bytes.len()], "{address}");
        }
    }
}
