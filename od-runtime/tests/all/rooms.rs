//! Rooms of a node: what its device has no use for takes none.

use crate::table::{Table, Unknown, With, on, row};
use od_model::row::Row;
use od_runtime::rooms::room;
use od_runtime::{AnyDevice, Device};

fn rooms<D: Device>() -> [usize; 12] {
    core::array::from_fn(room::<D>)
}

struct Few;

impl Table for Few {
    const ROWS: Option<&'static [Row]> = Some(&[row(0x1000, 0), row(0x1015, 0), row(0x2000, 9)]);
}

/// Objects around those of a service, whose greatest sub-indices do not count.
struct Many;

impl Table for Many {
    const ROWS: Option<&'static [Row]> = Some(&[
        row(0x1014, 0),
        row(0x1015, 9),
        row(0x1016, 0),
        row(0x1016, 3),
        row(0x1017, 9),
        row(0x1400, 1),
        row(0x1402, 1),
        row(0x15FF, 0),
        row(0x1600, 2),
        row(0x17FF, 4),
        row(0x1800, 7),
        row(0x19FF, 7),
        row(0x1A00, 5),
        row(0x1A01, 1),
        row(0x1BFF, 6),
        row(0x1C00, 7),
    ]);
}

struct Receiver;

impl Table for Receiver {
    const ROWS: Option<&'static [Row]> = Some(&[
        row(0x1016, 20),
        row(0x1400, 1),
        row(0x1401, 1),
        row(0x1600, 5),
        row(0x1A00, 4),
        row(0x1A01, 0),
    ]);
}

struct Long;

impl Table for Long {
    const ROWS: Option<&'static [Row]> = Some(&[row(0x1600, 7), row(0x1A00, 20)]);
}

#[test]
fn a_device_that_nobody_knows_has_room_for_everything() {
    let all = [32, 16, 16, 8, 8, 1, 1, 1, 1, 1, 8, 0];
    assert_eq!(rooms::<AnyDevice>(), all);
    let none = [5, 5, 0, 4, 0, 0, 0, 0, 0, 0, 8, 0];
    assert_eq!(rooms::<With<Unknown, 0>>(), none);
}

#[test]
fn each_service_takes_its_own_room() {
    const NONE: [usize; 12] = [5, 0, 0, 4, 0, 0, 0, 0, 0, 0, 0, 0];
    let with = |changes: &[(usize, usize)]| {
        let mut rooms = NONE;
        changes.iter().for_each(|(at, size)| rooms[*at] = *size);
        rooms
    };
    assert_eq!(rooms::<With<Few, 0>>(), NONE);
    assert_eq!(rooms::<With<Few, { on::ERRORS }>>(), with(&[(0, 20)]));
    assert_eq!(rooms::<With<Few, { on::EVENTS }>>(), with(&[(2, 16)]));
    assert_eq!(rooms::<With<Few, { on::BEHAVIOUR }>>(), with(&[(3, 8)]));
    assert_eq!(rooms::<With<Few, { on::SERVERS }>>(), with(&[(3, 8)]));
    assert_eq!(rooms::<With<Few, { on::LSS }>>(), with(&[(3, 8), (6, 1)]));
    assert_eq!(rooms::<With<Few, { on::BLOCK }>>(), with(&[(3, 8), (9, 1)]));
    assert_eq!(rooms::<With<Few, { on::GUARDING }>>(), with(&[(5, 1)]));
    let stores = with(&[(7, 1), (8, 1)]);
    assert_eq!(rooms::<With<Few, { on::STORAGE }>>(), stores);
    assert_eq!(rooms::<With<Few, { on::SEGMENTED }>>(), with(&[(9, 1)]));
    let streams = with(&[(8, 1), (9, 1)]);
    assert_eq!(rooms::<With<Few, { on::STREAMS }>>(), streams);
    assert_eq!(rooms::<With<Few, { on::CONSUMER }>>(), NONE, "nobody");
    assert_eq!(rooms::<With<Few, { on::RPDOS }>>(), NONE, "it has none");
}

#[test]
fn sizes_are_those_of_the_dictionary() {
    const SERVICES: u16 = on::CONSUMER | on::RPDOS | on::ERRORS;
    let none = [5, 5, 0, 4, 0, 0, 0, 0, 0, 0, 6, 0];
    assert_eq!(rooms::<With<Many, 0>>(), none);
    let some = [20, 16, 0, 4, 3, 0, 0, 0, 0, 0, 6, 512];
    assert_eq!(rooms::<With<Many, SERVICES>>(), some);
    let watches_many = [20, 0, 0, 4, 8, 0, 0, 0, 0, 0, 5, 2];
    assert_eq!(rooms::<With<Receiver, SERVICES>>(), watches_many);
    let maps_many = [5, 0, 0, 4, 0, 0, 0, 0, 0, 0, 8, 0];
    assert_eq!(rooms::<With<Long, 0>>(), maps_many);
}
