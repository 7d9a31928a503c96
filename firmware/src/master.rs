//! The master: it sends what every node has to answer, and measures what that takes.

use odkit::{CanId, Device, Extras, Frame, Instant, Lent, Node};

use crate::board;

/// What a master sends.
#[derive(Clone, Copy)]
pub enum Step {
    /// A frame: CAN-ID, length, data.
    Frame(u16, u8, [u8; 8]),
    /// This many milliseconds pass.
    Wait(u32),
    /// The device sees a change outside the bus.
    Change,
}

/// An SDO request.
pub const fn sdo(data: [u8; 8]) -> Step {
    Step::Frame(0x601, 8, data)
}

/// A node with its device and its time.
struct Bench<'b, 'd, D, const PDO: usize, const SDO: usize, X: Extras<D, SDO>> {
    node: &'b mut Node<D, PDO, SDO, X>,
    device: &'b mut Lent<'d>,
    now: Instant,
    /// Frames that the node sent.
    sent: u32,
}

impl<D: Device, const PDO: usize, const SDO: usize, X: Extras<D, SDO>>
    Bench<'_, '_, D, PDO, SDO, X>
{
    fn drain(&mut self) {
        while let Some(frame) = self.node.poll_transmit(self.device, self.now) {
            self.sent += 1;
            core::hint::black_box(frame);
        }
    }

    #[inline(never)]
    fn step(&mut self, step: &Step) {
        match *step {
            Step::Frame(id, dlc, data) => {
                let frame = Frame::with_dlc(CanId::standard(id), data, dlc);
                self.node.handle_frame(self.device, self.now, &frame);
            }
            Step::Wait(ms) => {
                let end = self.now.plus_millis(ms.into());
                while let Some(at) = self.node.poll_timeout().filter(|at| *at <= end) {
                    self.now = at;
                    self.node.handle_timeout(self.device, at);
                    self.drain();
                }
                self.now = end;
            }
            Step::Change => self.node.handle_change(self.device, self.now),
        }
        self.drain();
    }

    /// Ticks of a frame until all that it causes is sent, with those of reading the clock.
    #[inline(never)]
    fn ticks(&mut self, frame: &Frame) -> u32 {
        let before = board::clock();
        self.node.handle_frame(self.device, self.now, frame);
        self.drain();
        before.wrapping_sub(board::clock()) & 0xFF_FFFF
    }
}

/// Plays a script, reports what it took, and ends the program.
///
/// `upload` is the request that is measured; `script` goes through all that the node can do.
pub fn run<D: Device, const PDO: usize, const SDO: usize, X: Extras<D, SDO>>(
    node: &mut Node<D, PDO, SDO, X>,
    device: &mut Lent<'_>,
    upload: [u8; 8],
    script: &[Step],
) -> ! {
    board::start_clock();
    let now = Instant::ZERO;
    let mut bench = Bench {
        node,
        device,
        now,
        sent: 0,
    };
    let clock = board::clock();
    let overhead = clock.wrapping_sub(board::clock()) & 0xFF_FFFF;
    let before = board::clock();
    let started = bench.node.power_on(bench.device, now).is_ok();
    bench.drain();
    let power_on = before.wrapping_sub(board::clock()) & 0xFF_FFFF;
    bench.step(&Step::Frame(0, 2, [1, 0, 0, 0, 0, 0, 0, 0]));
    let request = Frame::full(CanId::standard(0x601), upload);
    bench.ticks(&request);
    let upload = bench.ticks(&request);
    let sync = Frame::standard(0x80, &[]);
    bench.ticks(&sync);
    let sync = bench.ticks(&sync);
    let foreign = bench.ticks(&Frame::standard(0x605, &[0x40, 0, 0x10, 0, 0, 0, 0, 0]));
    let before = board::clock();
    bench.node.handle_timeout(bench.device, now);
    let idle = before.wrapping_sub(board::clock()) & 0xFF_FFFF;
    for step in script {
        bench.step(step);
    }
    let (flash, ram) = board::sizes();
    board::print(b"flash\0", flash);
    board::print(b"ram\0", ram);
    board::print(b"stack\0", board::stack());
    board::print(b"sent\0", bench.sent);
    board::print(b"overhead\0", overhead);
    board::print(b"power_on\0", power_on);
    board::print(b"upload\0", upload);
    board::print(b"sync\0", sync);
    board::print(b"foreign\0", foreign);
    board::print(b"idle\0", idle);
    board::exit(started)
}
