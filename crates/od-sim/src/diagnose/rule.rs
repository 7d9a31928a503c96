//! A rule of the diagnosis.

use std::prelude::v1::*;

use super::facts::Facts;
use super::incident::Incident;

/// A rule: what it finds in the facts of a log.
pub(super) struct Rule {
    pub(super) name: &'static str,
    pub(super) title: &'static str,
    /// Whether it measures times; in a log without times the other rules know the order of the frames.
    pub(super) needs_times: bool,
    pub(super) check: fn(&Facts<'_>) -> Vec<Incident>,
}
