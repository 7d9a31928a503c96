//! Memory of a node: services that its device does not use take none.

use crate::support::{Full, Row, rows, tables, unsigned};
use crate::table::{With, on};
use od_model::{Access, DataType};
use od_runtime::Device;
use od_runtime::rooms::Sizes;

fn sizes<D: Device>(rows: Vec<Row>) -> Sizes {
    Sizes::of::<D>(&tables(rows).dictionary())
}

fn few() -> Vec<Row> {
    vec![(
        0x1000,
        0,
        DataType::Unsigned32,
        Access::Ro,
        false,
        unsigned(0),
    )]
}

type Of<const SERVICES: u16> = With<SERVICES>;

#[test]
fn a_device_with_every_service_has_room_for_it() {
    let all = sizes::<Full>(rows());
    assert_eq!((all.tpdos, all.rpdos, all.servers), (2, 2, 1));
    assert_eq!((all.errors, all.changes, all.messages), (32, 32, 16));
    assert_eq!((all.events, all.frames), (16, 9));
    assert_eq!((all.guards, all.lss, all.saves, all.clocks), (1, 1, 1, 1));
    // Eight entries in each of the four mappings.
    assert_eq!(all.mapped, 32);
    // The longest value, a DOMAIN.
    assert_eq!(all.buffers, 512);
    let values = tables(rows()).dictionary().store_len();
    assert_eq!(all.values, values);
}

#[test]
fn each_service_takes_its_own_memory() {
    let none = sizes::<Of<0>>(few());
    assert_eq!(
        (none.tpdos, none.rpdos, none.mapped, none.servers),
        (0, 0, 0, 1)
    );
    assert_eq!((none.errors, none.changes, none.messages), (5, 5, 0));
    assert_eq!((none.events, none.frames, none.watches), (0, 5, 0));
    assert_eq!(
        (none.guards, none.lss, none.saves, none.clocks),
        (0, 0, 0, 0)
    );
    assert_eq!(sizes::<Of<{ on::ERRORS }>>(few()).errors, 20);
    assert_eq!(sizes::<Of<{ on::EVENTS }>>(few()).events, 16);
    assert_eq!(sizes::<Of<{ on::GUARDING }>>(few()).guards, 1);
    assert_eq!(sizes::<Of<{ on::LSS }>>(few()).lss, 1);
    assert_eq!(sizes::<Of<{ on::STORAGE }>>(few()).saves, 1);
    assert_eq!(sizes::<Of<{ on::TIME }>>(few()).clocks, 1);
    assert_eq!(sizes::<Of<{ on::SYNC_PRODUCER }>>(few()).clocks, 1);
    for frames in [
        sizes::<Of<{ on::LSS }>>(few()).frames,
        sizes::<Of<{ on::BLOCK }>>(few()).frames,
        sizes::<Of<{ on::SERVERS }>>(few()).frames,
        sizes::<Of<{ on::BEHAVIOUR }>>(few()).frames,
    ] {
        assert_eq!(frames, 9);
    }
}

#[test]
fn sizes_are_those_of_the_dictionary() {
    let with = |index, sub| {
        let mut rows = rows();
        rows.push((
            index,
            sub,
            DataType::Unsigned32,
            Access::Rw,
            false,
            unsigned(0),
        ));
        rows
    };
    for (index, tpdos, rpdos) in [
        (0x1403, 2, 4),
        (0x15FF, 2, 512),
        (0x1802, 3, 2),
        (0x19FF, 512, 2),
    ] {
        let sizes = sizes::<Full>(with(index, 1));
        assert_eq!((sizes.tpdos, sizes.rpdos), (tpdos, rpdos), "{index:04X}h");
    }
    assert_eq!(sizes::<Of<0>>(with(0x1403, 1)).rpdos, 0);
    assert_eq!(sizes::<Full>(with(0x1016, 3)).watches, 3);
    assert_eq!(
        sizes::<Full>(with(0x1016, 20)).watches,
        8,
        "the node watches 8"
    );
    let servers = sizes::<Full>(with(0x1203, 1));
    assert_eq!((servers.servers, servers.buffers), (4, 4 * 512));
    assert_eq!(sizes::<Of<0>>(with(0x1203, 1)).servers, 1);
}
