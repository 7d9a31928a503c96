//! The node as a task that sleeps, with a clock that only the tests move.
#![cfg(feature = "embassy")]

mod support;

use std::cell::{Cell, RefCell};
use std::collections::VecDeque;
use std::future::poll_fn;
use std::pin::{Pin, pin};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, MutexGuard};
use std::task::{Context, Poll, Wake, Waker};

use embassy_sync::blocking_mutex::raw::CriticalSectionRawMutex;
use embassy_time::{Duration, MockDriver};
use odkit::board::{Filter, Filters, Receive, Shared, Transmit, Watch};
use odkit::storage::NoStorage;
use odkit::{BusEvent, Frame, NodeId};
use support::{Heater, frame, thermometer};

type Thermometer = Shared<CriticalSectionRawMutex, thermometer::Node<Heater>>;

/// The tests share the clock.
static CLOCK: Mutex<()> = Mutex::new(());

fn clock() -> MutexGuard<'static, ()> {
    let guard = CLOCK.lock().unwrap_or_else(|other| other.into_inner());
    MockDriver::get().reset();
    guard
}

/// A controller with its two halves.
#[derive(Default)]
struct Controller {
    came: VecDeque<Result<Frame, BusEvent>>,
    reader: Option<Waker>,
    sent: Vec<String>,
    /// Frames that the next frames replace.
    thrown_out: VecDeque<Frame>,
    /// It has no room for a frame.
    is_full: bool,
    /// States that it has to report to the sending half.
    refuses: VecDeque<BusEvent>,
    writer: Option<Waker>,
    filters: Vec<Vec<Filter>>,
}

struct Half(Arc<Mutex<Controller>>);

impl Receive for Half {
    async fn receive(&mut self) -> Result<Frame, BusEvent> {
        poll_fn(|cx| {
            let mut controller = self.0.lock().unwrap();
            controller.reader = Some(cx.waker().clone());
            controller
                .came
                .pop_front()
                .map_or(Poll::Pending, Poll::Ready)
        })
        .await
    }

    fn filter(&mut self, filters: &[Filter]) {
        self.0.lock().unwrap().filters.push(filters.to_vec());
    }
}

impl Transmit for Half {
    async fn transmit(&mut self, frame: &Frame) -> Result<Option<Frame>, BusEvent> {
        poll_fn(|cx| {
            let mut controller = self.0.lock().unwrap();
            if let Some(event) = controller.refuses.pop_front() {
                return Poll::Ready(Err(event));
            }
            if controller.is_full {
                controller.writer = Some(cx.waker().clone());
                return Poll::Pending;
            }
            controller.sent.push(frame.to_string());
            Poll::Ready(Ok(controller.thrown_out.pop_front()))
        })
        .await
    }
}

/// An executor of one task: polls it only if it was woken.
struct Executor<'t> {
    task: Pin<&'t mut dyn Future<Output = ()>>,
    wakes: Arc<Wakes>,
    controller: Arc<Mutex<Controller>>,
}

#[derive(Default)]
struct Wakes(AtomicUsize);

impl Wake for Wakes {
    fn wake(self: Arc<Self>) {
        self.0.fetch_add(1, Ordering::Relaxed);
    }
}

impl Executor<'_> {
    /// Runs until the task sleeps. Returns what it sent, and how often it was polled.
    fn run_until_asleep(&mut self) -> (Vec<String>, usize) {
        let waker = Waker::from(self.wakes.clone());
        let mut polls = 0;
        while self.wakes.0.swap(0, Ordering::Relaxed) > 0 {
            assert!(
                self.task
                    .as_mut()
                    .poll(&mut Context::from_waker(&waker))
                    .is_pending()
            );
            polls += 1;
            assert!(polls < 100, "it never sleeps");
        }
        let mut controller = self.controller.lock().unwrap();
        (std::mem::take(&mut controller.sent), polls)
    }

    fn sends(&mut self) -> Vec<String> {
        self.run_until_asleep().0
    }

    fn receives(&mut self, what: Result<Frame, BusEvent>) {
        let mut controller = self.controller.lock().unwrap();
        controller.came.push_back(what);
        if let Some(reader) = controller.reader.take() {
            reader.wake();
        }
    }

    fn advance(&mut self, millis: u64) -> (Vec<String>, usize) {
        MockDriver::get().advance(Duration::from_millis(millis));
        self.run_until_asleep()
    }
}

/// Runs the task of a thermometer while `test` has its executor.
fn run(test: impl FnOnce(&mut Executor<'_>, &Thermometer)) {
    let _guard = clock();
    let shared = Thermometer::new(thermometer::Node::new(
        thermometer::Device,
        NodeId::ONE,
        Heater::new(),
        NoStorage,
    ));
    let controller = Arc::new(Mutex::new(Controller::default()));
    let (mut rx, mut tx) = (Half(controller.clone()), Half(controller.clone()));
    let task = pin!(async {
        shared.run(&mut rx, &mut tx).await;
    });
    let wakes = Arc::new(Wakes(AtomicUsize::new(1)));
    let mut executor = Executor {
        task,
        wakes,
        controller,
    };
    assert_eq!(executor.sends(), [""; 0]);
    shared.with(|node, now| node.power_on(now));
    assert_eq!(executor.sends(), ["701#00"]);
    test(&mut executor, &shared);
}

#[test]
fn the_task_sleeps_until_a_frame_or_its_deadline() {
    run(|executor, _| {
        // Nothing is due without a heartbeat.
        assert_eq!(executor.advance(100_000), (vec![], 0));
        executor.receives(Ok(frame("601#2B17100064000000")));
        assert_eq!(executor.sends(), ["581#6017100000000000"]);
        for _ in 0..5 {
            assert_eq!(executor.advance(99), (vec![], 0));
            assert_eq!(executor.advance(1).0, ["701#7F"]);
        }
        executor.receives(Ok(frame("000#0100")));
        assert_eq!(executor.sends(), ["181#D700"]);
        assert_eq!(executor.advance(100).0, ["701#05"]);
    });
}

#[test]
fn a_change_from_another_task_sends_its_tpdo_at_once() {
    run(|executor, shared| {
        executor.receives(Ok(frame("000#0100")));
        assert_eq!(executor.sends(), ["181#D700"]);
        shared.with(|node, now| node.set(now, thermometer::TEMPERATURE, 99));
        assert_eq!(executor.sends(), ["181#6300"]);
        shared.with(|node, now| {
            node.change(now, |heater, store| {
                heater.ticks = 0;
                store.set(thermometer::TEMPERATURE, 98);
            })
        });
        assert_eq!(executor.sends(), ["181#6200"]);
        assert_eq!(executor.run_until_asleep(), (vec![], 0));
    });
}

#[test]
fn a_frame_that_the_controller_replaces_is_sent_again() {
    run(|executor, _| {
        let heartbeat = frame("701#7F");
        executor.controller.lock().unwrap().thrown_out = [heartbeat].into();
        executor.receives(Ok(frame("601#4000100000000000")));
        assert_eq!(executor.sends(), ["581#4300100000000000", "701#7F"]);
    });
}

#[test]
fn a_controller_without_room_delays_neither_frames_nor_time() {
    run(|executor, shared| {
        executor.controller.lock().unwrap().is_full = true;
        executor.receives(Ok(frame("601#2B17100064000000")));
        assert_eq!(executor.sends(), [""; 0]);
        executor.receives(Ok(frame("000#0100")));
        executor.receives(Ok(frame("201#0700")));
        assert_eq!(executor.sends(), [""; 0]);
        assert_eq!(shared.with(|node, _| node.get(thermometer::TARGET)), 7);
        for _ in 0..250 {
            assert_eq!(executor.advance(1).0, [""; 0]);
        }
        let mut controller = executor.controller.lock().unwrap();
        controller.is_full = false;
        controller.writer.take().expect("somebody writes").wake();
        drop(controller);
        // The first frame was passed on before the others arrived.
        let sent = executor.sends();
        assert_eq!(sent[0], "581#6017100000000000");
        assert_eq!(sent[1..], ["701#05", "701#05", "181#D700"]);
    });
}

#[test]
fn the_receiver_gets_its_filters_when_they_change() {
    run(|executor, _| {
        let told = |executor: &mut Executor<'_>| {
            let mut controller = executor.controller.lock().unwrap();
            let mut ids: Vec<u32> = controller
                .filters
                .drain(..)
                .flatten()
                .map(|filter| filter.id.raw())
                .collect();
            ids.sort_unstable();
            ids
        };
        assert_eq!(told(executor), [0, 0x80, 0x181, 0x201, 0x601, 0x701]);
        executor.receives(Ok(frame("601#4000100000000000")));
        executor.sends();
        assert!(told(executor).is_empty());
        executor.receives(Ok(frame("601#2300140101020080")));
        executor.sends();
        assert_eq!(told(executor), [0, 0x80, 0x181, 0x601, 0x701]);
        executor.receives(Ok(frame("601#23161001F4010900")));
        executor.sends();
        let all = [0, 0x80, 0x181, 0x601, 0x701, 0x709];
        assert_eq!(told(executor), all);
        let all = all.map(|id| odkit::CanId::standard(id as u16));
        let few: Filters<3> = all.into_iter().collect();
        let fewer: Filters<2> = few.as_slice().iter().copied().collect();
        for id in all {
            assert!(fewer.as_slice().iter().any(|filter| filter.accepts(id)));
        }
    });
}

#[test]
fn a_node_enters_and_leaves_bus_off() {
    run(|executor, shared| {
        executor.receives(Err(BusEvent::Off));
        executor.sends();
        assert!(shared.with(|node, _| node.is_bus_off()));
        executor.receives(Ok(frame("601#4000100000000000")));
        assert_eq!(executor.sends(), [""; 0]);
        executor.receives(Err(BusEvent::Active));
        executor.sends();
        executor.receives(Ok(frame("601#4000100000000000")));
        assert!(
            executor
                .sends()
                .contains(&"581#4300100000000000".to_owned())
        );
    });
}

/// Frames of a node wait for the controller; then the node learns of bus-off in one of three ways.
fn loses_frames_at_bus_off(learn: impl Fn(&mut Executor<'_>, &Thermometer)) {
    run(|executor, shared| {
        executor.controller.lock().unwrap().is_full = true;
        executor.receives(Ok(frame("601#2B17100064000000")));
        executor.receives(Ok(frame("000#0100")));
        assert_eq!(executor.sends(), [""; 0]);
        learn(executor, shared);
        assert_eq!(executor.sends(), [""; 0]);
        assert!(shared.with(|node, _| node.is_bus_off()));
        assert_eq!(executor.advance(500).0, [""; 0]);
        executor.receives(Err(BusEvent::Active));
        let mut controller = executor.controller.lock().unwrap();
        controller.is_full = false;
        if let Some(writer) = controller.writer.take() {
            writer.wake();
        }
        drop(controller);
        let sent = executor.sends();
        assert!(!shared.with(|node, _| node.is_bus_off()));
        assert_eq!(sent, [""; 0]);
        executor.receives(Ok(frame("601#4000100000000000")));
        assert_eq!(executor.sends(), ["581#4300100000000000"]);
    });
}

#[test]
fn frames_from_before_bus_off_are_not_sent_after_it() {
    // The receiving half reports it, as a `Watch` does.
    loses_frames_at_bus_off(|executor, _| executor.receives(Err(BusEvent::Off)));
    // Another task reports it, such as an interrupt of the controller.
    loses_frames_at_bus_off(|_, shared| {
        shared.with(|node, now| node.handle_bus(now, BusEvent::Off));
    });
    // The sending half reports it.
    loses_frames_at_bus_off(|executor, _| {
        let mut controller = executor.controller.lock().unwrap();
        controller.refuses.push_back(BusEvent::Off);
        controller.writer.take().expect("somebody writes").wake();
    });
}

#[test]
fn a_watch_reports_states_for_a_driver_that_only_waits_for_frames() {
    let _guard = clock();
    // The clock does not begin at 0. The bus has no errors, so there are only frames.
    MockDriver::get().advance(Duration::from_secs(5));
    let state = Cell::new(BusEvent::Active);
    let came = RefCell::new(VecDeque::new());
    let mut watch = Watch::new();
    let mut receive = |for_millis: u64| {
        let read = async || {
            poll_fn(|_| {
                came.borrow_mut()
                    .pop_front()
                    .map_or(Poll::Pending, Poll::Ready)
            })
            .await
        };
        let mut received = pin!(watch.receive(|| state.get(), read));
        let mut cx = Context::from_waker(Waker::noop());
        for _ in 0..=for_millis {
            if let Poll::Ready(result) = received.as_mut().poll(&mut cx) {
                return Some(result);
            }
            MockDriver::get().advance(Duration::from_millis(1));
        }
        None
    };
    assert_eq!(receive(1000), None);
    came.borrow_mut().push_back(Some(frame("080#")));
    assert_eq!(receive(0), Some(Ok(frame("080#"))));
    // Errors of the bus delay no frame for long, and lose none.
    came.borrow_mut().extend([None, None, Some(frame("081#"))]);
    assert_eq!(receive(0), None);
    assert_eq!(receive(2), Some(Ok(frame("081#"))));
    for event in [BusEvent::Passive, BusEvent::Off, BusEvent::Active] {
        assert_eq!(receive(20), None);
        state.set(event);
        assert_eq!(receive(20), Some(Err(event)));
    }
    state.set(BusEvent::Off);
    came.borrow_mut().push_back(Some(frame("082#")));
    assert_eq!(receive(0), Some(Err(BusEvent::Off)));
    assert_eq!(receive(0), Some(Ok(frame("082#"))));
}
