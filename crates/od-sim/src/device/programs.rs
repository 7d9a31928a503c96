//! Program download of a device of a file (1F50h to 1F57h): a memory for each sub-index of 1F50h.

use std::prelude::v1::*;

use od_model::{Address, Dictionary};
use od_runtime::Instant;
use od_runtime::program::{self, MemoryFailed, Program, ProgramMemory};

/// Bytes of a page.
const PAGE: usize = 256;
/// Limit of a program, in bytes.
const SIZE: u32 = 1 << 20;

/// A memory that keeps its program without power, and grows with a download.
#[derive(Clone, Default)]
pub(crate) struct Memory {
    bytes: Vec<u8>,
    program: Option<Program>,
}

impl ProgramMemory for Memory {
    fn size(&self) -> u32 {
        SIZE
    }

    fn erase(&mut self, _: Instant) -> Result<(), MemoryFailed> {
        *self = Self::default();
        Ok(())
    }

    fn write(&mut self, _: Instant, _: u32, page: &[u8]) -> Result<(), MemoryFailed> {
        self.bytes.extend_from_slice(page);
        Ok(())
    }

    fn read(&mut self, at: u32, to: &mut [u8]) {
        let at = at as usize;
        if let Some(from) = self.bytes.get(at..at + to.len()) {
            to.copy_from_slice(from);
        }
    }

    fn complete(&mut self, _: Instant, program: Program) -> Result<(), MemoryFailed> {
        self.program = Some(program);
        Ok(())
    }

    fn stored(&mut self) -> Option<Program> {
        self.program
    }
}

pub(crate) type Loader = program::Loader<Memory, PAGE>;

/// The loaders of a device, by the sub-indices of 1F50h.
pub(crate) type Programs = Vec<Loader>;

/// The loaders of a dictionary that has program data and program control.
pub(crate) fn of(dictionary: Dictionary<'_>) -> Programs {
    let numbers = (1..=254).filter(|number| {
        let has = |index| dictionary.find(Address::new(index, *number)).is_ok();
        has(0x1F50) && has(0x1F51)
    });
    numbers
        .map(|number| Loader::new(Memory::default(), number))
        .collect()
}
