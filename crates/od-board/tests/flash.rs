//! Saves on NOR flash: in the background in bounded steps, and inside the call; power failures in
//! any step.
#![cfg(feature = "flash")]

#[path = "../../od-runtime/tests/all/nor.rs"]
mod nor;
mod support;

use std::cell::{Cell, RefCell};
use std::pin::pin;
use std::rc::Rc;
use std::task::{Context, Poll, Waker};

use embedded_storage::nor_flash::{
    ErrorType, NorFlash, NorFlashError, NorFlashErrorKind, ReadNorFlash,
};
use odkit::board::Owner;
use odkit::board::storage::{Joined, Log, Mirror, Nor, Steps};
use odkit::storage::image::capacity_needed;
use odkit::storage::{Storage, image};
use odkit::{Event, Instant, NoApplication, NodeId};
use support::{frame, sent, thermometer};

const SAVED: usize = capacity_needed(&thermometer::DICTIONARY);
const BUFFER: usize = SAVED / 2 + 64;

type Mirrored = thermometer::Node<NoApplication, Mirror<SAVED, { thermometer::STORE_LEN }>>;

/// The only error of the flash.
#[derive(Clone, Copy, Debug)]
struct Failed;

impl NorFlashError for Failed {
    fn kind(&self) -> NorFlashErrorKind {
        NorFlashErrorKind::Other
    }
}

/// The strict flash as a driver. The test reads it while the log owns it; the pages of the log are
/// `N` of the flash.
#[derive(Clone)]
struct Chip<const PAGE: usize, const WORD: usize, const N: usize> {
    nor: Rc<RefCell<nor::Nor>>,
    /// Calls that change the flash.
    calls: Rc<Cell<usize>>,
}

impl<const PAGE: usize, const WORD: usize, const N: usize> Chip<PAGE, WORD, N> {
    fn new(pages: usize) -> Self {
        Self {
            nor: Rc::new(RefCell::new(nor::Nor::new(pages * PAGE, PAGE, WORD))),
            calls: Rc::default(),
        }
    }

    fn end(&self) -> u32 {
        self.nor.borrow().bytes.len() as u32
    }
}

impl<const PAGE: usize, const WORD: usize, const N: usize> ErrorType for Chip<PAGE, WORD, N> {
    type Error = Failed;
}

impl<const PAGE: usize, const WORD: usize, const N: usize> ReadNorFlash for Chip<PAGE, WORD, N> {
    const READ_SIZE: usize = if WORD == 4 { 4 } else { 1 };

    fn read(&mut self, offset: u32, bytes: &mut [u8]) -> Result<(), Failed> {
        assert!((offset as usize).is_multiple_of(Self::READ_SIZE));
        assert!(bytes.len().is_multiple_of(Self::READ_SIZE));
        let mut nor = self.nor.borrow_mut();
        nor.read(offset as usize, bytes).map_err(|_| Failed)
    }

    fn capacity(&self) -> usize {
        self.nor.borrow().bytes.len()
    }
}

impl<const PAGE: usize, const WORD: usize, const N: usize> NorFlash for Chip<PAGE, WORD, N> {
    const WRITE_SIZE: usize = WORD;
    const ERASE_SIZE: usize = PAGE;

    fn erase(&mut self, from: u32, to: u32) -> Result<(), Failed> {
        assert_eq!(to - from, PAGE as u32);
        self.calls.set(self.calls.get() + 1);
        let mut nor = self.nor.borrow_mut();
        nor.erase(from as usize).map_err(|_| Failed)
    }

    fn write(&mut self, offset: u32, bytes: &[u8]) -> Result<(), Failed> {
        self.calls.set(self.calls.get() + 1);
        let mut nor = self.nor.borrow_mut();
        nor.write(offset as usize, bytes).map_err(|_| Failed)
    }
}

/// Runs a future to its end; calls `between` before each step.
fn wait<T>(future: impl Future<Output = T>, mut between: impl FnMut()) -> T {
    let mut future = pin!(future);
    let mut cx = Context::from_waker(Waker::noop());
    loop {
        between();
        if let Poll::Ready(result) = future.as_mut().poll(&mut cx) {
            return result;
        }
    }
}

fn log<const PAGE: usize, const WORD: usize, const N: usize>(
    chip: &Chip<PAGE, WORD, N>,
) -> Log<Joined<Steps<Chip<PAGE, WORD, N>>, N>, BUFFER> {
    Log::new(Joined(Steps(chip.clone())), 0..chip.end())
}

/// Switches power on; returns the saved heartbeat time.
fn start<const PAGE: usize, const WORD: usize, const N: usize>(
    chip: &Chip<PAGE, WORD, N>,
) -> (Mirrored, Log<Joined<Steps<Chip<PAGE, WORD, N>>, N>, BUFFER>) {
    let mut log = log(chip);
    let mut node = Mirrored::new(
        thermometer::Device,
        NodeId::ONE,
        NoApplication,
        Mirror::new(&thermometer::DICTIONARY),
    );
    wait(log.load(&mut node.storage), || {}).expect("a flash that works");
    node.power_on(Instant::ZERO);
    sent(&mut node, Instant::ZERO);
    (node, log)
}

/// Heartbeat time in milliseconds.
fn time(node: &Mirrored) -> Option<u64> {
    node.poll_timeout().map(|at| at.as_micros() / 1000)
}

/// A master sets the heartbeat time and saves it.
fn command(node: &mut impl Owner, time: u16) -> Vec<String> {
    let [low, high] = time.to_le_bytes();
    let now = Instant::ZERO;
    node.handle_frame(now, &frame(&format!("601#2B171000{low:02X}{high:02X}0000")));
    node.handle_frame(now, &frame("601#2310100173617665"));
    sent(node, now)
}

const SET: &str = "581#6017100000000000";
const SAVED_NOW: &str = "581#6010100100000000";
const NOT_SAVED: &str = "581#8010100100000606";

#[test]
fn the_response_to_a_save_follows_when_the_flash_has_it() {
    let chip = Chip::<1024, 8, 1>::new(3);
    let (node, mut log) = start(&chip);
    let node = RefCell::new(node);
    assert_eq!(command(&mut *node.borrow_mut(), 700), [SET]);
    let mut now = Instant::ZERO;
    let save = log.save(|act| act(&mut node.borrow_mut().storage));
    let mut steps = 0;
    let mut calls = chip.calls.get();
    wait(save, || {
        // Between two steps the node is free, and its master has no response yet.
        let in_step = chip.calls.get() - calls;
        assert!(in_step <= 1, "{in_step} changes of the flash in a step");
        (calls, steps) = (chip.calls.get(), steps + 1);
        let mut node = node.borrow_mut();
        now = now.plus_millis(1);
        node.catch_up(now);
        assert_eq!(sent(&mut *node, now), [""; 0]);
    });
    assert!(steps > 5, "{steps}");
    let mut node = node.into_inner();
    now = now.plus_millis(3);
    node.catch_up(now);
    assert_eq!(sent(&mut node, now), [SAVED_NOW]);
    let events: Vec<_> = std::iter::from_fn(|| node.poll_event()).collect();
    assert!(events.contains(&Event::Saved(1)), "{events:?}");
    // A restore waits, too.
    node.handle_frame(now, &frame("601#231110016C6F6164"));
    assert_eq!(sent(&mut node, now), [""; 0]);
    let node = RefCell::new(node);
    wait(log.save(|act| act(&mut node.borrow_mut().storage)), || {});
    let mut node = node.into_inner();
    node.catch_up(now.plus_millis(3));
    assert_eq!(
        sent(&mut node, now.plus_millis(3)),
        ["581#6011100100000000"]
    );
    assert_eq!(time(&start(&chip).0), None);
}

#[test]
fn a_task_stores_all_saves() {
    let chip = Chip::<1024, 4, 1>::new(4);
    let (node, mut log) = start(&chip);
    let node = RefCell::new(node);
    let mut task = pin!(log.run(|act| act(&mut node.borrow_mut().storage)));
    let mut cx = Context::from_waker(Waker::noop());
    let mut now = Instant::ZERO;
    for time in 1..20 {
        command(&mut *node.borrow_mut(), time * 100);
        let mut answers = Vec::new();
        while answers.is_empty() {
            assert!(task.as_mut().poll(&mut cx).is_pending());
            now = now.plus_millis(1);
            node.borrow_mut().catch_up(now);
            answers = sent(&mut *node.borrow_mut(), now);
            answers.retain(|frame| frame.starts_with("581"));
        }
        assert_eq!(answers, [SAVED_NOW]);
        assert_eq!(self::time(&start(&chip).0), Some(u64::from(time) * 100));
    }
}

fn erasures<const PAGE: usize, const WORD: usize>(pages: usize) -> (usize, Vec<usize>) {
    let chip = Chip::<PAGE, WORD, 1>::new(pages);
    let (node, mut log) = start(&chip);
    let node = RefCell::new(node);
    let mut places = vec![0; pages];
    for save in 0..300u16 {
        command(&mut *node.borrow_mut(), 1 + save);
        let before = chip.nor.borrow().bytes.clone();
        wait(log.save(|act| act(&mut node.borrow_mut().storage)), || {});
        let mut node = node.borrow_mut();
        node.catch_up(Instant::from_millis(3 + 3 * u64::from(save)));
        sent(&mut *node, Instant::ZERO);
        let after = &chip.nor.borrow().bytes;
        for (page, place) in places.iter_mut().enumerate() {
            let of = page * PAGE..(page + 1) * PAGE;
            *place += usize::from(before[of.clone()] != after[of]);
        }
    }
    (chip.nor.borrow().erases, places)
}

#[test]
fn a_save_erases_at_most_one_page_on_average_and_pages_wear_evenly() {
    let all = [
        erasures::<256, 1>(3),
        erasures::<512, 2>(4),
        erasures::<1024, 4>(3),
        erasures::<2048, 8>(3),
        erasures::<512, 32>(5),
    ];
    for (erases, places) in all {
        assert!(erases <= 300, "{erases} erasures for 300 saves");
        let (least, most) = (places.iter().min(), places.iter().max());
        assert!(most <= least.map(|least| 2 * least).as_ref(), "{places:?}");
    }
    assert!(erasures::<2048, 8>(3).0 < 30);
}

/// Cuts power in every step of a save after `saves` others, and in `cuts` starts and saves one
/// after the other.
fn cut<const PAGE: usize, const WORD: usize, const N: usize>(saves: u16, cuts: u64) {
    let (mut step, mut seed) = (0, 1);
    loop {
        let chip = Chip::<PAGE, WORD, N>::new(3 * N);
        let mut old = None;
        for save in 1..=saves {
            let (mut node, mut log) = start(&chip);
            command(&mut node, save * 10);
            let node = RefCell::new(node);
            wait(log.save(|act| act(&mut node.borrow_mut().storage)), || {});
            old = Some(u64::from(save) * 10);
        }
        let mut was_cut = false;
        for cut in 0..cuts {
            let new = 5000 + cut * 10;
            let (mut node, mut log) = start(&chip);
            command(&mut node, new as u16);
            chip.nor.borrow_mut().cut_after(step, seed + cut);
            let node = RefCell::new(node);
            wait(log.save(|act| act(&mut node.borrow_mut().storage)), || {});
            was_cut = chip.nor.borrow().is_cut;
            chip.nor.borrow_mut().restore_power();
            let found = time(&start(&chip).0);
            let place = format!("{PAGE}/{WORD}, {saves} saves, step {step}.{seed}.{cut}");
            if was_cut {
                assert!(
                    found == old || found == Some(new),
                    "{place}: {found:?}, not {old:?} or {new}"
                );
            } else {
                assert_eq!(found, Some(new), "{place}");
            }
            old = found;
        }
        for new in [9000, 9010] {
            let (mut node, mut log) = start(&chip);
            command(&mut node, new);
            let node = RefCell::new(node);
            wait(log.save(|act| act(&mut node.borrow_mut().storage)), || {});
            assert_eq!(
                time(&start(&chip).0),
                Some(new.into()),
                "{PAGE}/{WORD} {step}.{seed}"
            );
        }
        if !was_cut {
            assert!(step > 3);
            return;
        }
        seed += 1;
        if seed == 3 {
            (step, seed) = (step + 1, 1);
        }
    }
}

#[test]
fn power_can_fail_in_any_step_of_a_save_in_the_background() {
    // The sixth save erases the oldest page, whatever the size of a word.
    cut::<256, 1, 1>(6, 2);
    for saves in [0, 3, 6] {
        cut::<256, 4, 1>(saves, 2);
        cut::<512, 8, 1>(saves, 1);
        cut::<512, 32, 1>(saves, 2);
    }
    // Pages that are too small for a set.
    cut::<64, 4, 4>(6, 2);
}

#[test]
fn a_flash_that_fails_gives_an_abort() {
    let chip = Chip::<1024, 8, 1>::new(3);
    let (mut node, mut log) = start(&chip);
    assert_eq!(command(&mut node, 300), [SET]);
    chip.nor.borrow_mut().cut_after(2, 1);
    let node = RefCell::new(node);
    wait(log.save(|act| act(&mut node.borrow_mut().storage)), || {});
    let mut node = node.into_inner();
    let later = Instant::from_millis(3);
    node.catch_up(later);
    assert_eq!(sent(&mut node, later), [NOT_SAVED]);
    let events: Vec<_> = std::iter::from_fn(|| node.poll_event()).collect();
    assert!(events.contains(&Event::NotSaved), "{events:?}");
}

/// The adapter without a log: everything happens inside the call.
#[test]
fn the_response_to_a_save_on_two_banks_of_flash_is_immediate() {
    fn run<const PAGE: usize, const WORD: usize>() {
        const { assert!(image::capacity_on(&thermometer::DICTIONARY, PAGE, WORD) <= 2 * PAGE) };
        let chip = Chip::<PAGE, WORD, 1>::new(4);
        let place = PAGE as u32;
        for save in 1..5u16 {
            let flash = Nor::new(chip.clone(), place, 2 * place);
            let mut node =
                thermometer::Node::new(thermometer::Device, NodeId::ONE, NoApplication, flash);
            node.power_on(Instant::ZERO);
            let old = node.poll_timeout().map(|at| at.as_micros() / 100_000);
            assert_eq!(old, (save > 1).then_some(u64::from(save - 1)));
            sent(&mut node, Instant::ZERO);
            assert_eq!(command(&mut node, save * 100), [SET, SAVED_NOW]);
        }
        let nor = chip.nor.borrow();
        assert_eq!(nor.erases, 4);
        let outside = [&nor.bytes[..PAGE], &nor.bytes[3 * PAGE..]].concat();
        assert!(outside.iter().all(|byte| *byte == 0xFF));
    }
    run::<1024, 8>();
    run::<512, 4>();
    run::<2048, 1>();
}
