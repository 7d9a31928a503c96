//! A server that accepts clients.

use std::collections::VecDeque;
use std::io::{ErrorKind, Result};
use std::time::{Duration, Instant as Clock};

use mio::{Registry, Token};

use super::links::listener::{Listener, Stream};
use super::links::opened::Protocol;
use super::terminal::note;

/// Limit of connections that are accepted in one turn.
const TURN: usize = 64;
/// A client without a free place waits this long: another may have left earlier, but its event may
/// come later.
const PATIENCE: Duration = Duration::from_millis(100);
/// Time until the next attempt after the system refused a connection.
const AGAIN: Duration = Duration::from_millis(100);
/// File descriptors that stay free for other uses.
#[cfg(unix)]
const FILES: usize = 4;

/// A server.
pub(super) struct Door {
    pub(super) number: usize,
    pub(super) protocol: Protocol,
    listener: Listener,
    /// Clients may wait.
    pub(super) ready: bool,
    /// Clients without a free place, and when they are refused.
    held: VecDeque<(Stream, String, Clock)>,
    /// No client is accepted before this time.
    shut: Option<Clock>,
    /// The last client was refused, and this was reported.
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

    /// The next time for another attempt, or to refuse a client.
    pub(super) fn deadline(&self) -> Option<Clock> {
        let held = self.held.front().map(|(_, _, until)| *until);
        self.shut.into_iter().chain(held).min()
    }

    /// Returns whether a client waits.
    pub(super) fn is_wanted(&self) -> bool {
        self.ready || !self.held.is_empty()
    }

    /// Accepts the next client. `full` is the reason if no more clients are accepted.
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
                // The client left before it was accepted.
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

    /// Reports it once until a client is accepted again.
    fn tell(&mut self, text: &str) {
        if !std::mem::replace(&mut self.refuses, true) {
            note(text);
        }
    }
}

/// Returns whether more files can be opened. Saving an EEPROM file has to work however many clients connect.
#[cfg(unix)]
fn has_files() -> bool {
    let files = (0..FILES).map(|_| std::fs::File::open("/dev/null"));
    files.collect::<Result<Vec<_>>>().is_ok()
}

#[cfg(not(unix))]
fn has_files() -> bool {
    true
}
