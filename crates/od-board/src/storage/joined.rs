//! Flash whose pages consist of several pages of the driver.

use embedded_storage_async::nor_flash::{ErrorType, MultiwriteNorFlash, NorFlash, ReadNorFlash};

/// A flash that erases `N` pages of the driver at a time. A [`Log`](super::Log) needs it if a set
/// does not fit into one page of the driver.
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
