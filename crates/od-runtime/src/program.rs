//! Program download (CiA 302-3: objects 1F50h, 1F51h, 1F56h, 1F57h) into a memory of pages.
//!
//! [`Loader`] is an [`Application`]. A device with behaviour of its own passes the calls about
//! these four objects on to it.

use core::fmt;

use od_model::Address;
use od_wire::{AbortCode, Instant};

use crate::application::{Application, Chunk, Context, Halt, Reset, Stream, StreamEnd};
use crate::storage::crc::Crc32;

/// Program data: a DOMAIN for each program.
const DATA: u16 = 0x1F50;
/// Program control: 0 stops, 1 starts, 2 resets, 3 clears the program.
const CONTROL: u16 = 0x1F51;
/// Program software identification: the CRC of the program; 0 without one.
const IDENTIFICATION: u16 = 0x1F56;
/// Flash status identification: bit 0 while data is being written, bits 1 to 7 the last error.
const STATUS: u16 = 0x1F57;

/// Codes of bits 1 to 7 of 1F57h.
const NO_FAULT: u8 = 0;
const NO_PROGRAM: u8 = 1;
const WRITE_FAULT: u8 = 5;

/// A program in the memory.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub struct Program {
    /// Length in bytes.
    pub len: u32,
    /// CRC-32 (reflected, polynomial 04C11DB7h), as 1F56h shows it.
    pub crc: u32,
}

/// The memory could not be erased or written.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub struct MemoryFailed;

impl fmt::Display for MemoryFailed {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("the memory could not be erased or written")
    }
}

impl core::error::Error for MemoryFailed {}

/// Memory for a program, which is erased as a whole and written page by page.
pub trait ProgramMemory {
    /// Bytes of the longest program.
    fn size(&self) -> u32;

    /// Returns whether the memory can take the next command.
    ///
    /// # Errors
    /// Time of the next attempt: the memory is busy until then, and the response to the master
    /// waits.
    fn ready(&mut self, now: Instant) -> Result<(), Instant> {
        let _ = now;
        Ok(())
    }

    /// Erases the program, or begins to erase it.
    ///
    /// # Errors
    /// [`MemoryFailed`].
    fn erase(&mut self, now: Instant) -> Result<(), MemoryFailed>;

    /// Writes a page, or begins to write it; the last page may be shorter. After one
    /// [`ready`](Self::ready) up to 889 bytes of pages can follow each other.
    ///
    /// # Errors
    /// [`MemoryFailed`].
    fn write(&mut self, now: Instant, at: u32, page: &[u8]) -> Result<(), MemoryFailed>;

    /// Fills `to` with the bytes of the memory from `at` on.
    fn read(&mut self, at: u32, to: &mut [u8]);

    /// The program arrived completely: a non-volatile memory notes it.
    ///
    /// # Errors
    /// [`MemoryFailed`].
    fn complete(&mut self, now: Instant, program: Program) -> Result<(), MemoryFailed> {
        let _ = (now, program);
        Ok(())
    }

    /// Returns the program in the memory at power-on.
    fn stored(&mut self) -> Option<Program> {
        None
    }
}

/// Receives one program from masters, and controls it. `PAGE` is the size of a page of the memory
/// in bytes.
///
/// The host starts the program: after the response to 1F51h was sent,
/// [`is_running`](Self::is_running) says whether the program has to run.
#[derive(Clone, Debug)]
pub struct Loader<M, const PAGE: usize> {
    /// The memory.
    pub memory: M,
    /// Sub-index of the objects.
    number: u8,
    page: [u8; PAGE],
    filled: usize,
    /// Number of bytes of the program that were received.
    written: u32,
    crc: Crc32,
    is_loading: bool,
    program: Option<Program>,
    is_running: bool,
    fault: u8,
}

impl<M: ProgramMemory, const PAGE: usize> Loader<M, PAGE> {
    /// A loader of program `number`, 1 to 254: the sub-index of its objects.
    pub const fn new(memory: M, number: u8) -> Self {
        const { assert!(PAGE > 0, "a page has bytes") };
        Self {
            memory,
            number,
            page: [0xFF; PAGE],
            filled: 0,
            written: 0,
            crc: Crc32::new(),
            is_loading: false,
            program: None,
            is_running: false,
            fault: NO_PROGRAM,
        }
    }

    /// The program in the memory, if it is complete.
    pub const fn program(&self) -> Option<Program> {
        self.program
    }

    /// Returns whether a master started the program and has not stopped it since.
    pub const fn is_running(&self) -> bool {
        self.is_running
    }

    fn is(&self, address: Address, index: u16) -> bool {
        address == Address::new(index, self.number)
    }

    /// Returns 1F57h.
    fn status(&mut self, now: Instant) -> u64 {
        u64::from(self.fault) << 1 | u64::from(self.is_busy(now))
    }

    fn is_busy(&mut self, now: Instant) -> bool {
        self.is_loading || self.memory.ready(now).is_err()
    }

    /// Brings 1F51h, 1F56h and 1F57h up to date, if the dictionary has them.
    fn show(&mut self, cx: &mut Context<'_, '_>) {
        let status = self.status(cx.now);
        let crc = self.program.map_or(0, |program| program.crc);
        for (index, value) in [
            (CONTROL, self.is_running.into()),
            (IDENTIFICATION, crc.into()),
            (STATUS, status),
        ] {
            cx.store
                .set_unsigned(Address::new(index, self.number), value);
        }
        cx.signals.wake();
    }

    fn ready(&mut self, now: Instant) -> Result<(), Halt> {
        self.memory.ready(now).map_err(Halt::Until)
    }

    /// Handles a result of the memory: after a failure no program exists, and 1F57h gives the
    /// reason.
    fn done(&mut self, result: Result<(), MemoryFailed>) -> Result<(), Halt> {
        result.map_err(|MemoryFailed| {
            self.forget(WRITE_FAULT);
            AbortCode::Hardware.into()
        })
    }

    fn forget(&mut self, fault: u8) {
        self.program = None;
        self.is_loading = false;
        self.fault = fault;
        (self.filled, self.written) = (0, 0);
        self.crc = Crc32::new();
    }

    fn write_page(&mut self, now: Instant) -> Result<(), Halt> {
        let page = self.page.get(..self.filled).unwrap_or_default();
        let result = self.memory.write(now, self.written, page);
        self.done(result)?;
        self.written += self.filled as u32;
        self.filled = 0;
        Ok(())
    }

    fn take(&mut self, now: Instant, chunk: Chunk<'_>) -> Result<(), Halt> {
        let size = self.memory.size() as usize;
        if chunk.bytes.len() > size.saturating_sub(chunk.at as usize) {
            return Err(AbortCode::TooLong.into());
        }
        self.ready(now)?;
        self.crc.update(chunk.bytes);
        for byte in chunk.bytes {
            if let Some(to) = self.page.get_mut(self.filled) {
                *to = *byte;
                self.filled += 1;
            }
            if self.filled == PAGE {
                self.write_page(now)?;
            }
        }
        if chunk.last {
            if self.filled > 0 {
                self.write_page(now)?;
            }
            let program = Program {
                len: self.written,
                crc: self.crc.finish(),
            };
            let result = self.memory.complete(now, program);
            self.done(result)?;
            self.forget(NO_FAULT);
            self.program = Some(program);
        }
        Ok(())
    }
}

impl<M: ProgramMemory, const PAGE: usize> Stream for Loader<M, PAGE> {
    fn begin_download(
        &mut self,
        cx: &mut Context<'_, '_>,
        _: Address,
        size: Option<u32>,
    ) -> Result<(), Halt> {
        if self.is_running {
            return Err(AbortCode::DeviceState.into());
        }
        if size.is_some_and(|size| size > self.memory.size()) {
            return Err(AbortCode::TooLong.into());
        }
        self.ready(cx.now)?;
        self.forget(NO_PROGRAM);
        let result = self.memory.erase(cx.now);
        let result = self.done(result);
        self.is_loading = result.is_ok();
        self.show(cx);
        result
    }

    fn write(
        &mut self,
        cx: &mut Context<'_, '_>,
        _: Address,
        chunk: Chunk<'_>,
    ) -> Result<(), Halt> {
        let result = self.take(cx.now, chunk);
        if !matches!(result, Err(Halt::Until(_))) && (chunk.last || result.is_err()) {
            self.show(cx);
        }
        result
    }

    fn begin_upload(&mut self, _: &mut Context<'_, '_>, _: Address) -> Result<u32, Halt> {
        let program = self.program.ok_or(AbortCode::NoData)?;
        Ok(program.len)
    }

    fn read(
        &mut self,
        cx: &mut Context<'_, '_>,
        _: Address,
        at: u32,
        to: &mut [u8],
    ) -> Result<(), Halt> {
        self.ready(cx.now)?;
        self.memory.read(at, to);
        Ok(())
    }

    fn end(&mut self, cx: &mut Context<'_, '_>, _: Address, _: StreamEnd) {
        // The download was not complete. The end of an upload changes nothing.
        if self.is_loading {
            let fault = self.fault;
            self.forget(fault);
            self.show(cx);
        }
    }
}

impl<M: ProgramMemory, const PAGE: usize> Application for Loader<M, PAGE> {
    fn reset(&mut self, cx: &mut Context<'_, '_>, reset: Reset) {
        if matches!(reset, Reset::PowerOn | Reset::Node) {
            self.is_running = false;
            let stored = self.memory.stored();
            let known = self.program.filter(|_| reset == Reset::Node);
            let program = stored.or(known);
            self.forget(if program.is_some() {
                NO_FAULT
            } else {
                NO_PROGRAM
            });
            self.program = program;
        }
        self.show(cx);
    }

    fn stream(&mut self, address: Address) -> Option<&mut dyn Stream> {
        if self.is(address, DATA) {
            Some(self)
        } else {
            None
        }
    }

    fn validate(
        &mut self,
        cx: &mut Context<'_, '_>,
        address: Address,
        value: &[u8],
    ) -> Result<(), AbortCode> {
        if !self.is(address, CONTROL) {
            return Ok(());
        }
        let is_busy = self.is_busy(cx.now);
        match value {
            [0] => Ok(()),
            [1 | 2] if self.program.is_none() => Err(AbortCode::NoData),
            [1 | 2] if is_busy => Err(AbortCode::DeviceState),
            [1 | 2] => Ok(()),
            [3] if self.is_running || is_busy => Err(AbortCode::DeviceState),
            [3] => Ok(()),
            _ => Err(AbortCode::ValueRange),
        }
    }

    fn written(&mut self, cx: &mut Context<'_, '_>, address: Address) {
        if !self.is(address, CONTROL) {
            return;
        }
        match cx.store.unsigned(CONTROL, self.number) {
            1 => self.is_running = true,
            3 => {
                self.forget(NO_PROGRAM);
                let result = self.memory.erase(cx.now);
                // 1F57h contains the reason of the failure.
                let _ = self.done(result);
            }
            _ => self.is_running = false,
        }
        self.show(cx);
    }

    /// Updates 1F57h when the memory is ready.
    fn tick(&mut self, cx: &mut Context<'_, '_>) -> Option<Instant> {
        let status = self.status(cx.now);
        cx.store
            .set_unsigned(Address::new(STATUS, self.number), status);
        self.memory.ready(cx.now).err()
    }
}
