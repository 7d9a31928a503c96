//! What a stage gets to work with.

use crate::console::Console;
use crate::repo::Repo;

/// What a stage gets to work with.
#[derive(Debug)]
pub(super) struct Context<'a> {
    pub(super) repo: &'a Repo,
    pub(super) console: &'a Console,
    pub(super) quick: bool,
    pub(super) long: bool,
}
