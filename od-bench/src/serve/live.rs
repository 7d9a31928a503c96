//! The bus in real time: what clients send, what devices send, and the clock.

use std::collections::BTreeMap;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError};
use std::time::{Duration, Instant as Clock, SystemTime};

use od_runtime::{Event, Frame, Instant};

use super::client::{Client, Encoded};
use super::fleet::Place;
use super::links::LINKS;
use super::links::opened::Protocol;
use super::terminal::note;
use super::threads::Input;
use crate::bench::Bench;
use crate::bus::Bus;
use crate::device::VirtualDevice;
use crate::links::Step;
use crate::script::Console;
use crate::words::plural;

/// Bytes of clients that the bus takes in one turn, before its answers go out.
const TURN: usize = 16 * 1024;
/// An input counts as this number of bytes at least.
const INPUT: usize = 64;
/// Longest time between two turns; after a longer pause of the computer the bus paused too, and nothing is
/// made up for.
const SLEPT: Duration = Duration::from_secs(2);

/// The bus in real time.
pub(super) struct Live {
    pub(super) bench: Bench,
    start: Clock,
    /// Time of day at the start, in microseconds.
    epoch: u64,
    clients: BTreeMap<u64, Client>,
    console: Console,
    /// Links that nobody can come to again once they are gone.
    links: usize,
    /// Does anything listen for clients that are still to come?
    listens: bool,
    frames: u64,
}

impl Live {
    /// Devices get power, and time begins. `links` are clients that are there from the start.
    pub(super) fn new(places: Vec<Place>, links: usize, listens: bool) -> Self {
        let mut bus = Bus::new();
        for Place { device, beside } in places {
            let number = match beside {
                Some(other) => bus.add_beside(device, other),
                None => bus.add(device),
            };
            bus.start(number);
        }
        let epoch = SystemTime::now().duration_since(SystemTime::UNIX_EPOCH);
        let mut live = Self {
            bench: Bench::new(bus),
            start: Clock::now(),
            epoch: epoch.map_or(0, |since| since.as_micros() as u64),
            clients: BTreeMap::new(),
            console: Console::default(),
            links,
            listens,
            frames: 0,
        };
        // Nobody listens yet; a master that comes later asks for the state.
        while live.bench.bus.poll().is_some() {}
        live.events(|event| matches!(event, Event::StorageDamaged | Event::SaveCut { .. }));
        live
    }

    fn now(&self) -> Instant {
        Instant::ZERO + self.start.elapsed()
    }

    /// Runs until Ctrl-C, or until the last link has ended.
    pub(super) fn run(&mut self, waiting: &Receiver<Input>, stopped: &AtomicBool) {
        while !stopped.load(Ordering::Relaxed) {
            self.catch_up();
            self.wake();
            self.flush();
            if self.is_over() {
                break;
            }
            let deadline = self.deadline();
            let patience = match deadline {
                Some(at) => at - self.now(),
                None => Duration::from_secs(3600),
            };
            let first = match waiting.recv_timeout(patience) {
                Ok(input) => Some(input),
                Err(RecvTimeoutError::Timeout) => None,
                Err(RecvTimeoutError::Disconnected) => break,
            };
            self.wind_back(deadline);
            // What waits already belongs to this turn, as far as it has room.
            let mut room = TURN;
            for input in first.into_iter().chain(waiting.try_iter()) {
                if stopped.load(Ordering::Relaxed) {
                    break;
                }
                let size = match &input {
                    Input::Bytes(_, bytes) => bytes.len().max(INPUT),
                    _ => INPUT,
                };
                self.take(input);
                room = room.saturating_sub(size);
                if room == 0 {
                    break;
                }
            }
        }
        for number in 0..self.bench.bus.devices().len() {
            self.bench.bus.with(number, VirtualDevice::power_off);
        }
        // Whoever waits for the last lines sees that there are no more.
        self.clients.clear();
        note(&format!(
            "\nodkit: ended; {} went over the bus",
            plural(self.frames as usize, "frame")
        ));
    }

    fn is_over(&self) -> bool {
        !self.listens && self.links == 0 && self.console.is_idle()
    }

    fn deadline(&self) -> Option<Instant> {
        let clients = self.clients.values();
        let clients = clients.filter_map(|client| client.codec.deadline());
        let console = self.console.deadline(self.bench.bus.now());
        clients
            .chain(console)
            .chain(self.bench.bus.next_deadline())
            .min()
    }

    /// A machine that slept must not send at once all that it has missed.
    fn wind_back(&mut self, deadline: Option<Instant>) {
        let Some(deadline) = deadline else {
            return;
        };
        let late = self.now() - deadline;
        if late > SLEPT {
            self.start += late;
            let seconds = late.as_secs();
            note(&format!(
                "the computer paused for {seconds} s; the bus paused too"
            ));
        }
    }

    /// The bus catches up with the clock, and what devices send goes out.
    fn catch_up(&mut self) {
        let now = self.now();
        self.bench.bus.advance(now);
        self.deliver();
    }

    fn deliver(&mut self) {
        while let Some(sent) = self.bench.bus.poll() {
            self.frames += 1;
            self.pass_on(&sent.frame, sent.at, None);
        }
        self.events(|_| true);
    }

    /// Lets codecs and the console do what is due.
    fn wake(&mut self) {
        let now = self.bench.bus.now();
        let stamp = self.epoch + now.as_micros();
        let mut due = Vec::new();
        for (number, client) in &mut self.clients {
            if client.codec.deadline().is_some_and(|at| at <= now) {
                let mut steps = Vec::new();
                client.codec.wake(now, stamp, &mut steps);
                due.push((*number, steps));
            }
        }
        for (number, steps) in due {
            self.steps(number, steps);
        }
        self.run_console();
    }

    /// Sends the bytes of the turn, one message per client.
    fn flush(&mut self) {
        for client in self.clients.values_mut() {
            client.flush();
        }
    }

    /// A frame for every client but the one it is from.
    fn pass_on(&mut self, frame: &Frame, at: Instant, from: Option<u64>) {
        let stamp = self.epoch + at.as_micros();
        let mut encoded = Encoded::new();
        for (number, client) in &mut self.clients {
            if Some(*number) != from {
                client.hear(frame, at, stamp, &mut encoded);
            }
        }
    }

    fn take(&mut self, input: Input) {
        match input {
            Input::Connected(mut client) => {
                if matches!(client.protocol, Protocol::Slcan | Protocol::Socketcand) {
                    note(&format!("{} connected", client.name));
                }
                client.push(client.codec.hello());
                self.clients.insert(client.number, client);
            }
            Input::Gone(number) => self.gone(number),
            Input::Bytes(number, bytes) => {
                if let Some(client) = self.clients.get_mut(&number) {
                    let mut steps = Vec::new();
                    client
                        .codec
                        .receive(&bytes, self.bench.bus.now(), &mut steps);
                    self.steps(number, steps);
                }
            }
            Input::Stop => {}
        }
    }

    fn gone(&mut self, number: u64) {
        let Some(client) = self.clients.get_mut(&number) else {
            return;
        };
        let mut rest = Vec::new();
        client.codec.finish(&mut rest);
        let protocol = client.protocol;
        self.steps(number, rest);
        if (number as usize) < LINKS {
            self.links = self.links.saturating_sub(1);
        }
        if protocol == Protocol::Lines {
            // It has no more to say, and still hears.
            return;
        }
        if let Some(mut client) = self.clients.remove(&number) {
            // It may have ended its own side only, and read on.
            client.flush();
            note(&format!("{} left", client.name));
        }
    }

    /// Carries out a client's bytes, one input after the other.
    fn steps(&mut self, number: u64, steps: Vec<Step>) {
        for step in steps {
            match step {
                Step::Reply(bytes) => {
                    if let Some(client) = self.clients.get_mut(&number) {
                        client.push(&bytes);
                    }
                }
                Step::Pause => {
                    if let Some(client) = self.clients.get_mut(&number) {
                        client.pause();
                    }
                }
                Step::Frame(frame) => {
                    self.catch_up();
                    self.frame(&frame, Some(number));
                }
                Step::Line(text) => {
                    if let Err(problem) = self.console.push(&text) {
                        note(&format!("odkit: line {problem}"));
                    }
                    self.catch_up();
                    self.run_console();
                }
            }
        }
    }

    /// Lines of the console whose moment has come.
    fn run_console(&mut self) {
        // The console itself does not hear what it sends; the others do.
        let mut clients = self.clients.values();
        let console = clients.find(|client| client.protocol == Protocol::Lines);
        let console = console.map(|client| client.number);
        while let Some(done) = self.console.step(&mut self.bench) {
            match done {
                Ok(Some(frame)) => self.frame(&frame, console),
                Ok(None) => self.deliver(),
                Err(why) => note(&format!("odkit: {why}")),
            }
        }
    }

    /// A frame from outside, and what it brings about.
    fn frame(&mut self, frame: &Frame, from: Option<u64>) {
        self.frames += 1;
        self.bench.bus.receive(frame);
        let now = self.bench.bus.now();
        self.pass_on(frame, now, from);
        self.deliver();
    }

    fn events(&mut self, wanted: impl Fn(&Event) -> bool) {
        let several = self.bench.bus.devices().len() > 1;
        for number in 0..self.bench.bus.devices().len() {
            let events = self.bench.bus.with(number, |device, _| {
                let name = several.then(|| format!("node {}: ", device.node_id()));
                let events: Vec<_> = std::iter::from_fn(|| device.poll_event()).collect();
                (name.unwrap_or_default(), events)
            });
            let (name, events) = events.unwrap_or_default();
            for event in events.into_iter().filter(&wanted) {
                if let Some(text) = words(event) {
                    note(&format!("{name}{text}"));
                }
            }
        }
    }
}

/// Event in words, for the terminal.
fn words(event: Event) -> Option<String> {
    Some(match event {
        Event::State(state) => format!("state: {state}"),
        Event::Reset(_, node) => format!("reset, node {node}"),
        Event::Saved(_) => "parameters saved".into(),
        Event::Restored(_) => "defaults restored".into(),
        Event::StorageDamaged => {
            "the EEPROM is damaged or of another version; the device loaded defaults or an older set"
                .into()
        }
        Event::SaveCut { factory: true } => {
            "a save was interrupted; the device loaded its factory values".into()
        }
        Event::SaveCut { factory: false } => {
            "a save was interrupted; the values saved before it remain".into()
        }
        Event::BusOff { .. } => "bus-off".into(),
        Event::BusOn => "back from bus-off".into(),
        Event::Error(error) => format!("error {:04X}h", error.code),
        Event::ErrorCleared(code) => format!("error {code:04X}h cleared"),
        Event::BitRate(code) => {
            format!("LSS set bit rate index {code}; the simulated bus has no bit rate")
        }
        _ => return None,
    })
}
