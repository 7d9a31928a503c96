//! The device: its dictionary, its flash, and the loader of odkit between them.

use odkit::program::{Loader, MemoryFailed, Program, ProgramMemory};
use odkit::{
    AbortCode, Address, Application, Chunk, Context, Halt, Instant, Reset, Stream, StreamEnd,
};

odkit::object_dictionary! {
    /// A device that can only receive a program.
    pub mod device {
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

/// 1F50h:01.
pub const PROGRAM: Address = Address::new(0x1F50, 1);
/// 1F51h:01: 0 stops the program, 1 starts it, 2 resets it, 3 erases it.
pub const CONTROL: Address = Address::new(0x1F51, 1);

/// Bytes of a page, which is written at once.
pub const PAGE: usize = 256;
/// Bytes of the flash for a program.
pub const SIZE: usize = 64 * 1024;

/// Time to erase the flash, in microseconds.
const ERASE_US: u64 = 80_000;
/// Time to write a page, in microseconds.
const WRITE_US: u64 = 400;

/// A flash memory that is busy for a while after each command.
pub struct Flash {
    bytes: Box<[u8; SIZE]>,
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

    /// Writing clears bits; only erasing sets them.
    fn write(&mut self, now: Instant, at: u32, page: &[u8]) -> Result<(), MemoryFailed> {
        let to = self.bytes.iter_mut().skip(at as usize);
        to.zip(page).for_each(|(to, from)| *to &= from);
        self.ready_at = self.ready_at.max(now).plus_micros(WRITE_US);
        Ok(())
    }

    fn read(&mut self, at: u32, to: &mut [u8]) {
        let from = &self.bytes[at as usize..];
        to.copy_from_slice(&from[..to.len()]);
    }
}

/// Receives a program page by page. RAM holds one page of it and one block of the SDO server.
pub struct BootLoader {
    loader: Loader<Flash, PAGE>,
    /// The ends of all transfers, for the tests.
    pub ends: Vec<StreamEnd>,
}

impl BootLoader {
    pub fn new() -> Self {
        let flash = Flash {
            bytes: Box::new([0xFF; SIZE]),
            ready_at: Instant::ZERO,
        };
        Self {
            loader: Loader::new(flash, PROGRAM.sub),
            ends: Vec::new(),
        }
    }

    /// The program, if it is complete.
    pub fn program(&self) -> Option<Program> {
        self.loader.program()
    }

    /// Returns whether it was started.
    pub fn is_running(&self) -> bool {
        self.loader.is_running()
    }
}

/// The loader does the work; this type only records how transfers end.
impl Stream for BootLoader {
    fn begin_download(
        &mut self,
        cx: &mut Context<'_, '_>,
        address: Address,
        size: Option<u32>,
    ) -> Result<(), Halt> {
        self.loader.begin_download(cx, address, size)
    }

    fn write(
        &mut self,
        cx: &mut Context<'_, '_>,
        address: Address,
        chunk: Chunk<'_>,
    ) -> Result<(), Halt> {
        self.loader.write(cx, address, chunk)
    }

    fn begin_upload(&mut self, cx: &mut Context<'_, '_>, address: Address) -> Result<u32, Halt> {
        self.loader.begin_upload(cx, address)
    }

    fn read(
        &mut self,
        cx: &mut Context<'_, '_>,
        address: Address,
        at: u32,
        to: &mut [u8],
    ) -> Result<(), Halt> {
        self.loader.read(cx, address, at, to)
    }

    fn end(&mut self, cx: &mut Context<'_, '_>, address: Address, end: StreamEnd) {
        self.loader.end(cx, address, end);
        self.ends.push(end);
    }
}

impl Application for BootLoader {
    fn reset(&mut self, cx: &mut Context<'_, '_>, reset: Reset) {
        self.loader.reset(cx, reset);
    }

    fn stream(&mut self, address: Address) -> Option<&mut dyn Stream> {
        if address == PROGRAM { Some(self) } else { None }
    }

    fn validate(
        &mut self,
        cx: &mut Context<'_, '_>,
        address: Address,
        value: &[u8],
    ) -> Result<(), AbortCode> {
        self.loader.validate(cx, address, value)
    }

    fn written(&mut self, cx: &mut Context<'_, '_>, address: Address) {
        self.loader.written(cx, address);
    }

    fn tick(&mut self, cx: &mut Context<'_, '_>) -> Option<Instant> {
        self.loader.tick(cx)
    }
}
