//! Saved values that exist and cannot be loaded: the node reports it, and a master may replace
//! them.

mod support;

use odkit::board::storage::Mirror;
use odkit::storage::image::capacity_needed;
use odkit::storage::{Storage, StorageError};
use odkit::{Application, Context, Instant, NodeId};
use support::{frame, sent, thermometer};

const SAVED: usize = capacity_needed(&thermometer::DICTIONARY);
type Mirrored = Mirror<SAVED, { thermometer::STORE_LEN }>;

/// Records what it was told of the storage, and saves operating records when time passes.
#[derive(Default)]
struct Told {
    sound: Option<bool>,
}

impl Application for Told {
    fn tick(&mut self, cx: &mut Context<'_, '_>) -> Option<Instant> {
        if cx.now > Instant::ZERO {
            cx.signals.keep();
        }
        Some(cx.now.plus_millis(1))
    }

    fn storage_is(&mut self, sound: bool) {
        self.sound = Some(sound);
    }
}

#[test]
fn a_set_that_cannot_be_loaded_is_damage_until_a_master_saves() {
    type Node = thermometer::Node<Told, Mirrored>;
    let lost = |lose: &dyn Fn(&mut Mirrored)| {
        let mut mirror = Mirror::new(&thermometer::DICTIONARY);
        lose(&mut mirror);
        let mut node = Node::new(thermometer::Device, NodeId::ONE, Told::default(), mirror);
        node.power_on(Instant::ZERO);
        sent(&mut node, Instant::ZERO);
        node
    };
    // A program with more values made the set.
    let longer = |mirror: &mut Mirrored| {
        let result = mirror.load(&[0x55; SAVED / 2 + 1]);
        assert_eq!(result, Err(StorageError::OutOfRange));
    };
    let unreadable = |mirror: &mut Mirrored| mirror.lose(StorageError::Device);
    for lose in [&longer as &dyn Fn(&mut _), &unreadable] {
        let mut node = lost(lose);
        assert_eq!(node.application.sound, Some(false));
        assert!(node.storage.newest().0.is_empty());
        // The device itself does not replace it.
        node.handle_timeout(Instant::from_millis(5));
        assert!(!node.storage.is_writing());
        // 1011h:01 does not either, because it has nothing to restore.
        node.handle_frame(Instant::ZERO, &frame("601#231110016C6F6164"));
        assert_eq!(sent(&mut node, Instant::ZERO), ["581#8011100100000606"]);
        assert_eq!(node.application.sound, Some(false));
        // 1010h:01 replaces it, and the storage is sound again.
        node.handle_frame(Instant::ZERO, &frame("601#2310100173617665"));
        assert_eq!(sent(&mut node, Instant::ZERO), [] as [String; 0]);
        while node.storage.step() {}
        let (set, number) = node.storage.newest();
        let set = set.to_vec();
        node.storage.stored(number, Ok(()));
        node.handle_timeout(Instant::from_millis(10));
        assert_eq!(
            sent(&mut node, Instant::from_millis(10)),
            ["581#6010100100000000"]
        );
        assert_eq!(node.application.sound, Some(true));
        let node = lost(&|mirror| mirror.load(&set).expect("its own set"));
        assert_eq!(node.application.sound, Some(true));
    }
}
