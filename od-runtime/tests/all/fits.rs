//! A node that does not fit its dictionary says so, and stays without power.

use crate::support::{Row, rows, tables, unsigned};
use crate::table::{Unknown, With, on};
use od_model::{Access, DataType, Dictionary};
use od_runtime::storage::NoStorage;
use od_runtime::{
    AbortCode, AnyDevice, Device, Extra, Extras, Frame, Instant, Lent, NoApplication, Node, NodeId,
    Profile, StoreTooSmall, Unfit,
};

const U32: DataType = DataType::Unsigned32;

/// The result of `power_on` of a fresh node, and whether it then sends its boot-up message.
fn start<const PDO: usize, const SDO: usize>(
    dictionary: Dictionary<'_>,
    values: usize,
) -> (Result<(), Unfit>, bool) {
    start_as::<AnyDevice, PDO, SDO>(dictionary, values)
}

/// As [`start`], of a node of this type.
fn start_as<D: Device, const PDO: usize, const SDO: usize>(
    dictionary: Dictionary<'_>,
    values: usize,
) -> (Result<(), Unfit>, bool) {
    let mut node: Node<D, PDO, SDO> = Node::new(NodeId::ONE);
    let mut device = Lent {
        dictionary,
        values: &mut vec![0; values],
        application: &mut NoApplication,
        storage: &mut NoStorage,
        profile: Some(&Profile::CIA301),
    };
    let result = node.power_on(&mut device, Instant::ZERO);
    assert_eq!(result.is_ok(), node.is_powered());
    let boot_up = Frame::standard(0x701, &[0]);
    let sent = node.poll_transmit(&mut device, Instant::ZERO);
    (result, sent == Some(boot_up))
}

fn with(row: Row) -> Vec<Row> {
    let mut rows = rows();
    rows.push(row);
    rows
}

#[test]
fn sizes_are_those_of_the_dictionary_or_more() {
    let tables = tables(rows());
    let dictionary = tables.dictionary();
    let values = dictionary.store_len();
    let needs = (dictionary.tpdos(), dictionary.rpdos(), dictionary.longest());
    assert_eq!(needs, (2, 2, 1024));
    assert_eq!(start::<2, 1024>(dictionary, values), (Ok(()), true));
    assert_eq!(start::<512, 2000>(dictionary, values), (Ok(()), true));
    let (needed, room) = (1024, 1023);
    assert_eq!(
        start::<2, 1023>(dictionary, values),
        (Err(Unfit::SdoBuffer { needed, room }), false)
    );
    let (needed, room) = (2, 1);
    assert_eq!(
        start::<1, 1024>(dictionary, values),
        (Err(Unfit::Tpdos { needed, room }), false)
    );
    let needed = values;
    assert_eq!(
        start::<2, 1024>(dictionary, values - 1),
        (Err(Unfit::Values(StoreTooSmall { needed })), false)
    );
}

/// A device whose dictionary has no object.
struct Empty;

impl Device for Empty {
    const DICTIONARY: Option<Dictionary<'static>> = Some(Dictionary::EMPTY);
}

#[test]
fn a_node_of_a_dictionary_serves_no_other() {
    let tables = tables(rows());
    let other = tables.dictionary();
    assert_eq!(start_as::<Empty, 2, 1024>(Dictionary::EMPTY, 0).0, Ok(()));
    assert_eq!(
        start_as::<Empty, 2, 1024>(other, other.store_len()),
        (Err(Unfit::Dictionary), false)
    );
}

#[test]
fn pdos_are_counted_to_the_last_one() {
    for (index, tpdos, rpdos) in [
        (0x13FF, 2, 2),
        (0x1403, 2, 4),
        (0x15FF, 2, 512),
        (0x1802, 3, 2),
        (0x19FF, 512, 2),
        (0x1A07, 2, 2),
    ] {
        let tables = tables(with((index, 1, U32, Access::Rw, false, unsigned(0))));
        let dictionary = tables.dictionary();
        assert_eq!((dictionary.tpdos(), dictionary.rpdos()), (tpdos, rpdos));
        let fits = Node::<AnyDevice, 3, 1024>::fits(&dictionary);
        assert_eq!(fits.is_ok(), tpdos <= 3 && rpdos <= 3, "{index:04X}h");
    }
    let needed = 4;
    let tables = tables(with((0x1403, 1, U32, Access::Rw, false, unsigned(0))));
    let fits = Node::<AnyDevice, 3, 1024>::fits(&tables.dictionary());
    assert_eq!(fits, Err(Unfit::Rpdos { needed, room: 3 }));
}

#[test]
fn a_constant_string_counts_with_its_length() {
    let text = |access| {
        let value = od_eds::Value::Text("t".repeat(1500));
        let row = (
            0x2007,
            0,
            DataType::VisibleString,
            access,
            false,
            Some(value),
        );
        tables(with(row)).dictionary().longest()
    };
    assert_eq!((text(Access::Const), text(Access::Rw)), (1500, 1500));
}

#[test]
fn services_that_the_node_lacks_are_named() {
    for (index, unfit) in [
        (0x1200, None),
        (0x1201, Some(Unfit::SdoServer(0x1201))),
        (0x127F, Some(Unfit::SdoServer(0x127F))),
        (0x1280, None),
    ] {
        let tables = tables(with((index, 1, U32, Access::Rw, false, unsigned(0x601))));
        let fits = Node::<AnyDevice, 2, 1024>::fits(&tables.dictionary());
        assert_eq!(fits.err(), unfit);
    }
    for (default, fits) in [
        (unsigned(0x80), Ok(())),
        (unsigned(0x8000_0080), Ok(())),
        (unsigned(0x4000_0080), Err(Unfit::SyncProducer)),
        (
            Some(od_eds::Value::NodeId(0x4000_0080)),
            Err(Unfit::SyncProducer),
        ),
    ] {
        let mut rows = rows();
        let row = rows.iter_mut().find(|row| row.0 == 0x1005);
        row.expect("1005h").5 = default;
        assert_eq!(
            Node::<AnyDevice, 2, 1024>::fits(&tables(rows).dictionary()),
            fits
        );
    }
}

#[test]
fn a_reason_says_what_to_write() {
    let say = |unfit: Unfit| unfit.to_string();
    let (needed, room) = (6, 4);
    assert_eq!(
        say(Unfit::Tpdos { needed, room }),
        "the node has room for 4 of 6 TPDOs; use `Node<_, 6, _>`"
    );
    assert_eq!(
        say(Unfit::Rpdos { needed, room }),
        "the node has room for 4 of 6 RPDOs; use `Node<_, 6, _>`"
    );
    assert_eq!(
        say(Unfit::SdoBuffer { needed, room }),
        "the SDO buffer has room for 4 of the 6 bytes of the longest value; use `Node<_, _, 6>`"
    );
    assert_eq!(
        say(Unfit::SdoServer(0x1201)),
        "1201h: the node has no room for this SDO server"
    );
    assert_eq!(
        say(Unfit::Dictionary),
        "the dictionary is not that of the node's type"
    );
    assert_eq!(
        say(Unfit::SyncProducer),
        "1005h produces SYNC by default, and the node does not; add 1006h, or clear bit 30"
    );
    assert_eq!(
        say(Unfit::from(StoreTooSmall { needed })),
        "the values of the dictionary need 6 bytes; lend a longer slice"
    );
}

#[test]
fn a_node_that_runs_partly_serves_what_it_can() {
    let mut bench = crate::support::Bench::new();
    assert!(crate::support::TestNode::fits(&bench.tables.dictionary()).is_err());
    assert_eq!(bench.power_on(), ["701#00"]);
    // 513 bytes into a DOMAIN of 1024, and a buffer of 512.
    let size = format!("{:08X}", 513u32.swap_bytes());
    let abort = AbortCode::OutOfMemory.code().swap_bytes();
    assert_eq!(
        bench.ask(&format!("601#21032000{size}")),
        format!("581#80032000{abort:08X}")
    );
    assert_eq!(
        bench.ask("601#2103200000020000"),
        "581#6003200000000000",
        "512"
    );
}

#[test]
fn a_streamed_value_needs_a_segment() {
    let mut description = od_eds::Description::default();
    let mut log = od_eds::EntryDescription::new("Log", DataType::Domain);
    log.access = od_eds::Spanned::from(Access::Rw);
    log.capacity = Some(0);
    let log = od_eds::ObjectDescription::var(log);
    description.objects.insert(0x2000, log);
    let tables = od_eds::Tables::new(&description);
    let dictionary = tables.dictionary();
    assert_eq!((dictionary.store_len(), dictionary.longest()), (0, 7));
    assert_eq!(start::<0, 7>(dictionary, 0), (Ok(()), true));
    let (needed, room) = (7, 6);
    assert_eq!(
        start::<0, 6>(dictionary, 0),
        (Err(Unfit::SdoBuffer { needed, room }), false)
    );
}

/// The result of `power_on` of a node without one of the services, with a dictionary of this object only.
fn alone<D: Device, X: Extras<D, 64>>(index: u16) -> Result<(), Unfit> {
    let tables = tables(vec![(index, 1, U32, Access::Rw, false, unsigned(0))]);
    Node::<D, 2, 64, X>::fits(&tables.dictionary())
}

#[test]
fn services_that_are_switched_off_are_named() {
    const ALL: u16 = u16::MAX;
    type Without<const SERVICE: u16> = With<Unknown, SERVICE>;
    for (index, answer) in [
        (0x100B, Ok(())),
        (0x100C, Err(Unfit::Service(0x100C))),
        (0x100D, Err(Unfit::Service(0x100D))),
        (0x1010, Ok(())),
    ] {
        assert_eq!(alone::<Without<{ ALL ^ on::GUARDING }>, ()>(index), answer);
        assert_eq!(alone::<Without<ALL>, ()>(index), Ok(()));
    }
    for (index, answer) in [
        (0x100F, Ok(())),
        (0x1010, Err(Unfit::Service(0x1010))),
        (0x1011, Err(Unfit::Service(0x1011))),
        (0x1012, Ok(())),
    ] {
        assert_eq!(alone::<Without<{ ALL ^ on::STORAGE }>, ()>(index), answer);
    }
    for (index, answer) in [
        (0x1016, Err(Unfit::Service(0x1016))),
        (0x1017, Ok(())),
        (0x1029, Ok(())),
    ] {
        assert_eq!(alone::<Without<{ ALL ^ on::CONSUMER }>, ()>(index), answer);
    }
    for (index, answer) in [
        (0x1016, Ok(())),
        (0x1028, Ok(())),
        (0x1029, Err(Unfit::Service(0x1029))),
    ] {
        assert_eq!(alone::<Without<{ ALL ^ on::BEHAVIOUR }>, ()>(index), answer);
    }
    for (index, answer) in [
        (0x13FF, Ok(())),
        (0x1400, Err(Unfit::Service(0x1400))),
        (0x17FF, Err(Unfit::Service(0x17FF))),
        (0x1800, Ok(())),
    ] {
        assert_eq!(alone::<Without<{ ALL ^ on::RPDOS }>, ()>(index), answer);
        assert_eq!(alone::<Without<ALL>, ()>(index), Ok(()));
    }
    assert_eq!(alone::<AnyDevice, ()>(0x1012), Ok(()), "as a value");
    assert_eq!(alone::<Empty, ()>(0x1012), Err(Unfit::Service(0x1012)));
    assert_eq!(alone::<Empty, ()>(0x1013), Ok(()));
}

#[test]
fn further_servers_need_room_and_the_service() {
    type Room<const SERVICES: u16> = Extra<With<Unknown, SERVICES>, 64, 3>;
    const ON: u16 = on::SERVERS;
    for (index, answer) in [
        (0x1200, Ok(())),
        (0x1201, Ok(())),
        (0x1203, Ok(())),
        (0x1204, Err(Unfit::SdoServer(0x1204))),
    ] {
        assert_eq!(alone::<With<Unknown, ON>, Room<ON>>(index), answer);
    }
    let answer = alone::<With<Unknown, 0>, Room<0>>(0x1201);
    assert_eq!(answer, Err(Unfit::SdoServer(0x1201)));
}

#[test]
fn a_sync_producer_needs_its_period_its_room_and_the_service() {
    fn fits<D: Device, X: Extras<D, 64>>(with_period: bool) -> Result<(), Unfit> {
        let mut rows = vec![(0x1005, 0, U32, Access::Rw, false, unsigned(0x4000_0080))];
        if with_period {
            rows.push((0x1006, 0, U32, Access::Rw, false, unsigned(0)));
        }
        Node::<D, 2, 64, X>::fits(&tables(rows).dictionary())
    }
    use crate::support::Full;
    const NO: Result<(), Unfit> = Err(Unfit::SyncProducer);
    assert_eq!(fits::<Full, Extra<Full, 64, 0>>(true), Ok(()));
    assert_eq!(fits::<Full, Extra<Full, 64, 0>>(false), NO);
    assert_eq!(fits::<Full, ()>(true), NO);
    assert_eq!(fits::<AnyDevice, Extra<AnyDevice, 64, 0>>(true), NO);
}
