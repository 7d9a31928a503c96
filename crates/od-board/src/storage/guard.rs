//! Flash that behaves after a power failure as the log expects.

use embedded_storage_async::nor_flash::{ErrorType, NorFlash, ReadNorFlash};

/// The log marks a page in its first and its last word. Power may fail while it writes one of these
/// words, or while it erases a page. So a mark with any bit written counts as written; otherwise it
/// would be written twice, which flash with error correction refuses. A page that seems erased is
/// checked before its first mark, and erased again if necessary.
#[derive(Clone, Debug)]
pub(super) struct Guard<F>(pub(super) F);

/// Number of bytes of the longest word.
const WORD: usize = 32;

impl<F: NorFlash> Guard<F> {
    /// Number of bytes that are written at once.
    const MARK: usize = {
        let mark = if F::WRITE_SIZE > F::READ_SIZE {
            F::WRITE_SIZE
        } else {
            F::READ_SIZE
        };
        assert!(mark <= WORD, "a word has at most 32 bytes");
        mark
    };

    async fn is_blank(&mut self, from: u32, len: usize) -> Result<bool, F::Error> {
        let mut word = [0; WORD];
        for at in (from..).step_by(Self::MARK).take(len / Self::MARK) {
            self.0.read(at, &mut word[..Self::MARK]).await?;
            if word[..Self::MARK].iter().any(|byte| *byte != 0xFF) {
                return Ok(false);
            }
        }
        Ok(true)
    }
}

impl<F: NorFlash> ErrorType for Guard<F> {
    type Error = F::Error;
}

impl<F: NorFlash> ReadNorFlash for Guard<F> {
    const READ_SIZE: usize = F::READ_SIZE;

    async fn read(&mut self, offset: u32, bytes: &mut [u8]) -> Result<(), Self::Error> {
        let end = offset as usize + bytes.len();
        let mark = if (offset as usize).is_multiple_of(F::ERASE_SIZE) {
            offset
        } else if end.is_multiple_of(F::ERASE_SIZE) {
            (end - Self::MARK) as u32
        } else {
            return self.0.read(offset, bytes).await;
        };
        let is_blank = self.is_blank(mark, Self::MARK).await?;
        bytes.fill(if is_blank { 0xFF } else { 0 });
        Ok(())
    }

    fn capacity(&self) -> usize {
        self.0.capacity()
    }
}

impl<F: NorFlash> NorFlash for Guard<F> {
    const WRITE_SIZE: usize = F::WRITE_SIZE;
    const ERASE_SIZE: usize = F::ERASE_SIZE;

    async fn erase(&mut self, from: u32, to: u32) -> Result<(), Self::Error> {
        self.0.erase(from, to).await
    }

    async fn write(&mut self, offset: u32, bytes: &[u8]) -> Result<(), Self::Error> {
        if (offset as usize).is_multiple_of(F::ERASE_SIZE)
            && !self.is_blank(offset, F::ERASE_SIZE).await?
        {
            self.0.erase(offset, offset + F::ERASE_SIZE as u32).await?;
        }
        self.0.write(offset, bytes).await
    }
}
