//! The report as JUnit XML, a test suite for each group.

use super::run::{Narrator, Report, groups, source};
use crate::conform::record::{Record, Verdict};
use crate::junit::{Case, Outcome, Run, Suite};

pub(super) fn render(report: &Report) -> String {
    let mut narrator = Narrator::new(report);
    let mut case = |record: &Record| Case {
        name: record.id.clone(),
        micros: Some(record.micros),
        outcome: outcome(record),
        output: narrator.lines(record),
    };
    let suites = groups(report).into_iter().map(|(group, records)| Suite {
        name: group.to_owned(),
        micros: records.iter().map(|record| record.micros).sum(),
        cases: records.into_iter().map(&mut case).collect(),
    });
    let head = report.head().into_iter();
    let run = Run {
        name: format!("odkit conform: {}", report.device),
        suites: suites.collect(),
        properties: head.map(|(name, value)| (name.to_owned(), value)).collect(),
    };
    run.render()
}

fn outcome(record: &Record) -> Outcome {
    let reason = record.verdict.reason();
    match &record.verdict {
        Verdict::Pass => Outcome::Passed,
        Verdict::Fail { .. } => Outcome::Failed {
            message: reason,
            text: source(record),
        },
        Verdict::Skipped(_) => Outcome::Skipped(reason),
        Verdict::NotApplicable(_) => Outcome::Skipped(format!("not applicable: {reason}")),
    }
}
