//! A place where clients come to.

use std::io::{ErrorKind, Result};
use std::time::{Duration, Instant as Clock};

use mio::{Registry, Token};

use super::links::listener::{Listener, Stream};
use super::links::opened::Protocol;
use super::terminal::note;

/// Most connections that are looked at in one turn.
const TURN: usize = 64;
/// What the system refuses is tried again after this time.
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
    /// A client without room, and how many rounds it waits for those who left before it came.
    held: Option<(Stream, String, usize)>,
    /// Nobody is let in before this moment.
    shut: Option<Clock>,
    /// The last client was refused, and that was told.
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
            held: None,
            shut: None,
            refuses: false,
        })
    }

    /// When to try again what the system refused.
    pub(super) fn deadline(&self) -> Option<Clock> {
        self.shut
    }

    /// The next client. `full` says why there is no room for it; it waits until the `readable` clients
    /// have had their turn, since one of them may have left before it came.
    pub(super) fn accept(
        &mut self,
        full: Option<&str>,
        readable: usize,
    ) -> Option<(Stream, String)> {
        if self.shut.is_some_and(|until| Clock::now() < until) {
            return None;
        }
        self.shut = None;
        for _ in 0..TURN {
            let (stream, name, rounds) = match self.held.take() {
                Some(held) => held,
                None => match self.listener.accept() {
                    Ok((stream, name)) => (stream, name, 0),
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
                        ) =>
                    {
                        continue;
                    }
                    Err(error) => {
                        self.tell(&format!("no client can connect: {error}"));
                        self.shut = Some(Clock::now() + AGAIN);
                        return None;
                    }
                },
            };
            let files = "too many open files; raise the limit with `ulimit -n`";
            let why = full.or_else(|| (!has_files()).then_some(files));
            match why {
                Some(_) if rounds <= readable => {
                    self.held = Some((stream, name, rounds + 1));
                    return None;
                }
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

/// Can more files be opened? A save into an EEPROM file has to work whoever connects.
#[cfg(unix)]
fn has_files() -> bool {
    let files = (0..FILES).map(|_| std::fs::File::open("/dev/null"));
    files.collect::<Result<Vec<_>>>().is_ok()
}

#[cfg(not(unix))]
fn has_files() -> bool {
    true
}
