//! A node in RTIC. The interrupt of the CAN controller handles frames, a task of low priority
//! writes flash, and the two share the node.
//!
//! That task makes a save in bounded steps, so the node responds to a SYNC at once while flash is
//! erased or written. The program sends a SYNC in each step, and prints the maximum number of
//! instructions: from the request of the interrupt to the TPDO (`sync`), while the task of low
//! priority locks the node (`held`), and of the interrupt that takes over a save (`call`).
#![no_std]
#![no_main]

pub mod board;

use core::sync::atomic::{AtomicU32, Ordering};

use cortex_m_semihosting::{debug, hprintln};
use odkit::board::storage::{Log, Mirror, Steps};
use odkit::storage::image::capacity_needed;
use odkit::{Frame, NoApplication};

use board::{Can, Flash, PAGE};

odkit::object_dictionary! {
    /// A slave of CiA 301 with 170 values.
    mod slave {
        eds = "../../eds/ds301.eds";
        without lss;
    }
}

/// Bytes of two sets of saved values, and of the buffer for one.
const SAVED: usize = capacity_needed(&slave::DICTIONARY);
const BUFFER: usize = SAVED / 2 + 64;
const _: () = assert!(BUFFER + 64 <= PAGE);

/// The node.
pub type Node = slave::Node<NoApplication, Mirror<SAVED, { slave::STORE_LEN }>>;
/// Its saved values.
pub type Keeper = Log<Steps<Flash>, BUFFER>;

/// Time when the interrupt was requested.
static REQUESTED: AtomicU32 = AtomicU32::new(0);

/// Maximum time for which the task of low priority has locked the node.
static HELD: AtomicU32 = AtomicU32::new(0);

/// Maximum time of the interrupt since the saves began.
static TOOK: AtomicU32 = AtomicU32::new(0);

/// Ticks of the clock, counted upwards.
fn ticks() -> u32 {
    0xFF_FFFF - cortex_m::peripheral::SYST::get_current()
}

/// Number of instructions since a time: an instruction takes 1024 ns with `-icount shift=10`, a
/// tick 80 ns.
fn instructions(since: u32) -> u32 {
    (ticks().wrapping_sub(since) & 0xFF_FFFF) * 80 / 1024
}

/// Receives a SYNC; the controller requests its interrupt.
fn sync() {
    REQUESTED.store(ticks(), Ordering::Relaxed);
    rtic::pend(lm3s6965::Interrupt::GPIOA);
}

/// An SDO request.
const fn sdo(data: [u8; 8]) -> Frame {
    Frame::standard(0x601, &data)
}

#[rtic::app(device = lm3s6965, dispatchers = [SSI0])]
mod app {
    use super::*;
    use odkit::NodeId;
    use odkit::board::{Clock, Port};

    #[shared]
    struct Shared {
        node: Node,
        can: Can,
        /// Longest wait of a SYNC so far.
        longest: u32,
    }

    #[local]
    struct Local {
        port: Port,
        clock: Clock<12_500_000, 24>,
        log: Keeper,
    }

    #[init]
    fn init(cx: init::Context) -> (Shared, Local) {
        let mut timer = cx.core.SYST;
        timer.set_reload(0xFF_FFFF);
        timer.clear_current();
        timer.set_clock_source(cortex_m::peripheral::syst::SystClkSource::Core);
        timer.enable_counter();
        let mut clock = Clock::new();
        let saved = Mirror::new(&slave::DICTIONARY);
        let mut node = Node::new(slave::Device, NodeId::ONE, NoApplication, saved);
        node.power_on(clock.at(ticks()));
        keep::spawn().ok();
        let shared = Shared {
            node,
            can: Can::new(),
            longest: 0,
        };
        let local = Local {
            port: Port::new(),
            clock,
            log: Keeper::new(Steps(Flash::new(sync)), 0..3 * PAGE as u32),
        };
        (shared, local)
    }

    /// Frames, and what is due: a timer requests it at [`Node::poll_timeout`](odkit::Node::poll_timeout), too.
    #[task(binds = GPIOA, priority = 2, shared = [node, can, longest], local = [port, clock])]
    fn frames(cx: frames::Context) {
        let begin = ticks();
        let now = cx.local.clock.at(begin);
        (cx.shared.node, cx.shared.can, cx.shared.longest).lock(|node, can, longest| {
            let since = REQUESTED.swap(0, Ordering::Relaxed);
            if since != 0 {
                can.push(Frame::standard(0x80, &[]));
            }
            let _ = cx.local.port.serve_nb(node, can, now);
            if since != 0 {
                *longest = instructions(since).max(*longest);
            }
        });
        TOOK.fetch_max(instructions(begin), Ordering::Relaxed);
    }

    /// Stores the values that the node saves.
    #[task(priority = 1, shared = [node], local = [log])]
    async fn keep(mut cx: keep::Context) {
        let log = cx.local.log;
        log.run(|act| {
            cx.shared.node.lock(|node| {
                let since = ticks();
                act(&mut node.storage);
                HELD.fetch_max(instructions(since), Ordering::Relaxed);
            });
        })
        .await;
    }

    /// The master, and the end of the program.
    #[idle(shared = [can, longest])]
    fn idle(mut cx: idle::Context) -> ! {
        let frames = [
            Frame::standard(0, &[1, 0]),
            // TPDO 1 at each SYNC.
            sdo([0x2F, 0x00, 0x18, 2, 1, 0, 0, 0]),
            sdo([0x2B, 0x17, 0x10, 0, 100, 0, 0, 0]),
        ];
        let send = |cx: &mut idle::Context<'_>, frame: Frame| {
            cx.shared.can.lock(|can| can.push(frame));
            rtic::pend(lm3s6965::Interrupt::GPIOA);
        };
        for frame in frames {
            send(&mut cx, frame);
        }
        TOOK.store(0, Ordering::Relaxed);
        // As many saves as fill the flash twice.
        for save in 1..=20 {
            send(&mut cx, sdo([0x23, 0x10, 0x10, 1, b's', b'a', b'v', b'e']));
            while cx.shared.can.lock(|can| can.saved) < save {
                rtic::pend(lm3s6965::Interrupt::GPIOA);
            }
        }
        let longest = cx.shared.longest.lock(|longest| *longest);
        let sent = cx.shared.can.lock(|can| can.sent);
        let [held, took] = [&HELD, &TOOK].map(|of| of.load(Ordering::Relaxed));
        hprintln!("sync {} held {} call {} sent {}", longest, held, took, sent);
        debug::exit(debug::EXIT_SUCCESS);
        loop {
            core::hint::spin_loop();
        }
    }
}

#[panic_handler]
fn panic(_: &core::panic::PanicInfo<'_>) -> ! {
    debug::exit(debug::EXIT_FAILURE);
    loop {
        core::hint::spin_loop();
    }
}
