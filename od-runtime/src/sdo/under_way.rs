//! A transfer under way and a response that waits, of a server that may have no room for either.

use super::late::Late;
use super::{Server, Transfer};
use crate::rooms::{Blank, Room, Rooms};

impl<D, const N: usize, R: Rooms> Server<D, N, R> {
    /// The transfer under way; a server without room for one has none.
    #[inline]
    pub(super) fn transfer(&self) -> &Transfer {
        self.transfers.all().first().unwrap_or(&Transfer::None)
    }

    #[inline]
    pub(super) fn set_transfer(&mut self, transfer: Transfer) {
        if let Some(to) = self.transfers.all_mut().first_mut() {
            *to = transfer;
        }
    }

    /// The response that waits.
    #[inline]
    pub(super) fn late(&self) -> &Late {
        self.late.all().first().unwrap_or(&Late::BLANK)
    }

    #[inline]
    pub(super) fn set_late(&mut self, late: Late) {
        if let Some(to) = self.late.all_mut().first_mut() {
            *to = late;
        }
    }
}
