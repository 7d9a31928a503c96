//! A node that several tasks use, and the task that runs it, on any executor.

use core::cell::RefCell;
use core::future::Future;

use embassy_futures::join::join3;
use embassy_futures::select::{Either, select};
use embassy_futures::yield_now;
use embassy_sync::blocking_mutex::Mutex;
use embassy_sync::blocking_mutex::raw::RawMutex;
use embassy_sync::signal::Signal;
use embassy_time::Timer;
use od_runtime::{BusEvent, Frame, Instant};

use crate::filters::{Filter, Filters};
use crate::owner::Owner;
use crate::port::Port;

/// The receiving half of a CAN controller.
pub trait Receive {
    /// Waits for a frame, or for a state of the controller such as [`BusEvent::Off`]. The future
    /// may be dropped before it is ready; this must not lose a frame.
    fn receive(&mut self) -> impl Future<Output = Result<Frame, BusEvent>>;

    /// Sets the acceptance filters: at the start, and when they change. A controller with fewer
    /// filters joins them with `filters.iter().copied().collect::<Filters<4>>()`; one without
    /// filters does nothing.
    fn filter(&mut self, filters: &[Filter]) {
        let _ = filters;
    }
}

/// The sending half of a CAN controller.
pub trait Transmit {
    /// Waits until the controller has room, and passes the frame to it. Returns the frame that the
    /// controller pushed out of a mailbox for it, if there is one. At bus-off the future is
    /// dropped, and the frame with it.
    fn transmit(&mut self, frame: &Frame) -> impl Future<Output = Result<Option<Frame>, BusEvent>>;
}

/// Number of filters that a receiver gets before it joins them.
const FILTERS: usize = 16;

/// Time after which the node is asked again while the controller has no room.
const AGAIN: embassy_time::Duration = embassy_time::Duration::from_millis(1);

/// An [`Owner`] that several tasks use: one task calls [`run`](Self::run), the others change
/// values. It can be a `static`.
///
/// The lock is held for at most one call of the node, and never during a wait.
pub struct Shared<M: RawMutex, B> {
    owner: Mutex<M, RefCell<B>>,
    /// There may be frames to send.
    frames: Signal<M, ()>,
    /// The next deadline may have changed.
    deadline: Signal<M, ()>,
    /// The filters may have changed.
    filters: Signal<M, ()>,
    /// The controller went bus-off: frames from before that must not be sent.
    off: Signal<M, ()>,
}

impl<M: RawMutex, B: Owner> Shared<M, B> {
    /// A node for several tasks.
    pub const fn new(owner: B) -> Self {
        Self {
            owner: Mutex::new(RefCell::new(owner)),
            frames: Signal::new(),
            deadline: Signal::new(),
            filters: Signal::new(),
            off: Signal::new(),
        }
    }

    /// Calls `act` with the node and the time. Frames that this causes, such as an event-driven
    /// TPDO of a changed value, are sent at once.
    ///
    /// # Panics
    /// If `act` calls `with` again.
    pub fn with<R>(&self, act: impl FnOnce(&mut B, Instant) -> R) -> R {
        let result = self.lock(act);
        self.filters.signal(());
        result
    }

    /// The node, before other tasks use it, for example to load saved values.
    pub fn get_mut(&mut self) -> &mut B {
        self.owner.get_mut().get_mut()
    }

    fn lock<R>(&self, act: impl FnOnce(&mut B, Instant) -> R) -> R {
        let result = self.owner.lock(|owner| {
            let now = embassy_time::Instant::now().as_micros();
            let mut owner = owner.borrow_mut();
            let result = act(&mut owner, Instant::from_micros(now));
            if owner.is_bus_off() {
                self.off.signal(());
            }
            result
        });
        self.frames.signal(());
        self.deadline.signal(());
        result
    }

    /// Runs the node: sleeps until a frame, its next deadline, or a change by [`with`](Self::with).
    /// Switch the power of the node on with `with`, before or after the call.
    pub async fn run(&self, receiver: &mut impl Receive, transmitter: &mut impl Transmit) -> ! {
        join3(
            self.receive(receiver),
            self.transmit(transmitter),
            self.wait(),
        )
        .await;
        // None of the three futures ends.
        core::future::pending().await
    }

    async fn receive(&self, receiver: &mut impl Receive) {
        loop {
            match select(receiver.receive(), self.filters.wait()).await {
                Either::First(Ok(frame)) => {
                    self.lock(|owner, now| owner.handle_frame(now, &frame));
                }
                Either::First(Err(event)) => {
                    self.lock(|owner, now| owner.handle_bus(now, event));
                    // A controller may report this state again and again.
                    yield_now().await;
                }
                Either::Second(()) => {}
            }
            let mut filters = None;
            self.owner.lock(|owner| {
                owner.borrow_mut().each_wanted_id(&mut |id| {
                    let filters: &mut Filters<FILTERS> = filters.get_or_insert_default();
                    filters.add(id);
                });
            });
            if let Some(filters) = filters {
                receiver.filter(filters.as_slice());
            }
        }
    }

    async fn transmit(&self, transmitter: &mut impl Transmit) {
        let (mut port, mut has_sent) = (Port::new(), false);
        loop {
            let next = self.owner.lock(|owner| {
                // The receiver, the transmitter or another task may have reported it.
                if self.off.try_take().is_some() {
                    port.clear();
                }
                let now = embassy_time::Instant::now().as_micros();
                let next = port.peek(&mut *owner.borrow_mut(), Instant::from_micros(now));
                next.copied()
            });
            let Some(frame) = next else {
                if core::mem::take(&mut has_sent) {
                    // A frame may have changed the next deadline, for example by the end of an
                    // inhibit time.
                    self.deadline.signal(());
                }
                self.frames.wait().await;
                continue;
            };
            match select(self.off.wait(), transmitter.transmit(&frame)).await {
                Either::First(()) => port.clear(),
                Either::Second(Ok(thrown_out)) => {
                    port.sent(&frame, thrown_out);
                    has_sent = true;
                }
                Either::Second(Err(event)) => {
                    self.lock(|owner, now| owner.handle_bus(now, event));
                    yield_now().await;
                }
            }
        }
    }

    async fn wait(&self) {
        loop {
            // Most signals only concern the deadline that is read here.
            self.deadline.reset();
            let now = embassy_time::Instant::now();
            let due = self.owner.lock(|owner| {
                let (mut owner, now) = (owner.borrow_mut(), Instant::from_micros(now.as_micros()));
                if owner.poll_timeout().is_some_and(|at| at <= now) {
                    owner.handle_timeout(now);
                    self.frames.signal(());
                    self.filters.signal(());
                }
                owner.poll_timeout()
            });
            let Some(due) = due.map(Instant::as_micros) else {
                self.deadline.wait().await;
                continue;
            };
            let mut at = embassy_time::Instant::from_micros(due);
            if due <= now.as_micros() {
                // A PDO is due and the controller has no room, but other work may become due.
                at = now + AGAIN;
            } else if at.as_micros() < due {
                // A tick is longer than a microsecond.
                at += embassy_time::Duration::from_ticks(1);
            }
            select(Timer::at(at), self.deadline.wait()).await;
        }
    }
}
