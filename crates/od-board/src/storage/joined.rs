//! Flash with larger pages than its own.

use embedded_storage_async::nor_flash::{ErrorType, MultiwriteNorFlash, NorFlash, ReadNorFlash};

/// A flash whose pages are erased `N` at a time, for a [`Log`](super::Log) of sets that do not fit into one of
/// its own.
#[derive(Clone, Debug)]
pub struct Joined<F, const N: usize>(pub F);

impl<F: ErrorType, const N: usize> ErrorType for Joined<F, N> {
    type Error = F::Error;
}

impl<F: ReadNorFlash, const N: usize> ReadNorFlash for Joined<F, N> {
    const READ_SIZE: usize = F::READ_SIZE;

    async fn read(&mut self, offset: u32, bytes: &mut [u8]) -> Result<(), Self::Error> {
        self.0.read(offset, bytes).await
    }

    fn capacity(&self) -> usize {
        self.0.capacity()
    }
}

impl<F: NorFlash, const N: usize> NorFlash for Joined<F, N> {
    const WRITE_SIZE: usize = F::WRITE_SIZE;
    const ERASE_SIZE: usize = {
        assert!(N > 0, "a page is one or more of the flash");
        N * F::ERASE_SIZE
    };

    async fn erase(&mut self, from: u32, to: u32) -> Result<(), Self::Error> {
        self.0.erase(from, to).await
    }

    async fn write(&mut self, offset: u32, bytes: &[u8]) -> Result<(), Self::Error> {
        self.0.write(offset, bytes).await
    }
}

impl<F: MultiwriteNorFlash, const N: usize> MultiwriteNorFlash for Joined<F, N> {}
