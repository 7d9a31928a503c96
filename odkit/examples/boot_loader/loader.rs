//! The device: its dictionary, its flash, and what it does with a program.

use odkit::{AbortCode, Address, Application, Chunk, Context, Halt, Instant, Stream, StreamEnd};

odkit::object_dictionary! {
    /// A device that can only receive a program.
    pub mod device {
        rename 0x1F51 = program_control;

        add 0x1000 { name = "Device type"; type = u32; access = const; default = 0 }
        add 0x1001 { name = "Error register"; type = u8 }
        add 0x1018 { code = record; name = "Identity object" }
        add 0x1018sub1 { name = "Vendor-ID"; type = u32; default = 0x5F }
        add 0x1F50 { code = array; name = "Program data" }
        add 0x1F50sub1 { name = "Program 1"; type = DOMAIN; access = rw; capacity = 0 }
        add 0x1F51 { code = array; name = "Program control" }
        add 0x1F51sub1 { name = "Program 1"; type = u8; access = rw; default = 0; high = 3 }
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

impl Flash {
    fn new() -> Self {
        Self {
            bytes: Box::new([0xFF; SIZE]),
            ready_at: Instant::ZERO,
        }
    }

    /// # Errors
    /// It is busy until then.
    fn ready(&self, now: Instant) -> Result<(), Halt> {
        if self.ready_at <= now {
            Ok(())
        } else {
            Err(Halt::Until(self.ready_at))
        }
    }

    fn erase(&mut self, now: Instant) {
        self.bytes.fill(0xFF);
        self.ready_at = now.plus_micros(ERASE_US);
    }

    /// Writing clears bits; only erasing sets them.
    fn write(&mut self, now: Instant, at: usize, page: &[u8]) {
        let to = self.bytes.iter_mut().skip(at);
        to.zip(page).for_each(|(to, from)| *to &= from);
        self.ready_at = self.ready_at.max(now).plus_micros(WRITE_US);
    }
}

/// Receives a program page by page; RAM holds one page of it, and one block of the SDO server.
pub struct BootLoader {
    pub flash: Flash,
    /// The page that is filled.
    page: [u8; PAGE],
    filled: usize,
    /// Bytes in the flash.
    written: usize,
    /// Length of the program, once all of it came.
    pub program: Option<usize>,
    pub is_running: bool,
    /// How transfers ended.
    pub ends: Vec<StreamEnd>,
}

impl BootLoader {
    pub fn new() -> Self {
        Self {
            flash: Flash::new(),
            page: [0xFF; PAGE],
            filled: 0,
            written: 0,
            program: None,
            is_running: false,
            ends: Vec::new(),
        }
    }

    /// The page goes to the flash.
    fn write_page(&mut self, now: Instant) {
        self.flash
            .write(now, self.written, &self.page[..self.filled]);
        self.written += self.filled;
        self.filled = 0;
    }

    /// What came is no program, and what was there is gone.
    fn erase(&mut self, now: Instant) {
        self.program = None;
        (self.filled, self.written) = (0, 0);
        self.flash.erase(now);
    }
}

impl Stream for BootLoader {
    fn begin_download(
        &mut self,
        cx: &mut Context<'_, '_>,
        _: Address,
        size: Option<u32>,
    ) -> Result<(), Halt> {
        if self.is_running {
            return Err(AbortCode::DeviceState.into());
        }
        if size.is_some_and(|size| size as usize > SIZE) {
            return Err(AbortCode::TooLong.into());
        }
        // While it erases, the first part waits, and with it the master.
        self.flash.ready(cx.now)?;
        self.erase(cx.now);
        Ok(())
    }

    fn write(
        &mut self,
        cx: &mut Context<'_, '_>,
        _: Address,
        chunk: Chunk<'_>,
    ) -> Result<(), Halt> {
        if chunk.at as usize + chunk.bytes.len() > SIZE {
            return Err(AbortCode::TooLong.into());
        }
        self.flash.ready(cx.now)?;
        for byte in chunk.bytes {
            self.page[self.filled] = *byte;
            self.filled += 1;
            if self.filled == PAGE {
                self.write_page(cx.now);
            }
        }
        if chunk.last {
            self.write_page(cx.now);
            self.program = Some(self.written);
        }
        Ok(())
    }

    fn begin_upload(&mut self, _: &mut Context<'_, '_>, _: Address) -> Result<u32, Halt> {
        let len = self.program.ok_or(AbortCode::NoData)?;
        Ok(len as u32)
    }

    fn read(
        &mut self,
        cx: &mut Context<'_, '_>,
        _: Address,
        at: u32,
        to: &mut [u8],
    ) -> Result<(), Halt> {
        self.flash.ready(cx.now)?;
        let from = &self.flash.bytes[at as usize..];
        to.copy_from_slice(&from[..to.len()]);
        Ok(())
    }

    fn end(&mut self, _: &mut Context<'_, '_>, _: Address, end: StreamEnd) {
        self.ends.push(end);
    }
}

impl Application for BootLoader {
    fn stream(&mut self, address: Address) -> Option<&mut dyn Stream> {
        if address == PROGRAM { Some(self) } else { None }
    }

    fn validate(
        &mut self,
        _: &mut Context<'_, '_>,
        address: Address,
        value: &[u8],
    ) -> Result<(), AbortCode> {
        match (address, value) {
            (CONTROL, [1 | 2]) if self.program.is_none() => Err(AbortCode::NoData),
            (CONTROL, [3]) if self.is_running => Err(AbortCode::DeviceState),
            _ => Ok(()),
        }
    }

    fn written(&mut self, cx: &mut Context<'_, '_>, address: Address) {
        if address != CONTROL {
            return;
        }
        match cx.store.get(device::program_control::PROGRAM_1) {
            3 => self.erase(cx.now),
            command => self.is_running = command > 0,
        }
    }
}
