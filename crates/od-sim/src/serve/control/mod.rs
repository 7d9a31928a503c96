//! Control of a live bench: it runs each line of a client and answers when the line is done.
//!
//! An answer is one line: `ok` and the result, `failed` and why the bench cannot do it, or `wrong`
//! and why the line cannot be read. Lines before it that begin with `| ` belong to it.

pub(super) mod address;
mod effect;
pub(super) mod open;

use std::collections::VecDeque;
use std::time::Duration;

use od_model::Refused;
use od_runtime::{Frame, Instant};

use crate::bench::Bench;
use crate::script::Console;

/// Limit of waiting lines of one client; a client that sends more is disconnected.
const MOST: usize = 1000;
/// The answer to a line that sends a frame waits this long for a real bus line.
const PATIENCE: Duration = Duration::from_secs(1);

/// Clients of the control socket.
#[derive(Default)]
pub(super) struct Control(Vec<Session>);

/// Effect of a line.
pub(super) enum Turn {
    /// This frame of a client goes to the bus.
    Frame(usize, Frame),
    /// Something changed.
    Changed,
    /// This goes to the client.
    Answer(usize, String),
    /// Figures go to the client, in JSON or as text.
    Stats(usize, bool),
}

/// One client, with a console of its own.
struct Session {
    client: usize,
    console: Console,
    /// The device that its lines are about.
    current: usize,
    queue: VecDeque<Entry>,
    /// The effect of the line that is in progress, in words.
    effect: Option<String>,
    /// The frame of this line that a real line has not sent, and the time until which its answer waits for it.
    sending: Option<(Frame, Instant)>,
    /// A frame of this line for which the queue had no room.
    lost: Option<Frame>,
    has_left: bool,
}

/// A line of a client, in order.
enum Entry {
    Line,
    Stats(bool),
    Answer(String),
}

/// The reason why a frame is not on the line, if the queue for it was full.
pub(super) fn lost(frame: &Frame) -> String {
    format!(
        "{frame} is lost: other frames of clients wait for the bus line, and their queue is full; send it again later"
    )
}

impl Control {
    /// A line of a client. Returns `false` if too many wait.
    pub(super) fn push(&mut self, client: usize, text: &str) -> bool {
        let place = self.0.iter().position(|one| one.client == client);
        let place = place.unwrap_or_else(|| {
            self.0.push(Session::new(client));
            self.0.len() - 1
        });
        self.0[place].push(text);
        self.0[place].queue.len() <= MOST
    }

    /// The client has left: the line in progress is completed, later ones do not start.
    pub(super) fn leave(&mut self, client: usize) {
        for session in self.0.iter_mut().filter(|one| one.client == client) {
            session.console.abandon();
            session.queue.clear();
            session.has_left = true;
        }
        self.0.retain(|one| !one.is_over());
    }

    /// Time when the next line is due, as seen at `now`.
    pub(super) fn deadline(&self, now: Instant) -> Option<Instant> {
        let due = |session: &Session| match session.queue.front() {
            _ if session.sending.is_some() => session.sending.map(|(_, until)| until),
            Some(Entry::Line) | None => session.console.deadline(now),
            Some(_) => Some(now),
        };
        self.0.iter().filter_map(due).min()
    }

    /// The queue for the line was full, and the frame of a client is lost: its line fails.
    pub(super) fn refused(&mut self, client: usize, frame: Frame) {
        for session in self.0.iter_mut().filter(|one| one.client == client) {
            session.lost = Some(frame);
            if session.sending.take().is_some() {
                session.answer(Ok(()));
            }
        }
    }

    /// Runs the next line that is due.
    pub(super) fn step(&mut self, bench: &mut Bench) -> Option<Turn> {
        let turn = self.0.iter_mut().find_map(|session| session.step(bench));
        if turn.is_none() {
            self.0.retain(|one| !one.is_over());
        }
        turn
    }
}

impl Session {
    fn new(client: usize) -> Self {
        Self {
            client,
            console: Console::default(),
            current: 0,
            queue: VecDeque::new(),
            effect: None,
            sending: None,
            lost: None,
            has_left: false,
        }
    }

    fn is_over(&self) -> bool {
        self.has_left && self.console.is_idle()
    }

    fn push(&mut self, text: &str) {
        self.queue.push_back(match text.trim() {
            "stats" => Entry::Stats(false),
            "stats json" => Entry::Stats(true),
            text => match self.console.push(text) {
                Ok(true) => Entry::Line,
                Ok(false) => Entry::Answer("ok".into()),
                Err(problem) => {
                    Entry::Answer(format!("wrong {}; {}", problem.message, problem.help))
                }
            },
        });
    }

    fn step(&mut self, bench: &mut Bench) -> Option<Turn> {
        let client = self.client;
        match self.queue.front() {
            Some(Entry::Answer(_)) => match self.queue.pop_front() {
                Some(Entry::Answer(text)) => return Some(Turn::Answer(client, text)),
                _ => return None,
            },
            Some(Entry::Stats(json)) => {
                let turn = Turn::Stats(client, *json);
                self.queue.pop_front();
                return Some(turn);
            }
            Some(Entry::Line) => {}
            None if self.console.is_idle() => return None,
            None => {}
        }
        if let Some((frame, until)) = self.sending {
            let result = match bench.bus.is_sent(&frame) {
                Ok(false) if bench.bus.now() < until => return None,
                Ok(false) => Err(format!(
                    "{frame} still waits; other frames fill the bus line"
                )),
                Ok(true) => Ok(()),
                Err(why) => Err(why),
            };
            let result = result.map_err(Refused::from);
            self.sending = None;
            self.answer(result);
            return Some(Turn::Changed);
        }
        let deed = self.console.front().cloned();
        std::mem::swap(&mut bench.current, &mut self.current);
        let result = self.console.step(bench);
        let effect = deed.map(|deed| effect::effect(&deed, bench));
        std::mem::swap(&mut bench.current, &mut self.current);
        let result = result?;
        self.effect = effect.or(self.effect.take());
        let is_last = result.is_err() || !self.console.goes_on();
        Some(match result {
            Ok(Some(frame)) => {
                if is_last && bench.bus.line.is_real() {
                    self.sending = Some((frame, bench.bus.now() + PATIENCE));
                } else if is_last {
                    self.answer(Ok(()));
                }
                Turn::Frame(client, frame)
            }
            result => {
                if is_last {
                    self.answer(result.map(|_| ()));
                }
                Turn::Changed
            }
        })
    }

    /// Answers the line in progress.
    fn answer(&mut self, result: Result<(), Refused>) {
        let effect = self.effect.take().unwrap_or_default();
        let result = match self.lost.take() {
            Some(frame) => result.and(Err(lost(&frame).into())),
            None => result,
        };
        let answer = match result {
            Ok(()) => format!("ok {effect}"),
            Err(why) => format!("failed {why}"),
        };
        if let Some(entry) = self.queue.front_mut() {
            *entry = Entry::Answer(answer);
        }
    }
}
