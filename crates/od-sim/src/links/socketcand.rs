//! The protocol of the socketcand daemon: commands in angle brackets over TCP.
//!
//! The server greets a client with `< hi >`. The client opens a bus (`< open can0 >`) and is then in
//! BCM mode, in which it receives its subscriptions and can have frames sent repeatedly,
//! or after `< rawmode >` in RAW mode, in which it receives everything.
//!
//! | | |
//! |---|---|
//! | `< send 601 8 40 4 60 0 0 0 0 0 >`, `< sendrtr 701 0 >` | a frame, at once |
//! | `< add 0 20000 80 0 >`, `< update 80 1 5 >`, `< delete 80 >` | a frame every 20 ms |
//! | `< subscribe 0 0 181 >`, `< filter 0 0 181 2 FF 00 >`, `< unsubscribe 181 >` | subscriptions of BCM mode |
//! | `< rawmode >`, `< bcmmode >`, `< echo >` | |
//!
//! There is one bus, and every name opens it. ISO-TP, CAN FD, statistics and multiplex
//! filters are answered like unknown commands.

mod jobs;
#[cfg(test)]
mod tests;

use std::format;
use std::prelude::v1::*;

use od_runtime::{CanId, Frame, Instant};

use super::codec::{Codec, Step, reply};
use jobs::{Jobs, Watches};

/// The longest valid command is an `add` with 8 bytes.
const LONGEST: usize = 128;
/// Longest name of an interface.
const LONGEST_NAME: usize = 16;

const OK: &[u8] = b"< ok >";
const UNKNOWN: &[u8] = b"< error unknown command >";
const SYNTAX: &[u8] = b"< error syntax error >";
const TOO_MANY: &[u8] = b"< error too many jobs >";

#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
enum Mode {
    #[default]
    NoBus,
    Bcm,
    Raw,
}

/// State of one client's connection.
#[derive(Debug, Default)]
pub struct Session {
    mode: Mode,
    /// The command so far, from its opening bracket.
    text: Vec<u8>,
    jobs: Jobs,
    watches: Watches,
}

impl Codec for Session {
    fn hello(&self) -> &'static [u8] {
        b"< hi >"
    }

    fn receive(&mut self, bytes: &[u8], now: Instant, steps: &mut Vec<Step>) {
        for byte in bytes {
            match byte {
                b'<' => {
                    self.text.clear();
                    self.text.push(b'<');
                }
                b'>' if !self.text.is_empty() => {
                    let text = std::mem::take(&mut self.text);
                    match text.len() {
                        0..LONGEST => {
                            self.command(&String::from_utf8_lossy(&text[1..]), now, steps)
                        }
                        _ => reply(steps, SYNTAX),
                    }
                    self.text = text;
                    self.text.clear();
                }
                // Text between commands is ignored.
                _ if self.text.is_empty() || self.text.len() >= LONGEST => {}
                _ => self.text.push(*byte),
            }
        }
    }

    fn form(&self) -> Option<&'static str> {
        (self.mode == Mode::Raw).then_some("socketcand")
    }

    fn encode(&mut self, frame: &Frame, now: Instant, stamp: u64, out: &mut Vec<u8>) {
        match self.mode {
            Mode::NoBus => {}
            Mode::Raw => write(frame, stamp, "", out),
            Mode::Bcm => {
                if self.watches.hears(frame, now) {
                    write(frame, stamp, " ", out);
                }
            }
        }
    }

    fn deadline(&self) -> Option<Instant> {
        match (self.jobs.deadline(), self.watches.deadline()) {
            (Some(job), Some(watch)) => Some(job.min(watch)),
            (job, watch) => job.or(watch),
        }
    }

    fn wake(&mut self, now: Instant, stamp: u64, steps: &mut Vec<Step>) {
        while let Some(frame) = self.watches.due(now) {
            let mut text = Vec::new();
            write(&frame, stamp, " ", &mut text);
            reply(steps, &text);
        }
        self.jobs.due(now, |frame| steps.push(Step::Frame(frame)));
    }
}

impl Session {
    fn command(&mut self, text: &str, now: Instant, steps: &mut Vec<Step>) {
        let mut words = text.split_ascii_whitespace();
        let name = words.next().unwrap_or_default();
        if self.mode == Mode::NoBus {
            let bus = words.next().filter(|bus| bus.len() <= LONGEST_NAME);
            match (name, bus, words.next()) {
                ("open", Some(_), None) => {
                    self.mode = Mode::Bcm;
                    reply(steps, OK);
                }
                ("open", _, _) => reply(steps, SYNTAX),
                _ => reply(steps, UNKNOWN),
            }
            return;
        }
        let words: Vec<&str> = words.collect();
        let done = match (name, self.mode) {
            ("rawmode", _) => {
                self.switch(Mode::Raw, steps);
                // Clients compare the whole message with the response.
                steps.push(Step::Pause);
                return;
            }
            ("bcmmode", _) => return self.switch(Mode::Bcm, steps),
            ("echo", _) => return reply(steps, b"< echo >"),
            ("send", _) => data_frame(&words).map(|frame| steps.push(Step::Frame(frame))),
            ("sendrtr", _) => remote_frame(&words).map(|frame| steps.push(Step::Frame(frame))),
            ("add", Mode::Bcm) => interval(&words).and_then(|(every, rest)| {
                let frame = data_frame(rest)?;
                if self.jobs.add(frame, every, now) {
                    steps.push(Step::Frame(frame));
                } else {
                    reply(steps, TOO_MANY);
                }
                Some(())
            }),
            ("update", Mode::Bcm) => data_frame(&words).map(|frame| self.jobs.update(frame)),
            ("delete", Mode::Bcm) => one_id(&words).map(|id| self.jobs.delete(id)),
            ("subscribe", Mode::Bcm) => interval(&words).and_then(|(every, rest)| {
                let id = one_id(rest)?;
                if !self.watches.add(id, every, None) {
                    reply(steps, TOO_MANY);
                }
                Some(())
            }),
            ("filter", Mode::Bcm) => interval(&words).and_then(|(every, rest)| {
                let mask = data_frame(rest)?;
                if !self.watches.add(mask.id(), every, Some(mask)) {
                    reply(steps, TOO_MANY);
                }
                Some(())
            }),
            ("unsubscribe", Mode::Bcm) => one_id(&words).map(|id| self.watches.delete(id)),
            _ => return reply(steps, UNKNOWN),
        };
        if done.is_none() {
            reply(steps, SYNTAX);
        }
    }

    /// Jobs and subscriptions end with the mode.
    fn switch(&mut self, mode: Mode, steps: &mut Vec<Step>) {
        self.mode = mode;
        self.jobs = Jobs::default();
        self.watches = Watches::default();
        reply(steps, OK);
    }
}

/// `< frame 123 23.424242 1122 >`; BCM mode has a blank after each byte.
fn write(frame: &Frame, stamp: u64, blank: &str, out: &mut Vec<u8>) {
    let kind = if frame.is_remote() { "rtr" } else { "frame" };
    let (seconds, micros) = (stamp / 1_000_000, stamp % 1_000_000);
    let mut text = format!("< {kind} {} {seconds}.{micros:06} ", frame.id());
    if frame.is_remote() {
        text.push_str(&format!("{}", frame.dlc()));
    }
    for byte in frame.data() {
        text.push_str(&format!("{byte:02X}{blank}"));
    }
    text.push_str(" >");
    out.extend_from_slice(text.as_bytes());
}

/// Up to three digits are a CAN-ID of 11 bits, eight digits are one of 29 bits.
fn id(word: &str) -> Option<CanId> {
    let raw = hex(word)?;
    match word.len() {
        1..=3 if raw <= 0x7FF => Some(CanId::standard(raw as u16)),
        8 if raw <= 0x1FFF_FFFF => Some(CanId::extended(raw)),
        _ => None,
    }
}

/// Digits only, without a sign.
fn hex(word: &str) -> Option<u32> {
    let digits = word.bytes().all(|byte| byte.is_ascii_hexdigit());
    u32::from_str_radix(word, 16).ok().filter(|_| digits)
}

fn one_id(words: &[&str]) -> Option<CanId> {
    match words {
        [word] => id(word),
        _ => None,
    }
}

fn dlc(word: &str) -> Option<u8> {
    match word.as_bytes() {
        [digit @ b'0'..=b'8'] => Some(digit - b'0'),
        _ => None,
    }
}

/// `123 2 11 22`
fn data_frame(words: &[&str]) -> Option<Frame> {
    let [name, length, bytes @ ..] = words else {
        return None;
    };
    let (id, dlc) = (id(name)?, dlc(length)?);
    let mut data = [0; 8];
    if bytes.len() != usize::from(dlc) {
        return None;
    }
    for (byte, word) in data.iter_mut().zip(bytes) {
        *byte = hex(word).and_then(|value| u8::try_from(value).ok())?;
    }
    Some(Frame::with_dlc(id, data, dlc))
}

fn remote_frame(words: &[&str]) -> Option<Frame> {
    match words {
        [name, length] => Frame::remote(id(name)?, dlc(length)?),
        _ => None,
    }
}

/// Reads seconds and microseconds, and returns the rest.
fn interval<'w>(words: &'w [&'w str]) -> Option<(u64, &'w [&'w str])> {
    let [seconds, micros, rest @ ..] = words else {
        return None;
    };
    let number = |word: &str| {
        let digits = word.bytes().all(|byte| byte.is_ascii_digit());
        word.parse::<u32>().ok().filter(|_| digits).map(u64::from)
    };
    Some((number(seconds)? * 1_000_000 + number(micros)?, rest))
}
