//! A configuration is read, written, and restored if the node refuses a part.

use od_model::{Address, Dictionary};
use od_sim::bus::Bus;
use od_tools::bench::OnBench;
use od_tools::configure::{Setting, addresses, apply, read};
use od_tools::master::Master;

use crate::{bus, id};

type Values = Vec<(Address, Vec<u8>)>;

fn all(bus: &mut Bus, dictionary: Dictionary<'_>) -> Values {
    let mut master = Master::new(OnBench(bus), id(5));
    let found = read(&mut master, &addresses(dictionary), |_| {}).expect("a node");
    found
        .into_iter()
        .filter_map(|(address, bytes)| Some((address, bytes.ok()?)))
        .collect()
}

fn settings(values: &Values) -> Vec<Setting> {
    let values = values.iter().cloned();
    values
        .map(|(address, bytes)| Setting { address, bytes })
        .collect()
}

#[track_caller]
fn write(bus: &mut Bus, address: Address, bytes: &[u8]) {
    let mut master = Master::new(OnBench(bus), id(5));
    assert_eq!(master.download(address, bytes), Ok(()), "{address}");
}

#[test]
fn a_configuration_that_was_read_can_be_restored_on_all_twelve_devices() {
    for kind in od_devices::DEVICES {
        let mut bus = bus(&[(kind.name, 5)]);
        let before = all(&mut bus, kind.dictionary);
        assert!(before.len() > 10, "{}", kind.name);
        let heartbeat = Address::new(0x1017, 0);
        let event_timer = Address::new(0x1800, 5);
        write(&mut bus, heartbeat, &[100, 0]);
        write(&mut bus, event_timer, &[50, 0]);
        let mut master = Master::new(OnBench(&mut bus), id(5));
        let applied = apply(&mut master, &settings(&before), |_| {}).expect("a node");
        assert!(applied.wrong.is_empty(), "{}: {applied:?}", kind.name);
        assert_eq!(all(&mut bus, kind.dictionary), before, "{}", kind.name);
    }
}

#[test]
fn a_mapping_changes_while_its_pdo_is_not_valid() {
    let dictionary = od_devices::find("eam_mt").expect("a device").dictionary;
    let mut bus = bus(&[("eam_mt", 5)]);
    let mut wanted = all(&mut bus, dictionary);
    // Position value and diagnostic are mapped into the first TPDO, which is valid again
    // afterwards.
    for (sub, value) in [(1, 0x6004_0020_u32), (2, 0x2117_0010)] {
        let place = wanted
            .iter_mut()
            .find(|(one, _)| *one == Address::new(0x1A00, sub));
        place.expect("a mapping").1 = value.to_le_bytes().to_vec();
    }
    let count = wanted
        .iter_mut()
        .find(|(one, _)| *one == Address::new(0x1A00, 0));
    count.expect("a mapping").1 = vec![2];
    let mut master = Master::new(OnBench(&mut bus), id(5));
    let applied = apply(&mut master, &settings(&wanted), |_| {}).expect("a node");
    assert!(
        applied.wrong.is_empty() && applied.written >= 2,
        "{applied:?}"
    );
    assert_eq!(all(&mut bus, dictionary), wanted);
}

#[test]
fn if_one_value_is_refused_the_others_are_restored() {
    let dictionary = od_devices::find("gxmm").expect("a device").dictionary;
    let mut bus = bus(&[("gxmm", 5)]);
    let before = all(&mut bus, dictionary);
    let mut wanted = before.clone();
    for (address, bytes) in &mut wanted {
        match (address.index, address.sub) {
            (0x1017, 0) => *bytes = vec![100, 0],
            (0x1800, 5) => *bytes = vec![50, 0],
            // More than the encoder has.
            (0x6001, 0) => *bytes = vec![0xFF; 4],
            _ => {}
        }
    }
    let mut master = Master::new(OnBench(&mut bus), id(5));
    let applied = apply(&mut master, &settings(&wanted), |_| {}).expect("a node");
    assert!(
        applied.is_put_back && applied.left.is_empty(),
        "{applied:?}"
    );
    let wrong: Vec<_> = applied
        .wrong
        .iter()
        .map(|one| one.setting.address)
        .collect();
    assert_eq!(wrong, [Address::new(0x6001, 0)]);
    assert_eq!(all(&mut bus, dictionary), before);
    // For an object that does not exist nothing is written at all.
    let mut more = settings(&wanted);
    more.push(Setting {
        address: Address::new(0x5FFE, 0),
        bytes: vec![1],
    });
    let mut master = Master::new(OnBench(&mut bus), id(5));
    let applied = apply(&mut master, &more, |_| {}).expect("a node");
    assert!(applied.is_put_back && applied.written == 0, "{applied:?}");
    assert_eq!(all(&mut bus, dictionary), before);
}
