//! A run of the conformance test, and what its reports have in common.

use crate::conform::record::{Record, Times, Traced, Verdict, percentile};

/// A run of the conformance test.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Report {
    /// The device, as the EDS names it.
    pub device: String,
    /// The EDS.
    pub eds: String,
    /// The link.
    pub link: String,
    /// The node ID.
    pub node: u8,
    /// The cases, in the order in which they were run.
    pub records: Vec<Record>,
    /// Times that the node took.
    pub times: Times,
    /// Reason why the run could not go on, if it could not.
    pub lost: Option<String>,
}

/// Number of cases with each verdict.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub struct Counts {
    /// The node is right.
    pub pass: usize,
    /// The node is wrong.
    pub fail: usize,
    /// Not tested.
    pub skipped: usize,
    /// The node does not have it.
    pub not_applicable: usize,
}

impl Report {
    /// Whether no case failed and the run came to its end.
    pub fn is_pass(&self) -> bool {
        self.lost.is_none() && self.counts().fail == 0
    }

    /// Number of cases with each verdict.
    pub fn counts(&self) -> Counts {
        let mut counts = Counts::default();
        for record in &self.records {
            *match record.verdict {
                Verdict::Pass => &mut counts.pass,
                Verdict::Fail { .. } => &mut counts.fail,
                Verdict::Skipped(_) => &mut counts.skipped,
                Verdict::NotApplicable(_) => &mut counts.not_applicable,
            } += 1;
        }
        counts
    }

    /// `12 passed, 1 failed, 2 skipped, 3 not applicable`.
    pub fn summary(&self) -> String {
        let Counts {
            pass,
            fail,
            skipped,
            not_applicable,
        } = self.counts();
        let all = self.records.len();
        let cases = if all == 1 { "case" } else { "cases" };
        format!(
            "{all} {cases}: {pass} passed, {fail} failed, {skipped} skipped, {not_applicable} not applicable"
        )
    }

    /// Values that were changed and put back, and those that could not be; `None` if nothing was changed.
    pub(super) fn put_back(&self) -> Option<String> {
        let notes = self.records.iter().flat_map(|record| &record.notes);
        let count = |start: &str| notes.clone().filter(|note| note.starts_with(start)).count();
        let (back, not) = (count("put back"), count("could not"));
        let values = if back == 1 { "value" } else { "values" };
        match (back, not) {
            (0, 0) => None,
            (_, 0) => Some(format!("changed and put back: {back} {values}")),
            _ => Some(format!(
                "changed and put back: {back} {values}; could not be put back: {not}"
            )),
        }
    }

    /// The times that the node took, with percentiles; a line each.
    pub(super) fn timings(&self) -> Vec<(&'static str, usize, [u64; 3])> {
        let both = [
            ("SDO response", &self.times.answers),
            ("boot-up after a reset", &self.times.boots),
        ];
        let line = |(name, values): (&'static str, &Vec<u64>)| {
            let at = |percent| percentile(values, percent);
            Some((name, values.len(), [at(50)?, at(95)?, at(100)?]))
        };
        both.into_iter().filter_map(line).collect()
    }
}

/// Microseconds as milliseconds.
pub(super) fn millis(micros: u64) -> String {
    format!("{}.{:03} ms", micros / 1000, micros % 1000)
}

/// A frame as a line: when, whose, what.
pub(super) fn frame(traced: &Traced) -> String {
    let mark = if traced.ours { "->" } else { "<-" };
    format!("{:?} {mark} {}", traced.at, traced.frame)
}

/// The groups in order, each with its cases.
pub(super) fn groups(report: &Report) -> Vec<(&str, Vec<&Record>)> {
    let mut all: Vec<(&str, Vec<&Record>)> = Vec::new();
    for record in &report.records {
        match all.iter_mut().find(|(group, _)| *group == record.group) {
            Some((_, records)) => records.push(record),
            None => all.push((&record.group, vec![record])),
        }
    }
    all
}
