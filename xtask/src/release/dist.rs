//! A release that is being made.

use crate::console::Console;
use crate::repo::Repo;

/// The input of a part.
pub(super) struct Dist<'a> {
    pub(super) repo: &'a Repo,
    pub(super) console: &'a Console,
    pub(super) version: String,
    /// Seconds since 1970 that files and archives bear.
    pub(super) epoch: String,
}
