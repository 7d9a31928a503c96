//! A bus with its devices and all listeners.

use std::collections::VecDeque;
use std::thread::{self, Thread, ThreadId};
use std::time::{Duration, Instant as Clock};

use od_sim::bus::Bus;
use od_sim::line::ErrorState;
use od_sim::logs::{BusError, What};
use od_wire::{Frame, Instant};

use crate::cyclic::Cyclic;
use crate::faults::Fault;
use crate::filter::{Filter, passes};
use crate::journal::{Journal, frame};
use crate::party::{Party, Wait};
use crate::story::Story;
use crate::time::Time;

/// Maximum number of frames that wait for a bus; the newest ones are lost, as in a controller.
const QUEUED: usize = 1_000_000;

/// A message that a bus of python-can received.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Heard {
    pub(crate) at: Instant,
    pub(crate) what: What,
    /// It sent the frame itself.
    pub(crate) own: bool,
}

/// A bus of python-can, or a client.
#[derive(Debug)]
pub(crate) struct Listener {
    pub(crate) id: u32,
    pub(crate) queue: VecDeque<Heard>,
    pub(crate) filters: Option<Vec<Filter>>,
    /// It receives what it sends.
    pub(crate) own: bool,
}

/// Result of a step in time.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Step {
    /// A frame was sent.
    Moved,
    /// Nothing happened until the moment.
    Reached,
    /// Python must make the frame of this task; the number is the index of the frame.
    Call(u32, usize),
}

/// The state of one bus.
pub(crate) struct State {
    pub(crate) bus: Bus,
    /// Names of the devices.
    pub(crate) names: Vec<String>,
    pub(crate) listeners: Vec<Listener>,
    pub(crate) cyclics: Vec<Cyclic>,
    pub(crate) parties: Vec<Party>,
    pub(crate) journal: Journal,
    /// The inputs so far, as a script.
    pub(crate) story: Story,
    /// The number of the first record that `expect` looks at.
    pub(crate) seen: usize,
    /// The last frame from a program, or change of the bench.
    pub(crate) acted: Instant,
    /// The buses whose frames wait for a line that takes time.
    senders: VecDeque<u32>,
    /// Time is that of the clock since this moment.
    pub(crate) real: Option<Clock>,
    /// Time follows the clock because of a wait that Python does not report: both at its start.
    pub(crate) follows: Option<(Clock, Instant)>,
    /// Seconds that pass on the bus in a second of the clock while time follows it.
    pub(crate) pace: f64,
    /// It is an error if time follows the clock.
    pub(crate) strict: bool,
    /// The program was warned that time follows the clock.
    pub(crate) warned_of_clock: bool,
    /// The program was warned that a thread has long been computing.
    pub(crate) warned_of_computing: bool,
    /// Counts all changes of the bus.
    pub(crate) changes: u64,
    ids: u32,
    /// The process that its threads are in.
    process: u32,
}

impl Default for State {
    fn default() -> Self {
        Self {
            bus: Bus::default(),
            names: Vec::new(),
            listeners: Vec::new(),
            cyclics: Vec::new(),
            parties: Vec::new(),
            journal: Journal::default(),
            story: Story::default(),
            seen: 0,
            acted: Instant::ZERO,
            senders: VecDeque::new(),
            real: None,
            follows: None,
            pace: 1.0,
            strict: false,
            warned_of_clock: false,
            warned_of_computing: false,
            changes: 0,
            ids: 0,
            process: std::process::id(),
        }
    }
}

impl State {
    /// A number that is unique on the bus.
    pub(crate) fn number(&mut self) -> u32 {
        self.ids += 1;
        self.ids
    }

    /// Adds a bus of python-can or a client as a listener; returns its number.
    pub(crate) fn listen(&mut self, own: bool) -> u32 {
        let id = self.number();
        self.listeners.push(Listener {
            id,
            queue: VecDeque::new(),
            filters: None,
            own,
        });
        id
    }

    /// Switches its devices on.
    pub(crate) fn start(&mut self) {
        for device in 0..self.bus.devices().len() {
            self.bus.start(device);
        }
    }

    /// The current time.
    pub(crate) fn now(&self) -> Instant {
        self.bus.now()
    }

    /// The next moment with an event.
    pub(crate) fn next(&self) -> Option<Instant> {
        let cyclics = self.cyclics.iter().filter_map(Cyclic::due);
        cyclics.chain(self.bus.next_deadline()).min()
    }

    /// Lets time pass to the next frame, or to `to`.
    pub(crate) fn step(&mut self, to: Instant) -> Step {
        self.changes += 1;
        let (before, end) = (self.now(), self.journal.end());
        if std::mem::take(&mut self.story.acted) {
            self.story.fresh = end;
        }
        let due = self.cyclics.iter().filter_map(Cyclic::due).min();
        let target = due.map_or(to, |due| due.min(to)).max(self.now());
        let sent = self.bus.advance_until_sent(target);
        if self.now() != before {
            self.story.fresh = end;
        }
        self.collect();
        if sent {
            return Step::Moved;
        }
        let now = self.now();
        let Some(at) = self
            .cyclics
            .iter()
            .position(|one| one.due().is_some_and(|due| due <= now))
        else {
            return Step::Reached;
        };
        let (id, port, calls) = {
            let one = &self.cyclics[at];
            (one.id, one.port, one.calls)
        };
        match self.cyclics[at].take(now) {
            Some((place, _)) if calls => return Step::Call(id, place),
            // A frame that the line does not accept is lost, like that of a timer.
            Some((_, frame)) => drop(self.transmit(port, &frame)),
            None => {}
        }
        Step::Moved
    }

    /// The frames that devices have sent at this moment, if others are still due.
    pub(crate) fn due(&self) -> Vec<Frame> {
        let now = self.now();
        if self.story.acted || self.bus.next_deadline().is_none_or(|next| next > now) {
            return Vec::new();
        }
        let records = self.journal.since(self.story.fresh);
        records
            .filter(|one| one.at == now && !one.sent)
            .filter_map(frame)
            .collect()
    }

    /// Adds an action to the script of what happened; `device` is the device that it is about.
    pub(crate) fn tell(&mut self, device: Option<usize>, line: &str) {
        if self.bus.line.is_real() {
            self.story.cannot("frames that take time (`real_line`)");
        }
        let due = self.due();
        self.story.add(self.now(), &due, device, line);
    }

    /// A program sends a frame.
    ///
    /// # Errors
    /// The CAN controller of the programs is bus-off.
    pub(crate) fn transmit(&mut self, port: u32, frame: &Frame) -> Result<(), Fault> {
        if self.bus.line.controller(0).error_state() == ErrorState::BusOff {
            return Err(Fault::system(
                "the CAN controller of the programs is bus-off; restart it with `bench.restart()`",
            ));
        }
        let now = self.now();
        self.acted = now;
        if self.bus.line.is_real() {
            self.story.cannot("frames that take time (`real_line`)");
        }
        let due = self.due();
        self.story.send(now, &due, *frame);
        if self.bus.line.is_real() {
            self.senders.push_back(port);
            self.bus.receive(frame);
        } else if self.bus.receive(frame) {
            self.hear(now, What::Frame(*frame), Some(port));
        }
        self.collect();
        Ok(())
    }

    /// Delivers the sent frames.
    pub(crate) fn collect(&mut self) {
        while let Some(one) = self.bus.line.poll() {
            if one.device.is_none() && one.bus_off {
                self.senders.pop_front();
            }
            self.hear(one.at, What::Error(BusError::Frame), None);
        }
        while let Some(sent) = self.bus.poll() {
            let from = match sent.device {
                None => self.senders.pop_front(),
                Some(_) => None,
            };
            self.hear(sent.at, What::Frame(sent.frame), from);
        }
        if !self.senders.is_empty() && !self.bus.is_sending(0) {
            self.senders.clear();
        }
    }

    /// All listeners receive a frame; `from` is the bus that sent it.
    pub(crate) fn hear(&mut self, at: Instant, what: What, from: Option<u32>) {
        for one in &mut self.listeners {
            let own = from == Some(one.id);
            let passes = match what {
                What::Frame(frame) => passes(one.filters.as_deref(), frame.id()),
                What::Error(_) => true,
            };
            if !passes || (own && !one.own) {
                continue;
            }
            if one.queue.len() < QUEUED {
                one.queue.push_back(Heard { at, what, own });
            }
        }
        self.journal.add(at, from.is_some(), what);
    }

    /// Drops all events: the bench was replaced.
    pub(crate) fn forget(&mut self) {
        self.journal.clear();
        self.senders.clear();
        (self.seen, self.acted) = (0, self.now());
        self.listeners.iter_mut().for_each(|one| one.queue.clear());
        self.real = self.real.map(|_| Clock::now());
    }

    /// The listener with this number.
    pub(crate) fn listener(&mut self, id: u32) -> Option<&mut Listener> {
        self.listeners.iter_mut().find(|one| one.id == id)
    }

    /// Whose turn it is among the waits that have ended: buses that receive, in the order in which they
    /// were opened; then threads that wait for any frame; then those whose moment has come, in the order in
    /// which they took part, and `run` after all others. `None`: the wait is not over.
    pub(crate) fn turn(&self, wait: Wait, place: usize) -> Option<(u8, u32)> {
        let heard = |port| match self.listeners.iter().find(|one| one.id == port) {
            Some(one) => !one.queue.is_empty(),
            // It was closed.
            None => true,
        };
        match wait.port {
            Some(port) if heard(port) => Some((0, port)),
            _ if wait.seen.is_some_and(|seen| seen != self.journal.end()) => Some((1, 0)),
            _ => wait.until.filter(|until| *until <= self.now()).map(|_| {
                (
                    2 + u8::from(wait.is_last),
                    u32::try_from(place).unwrap_or(u32::MAX),
                )
            }),
        }
    }

    /// Wakes the threads whose waits have ended.
    pub(crate) fn wake(&self) {
        let own = thread::current().id();
        for (at, party) in self.parties.iter().enumerate() {
            let is_over = |wait| self.turn(wait, at).is_some();
            if self.parties.len() > 1 && !party.is(own) && party.wait.is_some_and(is_over) {
                party.thread.as_ref().into_iter().for_each(Thread::unpark);
            }
        }
    }

    /// Time until the clock reaches a moment, if time follows the clock: while the thread that opened the bus waits in
    /// Python, and otherwise to the end of any wait in Python. `None`: it has reached the moment.
    pub(crate) fn ahead_of_the_clock(&self, to: Instant) -> Option<Duration> {
        let waits = self.parties.iter().enumerate().filter_map(|(at, party)| {
            let wait = party.wait?;
            let counts = at == 0 || wait.until.is_some();
            wait.paced.filter(|_| counts)
        });
        let follows = waits.chain(self.follows);
        follows.filter_map(|start| self.left(start, to)).max()
    }

    /// Time until the clock reaches a moment, from the start of a wait that follows it. `None`: it has reached the moment.
    pub(crate) fn left(&self, (clock, from): (Clock, Instant), to: Instant) -> Option<Duration> {
        let time = to.micros_since(from) as f64 / 1e6 / self.pace;
        let left = time - clock.elapsed().as_secs_f64();
        (left > 0.0).then(|| Duration::from_secs_f64(left.min(1e6)))
    }

    /// A thread acts, or ends a wait. Returns whether it takes part.
    pub(crate) fn touch(&mut self, id: ThreadId) -> bool {
        // After a fork only one thread exists.
        let process = std::process::id();
        if std::mem::replace(&mut self.process, process) != process {
            self.parties.retain(|party| party.is(id));
        }
        self.changes += 1;
        let Some(own) = self.parties.iter_mut().find(|party| party.is(id)) else {
            return false;
        };
        own.touch();
        true
    }

    pub(crate) fn begin(&mut self, id: ThreadId, wait: Wait) {
        if let Some(party) = self.parties.iter_mut().find(|party| party.is(id)) {
            party.begin(wait);
        }
    }

    /// A thread ends its wait.
    pub(crate) fn leave(&mut self, id: ThreadId) {
        let own = self.parties.iter_mut().find(|party| party.is(id));
        if let Some(own) = own.filter(|own| own.wait.is_some() || own.target.is_some()) {
            (own.wait, own.target) = (None, None);
            self.touch(id);
        }
    }

    /// Movement of its time.
    pub(crate) fn time(&self) -> Time {
        match self.real {
            Some(_) => Time::Real,
            None if self.strict => Time::Strict,
            None => Time::Virtual,
        }
    }

    /// The moment from which a time-out is counted: in real time that of the clock, which may be ahead of the bus.
    pub(crate) fn present(&self) -> Instant {
        let now = self.now();
        self.clock().map_or(now, |clock| clock.max(now))
    }

    /// The moment that the clock shows, on a wire in real time.
    pub(crate) fn clock(&self) -> Option<Instant> {
        let micros = self.real?.elapsed().as_micros();
        Some(Instant::from_micros(
            u64::try_from(micros).unwrap_or(u64::MAX),
        ))
    }
}
