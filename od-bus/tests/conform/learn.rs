//! An EDS from a device says what the EDS says that the device was made from.

use od_bench::{EdsOptions, VirtualDevice};
use od_bus::bench::OnBench;
use od_bus::compare::compare;
use od_bus::learn::{Options, learn};
use od_bus::master::Master;
use od_eds::Tables;
use od_model::{Access, Dictionary};
use od_wire::NodeId;

use crate::simulated::{alone, bus};

/// Values whose presence, type or access is another one in a learned dictionary.
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
fn the_twelve_devices_are_learned_and_stand_in() {
    for kind in od_devices::DEVICES {
        let name = kind.name;
        let mut bus = bus(name);
        let made = learn(OnBench(&mut bus), NodeId::ONE, Options::default(), |_| {});
        let text = od_eds::write(&made.expect("a device that answers"));
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
        assert!(differences.is_empty(), "{name}: {differences:?}");
        // The learned file replaces the device.
        let device = VirtualDevice::from_eds(&text, EdsOptions::default()).expect("a device");
        let mut twin = Master::new(OnBench(alone(device)), NodeId::ONE);
        for entry in made.entries().filter(|one| one.access == Access::Const) {
            let bytes = original.upload(entry.address).expect("an answer");
            let same = twin.upload(entry.address).expect("an answer");
            assert_eq!(bytes, same, "{name}: {}", entry.address);
        }
        let differences = compare(made, &mut twin, false).expect("a device that answers");
        assert!(differences.is_empty(), "{name}: {differences:?}");
    }
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
