//! Selects the thread that moves the time of a bus.
//!
//! Time moves when every thread that takes part on the bus waits: in a call of this package, or in
//! Python (`_who.py`). The thread that detects this moves time to the next frame. While one of them
//! runs, no thread moves time. If a thread sleeps in a way that Python does not show, its reason is unknown:
//! time then follows the clock.

use std::sync::MutexGuard;
use std::thread;
use std::time::{Duration, Instant as Clock};

use od_wire::Instant;
use pyo3::prelude::*;

use crate::party::{Known, Outside, Wait};
use crate::state::{State, Step};
use crate::wire::Wire;

/// End of a wait.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum End {
    /// The condition of the wait is met.
    Done,
    /// The moment has come.
    Late,
}

/// Changes of the bus between two checks for signals such as Ctrl-C, by any thread: each of the
/// steps of a client is a wait of its own.
const LOOK: u64 = 1024;
/// Maximum pause of a thread that waits for others.
const NAP: Duration = Duration::from_millis(2);

/// How far time can move.
enum Way {
    /// To the next frame, or to this moment if it comes first.
    Free(Option<Instant>),
    /// Like `Free`, but not to the end of a time-out.
    Frames(Option<Instant>),
    /// A thread runs.
    Closed,
}

/// Waits until `done` or until `wait` is over. `done` is called after each event; frames
/// for a bus are delivered `in_turn`, while no other thread runs. After `patience` on the clock it ends in any case.
///
/// # Errors
/// An exception in Python, such as `KeyboardInterrupt`.
pub(crate) fn pass(
    py: Python<'_>,
    wire: &Wire,
    wait: Wait,
    (patience, in_turn): (Option<Duration>, bool),
    done: &mut dyn FnMut(&mut State) -> PyResult<bool>,
) -> PyResult<End> {
    let mut pass = Pass::new(wire, patience);
    pass.in_turn = in_turn;
    let result = pass.run(py, wait, done);
    let mut state = wire.lock();
    state.leave(thread::current().id());
    let over = std::mem::take(&mut state.over);
    drop(state);
    // Objects dropped with them may use the bus.
    drop(over);
    result
}

struct Pass<'w> {
    wire: &'w Wire,
    began: Clock,
    patience: Option<Duration>,
    idle: u32,
    /// No thread has started since the check.
    knows_threads: bool,
    /// A frame is received only while no other thread runs.
    in_turn: bool,
}

impl<'w> Pass<'w> {
    fn new(wire: &'w Wire, patience: Option<Duration>) -> Self {
        Self {
            wire,
            began: Clock::now(),
            patience,
            idle: 0,
            knows_threads: false,
            in_turn: false,
        }
    }

    fn run(
        &mut self,
        py: Python<'_>,
        mut wait: Wait,
        done: &mut dyn FnMut(&mut State) -> PyResult<bool>,
    ) -> PyResult<End> {
        let own = thread::current().id();
        let began = self.wire.lock().now();
        loop {
            let mut state = self.wire.lock();
            if let Some(clock) = state.clock() {
                self.catch_up(py, state, clock)?;
                state = self.wire.lock();
            } else if let Some(turn) = state.turn(wait)
                && state.parties.len() > 1
                && (turn.0 == 1
                    || (turn.0 == 0 && self.in_turn)
                    || (turn.0 == 2 && state.now() > began))
                && !self.is_out_of_patience()
            {
                state.begin(own, wait);
                drop(state);
                let (locked, is_next) = self.is_next(py, turn)?;
                if !is_next {
                    drop(locked);
                    self.rest(py)?;
                    continue;
                }
                state = locked;
            }
            wait.seen = wait.seen.map(|_| state.journal.end());
            let end = if done(&mut state)? {
                Some(End::Done)
            } else if wait.until.is_some_and(|until| until <= state.now()) {
                Some(End::Late)
            } else {
                None
            };
            if let Some(end) = end {
                state.leave(own);
                return Ok(end);
            }
            state.begin(own, wait);
            if state.real.is_some() {
                let next = [state.next(), wait.until].into_iter().flatten().min();
                let left = next.map(|next| next.micros_since(state.now()));
                drop(state);
                self.sleep(
                    py,
                    left.map_or(NAP * 25, Duration::from_micros).min(NAP * 25),
                )?;
                continue;
            }
            drop(state);
            let (state, way) = self.survey(py, wait)?;
            let to = match way {
                Way::Free(to) => to,
                Way::Frames(to)
                    if state
                        .next()
                        .is_some_and(|next| to.is_none_or(|to| next <= to)) =>
                {
                    to
                }
                // No frame will come, or another thread is about to act.
                _ if self.is_out_of_patience() => {
                    if let Some(until) = wait.until {
                        drop(state);
                        self.advance(py, until)?;
                    }
                    return Ok(End::Late);
                }
                _ => {
                    drop(state);
                    self.rest(py)?;
                    continue;
                }
            };
            let Some(to) = to.or_else(|| state.next()) else {
                drop(state);
                self.rest(py)?;
                continue;
            };
            if to < state.now() || (to == state.now() && state.next().is_none_or(|next| next > to))
            {
                drop(state);
                self.rest(py)?;
                continue;
            }
            self.idle = 0;
            self.step(py, state, to)?;
        }
    }

    /// Checks all threads that take part. The result is valid while the lock is held.
    fn survey(&mut self, py: Python<'_>, own: Wait) -> PyResult<(MutexGuard<'w, State>, Way)> {
        let id = thread::current().id();
        let mut limit = own.until;
        if !self.knows_threads {
            self.knows_threads = !self.wire.notice_threads(py, false)?;
        }
        let mut state = self.wire.lock();
        let (mut outside, mut knows, mut wanted, mut daemon) =
            (Vec::new(), true, own.port.is_none(), false);
        for party in &state.parties {
            match party.wait {
                _ if party.is(id) => daemon = party.daemon,
                Some(wait) if state.is_over(wait) => return Ok((state, Way::Closed)),
                Some(wait) => {
                    limit = earlier(limit, wait.until);
                    wanted |= wait.port.is_none();
                }
                None => {
                    outside.push(party.ident);
                    knows &= party.outside != Outside::Runs;
                }
            }
        }
        if outside.is_empty() && self.knows_threads {
            return Ok((state, Way::Free(limit)));
        }
        // A thread that ran a moment ago usually still does.
        if (!knows || !self.knows_threads) && self.idle == 0 {
            return Ok((state, Way::Closed));
        }
        let changes = state.changes;
        drop(state);
        let found = Wire::look(py, &outside)?;
        self.knows_threads = !self.wire.notice_threads(py, false)?;
        state = self.wire.lock();
        if !self.knows_threads || state.changes != changes {
            return Ok((state, Way::Closed));
        }
        let way = match state.learn(&outside, found) {
            Known::Run => match follow(&mut state) {
                Some(clock) => Way::Free(earlier(limit, Some(clock))),
                None => Way::Closed,
            },
            Known::Wait(until) => Way::Free(earlier(limit, Some(until))),
            Known::WaitForEver if daemon && !wanted => Way::Frames(limit),
            Known::WaitForEver => Way::Free(limit),
        };
        Ok((state, way))
    }

    /// Returns whether no thread runs, and none comes before this one.
    fn is_next(&self, py: Python<'_>, turn: (u8, u32)) -> PyResult<(MutexGuard<'w, State>, bool)> {
        let id = thread::current().id();
        let state = self.wire.lock();
        let mut outside = Vec::new();
        for party in state.parties.iter().filter(|party| !party.is(id)) {
            match party.wait.map(|wait| state.turn(wait)) {
                Some(Some(other)) if other < turn => return Ok((state, false)),
                Some(_) => {}
                None => outside.push(party.ident),
            }
        }
        if outside.is_empty() {
            return Ok((state, true));
        }
        let changes = state.changes;
        drop(state);
        let found = Wire::look(py, &outside)?;
        let mut state = self.wire.lock();
        let is_next = state.changes == changes
            && (state.learn(&outside, found) != Known::Run || follow(&mut state).is_some());
        Ok((state, is_next))
    }

    /// One step in time.
    fn step(
        &mut self,
        py: Python<'_>,
        mut state: MutexGuard<'_, State>,
        to: Instant,
    ) -> PyResult<Step> {
        let step = state.step(to);
        state.wake();
        let looks = state.changes - state.looked >= LOOK;
        if looks {
            state.looked = state.changes;
        }
        if let Step::Call(task, place) = step {
            // Python runs in this thread now.
            state.leave(thread::current().id());
            drop(state);
            self.knows_threads = false;
            call(py, self.wire, task, place)?;
        } else {
            drop(state);
        }
        if looks {
            py.check_signals()?;
            py.detach(|| ());
        }
        Ok(step)
    }

    /// Lets time pass to a moment, whatever threads run.
    fn advance(&mut self, py: Python<'_>, to: Instant) -> PyResult<()> {
        loop {
            let state = self.wire.lock();
            if self.step(py, state, to)? == Step::Reached {
                return Ok(());
            }
        }
    }

    /// Time follows the clock.
    fn catch_up(
        &mut self,
        py: Python<'_>,
        state: MutexGuard<'_, State>,
        clock: Instant,
    ) -> PyResult<()> {
        drop(state);
        self.advance(py, clock)
    }

    fn is_out_of_patience(&self) -> bool {
        self.patience
            .is_some_and(|most| self.began.elapsed() >= most)
    }

    /// Lets the others run: the longer it takes, the longer the pause.
    fn rest(&mut self, py: Python<'_>) -> PyResult<()> {
        self.idle = self.idle.saturating_add(1);
        // A frame ends the pause at once. Without one the running thread gets the interpreter.
        let micros = 25 << self.idle.min(8);
        self.sleep(py, Duration::from_micros(micros).min(NAP))
    }

    fn sleep(&mut self, py: Python<'_>, time: Duration) -> PyResult<()> {
        let time = match self.patience {
            Some(most) => time.min(
                most.saturating_sub(self.began.elapsed())
                    .max(Duration::from_micros(50)),
            ),
            None => time,
        };
        py.detach(|| thread::park_timeout(time));
        py.check_signals()
    }
}

/// The earlier of two moments, of which none may be.
fn earlier(a: Option<Instant>, b: Option<Instant>) -> Option<Instant> {
    match (a, b) {
        (Some(a), Some(b)) => Some(a.min(b)),
        (a, b) => a.or(b),
    }
}

/// Time follows the clock if every running thread sleeps; returns the moment that the clock shows.
fn follow(state: &mut State) -> Option<Instant> {
    if state.follows.is_none() {
        let own = thread::current().id();
        let (mut latest, mut is_closed) = (None, false);
        state.parties.retain_mut(|party| {
            if party.is(own) || !party.runs() {
                return true;
            }
            let since = party.lets_time_follow();
            let takes_part = party.thread.is_some();
            is_closed |= since.is_none();
            if takes_part {
                latest = latest.max(since);
            }
            // A thread that never took part may sleep or compute.
            takes_part || since.is_none()
        });
        if is_closed {
            return None;
        }
        let now = state.now();
        for party in &mut state.parties {
            party.leads = !party.is(own) && party.runs();
        }
        state.follows = Some((latest?, now));
    }
    let (clock, from) = state.follows?;
    Some(from.plus_micros(u64::try_from(clock.elapsed().as_micros()).ok()?))
}

/// Python makes the frame of a task.
fn call(py: Python<'_>, wire: &Wire, task: u32, place: usize) -> PyResult<()> {
    let Some(maker) = wire.maker(py, task) else {
        return Ok(());
    };
    let frame = maker
        .call1(py, (place,))?
        .extract::<crate::value::Parts>(py)?
        .frame()?;
    let mut state = wire.lock();
    let port = state
        .cyclics
        .iter()
        .find(|one| one.id == task)
        .map(|one| one.port);
    if let Some(port) = port {
        // A frame that the line does not accept is lost, like that of a timer.
        drop(state.transmit(port, &frame));
        state.wake();
    }
    Ok(())
}
