//! Moves the time of a bus.
//!
//! Time moves when every thread that takes part on the bus waits: in a call of this package, or in a wait of
//! Python that `odkit/_waits.py` reports. The thread that detects this moves time to the next frame or to the
//! first time-out. While one of them runs, no thread moves time. Time follows the clock while the
//! thread that opened the bus waits in Python, up to the time-out of any wait in Python, and while a thread
//! waits for something that Python does not report.

use std::cell::Cell;
use std::thread;
use std::time::{Duration, Instant as Clock};

use od_wire::Instant;
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;

use crate::party::{Wait, detached};
use crate::state::{State, Step};
use crate::wire::{self, Wire};

/// End of a wait.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum End {
    /// The condition of the wait is met.
    Done,
    /// The moment has come.
    Late,
}

/// Result of an attempt to move time.
pub(crate) enum Moved {
    Yes,
    /// It cannot move for this time, or until a thread acts.
    No(Duration),
}

/// Maximum pause of a thread that waits for others.
pub(crate) const NAP: Duration = Duration::from_millis(2);
/// Time on the clock between two checks for signals such as Ctrl-C.
pub(crate) const LOOK: Duration = Duration::from_millis(10);
/// Maximum time that passes on the bus in one step, in ms: without frames a step costs up to 1 ms per second.
const STEP: u64 = 10_000;
/// Number of steps after which the only thread on a bus lets other threads of Python run.
const ALONE: u32 = 64;

/// Waits until `done` or until `wait` is over. `done` is called after each event; frames
/// for a bus are delivered `in_turn`, while no other thread runs.
///
/// # Errors
/// An exception in Python, such as `KeyboardInterrupt`.
pub(crate) fn pass(
    py: Python<'_>,
    wire: &Wire,
    wait: Wait,
    in_turn: bool,
    done: &mut dyn FnMut(&mut State) -> PyResult<bool>,
) -> PyResult<End> {
    let others = wire::others(wire);
    let id = thread::current().id();
    let set = |elsewhere: bool| {
        for other in &others {
            let mut state = other.lock();
            let own = state.parties.iter_mut().find(|party| party.is(id));
            own.into_iter().for_each(|own| own.elsewhere = elsewhere);
        }
    };
    set(true);
    let mut pass = Pass::new(wire, in_turn);
    let result = pass.run(py, wait, done);
    wire.lock().leave(id);
    set(false);
    result
}

pub(crate) struct Pass<'w> {
    wire: &'w Wire,
    pub(crate) idle: u32,
    steps: u32,
    /// A frame is received only while no other thread runs.
    in_turn: bool,
}

impl<'w> Pass<'w> {
    pub(crate) fn new(wire: &'w Wire, in_turn: bool) -> Self {
        Self {
            wire,
            idle: 0,
            steps: 0,
            in_turn,
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
                drop(state);
                self.advance(py, clock)?;
                state = self.wire.lock();
            } else if state.parties.len() > 1 && !self.is_next(&mut state, wait, began) {
                drop(state);
                self.forget_ended(py)?;
                self.rest(py, NAP)?;
                continue;
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
                sleep(py, left.map_or(LOOK, Duration::from_micros).min(LOOK))?;
                continue;
            }
            drop(state);
            match self.move_time(py, wait)? {
                Moved::Yes => self.idle = 0,
                Moved::No(most) => self.rest(py, most)?,
            }
        }
    }

    /// Returns whether this thread may continue if its wait is over: no thread runs, and none comes before it.
    pub(crate) fn is_next(&self, state: &mut State, wait: Wait, began: Instant) -> bool {
        let id = thread::current().id();
        let place = state.parties.iter().position(|party| party.is(id));
        let Some(turn) = state.turn(wait, place.unwrap_or(0)) else {
            return true;
        };
        let is_closed = |port| !state.listeners.iter().any(|one| one.id == port);
        if wait.port.is_some_and(is_closed) {
            return true;
        }
        let has_turns = match turn.0 {
            0 => self.in_turn,
            1 => true,
            _ => state.now() > began,
        };
        if !has_turns {
            return true;
        }
        state.begin(id, wait);
        let mut others = state.parties.iter().enumerate();
        others.all(|(at, party)| match party.wait {
            _ if party.is(id) => true,
            None => party.elsewhere || party.is_asleep,
            Some(other) => state.turn(other, at).is_none_or(|other| other >= turn),
        })
    }

    /// Forgets threads that have ended, if this one has waited for others a while.
    pub(crate) fn forget_ended(&self, py: Python<'_>) -> PyResult<()> {
        if self.idle > 1 {
            self.wire.look(py)?;
        }
        Ok(())
    }

    /// Moves time by one event if no thread that takes part runs.
    pub(crate) fn move_time(&mut self, py: Python<'_>, own: Wait) -> PyResult<Moved> {
        let id = thread::current().id();
        let mut state = self.wire.lock();
        if state.parties.len() > 1 {
            let busy = |state: &State| {
                let mut parties = state.parties.iter().enumerate();
                parties.any(|(at, party)| {
                    let over = |wait| state.turn(wait, at).is_some();
                    !party.is(id) && party.wait.is_some_and(over)
                })
            };
            let asks = |state: &State| {
                let mut others = state.parties.iter().filter(|party| !party.is(id));
                others.any(|party| party.wait.is_none() || party.target.is_some())
                    || state.parties.iter().any(|party| party.target.is_some())
            };
            if busy(&state) {
                return Ok(Moved::No(NAP));
            }
            if asks(&state) {
                // A thread that ran a moment ago usually still does.
                if self.idle == 0 {
                    return Ok(Moved::No(NAP));
                }
                let changes = state.changes;
                drop(state);
                let runs = self.wire.look(py)?;
                state = self.wire.lock();
                if runs || state.changes != changes || busy(&state) {
                    return Ok(Moved::No(NAP));
                }
            } else {
                state.follows = None;
            }
        }
        let now = state.now();
        let ends = state.parties.iter().filter_map(|party| party.wait?.until);
        let end = ends.chain(own.until).min();
        let Some(to) = [end, state.next()].into_iter().flatten().min() else {
            return Ok(Moved::No(NAP));
        };
        if let Some(left) = state.ahead_of_the_clock(to) {
            if own.paced.is_some() && state.strict {
                drop(state);
                return Err(PyRuntimeError::new_err(
                    "this wait in Python lets time follow the clock, and the bus has time=\"strict\"; use \
                     `odkit.patch_time()`, or wait in a call of odkit",
                ));
            }
            return Ok(Moved::No(left));
        }
        let to = to.min(now.plus_millis(STEP));
        if self.steps > ALONE && state.parties.len() == 1 {
            drop(state);
            self.run_alone(py, own)?;
            return Ok(Moved::Yes);
        }
        self.step(py, state, to)?;
        Ok(Moved::Yes)
    }

    /// Lets time pass without the interpreter's lock while no Python takes part, for at most `LOOK`.
    fn run_alone(&mut self, py: Python<'_>, own: Wait) -> PyResult<()> {
        let (wire, began) = (self.wire, Clock::now());
        let call = detached(py, || {
            let mut state = wire.lock();
            let mut call = None;
            while state.parties.len() == 1
                && call.is_none()
                && state.turn(own, 0).is_none()
                && began.elapsed() < LOOK
            {
                let next = [own.until, state.next()].into_iter().flatten().min();
                let Some(next) = next else { break };
                let to = next.min(state.now().plus_millis(STEP));
                if let Step::Call(task, place) = state.step(to) {
                    call = Some((task, place));
                }
            }
            call
        });
        if let Some((task, place)) = call {
            self.wire.lock().leave(thread::current().id());
            wire::call(py, self.wire, task, place)?;
        }
        py.check_signals()
    }

    /// One step in time.
    fn step(
        &mut self,
        py: Python<'_>,
        mut state: std::sync::MutexGuard<'_, State>,
        to: Instant,
    ) -> PyResult<Step> {
        let step = state.step(to);
        state.wake();
        self.steps += 1;
        if let Step::Call(task, place) = step {
            // The function of the task runs in this thread, which therefore does not wait.
            state.leave(thread::current().id());
            drop(state);
            wire::call(py, self.wire, task, place)?;
        } else {
            drop(state);
        }
        look(py)?;
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

    /// Lets the others run.
    fn rest(&mut self, py: Python<'_>, most: Duration) -> PyResult<()> {
        // A frame ends the pause at once. Without one the running thread gets the interpreter.
        let pause = length(self.idle, most);
        self.idle = self.idle.saturating_add(1);
        sleep(py, pause)
    }
}

thread_local! {
    /// The last check of this thread for signals.
    static LOOKED: Cell<Option<Clock>> = const { Cell::new(None) };
}

/// Checks for signals such as Ctrl-C, and lets other threads of Python run, at most every `LOOK`: for loops that have
/// something to do all the time.
///
/// # Errors
/// `KeyboardInterrupt`, or another exception of a signal's handler.
pub(crate) fn look(py: Python<'_>) -> PyResult<()> {
    if LOOKED.get().is_some_and(|at| at.elapsed() < LOOK) {
        return Ok(());
    }
    LOOKED.set(Some(Clock::now()));
    py.check_signals()?;
    detached(py, || ());
    Ok(())
}

/// Waits for a time on the clock, or until another thread wakes this one.
///
/// # Errors
/// As [`look`].
pub(crate) fn sleep(py: Python<'_>, time: Duration) -> PyResult<()> {
    detached(py, || thread::park_timeout(time));
    py.check_signals()
}

/// The length of the next pause; pauses grow while nothing happens.
pub(crate) fn length(idle: u32, most: Duration) -> Duration {
    let pause = Duration::from_micros(25 << idle.saturating_add(1).min(8));
    pause.min(NAP).min(most.max(Duration::from_micros(50)))
}
