//! Saves with a duration, and the result of an interrupted save (1010h; manual 001, chapter 6.3;
//! manual 003, chapter 5.1.3.1).

use crate::support::{Bench, rows, unsigned};
use od_model::{Access, Address, DataType};
use od_runtime::{CutSave, Event, NoApplication, Restore, SaveAnswer, SavedCobIds};

const SAVE: &str = "601#2310100173617665";
const SAVED: &str = "581#6010100100000000";

/// A node whose save takes 50 ms.
fn bench(answer: SaveAnswer, cut: CutSave) -> Bench {
    let mut all = rows();
    all.push((
        0x2300,
        0,
        DataType::Unsigned32,
        Access::Rw,
        false,
        unsigned(0),
    ));
    let mut bench = Bench::with(all, NoApplication);
    bench.node.device_mut().profile.pdo.event_on_change = false;
    bench.node.device_mut().profile.store.answer = answer;
    bench.node.device_mut().profile.store.cut = cut;
    bench.node.device_mut().profile.store.duration_us = 50_000;
    bench.power_on();
    bench
}

fn write(bench: &mut Bench, value: u8) {
    bench.ask(&format!("601#23002300{value:02X}000000"));
}

/// The value after the next start.
fn after_power_cycle(bench: &mut Bench) -> u64 {
    assert_eq!(bench.power_cycle(), ["701#00"]);
    bench.value(0x2300, 0)
}

#[test]
fn the_response_is_sent_when_all_is_stored() {
    let mut bench = bench(SaveAnswer::AfterStoring, CutSave::Factory);
    write(&mut bench, 7);
    assert!(bench.send(SAVE).is_empty());
    assert!(bench.wait(49).is_empty());
    assert_eq!(bench.wait(1), [(50, SAVED.to_owned())]);
    let events: Vec<_> = std::iter::from_fn(|| bench.node.poll_event()).collect();
    assert_eq!(events.last(), Some(&Event::Saved(1)));
    assert_eq!(after_power_cycle(&mut bench), 7);
}

#[test]
fn a_client_that_does_not_wait_gets_its_response_afterwards() {
    let mut bench = bench(SaveAnswer::AfterStoring, CutSave::Factory);
    bench.send(SAVE);
    assert!(bench.send("601#4001100000000000").is_empty());
    assert!(bench.send("601#4000100000000000").is_empty(), "the newest");
    assert_eq!(
        bench.wait(100),
        [
            (50, SAVED.to_owned()),
            (50, "581#4300100096010200".to_owned())
        ]
    );
    // A client that aborts gets no response, and the device stores the values in any case.
    write(&mut bench, 9);
    bench.send(SAVE);
    assert!(bench.send("601#8010100100000405").is_empty());
    assert!(bench.wait(100).is_empty());
    assert_eq!(bench.ask("601#4000100000000000"), "581#4300100096010200");
    assert_eq!(after_power_cycle(&mut bench), 9);
    // Bits 0 to 4 of the command of an abort mean nothing (CiA 301, chapter 7.2.4.3.17).
    bench.send(SAVE);
    assert!(bench.send("601#9F10100100000405").is_empty());
    assert!(bench.wait(100).is_empty());
}

#[test]
fn two_saves_in_a_row_are_both_carried_out() {
    let mut bench = bench(SaveAnswer::AfterStoring, CutSave::Factory);
    write(&mut bench, 7);
    bench.send(SAVE);
    bench.send(SAVE);
    assert_eq!(
        bench.wait(200),
        [(50, SAVED.to_owned()), (100, SAVED.to_owned())]
    );
    assert_eq!(after_power_cycle(&mut bench), 7);
}

#[test]
fn other_services_continue_and_stopped_drops_the_response() {
    let mut bench = bench(SaveAnswer::AfterStoring, CutSave::Factory);
    write(&mut bench, 7);
    bench.send(SAVE);
    assert_eq!(bench.send("701#R"), [""; 0], "no guarding here");
    bench.send("000#0201");
    assert!(bench.wait(100).is_empty(), "no SDO in Stopped");
    bench.send("000#8001");
    assert_eq!(bench.ask("601#4000100000000000"), "581#4300100096010200");
    assert_eq!(after_power_cycle(&mut bench), 7);
}

#[test]
fn with_an_immediate_response_the_values_of_the_command_are_saved() {
    let mut bench = bench(SaveAnswer::AtOnce, CutSave::Factory);
    write(&mut bench, 7);
    assert_eq!(bench.ask(SAVE), SAVED);
    write(&mut bench, 8);
    bench.wait(50);
    assert_eq!(after_power_cycle(&mut bench), 7);
}

#[test]
fn a_second_save_keeps_the_values_of_the_first() {
    let mut bench = bench(SaveAnswer::AtOnce, CutSave::Factory);
    write(&mut bench, 7);
    bench.ask(SAVE);
    write(&mut bench, 8);
    bench.ask(SAVE);
    bench.wait(50);
    assert_eq!(after_power_cycle(&mut bench), 8);
    // 1011h after a save restores what was saved.
    bench.ask(SAVE);
    bench.ask("601#231110016C6F6164");
    assert_eq!(after_power_cycle(&mut bench), 0);
}

#[test]
fn a_power_failure_during_a_save_leaves_what_the_family_says() {
    for (cut, left) in [(CutSave::LastSet, 7), (CutSave::Factory, 0)] {
        for answer in [SaveAnswer::AtOnce, SaveAnswer::AfterStoring] {
            let mut bench = bench(answer, cut);
            write(&mut bench, 7);
            bench.send(SAVE);
            bench.wait(50);
            write(&mut bench, 8);
            bench.send(SAVE);
            bench.wait(49);
            assert_eq!(after_power_cycle(&mut bench), left, "{cut:?}");
            assert_eq!(after_power_cycle(&mut bench), left, "{cut:?}, for good");
            // The next save works as usual.
            write(&mut bench, 9);
            bench.send(SAVE);
            bench.wait(50);
            assert_eq!(after_power_cycle(&mut bench), 9);
        }
    }
}

#[test]
fn a_reset_during_a_save_interrupts_it() {
    for command in ["000#8101", "000#8201"] {
        let mut bench = bench(SaveAnswer::AtOnce, CutSave::Factory);
        write(&mut bench, 7);
        bench.ask(SAVE);
        bench.wait(50);
        bench.ask(SAVE);
        assert_eq!(bench.send(command), ["701#00"]);
        assert!(bench.wait(100).is_empty());
        assert_eq!(after_power_cycle(&mut bench), 0, "{command}");
    }
}

#[test]
fn a_storage_that_fails_at_the_end_is_reported() {
    let mut bench = bench(SaveAnswer::AfterStoring, CutSave::LastSet);
    bench.send(SAVE);
    bench.node.storage.cut_after(0);
    assert_eq!(
        bench.wait(50),
        [(50, "581#8010100100000606".to_owned())],
        "06060000h"
    );
}

#[test]
fn a_saved_cob_id_follows_the_node_id_or_stays() {
    for (rule, cob_id) in [
        (SavedCobIds::Absolute, 0x187),
        (SavedCobIds::Difference, 0x18F),
    ] {
        let mut bench = bench(SaveAnswer::AtOnce, CutSave::Factory);
        bench.node.device_mut().profile.store.cob_ids = rule;
        bench.ask("601#2301180181010080");
        bench.ask("601#2300180181010080");
        bench.ask("601#2300180187010000");
        bench.ask(SAVE);
        bench.wait(50);
        bench.power_cycle();
        assert_eq!(bench.value(0x1800, 1), 0x187);
        bench.node.power_off();
        bench = bench.at(od_runtime::NodeId::new(9).expect("1 to 127"));
        assert_eq!(bench.power_on(), ["709#00"]);
        assert_eq!(bench.value(0x1800, 1), cob_id, "{rule:?}");
        assert_eq!(bench.value(0x1014, 0), 0x89, "never changed");
    }
}

#[test]
fn a_difference_outside_the_11_bits_is_not_loaded() {
    let mut bench = bench(SaveAnswer::AtOnce, CutSave::Factory);
    bench.node.device_mut().profile.store.cob_ids = SavedCobIds::Difference;
    bench.ask("601#231410008E060000");
    bench.ask("601#23141000DF060080");
    bench.ask("601#23141000F8070080");
    bench.ask(SAVE);
    bench.wait(50);
    bench.node.power_off();
    bench = bench.at(od_runtime::NodeId::new(127).expect("1 to 127"));
    bench.power_on();
    assert_eq!(bench.value(0x1014, 0), 0xFF, "the default");
}

/// A node with groups: 2300h makes a pair with an object of the application group, and so does
/// 2004h, which is never saved.
fn twins(restore: Restore) -> Bench {
    let mut all = rows();
    let rw = |index, sub| {
        (
            index,
            sub,
            DataType::Unsigned32,
            Access::Rw,
            false,
            unsigned(0),
        )
    };
    all.extend([0x2300, 0x2301, 0x6200, 0x6201].map(|index| rw(index, 0)));
    all.extend([0x1010, 0x1011].map(|index| rw(index, 3)));
    let mut bench = Bench::with(all, NoApplication);
    bench.node.device_mut().profile.store.twins = const {
        &[
            [Address::new(0x2300, 0), Address::new(0x6200, 0)],
            [Address::new(0x2004, 0), Address::new(0x6201, 0)],
        ]
    };
    bench.node.device_mut().profile.store.restore = restore;
    bench.node.device_mut().profile.pdo.event_on_change = false;
    bench.power_on();
    for (index, value) in [("0023", 7), ("0123", 8), ("0062", 9), ("0162", 10)] {
        bench.ask(&format!("601#23{index}00{value:02X}000000"));
    }
    bench.ask("601#2F04200003000000");
    bench
}

#[test]
fn a_group_is_saved_with_the_pairs_of_its_objects() {
    let mut bench = twins(Restore::AfterReset);
    assert_eq!(bench.ask("601#2310100373617665"), "581#6010100300000000");
    bench.power_cycle();
    let values = [0x2300, 0x2301, 0x6200, 0x6201, 0x2004].map(|index| bench.value(index, 0));
    assert_eq!(values, [7, 0, 9, 10, 0], "2301h is in another group");
    // Both are restored together, too.
    bench.ask("601#2300230005000000");
    assert_eq!(bench.ask("601#231110036C6F6164"), "581#6011100300000000");
    bench.power_cycle();
    assert_eq!((bench.value(0x2300, 0), bench.value(0x6200, 0)), (0, 0));
}

#[test]
fn an_unsaved_object_of_a_pair_is_not_restored() {
    let mut bench = twins(Restore::AtOnce);
    bench.ask("601#231110036C6F6164");
    let values = [0x2300, 0x2301, 0x6200, 0x6201, 0x2004].map(|index| bench.value(index, 0));
    assert_eq!(values, [0, 8, 0, 0, 3]);
}

/// An application that records the events of the storage.
#[derive(Default)]
struct Hears {
    sound: Vec<bool>,
    ticks: usize,
}

impl od_runtime::Application for Hears {
    fn storage_is(&mut self, sound: bool) {
        self.sound.push(sound);
    }

    fn tick(&mut self, _: &mut od_runtime::Context<'_, '_>) -> Option<od_runtime::Instant> {
        self.ticks += 1;
        None
    }
}

#[test]
fn an_application_is_told_that_its_storage_is_sound() {
    let mut bench = Bench::with(rows(), Hears::default());
    bench.power_on();
    assert_eq!(bench.node.application.sound, [true]);
    for request in [SAVE, "601#231110016C6F6164"] {
        bench.node.application = Hears::default();
        bench.send(request);
        let hears = &bench.node.application;
        assert_eq!(
            (&hears.sound[..], hears.ticks),
            (&[true][..], 1),
            "{request}"
        );
    }
}

#[test]
fn the_newest_set_is_enough_for_a_start() {
    use od_runtime::storage::Storage;
    use od_runtime::storage::image::{newest, writer};
    let mut bench = bench(SaveAnswer::AtOnce, CutSave::LastSet);
    assert_eq!(writer(&mut bench.node.storage), Ok(None));
    assert_eq!(newest(&mut bench.node.storage), Ok(None));
    bench.node.device_mut().profile.store.duration_us = 0;
    for value in [7, 8, 9] {
        write(&mut bench, value);
        assert_eq!(bench.ask(SAVE), SAVED);
        let who = writer(&mut bench.node.storage).expect("it can be read");
        let place = newest(&mut bench.node.storage).expect("it can be read");
        let (who, place) = (who.expect("a set"), place.expect("a set"));
        let mut bytes = vec![0; place.len()];
        bench
            .node
            .storage
            .read(place.start, &mut bytes)
            .expect("there");
        // The same set at the start of another storage.
        let mut other = self::bench(SaveAnswer::AtOnce, CutSave::LastSet);
        other.node.power_off();
        other.node.storage.write(0, &bytes).expect("it has room");
        assert_eq!(writer(&mut other.node.storage), Ok(Some(who)));
        assert_eq!(after_power_cycle(&mut other), u64::from(value));
    }
}
