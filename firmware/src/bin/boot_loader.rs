//! A boot loader. A master writes a program to 1F50h:01 by block transfer, checks it by 1F56h and
//! 1F57h, and starts it with 1F51h:01 (CiA 302-3). The program reports its start and ends the
//! emulator.
#![no_std]
#![no_main]

use core::arch::{asm, global_asm};

use odkit::program::{Loader, MemoryFailed, Program, ProgramMemory};
use odkit::sdo::{block_segment, crc16, unused};
use odkit::storage::NoStorage;
use odkit::{Frame, Instant, Node, NodeId};
use odkit_firmware::board::{self, Once};

odkit::object_dictionary! {
    /// A device that can only receive a program.
    mod device {
        without lss, rpdos, changes, guarding, consumer, storage, behaviour, events;

        add 0x1000 { name = "Device type"; type = u32; access = const; default = 0 }
        add 0x1001 { name = "Error register"; type = u8 }
        add 0x1018 { code = record; name = "Identity object" }
        add 0x1018sub1 { name = "Vendor-ID"; type = u32; default = 0x5F }
        add 0x1F50 { code = array; name = "Program data" }
        add 0x1F50sub1 { name = "Program 1"; type = DOMAIN; access = rw; capacity = 0 }
        add 0x1F51 { code = array; name = "Program control" }
        add 0x1F51sub1 { name = "Program 1"; type = u8; access = rw; default = 0; high = 3 }
        add 0x1F56 { code = array; name = "Program software identification" }
        add 0x1F56sub1 { name = "Program 1"; type = u32; access = ro }
        add 0x1F57 { code = array; name = "Flash status identification" }
        add 0x1F57sub1 { name = "Program 1"; type = u32; access = ro }
    }
}

/// Bytes of a page, and of the memory for a program.
const PAGE: usize = 256;
const SIZE: usize = 8192;

/// Time to erase the memory and to write a page, in microseconds.
const ERASE_US: u64 = 20_000;
const WRITE_US: u64 = 400;

/// A simulation of flash: it is busy for some time after each command.
struct Flash {
    bytes: &'static mut [u8; SIZE],
    ready_at: Instant,
}

impl ProgramMemory for Flash {
    fn size(&self) -> u32 {
        SIZE as u32
    }

    fn ready(&mut self, now: Instant) -> Result<(), Instant> {
        if self.ready_at <= now {
            Ok(())
        } else {
            Err(self.ready_at)
        }
    }

    fn erase(&mut self, now: Instant) -> Result<(), MemoryFailed> {
        self.bytes.fill(0xFF);
        self.ready_at = now.plus_micros(ERASE_US);
        Ok(())
    }

    fn write(&mut self, now: Instant, at: u32, page: &[u8]) -> Result<(), MemoryFailed> {
        let at = at as usize;
        let to = self.bytes.get_mut(at..at + page.len());
        to.ok_or(MemoryFailed)?.copy_from_slice(page);
        self.ready_at = self.ready_at.max(now).plus_micros(WRITE_US);
        Ok(())
    }

    fn read(&mut self, at: u32, to: &mut [u8]) {
        if let Some(from) = self.bytes.get(at as usize..at as usize + to.len()) {
            to.copy_from_slice(from);
        }
    }
}

// The program that the master writes: a vector table, code that does not depend on its place, and bytes that make it
// longer than one block. It runs at the beginning of the memory.
global_asm!(
    ".syntax unified",
    ".section .script, \"a\"",
    ".balign 4",
    ".global program_begin",
    ".global program_end",
    "program_begin:",
    ".word 0x2000C000",
    ".word 0x2000C000 + (2f - program_begin) + 1",
    ".thumb",
    "2: adr r1, 3f",
    "movs r0, #4",
    "bkpt 0xAB",
    "movw r1, #0x0026",
    "movt r1, #0x0002",
    "movs r0, #0x18",
    "bkpt 0xAB",
    "b .",
    ".balign 4",
    "3: .asciz \"the program runs\\n\"",
    ".balign 4",
    ".set number, 1",
    ".rept 700",
    ".word (number * 0x9E3779B1) & 0xFFFFFFFF",
    ".set number, number + 1",
    ".endr",
    "program_end:",
    ".previous",
);

unsafe extern "C" {
    static program_begin: u8;
    static program_end: u8;
}

#[unsafe(link_section = ".eeprom")]
static MEMORY: Once<[u8; SIZE]> = Once::new([0; SIZE]);

/// A master at the other end of the bus, and the time of both.
struct Master {
    node: device::Node<Loader<Flash, PAGE>>,
    now: Instant,
}

impl Master {
    /// Sends a frame to the SDO server.
    fn send(&mut self, data: [u8; 8]) {
        let frame = Frame::standard(0x601, &data);
        self.node.handle_frame(self.now, &frame);
    }

    /// Sends a request, and returns its answer, which may be delayed.
    fn ask(&mut self, data: [u8; 8]) -> [u8; 8] {
        self.send(data);
        loop {
            if let Some(frame) = self.node.poll_transmit(self.now) {
                return *frame.bytes();
            }
            let Some(at) = self.node.poll_timeout() else {
                board::exit(false);
            };
            self.now = at;
            self.node.handle_timeout(at);
        }
    }

    /// As [`ask`](Self::ask), but the answer must begin with these bytes.
    fn expect(&mut self, data: [u8; 8], answer: &[u8]) -> [u8; 8] {
        let found = self.ask(data);
        if !found.starts_with(answer) {
            board::print(
                b"answer\0",
                u32::from_be_bytes([found[0], found[1], found[2], found[3]]),
            );
            board::exit(false);
        }
        found
    }

    /// Writes 1F50h:01 by block transfer.
    fn load(&mut self, program: &[u8]) {
        let [a, b, c, d] = (program.len() as u32).to_le_bytes();
        let begun = self.expect([0xC6, 0x50, 0x1F, 1, a, b, c, d], &[0xA4, 0x50, 0x1F, 1]);
        let mut block_size = begun[4];
        let mut rest = program;
        while !rest.is_empty() {
            let mut sequence = 1;
            loop {
                let (segment, after) = rest.split_at(rest.len().min(7));
                rest = after;
                let data = block_segment(sequence, segment, rest.is_empty());
                if rest.is_empty() || sequence == block_size {
                    let answer = self.expect(data, &[0xA2, sequence]);
                    block_size = answer[2];
                    break;
                }
                self.send(data);
                sequence += 1;
            }
        }
        let [low, high] = crc16(program).to_le_bytes();
        let end = 0xC1 | unused(program.len()) << 2;
        self.expect([end, low, high, 0, 0, 0, 0, 0], &[0xA1]);
    }
}

#[unsafe(no_mangle)]
extern "C" fn main() -> ! {
    let flash = Flash {
        bytes: MEMORY.take(),
        ready_at: Instant::ZERO,
    };
    let mut master = Master {
        node: Node::new(
            device::Device,
            NodeId::ONE,
            Loader::new(flash, 1),
            NoStorage,
        ),
        now: Instant::ZERO,
    };
    master.node.power_on(master.now);
    while master.node.poll_transmit(master.now).is_some() {}
    // SAFETY: the linker has put the program between the two symbols.
    let program = unsafe {
        let begin = &raw const program_begin;
        let len = (&raw const program_end).offset_from(begin) as usize;
        core::slice::from_raw_parts(begin, len)
    };
    // Without a program there is nothing to start: 08000024h.
    let start = [0x2F, 0x51, 0x1F, 1, 1, 0, 0, 0];
    master.expect(start, &[0x80, 0x51, 0x1F, 1, 0x24, 0, 0, 8]);
    master.load(program);
    // Bit 0 of 1F57h is 1 while pages are written into the flash.
    while master.ask([0x40, 0x57, 0x1F, 1, 0, 0, 0, 0]) != [0x43, 0x57, 0x1F, 1, 0, 0, 0, 0] {
        let Some(at) = master.node.poll_timeout() else {
            board::exit(false);
        };
        master.now = at;
        master.node.handle_timeout(at);
    }
    master.expect(start, &[0x60, 0x51, 0x1F, 1]);
    let identification = master.ask([0x40, 0x56, 0x1F, 1, 0, 0, 0, 0]);
    let [.., a, b, c, d] = identification;
    board::print(b"program\0", u32::from_le_bytes([a, b, c, d]));
    let loader = master.node.application;
    match loader.program() {
        Some(Program { len, .. }) if loader.is_running() && len as usize == program.len() => {
            jump(loader.memory.bytes)
        }
        _ => board::exit(false),
    }
}

/// Starts a program, with the stack pointer and the entry of its vector table.
fn jump(program: &[u8; SIZE]) -> ! {
    let [a, b, c, d, e, f, g, h, ..] = *program;
    let stack = u32::from_le_bytes([a, b, c, d]);
    let entry = u32::from_le_bytes([e, f, g, h]);
    // SAFETY: the program was made for this place, and nothing of this one is needed any more.
    unsafe {
        asm!("msr msp, {0}", "isb", "bx {1}", in(reg) stack, in(reg) entry, options(noreturn));
    }
}
