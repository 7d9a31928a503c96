//! Files of the computer that runs the emulator, by semihosting.

use core::ffi::CStr;

use odkit_firmware::board::File;

/// Number of bytes that are read or written at once.
const ROOM: usize = 2048;

/// A file that is read from its beginning to its end.
pub struct Input {
    file: File,
    bytes: [u8; ROOM],
    at: usize,
    end: usize,
}

impl Input {
    /// Opens a file.
    pub fn open(name: &CStr) -> Self {
        Self {
            file: File::open(name, false),
            bytes: [0; ROOM],
            at: 0,
            end: 0,
        }
    }

    /// The next byte; `None` at the end.
    pub fn byte(&mut self) -> Option<u8> {
        if self.at == self.end {
            (self.at, self.end) = (0, self.file.read(&mut self.bytes));
        }
        let byte = self.bytes.get(self.at).filter(|_| self.at < self.end)?;
        self.at += 1;
        Some(*byte)
    }

    /// Fills `to`.
    pub fn fill(&mut self, to: &mut [u8]) -> Option<()> {
        to.iter_mut().try_for_each(|byte| {
            *byte = self.byte()?;
            Some(())
        })
    }

    /// The next bytes.
    pub fn array<const N: usize>(&mut self) -> Option<[u8; N]> {
        let mut bytes = [0; N];
        self.fill(&mut bytes)?;
        Some(bytes)
    }
}

/// A file that is written.
pub struct Output {
    file: File,
    bytes: [u8; ROOM],
    len: usize,
}

impl Output {
    /// Creates a file, or empties it.
    pub fn open(name: &CStr) -> Self {
        Self {
            file: File::open(name, true),
            bytes: [0; ROOM],
            len: 0,
        }
    }

    /// Adds bytes.
    pub fn put(&mut self, bytes: &[u8]) {
        for byte in bytes {
            if self.len == ROOM {
                self.write();
            }
            self.bytes[self.len] = *byte;
            self.len += 1;
        }
    }

    /// Writes the remaining bytes.
    pub fn write(&mut self) {
        self.file.write(&self.bytes[..self.len]);
        self.len = 0;
    }
}
