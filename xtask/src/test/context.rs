//! The input of a stage.

use crate::console::Console;
use crate::repo::Repo;

/// The input of a stage.
#[derive(Debug)]
pub(super) struct Context<'a> {
    pub(super) repo: &'a Repo,
    pub(super) console: &'a Console,
    pub(super) quick: bool,
    pub(super) long: bool,
}
