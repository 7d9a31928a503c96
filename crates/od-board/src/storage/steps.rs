//! An asynchronous flash driver made of a blocking one.

use core::future::poll_fn;
use core::task::Poll;

use embedded_storage::nor_flash as blocking;
use embedded_storage_async::nor_flash::{ErrorType, NorFlash, ReadNorFlash};

/// Makes an asynchronous driver of a driver whose calls block until the flash is done. Each poll
/// reads, erases one page or writes at most 64 bytes, and returns to the caller.
#[derive(Clone, Debug)]
pub struct Steps<F>(pub F);

/// Number of bytes that one step writes.
const STEP: usize = 64;

/// Lets other tasks run.
pub(super) async fn pause() {
    let mut waited = false;
    poll_fn(|cx| {
        if core::mem::replace(&mut waited, true) {
            return Poll::Ready(());
        }
        cx.waker().wake_by_ref();
        Poll::Pending
    })
    .await;
}

impl<F: blocking::ErrorType> ErrorType for Steps<F> {
    type Error = F::Error;
}

impl<F: blocking::ReadNorFlash> ReadNorFlash for Steps<F> {
    const READ_SIZE: usize = F::READ_SIZE;

    async fn read(&mut self, offset: u32, bytes: &mut [u8]) -> Result<(), Self::Error> {
        pause().await;
        self.0.read(offset, bytes)
    }

    fn capacity(&self) -> usize {
        self.0.capacity()
    }
}

impl<F: blocking::NorFlash> NorFlash for Steps<F> {
    const WRITE_SIZE: usize = F::WRITE_SIZE;
    const ERASE_SIZE: usize = F::ERASE_SIZE;

    async fn erase(&mut self, from: u32, to: u32) -> Result<(), Self::Error> {
        for page in (from..to).step_by(F::ERASE_SIZE) {
            pause().await;
            self.0.erase(page, page + F::ERASE_SIZE as u32)?;
        }
        Ok(())
    }

    async fn write(&mut self, offset: u32, bytes: &[u8]) -> Result<(), Self::Error> {
        let step = STEP.next_multiple_of(F::WRITE_SIZE);
        for (at, part) in (offset..).step_by(step).zip(bytes.chunks(step)) {
            pause().await;
            self.0.write(at, part)?;
        }
        Ok(())
    }
}

impl<F: blocking::MultiwriteNorFlash> embedded_storage_async::nor_flash::MultiwriteNorFlash
    for Steps<F>
{
}
