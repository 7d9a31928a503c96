//! The report as text, one line per case, with the frames of failed cases.

use od_model::Visible;

use super::run::{Narrator, Report, millis, source};
use crate::conform::record::{Record, Verdict};

/// Number of the last frames before a failure that are shown.
const SHOWN: usize = 12;

pub(super) fn render(report: &Report) -> String {
    let mut lines = vec![format!(
        "{} (node {}, {}) against {}",
        report.device, report.node, report.link, report.eds
    )];
    let known = ["Device", "Node ID", "Link", "EDS"];
    let head = report
        .head()
        .into_iter()
        .filter(|(name, _)| !known.contains(name));
    lines.extend(head.map(|(name, value)| format!("{name}: {value}")));
    let mut narrator = Narrator::new(report);
    let width = report.records.iter().map(|record| record.id.len()).max();
    let width = width.unwrap_or(0);
    let mut group = "";
    for record in &report.records {
        if record.group != group {
            group = &record.group;
            lines.push(String::new());
            lines.push(group.to_owned());
        }
        let word = record.verdict.word();
        lines.push(format!(
            "  {word:<7}  {:<width$}  {}",
            record.id, record.title
        ));
        details(record, &mut narrator, &mut lines);
    }
    lines.push(String::new());
    for (group, counts) in report.by_group() {
        lines.push(format!(
            "{group:<18} {:>3} passed {:>3} failed {:>3} skipped {:>3} not applicable",
            counts.pass, counts.fail, counts.skipped, counts.not_applicable
        ));
    }
    let failures: Vec<&str> = report.failures().map(|record| &*record.id).collect();
    if !failures.is_empty() {
        lines.push(format!("failed: {}", failures.join(", ")));
    }
    lines.push(String::new());
    for (name, count, [middle, most, longest]) in report.timings() {
        lines.push(format!(
            "{name}: 50 % within {}, 95 % within {}, longest {} ({count} measured)",
            millis(middle),
            millis(most),
            millis(longest)
        ));
    }
    lines.extend(report.put_back());
    if let Some(why) = &report.lost {
        lines.push(format!("the run ended early: {why}"));
    }
    lines.push(report.summary());
    Visible(&lines.join("\n")).lines().into_owned()
}

fn details(record: &Record, narrator: &mut Narrator, lines: &mut Vec<String>) {
    match &record.verdict {
        Verdict::Pass => {}
        Verdict::Fail { expected, got } => {
            lines.push(format!("             clause    {}", source(record)));
            lines.push(format!("             expected  {expected}"));
            lines.push(format!("             but       {got}"));
            let frames = narrator.lines(record);
            let found = &frames[..record.found];
            lines.extend(
                found[found.len().saturating_sub(SHOWN)..]
                    .iter()
                    .map(|line| format!("             {line}")),
            );
            for note in &record.notes {
                lines.push(format!("             {note}"));
            }
        }
        Verdict::Skipped(why) | Verdict::NotApplicable(why) => {
            lines.push(format!("             {why}"));
        }
    }
    // A value that could not be restored always has a line.
    if !record.verdict.is_fail() {
        let lost = record
            .notes
            .iter()
            .filter(|note| note.starts_with("could not"));
        lines.extend(lost.map(|note| format!("             {note}")));
    }
}
