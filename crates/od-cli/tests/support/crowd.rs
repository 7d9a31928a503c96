//! Clients that load a bench: one that floods it, some that never read, and a polite one that
//! measures its response time.

use std::io::{Read, Write};
use std::net::TcpStream;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::thread;
use std::time::{Duration, Instant};

use super::sim::{Sim, say};

/// An upload of 1000h, to which the device responds.
const FLOOD: &str = "t60184000100000000000\r";
/// The polite client reads 1018h:01; no other client does.
const REQUEST: &[u8] = b"t60184018100100000000\r";
const ANSWER: &[u8] = b"t581843181001";

/// Result of a crowd.
pub(crate) struct Measured {
    /// Frames per second that the flooder sent.
    pub(crate) flood: f64,
    /// Time from request to answer, the shortest first.
    pub(crate) answers: Vec<Duration>,
    /// Maximum memory and number of threads of the bench; `None` if the system does not tell.
    pub(crate) memory: Option<Memory>,
}

/// The process of the bench, as the system shows it.
#[derive(Clone, Copy)]
pub(crate) struct Memory {
    /// Largest resident set so far, in kB.
    pub(crate) peak: u64,
    pub(crate) threads: u64,
}

impl Measured {
    pub(crate) fn median(&self) -> Duration {
        self.answers[self.answers.len() / 2]
    }

    pub(crate) fn max(&self) -> Duration {
        self.answers.last().copied().unwrap_or_default()
    }

    /// One row of a table.
    pub(crate) fn row(&self, silent: usize) -> String {
        let memory = self.memory.map_or("?".into(), |memory| {
            format!("{} kB, {} threads", memory.peak, memory.threads)
        });
        format!(
            "{silent} silent: {:.0} frames/s, {} answers, median {:?}, max {:?}, {memory}",
            self.flood,
            self.answers.len(),
            self.median(),
            self.max()
        )
    }
}

/// A flooder, `silent` clients, and a polite client that sends requests until `enough` returns true.
pub(crate) fn measure(sim: &Sim, silent: usize, mut enough: impl FnMut(usize) -> bool) -> Measured {
    let mut deaf: Vec<TcpStream> = (0..silent).map(|_| sim.client()).collect();
    for client in &mut deaf {
        say(client, "O\r", "\r");
    }
    let (ends, sent) = (
        Arc::new(AtomicBool::new(false)),
        Arc::new(AtomicU64::new(0)),
    );
    let floods = flood(sim.client(), &ends, &sent);
    let mut polite = sim.client();
    say(&mut polite, "O\r", "\r");
    while sent.load(Ordering::Relaxed) < 1000 {
        thread::yield_now();
    }
    let (start, before) = (Instant::now(), sent.load(Ordering::Relaxed));
    let mut answers = Vec::new();
    while !enough(answers.len()) {
        answers.push(ask(&mut polite));
        // A pause, as a master makes it; meanwhile frames of the flood queue up.
        thread::sleep(Duration::from_millis(1));
    }
    let frames = (sent.load(Ordering::Relaxed) - before) as f64;
    let flood = frames / start.elapsed().as_secs_f64();
    ends.store(true, Ordering::Relaxed);
    let memory = memory(sim.child.id());
    for flood in floods {
        flood.join().expect("no panic");
    }
    answers.sort();
    Measured {
        flood,
        answers,
        memory,
    }
}

/// Time from a request to its response.
fn ask(polite: &mut TcpStream) -> Duration {
    let start = Instant::now();
    polite.write_all(REQUEST).expect("it reads");
    let mut heard = Vec::new();
    let mut buffer = vec![0; 64 * 1024];
    loop {
        let len = polite.read(&mut buffer).expect("an answer");
        assert_ne!(len, 0, "the bench has ended");
        heard.extend_from_slice(&buffer[..len]);
        if heard.windows(ANSWER.len()).any(|piece| piece == ANSWER) {
            return start.elapsed();
        }
        heard.drain(..heard.len().saturating_sub(ANSWER.len()));
    }
}

/// One thread writes as fast as possible, the other reads.
fn flood(
    mut client: TcpStream,
    ends: &Arc<AtomicBool>,
    sent: &Arc<AtomicU64>,
) -> [thread::JoinHandle<()>; 2] {
    let mut reading = client.try_clone().expect("a second handle");
    let (ends, sent) = (Arc::clone(ends), Arc::clone(sent));
    let writer = thread::spawn(move || {
        let requests = FLOOD.repeat(500);
        let _ = client.write_all(b"O\r");
        while !ends.load(Ordering::Relaxed) && client.write_all(requests.as_bytes()).is_ok() {
            sent.fetch_add(500, Ordering::Relaxed);
        }
        let _ = client.shutdown(std::net::Shutdown::Both);
    });
    let reader = thread::spawn(move || {
        let mut buffer = vec![0; 64 * 1024];
        while reading.read(&mut buffer).is_ok_and(|len| len > 0) {}
    });
    [writer, reader]
}

/// Linux has it in a file.
fn memory(process: u32) -> Option<Memory> {
    let status = std::fs::read_to_string(format!("/proc/{process}/status")).ok()?;
    let number = |name: &str| {
        let mut lines = status.lines();
        let line = lines.find_map(|line| line.strip_prefix(name))?;
        line.split_whitespace().next()?.parse().ok()
    };
    Some(Memory {
        peak: number("VmHWM:")?,
        threads: number("Threads:")?,
    })
}
