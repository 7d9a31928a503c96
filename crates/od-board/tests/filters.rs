//! The acceptance filters pass every frame that a node uses.

mod support;

use odkit::board::{Filters, Owner};
use odkit::nmt::State;
use odkit::rooms::{LoadedRooms, LoadedValues};
use odkit::storage::{Memory, NoStorage};
use odkit::{
    CanId, Device, Dictionary, Frame, Instant, NoApplication, Node, NodeId, Profile, Services,
};
use support::{Random, frame, sent, thermometer};

odkit::object_dictionary! {
    /// A device with all objects of CiA 301.
    mod everything {
        eds = "../../../firmware/eds/ds301.eds";
    }
}

/// A device whose dictionary is known at run time.
struct Loaded {
    dictionary: Dictionary<'static>,
    profile: &'static Profile,
}

impl Services for Loaded {
    const SERVERS: bool = true;
    const SYNC_PRODUCER: bool = true;
    const TIME: bool = true;
}

impl Device for Loaded {
    type Values = LoadedValues;
    type Rooms = LoadedRooms;

    fn dictionary(&self) -> Dictionary<'_> {
        self.dictionary
    }

    fn profile(&self) -> &Profile {
        self.profile
    }
}

type Any = Node<Loaded, NoApplication, Memory<Vec<u8>>>;

/// State of the node that is visible from outside.
fn shows(node: &mut Any, now: Instant) -> (Vec<String>, Option<Instant>, State, Vec<u8>) {
    let frames = sent(node, now);
    (
        frames,
        node.poll_timeout(),
        node.state(),
        node.values().to_vec(),
    )
}

/// Plays the same frames to a node that gets all frames and to one behind filters.
fn compare(name: &str, dictionary: Dictionary<'static>, profile: &'static Profile, steps: u32) {
    let mut random = Random(0x1234_5678_9ABC_DEF1);
    let node = || {
        let memory = Memory::new(vec![0; 16 * 1024]);
        let loaded = Loaded {
            dictionary,
            profile,
        };
        let mut node = Node::new(loaded, NodeId::ONE, NoApplication, memory);
        node.power_on(Instant::ZERO);
        node
    };
    let (mut all, mut filtered) = (node(), node());
    let mut now = Instant::ZERO;
    let mut filters = Filters::<64>::default();
    let (mut refused, mut changes) = (0, 0);
    let ids = [
        0x181, 0x201, 0x202, 0x281, 0x301, 0x333, 0x401, 0x80, 0x85, 0x701, 0x705, 0x77F, 0x601,
        0x605, 0x7E5, 0,
    ];
    let lengths = [0, 1, 2, 4, 8];
    for step in 0..steps {
        let node_id = u16::from(all.node_id().raw());
        let bytes = random.below(u64::MAX).to_le_bytes();
        let frame = match random.below(10) {
            // Configuration: COB-IDs, monitored nodes, the node ID of a family that has an object
            // for it.
            0 | 1 => {
                let object = random.one_of(&[
                    [0x23, 0x05, 0x10, 0],
                    [0x23, 0x12, 0x10, 0],
                    [0x23, 0x16, 0x10, 1],
                    [0x23, 0x16, 0x10, 2],
                    [0x23, 0x00, 0x14, 1],
                    [0x23, 0x01, 0x14, 1],
                    [0x23, 0x00, 0x18, 1],
                    [0x23, 0x01, 0x18, 1],
                    [0x23, 0x00, 0x12, 1],
                    [0x23, 0x01, 0x12, 1],
                    [0x2F, 0x00, 0x14, 2],
                    [0x2B, 0x17, 0x10, 0],
                    [0x2B, 0x0C, 0x10, 0],
                    [0x2F, 0x0D, 0x10, 0],
                    [0x2F, 0x01, 0x21, 0],
                ]);
                let value = match object[1..3] {
                    [0x16, 0x10] => (random.below(6) as u32) << 16 | 500,
                    [0x17, 0x10] => random.one_of(&[0, 100]),
                    [0x01, 0x21] => random.one_of(&[1, 2, 5]),
                    _ => {
                        let flags = random.one_of(&[0, 0, 0, 1 << 31, 1 << 30, 1 << 29]);
                        u32::from(random.one_of(&ids)) | flags
                    }
                };
                let mut data = [0; 8];
                data[..4].copy_from_slice(&object);
                data[4..].copy_from_slice(&value.to_le_bytes());
                Frame::full(CanId::standard(0x600 + node_id), data)
            }
            2 => {
                let command = random.one_of(&[1, 1, 1, 2, 0x80, 0x81, 0x82]);
                Frame::standard(0, &[command, random.one_of(&[0, node_id as u8])])
            }
            // LSS: the configuration state and back, a node ID, store.
            3 => {
                let data = random.one_of(&[[4, 1], [4, 0], [0x11, 3], [0x11, 7], [0x17, 0]]);
                Frame::full(CanId::standard(0x7E5), [data[0], data[1], 0, 0, 0, 0, 0, 0])
            }
            kind => {
                let id = match kind {
                    4 => CanId::extended(random.one_of(&ids).into()),
                    5 | 6 => CanId::standard(step as u16),
                    _ => CanId::standard(random.one_of(&ids)),
                };
                match random.below(4) {
                    0 => Frame::remote(id, 8).expect("a length"),
                    _ => Frame::with_dlc(id, bytes, random.one_of(&lengths)),
                }
            }
        };
        now = now.plus_millis(random.below(40));
        let mut told = Vec::new();
        if let Some(ids) = filtered.poll_wanted_ids() {
            told.extend(ids);
            changes += 1;
            filters = told.iter().copied().collect();
        }
        let passes = filters
            .as_slice()
            .iter()
            .any(|filter| filter.accepts(frame.id()));
        refused += u32::from(!passes);
        for (node, passes) in [(&mut all, true), (&mut filtered, passes)] {
            node.catch_up(now);
            if passes {
                node.handle_frame(now, &frame);
            }
        }
        assert_eq!(
            shows(&mut all, now),
            shows(&mut filtered, now),
            "{name}, step {step}: {frame} with {filters:?}"
        );
    }
    assert!(refused > steps / 4, "{name}: {refused} of {steps} refused");
    assert!(changes > 5, "{name}: {changes} changes");
}

#[test]
fn rejected_frames_have_no_effect_on_the_node() {
    for kind in od_devices::DEVICES {
        compare(kind.name, kind.dictionary, kind.profile, 3_000);
    }
    let plain = thermometer::DICTIONARY;
    compare("thermometer", plain, &Profile::CIA301, 3_000);
    const LSS: Profile = Profile {
        lss: Some(odkit::LssProfile::CIA305),
        ..Profile::CIA301
    };
    compare("ds301", everything::DICTIONARY, &LSS, 10_000);
}

#[test]
fn changed_filters_are_reported() {
    let mut node = Node::new(thermometer::Device, NodeId::ONE, NoApplication, NoStorage);
    let now = Instant::ZERO;
    let told = |node: &mut thermometer::Node| {
        let told = node.poll_wanted_ids().into_iter().flatten();
        let mut ids: Vec<u32> = told.map(|id| id.raw()).collect();
        ids.sort_unstable();
        ids
    };
    node.power_on(now);
    let first = [0, 0x80, 0x181, 0x201, 0x601, 0x701];
    assert_eq!(told(&mut node), first);
    node.handle_frame(now, &frame("601#4000100000000000"));
    assert!(told(&mut node).is_empty());
    // The RPDO, the TPDO without remote frames, a monitored node.
    node.handle_frame(now, &frame("601#2300140101020080"));
    assert_eq!(told(&mut node), [0, 0x80, 0x181, 0x601, 0x701]);
    node.handle_frame(now, &frame("601#2300140133030000"));
    assert_eq!(told(&mut node), [0, 0x80, 0x181, 0x333, 0x601, 0x701]);
    node.handle_frame(now, &frame("601#2300180181010080"));
    node.handle_frame(now, &frame("601#2300180181010040"));
    assert_eq!(told(&mut node), [0, 0x80, 0x333, 0x601, 0x701]);
    node.handle_frame(now, &frame("601#23161001F4010900"));
    assert_eq!(told(&mut node), [0, 0x80, 0x333, 0x601, 0x701, 0x709]);
    assert!(told(&mut node).is_empty());
}

/// However few filters there are, they pass all frames that they are made for.
#[test]
fn fewer_filters_pass_more_frames_but_never_fewer() {
    let mut random = Random(77);
    for _ in 0..500 {
        let ids: Vec<CanId> = (0..random.below(20))
            .map(|_| match random.below(5) {
                0 => CanId::extended(random.below(1 << 29) as u32),
                _ => CanId::standard(random.below(1 << 11) as u16),
            })
            .collect();
        fn accepted<const N: usize>(ids: &[CanId], all: &[CanId]) -> usize {
            let filters: Filters<N> = ids.iter().copied().collect();
            assert!(filters.as_slice().len() <= N);
            let passes = |id: &CanId| filters.as_slice().iter().any(|filter| filter.accepts(*id));
            assert!(ids.iter().all(passes), "{ids:?} {filters:?}");
            all.iter().filter(|id| passes(id)).count()
        }
        let all: Vec<CanId> = (0..0x800).map(CanId::standard).collect();
        let exact = accepted::<32>(&ids, &all);
        let standard: std::collections::BTreeSet<_> =
            ids.iter().filter(|id| !id.is_extended()).collect();
        assert_eq!(exact, standard.len());
        assert!(accepted::<14>(&ids, &all) >= exact);
        accepted::<3>(&ids, &all);
        accepted::<2>(&ids, &all);
    }
}
