//! The bus in real time: bytes of clients, frames of devices, and the clock.

use std::collections::VecDeque;
use std::io::{self, ErrorKind};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant as Clock};

use od_runtime::{Frame, Instant};

use super::clients::Clients;
use super::control::{Control, lost};
use super::device_events;
use super::error::Error;
use super::fleet::PlacedDevice;
use super::links::LINKS;
use super::links::listener::Listener;
use super::links::opened::{Opened, Protocol};
use super::log::Log;
use super::pace::{LATE, Pace};
use super::stats::Stats;
use super::terminal::{news, note};
use crate::bench::Bench;
use crate::bus::Bus;
use crate::device::VirtualDevice;
use crate::device::notice;
use crate::links::Step;
use crate::script::Console;
use crate::words::plural;

/// Limit of bytes that the bus takes from one client in a turn.
const TURN: usize = 4 * 1024;
/// Turns after which the frames of all clients are sent.
const ROUND: usize = 4;
/// Limit of reads from a client whose connection is lost.
const LAST: usize = 64;

/// The bus in real time.
pub(super) struct Live {
    pub(super) bench: Bench,
    pace: Pace,
    pub(super) clients: Clients,
    console: Console,
    pub(super) control: Control,
    pub(super) stats: Stats,
    /// Log file of the bus.
    pub(super) log: Option<Log>,
    stopped: Arc<AtomicBool>,
    /// The client whose bytes are being handled.
    cause: Option<usize>,
    /// Frames that wait for a real line or are being sent there, with the clients that sent them.
    sending: VecDeque<(Frame, Option<usize>)>,
    /// Number of links with a client of their own that are still open.
    links: usize,
    /// Reason why the last link was lost.
    lost: Option<String>,
}

impl Live {
    /// Switches the devices on. Their frames wait until the bench [runs](Self::run), so that every
    /// link that exists by then receives them.
    pub(super) fn new(
        placed: Vec<PlacedDevice>,
        clients: Clients,
        stats: Stats,
        stopped: Arc<AtomicBool>,
    ) -> Self {
        let mut bus = Bus::new();
        for PlacedDevice { device, beside } in placed {
            let number = match beside {
                Some(other) => bus.add_beside(device, other),
                None => bus.add(device),
            };
            bus.start(number);
        }
        let mut live = Self {
            bench: Bench::new(bus),
            pace: Pace::new(),
            clients,
            console: Console::default(),
            control: Control::default(),
            stats,
            log: None,
            stopped,
            cause: None,
            sending: VecDeque::new(),
            links: 0,
            lost: None,
        };
        device_events::print(&mut live.bench, |event| notice::of_storage(event).is_some());
        live
    }

    pub(super) fn add(&mut self, link: Opened) -> io::Result<()> {
        match link {
            Opened::Listener(protocol, listener, _) => {
                self.clients.open(protocol, Listener::Tcp(listener))
            }
            Opened::Ends(ends) => {
                self.links += 1;
                self.clients.join(ends)
            }
        }
    }

    /// Runs until Ctrl-C, or until the last link has ended.
    pub(super) fn run(&mut self) -> Result<(), Error> {
        self.pace = Pace::new();
        while !self.is_stopped() {
            self.catch_up();
            self.wake();
            self.flush();
            if !self.clients.has_doors() && self.links == 0 && self.console.is_idle() {
                break;
            }
            let patience = match self.deadline() {
                Some(at) => at - self.pace.at(Clock::now()),
                None => Duration::from_secs(3600),
            };
            self.clients.wait(patience)?;
            self.turns();
        }
        for number in 0..self.bench.bus.devices().len() {
            self.bench.bus.with(number, VirtualDevice::power_off);
        }
        self.finish()?;
        news(&format!(
            "\nodkit: ended; {} went over the bus",
            plural(self.stats.frames as usize, "frame")
        ));
        match self.lost.take().filter(|_| !self.is_stopped()) {
            Some(why) => Err(Error::Failed(format!("the last link is lost: {why}"))),
            None => Ok(()),
        }
    }

    fn is_stopped(&self) -> bool {
        self.stopped.load(Ordering::Relaxed)
    }

    /// Sends the last lines to the clients.
    fn finish(&mut self) -> io::Result<()> {
        self.flush();
        while self.clients.console_waits() && !self.is_stopped() {
            self.clients.wait(Duration::from_millis(100))?;
            self.flush();
        }
        for (number, error) in self.clients.finish(&self.stopped) {
            self.end(number, Some(error));
        }
        if let Some(log) = self.log.take() {
            log.finish();
        }
        Ok(())
    }

    fn deadline(&self) -> Option<Instant> {
        let (bus, now) = (&self.bench.bus, self.bench.bus.now());
        let all = [
            self.clients.codecs_due(),
            self.console.deadline(now),
            self.control.deadline(now),
            bus.next_deadline(),
        ];
        all.into_iter().flatten().min()
    }

    /// Runs the bus up to the present time and sends the frames of the devices. A bus that is late,
    /// because the computer slept or is too slow, must not send all missed frames at once.
    pub(super) fn catch_up(&mut self) {
        let clock = Clock::now();
        let before = self.bench.bus.now();
        if self.pace.at(clock) - before > LATE
            && let Some(due) = self.deadline()
            && let Some(late) = self.pace.shift(due.max(before), clock)
        {
            note(&format!(
                "odkit did not run for {} ms; the bus continues from the present time",
                late.as_millis()
            ));
        }
        self.bench.bus.advance(self.pace.at(clock));
        // No client caused this.
        let cause = self.cause.take();
        self.deliver();
        self.cause = cause;
    }

    pub(super) fn deliver(&mut self) {
        while let Some(sent) = self.bench.bus.poll() {
            let is_of_client = sent.device.is_none() && !self.bench.bus.take_of_master(&sent.frame);
            let from = is_of_client.then(|| self.sender(&sent.frame)).flatten();
            self.pass_on(&sent.frame, sent.at, from);
        }
        if !self.bench.bus.is_sending(0) {
            self.sending.clear();
        }
        device_events::print(&mut self.bench, |_| true);
    }

    /// The client that sent a frame of a real line. The line keeps the order, so the frames before it are lost.
    fn sender(&mut self, frame: &Frame) -> Option<usize> {
        let place = self.sending.iter().position(|(sent, _)| sent == frame)?;
        self.sending.drain(..=place).next_back()?.1
    }

    /// Lets codecs and the console do the work that is due.
    fn wake(&mut self) {
        let now = self.bench.bus.now();
        let stamp = self.pace.stamp(now);
        let mut due = Vec::new();
        for client in self.clients.all() {
            if client.codec.deadline().is_some_and(|at| at <= now) {
                let mut steps = Vec::new();
                client.codec.wake(now, stamp, &mut steps);
                due.push((client.number, steps));
            }
        }
        for (number, steps) in due {
            self.steps(number, steps);
        }
        self.run_console();
        self.run_control();
    }

    /// Sends the bytes that wait for clients.
    fn flush(&mut self) {
        for (number, error) in self.clients.flush() {
            self.lose(number, error);
        }
    }

    /// Sends a frame to every client except its sender.
    fn pass_on(&mut self, frame: &Frame, at: Instant, from: Option<usize>) {
        let stamp = self.pace.stamp(at);
        self.stats.frame(frame, from, self.cause);
        if let Some(log) = &mut self.log {
            log.add(stamp, frame);
        }
        self.clients.hear(frame, (at, stamp), from, self.cause);
    }

    /// Gives a turn to each client that has sent something, within the limit of this round. After that
    /// new clients are accepted: clients that have left make room for them.
    fn turns(&mut self) {
        let mut turns = 0;
        for number in self.clients.ready() {
            if turns == ROUND || self.is_stopped() {
                break;
            }
            turns += usize::from(self.turn(number));
        }
        for (number, name) in self.clients.accept() {
            let Some(client) = self.clients.get(number) else {
                continue;
            };
            let hello = client.codec.hello();
            if client.protocol != Protocol::Control {
                news(&format!("{name} connected"));
            }
            self.clients.answer(number, hello);
        }
    }

    /// Handles the bytes of one client, until there are no more or its limit is reached. Returns whether
    /// there were any.
    fn turn(&mut self, number: usize) -> bool {
        let mut buffer = [0; TURN];
        let mut room = self.clients.turn().min(TURN);
        let mut has_sent = false;
        while room > 0 {
            let len = match self.clients.read(number, &mut buffer[..room]) {
                Ok(Some(len)) if len > 0 => len,
                Ok(None) => break,
                end => {
                    self.end(number, end.err());
                    return has_sent;
                }
            };
            (has_sent, room) = (true, room - len);
            self.receive(number, &buffer[..len]);
        }
        // Its answers are sent before the next turn.
        let flushed = self.clients.get(number).map(|client| client.flush());
        if let Some(Err(error)) = flushed {
            self.lose(number, error);
        }
        has_sent
    }

    /// Ends a client that no bytes reach. What it sent before still counts: a program that sends a frame and closes its
    /// connection without having read all frames of the bus resets it.
    fn lose(&mut self, number: usize, error: io::Error) {
        let mut buffer = [0; TURN];
        for _ in 0..LAST {
            match self.clients.read(number, &mut buffer) {
                Ok(Some(len)) if len > 0 => self.receive(number, &buffer[..len]),
                _ => break,
            }
        }
        self.end(number, Some(error));
    }

    fn receive(&mut self, number: usize, bytes: &[u8]) {
        let now = self.bench.bus.now();
        let Some(client) = self.clients.get(number) else {
            return;
        };
        if client.is_http(bytes) {
            note(&format!(
                "{} was disconnected: it sent an HTTP request, and a browser must not drive the bus",
                client.name
            ));
            return self.clients.remove(number);
        }
        let mut steps = Vec::new();
        client.codec.receive(bytes, now, &mut steps);
        self.steps(number, steps);
    }

    /// A client has sent everything; with an `error`, it also receives nothing more.
    fn end(&mut self, number: usize, error: Option<io::Error>) {
        let Some(client) = self.clients.get(number) else {
            return;
        };
        if error.is_none() && client.port.outlives_hosts() {
            return client.restart();
        }
        let is_first = client.ended.replace(Clock::now()).is_none();
        client.readable = false;
        let (name, protocol) = (client.name.clone(), client.protocol);
        let mut rest = Vec::new();
        if is_first {
            client.codec.finish(&mut rest);
        }
        self.steps(number, rest);
        let mut left = self.clients.get(number).into_iter();
        let waits = left.any(|client| client.flush().is_ok() && !client.is_flushed());
        let hears = number >= LINKS && waits || protocol == Protocol::Lines;
        let is_heard = error.is_none() && hears;
        if !is_heard {
            self.clients.remove(number);
        }
        if number >= LINKS {
            if protocol == Protocol::Control {
                self.control.leave(number);
            } else if is_first {
                news(&format!("{name} left"));
            }
            if !is_heard {
                self.stats.forget(number);
            }
            return;
        }
        self.links -= usize::from(is_first);
        self.lost = match (protocol, error) {
            // A reader that closed its end is not an error.
            (Protocol::Lines, None) => None,
            (Protocol::Lines, Some(error)) if error.kind() == ErrorKind::BrokenPipe => None,
            (_, error) => {
                let why = error.map_or("hung up".into(), |error| error.to_string());
                note(&format!("{name} is lost: {why}"));
                Some(format!("{name}: {why}"))
            }
        };
    }

    /// Handles the bytes of a client, one input after the other.
    fn steps(&mut self, number: usize, steps: Vec<Step>) {
        self.cause = Some(number);
        for step in steps {
            match step {
                Step::Reply(bytes) => self.clients.answer(number, &bytes),
                Step::Pause => {
                    if let Some(client) = self.clients.get(number) {
                        client.pause();
                    }
                }
                Step::Frame(frame) => {
                    self.catch_up();
                    self.frame(&frame, Some(number));
                }
                Step::Line(text) => self.line(number, &text),
                Step::Open => self.bench.bus.restart_controller(0),
                Step::Status => {
                    self.catch_up();
                    let controller = self.bench.bus.line.controller(0);
                    let client = self.clients.get(number);
                    if let Some(reply) = client.map(|one| one.codec.status(controller)) {
                        self.clients.answer(number, &reply);
                    }
                }
                Step::Leave => self.clients.dismiss(number),
            }
        }
        self.cause = None;
    }

    /// Handles a line of a client; lines of a disconnected client are ignored.
    fn line(&mut self, number: usize, text: &str) {
        let protocol = self.clients.get(number).map(|client| client.protocol);
        match protocol {
            Some(Protocol::Control) => self.command(number, text),
            Some(_) => {
                if let Err(problem) = self.console.push(text) {
                    note(&format!("odkit: line {problem}"));
                }
                self.catch_up();
                self.run_console();
            }
            None => {}
        }
    }

    /// Runs the lines of the console that are due.
    fn run_console(&mut self) {
        // Other clients receive frames of the console; the console itself does not.
        let mut clients = self.clients.all();
        let console = clients.find(|client| client.protocol == Protocol::Lines);
        let console = console.map(|client| client.number);
        drop(clients);
        while let Some(done) = self.console.step(&mut self.bench) {
            match done {
                Ok(Some(frame)) => {
                    if !self.frame(&frame, console) {
                        note(&format!("odkit: {}", lost(&frame)));
                    }
                }
                Ok(None) => self.deliver(),
                Err(why) => note(&format!("odkit: {why}")),
            }
        }
    }

    /// Puts a frame from outside on the bus, with its effects. On a real line the others receive it when it was sent.
    /// Returns `false` if the queue for a real line is full, and the frame is lost.
    pub(super) fn frame(&mut self, frame: &Frame, from: Option<usize>) -> bool {
        let bus = &mut self.bench.bus;
        let mut is_taken = true;
        if !bus.line.is_real() {
            bus.receive(frame);
            let now = bus.now();
            self.pass_on(frame, now, from);
        } else if bus.queue(frame) {
            self.sending.push_back((*frame, from));
        } else {
            is_taken = false;
        }
        self.deliver();
        is_taken
    }
}
