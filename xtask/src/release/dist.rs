//! A release that is being made.

use crate::console::Console;
use crate::repo::Repo;

/// The input of a part.
pub(super) struct Dist<'a> {
    pub(super) repo: &'a Repo,
    pub(super) console: &'a Console,
    pub(super) version: String,
    /// Time of files in archives, in seconds since 1970.
    pub(super) epoch: String,
}
