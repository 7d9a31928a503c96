//! A place where clients come to.

use std::collections::VecDeque;
use std::io::{ErrorKind, Result};
use std::time::{Duration, Instant as Clock};

use mio::{Registry, Token};

use super::links::listener::{Listener, Stream};
use super::links::opened::Protocol;
use super::terminal::note;

/// Most connections that are looked at in one turn.
const TURN: usize = 64;
/// A client without room waits this long: another may have left before it came, and the news of that
/// may come later.
const PATIENCE: Duration = Duration::from_millis(100);
/// Time after which a connection that the system refused is tried again.
const AGAIN: Duration = Duration::from_millis(100);
/// Files that remain free for everything but clients.
#[cfg(unix)]
const FILES: usize = 4;

/// A server.
pub(super) struct Door {
    pub(super) number: usize,
    pub(super) protocol: Protocol,
    listener: Listener,
    /// Clients may be waiting.
    pub(super) ready: bool,
    /// Clients without room, and when they are refused.
    held: VecDeque<(Stream, String, Clock)>,
    /// No client is let in before this moment.
    shut: Option<Clock>,
    /// The last client was refused, and that was reported.
    refuses: bool,
}

impl Door {
    pub(super) fn new(
        number: usize,
        protocol: Protocol,
        mut listener: Listener,
        events: &Registry,
    ) -> Result<Self> {
        listener.register(events, Token(number))?;
        Ok(Self {
            number,
            protocol,
            listener,
            ready: true,
            held: VecDeque::new(),
            shut: None,
            refuses: false,
        })
    }

    /// Time when to try again what the system refused, or to refuse a client.
    pub(super) fn deadline(&self) -> Option<Clock> {
        let held = self.held.front().map(|(_, _, until)| *until);
        self.shut.into_iter().chain(held).min()
    }

    /// Does a client wait to be let in?
    pub(super) fn is_wanted(&self) -> bool {
        self.ready || !self.held.is_empty()
    }

    /// The next client. `full` is the reason if no more clients are accepted.
    pub(super) fn accept(&mut self, full: Option<&str>) -> Option<(Stream, String)> {
        let now = Clock::now();
        if self.shut.is_some_and(|until| now < until) {
            return None;
        }
        self.shut = None;
        for _ in 0..2 * TURN {
            if let Some((_, _, until)) = self.held.front() {
                let files = "too many open files; raise the limit with `ulimit -n`";
                let why = full.or_else(|| (!has_files()).then_some(files));
                if why.is_some() && now < *until && (full.is_none() || self.held.len() == TURN) {
                    return None;
                }
                if why.is_none() || now >= *until {
                    let (stream, name, _) = self.held.pop_front()?;
                    match why {
                        Some(why) => {
                            self.tell(&format!("{name} was refused: {why}"));
                            stream.refuse(self.protocol, why);
                        }
                        None if stream.prepare().is_err() => {}
                        None => {
                            self.refuses = false;
                            return Some((stream, name));
                        }
                    }
                    continue;
                }
            }
            match self.listener.accept() {
                Ok((stream, name)) => self.held.push_back((stream, name, now + PATIENCE)),
                Err(error) if error.kind() == ErrorKind::WouldBlock => {
                    self.ready = false;
                    return None;
                }
                // The client went before it was let in.
                Err(error)
                    if matches!(
                        error.kind(),
                        ErrorKind::ConnectionAborted
                            | ErrorKind::ConnectionReset
                            | ErrorKind::Interrupted
                    ) => {}
                Err(error) => {
                    self.tell(&format!("no client can connect: {error}"));
                    self.shut = Some(now + AGAIN);
                    return None;
                }
            }
        }
        None
    }

    /// Tells it once until a client is let in again.
    fn tell(&mut self, text: &str) {
        if !std::mem::replace(&mut self.refuses, true) {
            note(text);
        }
    }
}

/// Can more files be opened? A save into an EEPROM file has to work however many connect.
#[cfg(unix)]
fn has_files() -> bool {
    let files = (0..FILES).map(|_| std::fs::File::open("/dev/null"));
    files.collect::<Result<Vec<_>>>().is_ok()
}

#[cfg(not(unix))]
fn has_files() -> bool {
    true
}
