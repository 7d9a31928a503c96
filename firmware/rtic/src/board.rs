//! A board with a CAN controller and flash, both simulated in memory.

use embedded_can::{ErrorKind, nb};
use embedded_storage::nor_flash::{
    ErrorType, NorFlash, NorFlashError, NorFlashErrorKind, ReadNorFlash,
};
use odkit::Frame;

/// A CAN controller without a bus: the program pushes and takes the frames.
#[derive(Debug)]
pub struct Can {
    /// Received frames.
    pub received: [Option<Frame>; 4],
    /// Number of sent frames.
    pub sent: u32,
    /// Number of responses to 1010h.
    pub saved: u32,
}

impl Can {
    /// A controller that has received and sent nothing.
    pub const fn new() -> Self {
        Self {
            received: [None; 4],
            sent: 0,
            saved: 0,
        }
    }

    /// Receives a frame.
    pub fn push(&mut self, frame: Frame) {
        if let Some(room) = self.received.iter_mut().find(|frame| frame.is_none()) {
            *room = Some(frame);
        }
    }
}

/// Sending cannot fail.
#[derive(Debug)]
pub enum Never {}

impl embedded_can::Error for Never {
    fn kind(&self) -> ErrorKind {
        match *self {}
    }
}

impl NorFlashError for Never {
    fn kind(&self) -> NorFlashErrorKind {
        match *self {}
    }
}

impl nb::Can for Can {
    type Frame = Frame;
    type Error = Never;

    fn transmit(&mut self, frame: &Frame) -> ::nb::Result<Option<Frame>, Never> {
        self.sent += 1;
        self.saved += u32::from(frame.data().starts_with(&[0x60, 0x10, 0x10]));
        Ok(None)
    }

    fn receive(&mut self) -> ::nb::Result<Frame, Never> {
        let frame = self.received[0].take().ok_or(::nb::Error::WouldBlock)?;
        self.received.rotate_left(1);
        Ok(frame)
    }
}

/// Bytes of a page.
pub const PAGE: usize = 4096;

/// Three pages of flash. Erasing takes long, as in real flash.
#[derive(Debug)]
pub struct Flash {
    bytes: [u8; 3 * PAGE],
    /// Called during each erasure and each write.
    pub during: fn(),
}

impl Flash {
    /// Erased flash.
    pub const fn new(during: fn()) -> Self {
        let bytes = [0xFF; 3 * PAGE];
        Self { bytes, during }
    }
}

impl ErrorType for Flash {
    type Error = Never;
}

impl ReadNorFlash for Flash {
    const READ_SIZE: usize = 1;

    fn read(&mut self, offset: u32, bytes: &mut [u8]) -> Result<(), Never> {
        let from = self.bytes.iter().skip(offset as usize);
        bytes
            .iter_mut()
            .zip(from)
            .for_each(|(to, from)| *to = *from);
        Ok(())
    }

    fn capacity(&self) -> usize {
        self.bytes.len()
    }
}

impl NorFlash for Flash {
    const WRITE_SIZE: usize = 8;
    const ERASE_SIZE: usize = PAGE;

    fn erase(&mut self, from: u32, to: u32) -> Result<(), Never> {
        (self.during)();
        for _ in 0..20 {
            for byte in self.bytes.iter_mut().take(to as usize).skip(from as usize) {
                *core::hint::black_box(byte) = 0xFF;
            }
        }
        Ok(())
    }

    fn write(&mut self, offset: u32, bytes: &[u8]) -> Result<(), Never> {
        (self.during)();
        let to = self.bytes.iter_mut().skip(offset as usize);
        to.zip(bytes).for_each(|(to, from)| *to &= *from);
        Ok(())
    }
}
