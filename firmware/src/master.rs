//! The master: it sends the requests to the node, and measures the time and the frames of the
//! answers.

use odkit::storage::Storage;
use odkit::{Application, Device, Frame, Instant, Node};

use crate::board;

/// A step of the master.
#[derive(Clone, Copy)]
pub enum Step {
    /// A frame.
    Frame(Frame),
    /// This many milliseconds pass.
    Wait(u32),
    /// The device sees a change outside the bus.
    Change,
}

/// An SDO request.
pub const fn sdo(data: [u8; 8]) -> Step {
    frame(0x601, data)
}

/// A frame.
pub const fn frame<const N: usize>(id: u16, data: [u8; N]) -> Step {
    Step::Frame(Frame::standard(id, &data))
}

#[unsafe(link_section = ".script")]
static START: Step = frame(0, [1, 0]);
#[unsafe(link_section = ".script")]
static SYNC: Frame = Frame::standard(0x80, &[]);
#[unsafe(link_section = ".script")]
static FOREIGN: Frame = Frame::standard(0x605, &[0x40, 0, 0x10, 0, 0, 0, 0, 0]);

/// A node and its time.
struct Bench<'b, D: Device, A, S> {
    node: &'b mut Node<D, A, S>,
    now: Instant,
    /// Frames that the node sent.
    sent: u32,
}

impl<D: Device, A: Application, S: Storage> Bench<'_, D, A, S> {
    #[inline(never)]
    fn drain(&mut self) {
        loop {
            let frame = self.node.poll_transmit(self.now);
            if frame.is_none() {
                return;
            }
            core::hint::black_box(&frame);
            self.sent += 1;
        }
    }

    #[inline(never)]
    fn wait(&mut self, ms: u32) {
        let end = self.now.plus_millis(ms.into());
        while let Some(at) = self.node.poll_timeout().filter(|at| *at <= end) {
            self.now = at;
            self.node.handle_timeout(at);
            self.drain();
        }
        self.now = end;
    }

    #[inline(never)]
    fn step(&mut self, step: &Step) {
        match step {
            Step::Frame(frame) => self.node.handle_frame(self.now, frame),
            Step::Wait(ms) => self.wait(*ms),
            Step::Change => self.node.handle_change(self.now),
        }
        self.drain();
    }

    /// Ticks until the first frame is sent.
    #[inline(never)]
    fn power_on(&mut self) -> u32 {
        let before = board::clock();
        self.node.power_on(self.now);
        self.drain();
        before.wrapping_sub(board::clock()) & 0xFF_FFFF
    }

    /// Ticks from the second reception of a frame until all its effects are sent, including those
    /// of reading the clock.
    #[inline(never)]
    fn ticks(&mut self, frame: &Frame) -> u32 {
        let mut ticks = 0;
        for _ in 0..2 {
            let before = board::clock();
            self.node.handle_frame(self.now, frame);
            self.drain();
            ticks = before.wrapping_sub(board::clock()) & 0xFF_FFFF;
        }
        ticks
    }
}

/// Runs a script, prints the measurements, and ends the program.
///
/// `upload` is the request that is measured; `script` uses everything that the node can do.
pub fn run<D: Device, A: Application, S: Storage>(
    node: &mut Node<D, A, S>,
    upload: &Frame,
    script: &[Step],
) -> ! {
    board::start_clock();
    let mut bench = Bench {
        node,
        now: Instant::ZERO,
        sent: 0,
    };
    let clock = board::clock();
    let overhead = clock.wrapping_sub(board::clock()) & 0xFF_FFFF;
    board::print(b"overhead\0", overhead);
    board::print(b"power_on\0", bench.power_on());
    bench.step(&START);
    board::print(b"upload\0", bench.ticks(upload));
    board::print(b"sync\0", bench.ticks(&SYNC));
    board::print(b"foreign\0", bench.ticks(&FOREIGN));
    let before = board::clock();
    bench.node.handle_timeout(bench.now);
    let idle = before.wrapping_sub(board::clock()) & 0xFF_FFFF;
    board::print(b"idle\0", idle);
    for step in script {
        bench.step(step);
    }
    let (flash, ram) = board::sizes();
    board::print(b"flash\0", flash);
    board::print(b"ram\0", ram);
    board::print(b"stack\0", board::stack());
    board::print(b"sent\0", bench.sent);
    board::exit(true)
}
