//! The report as text, a line a case, with the frames of what failed.

use od_model::Visible;

use super::run::{self, Report, millis};
use crate::conform::record::{Record, Verdict};

/// Number of frames of a failed case that are shown, the last ones.
const SHOWN: usize = 12;

pub(super) fn render(report: &Report) -> String {
    let mut lines = vec![format!(
        "{} (node {}, {}) against {}",
        report.device, report.node, report.link, report.eds
    )];
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
        details(record, &mut lines);
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

fn details(record: &Record, lines: &mut Vec<String>) {
    match &record.verdict {
        Verdict::Pass => {}
        Verdict::Fail { expected, got } => {
            lines.push(format!("             clause    {}", record.clause));
            lines.push(format!("             expected  {expected}"));
            lines.push(format!("             but       {got}"));
            let from = record.frames.len().saturating_sub(SHOWN);
            for traced in &record.frames[from..] {
                lines.push(format!("             {}", run::frame(traced)));
            }
            for note in &record.notes {
                lines.push(format!("             {note}"));
            }
        }
        Verdict::Skipped(why) | Verdict::NotApplicable(why) => {
            lines.push(format!("             {why}"));
        }
    }
    // What could not be put back is worth a line in any case.
    if !record.verdict.is_fail() {
        let lost = record
            .notes
            .iter()
            .filter(|note| note.starts_with("could not"));
        lines.extend(lost.map(|note| format!("             {note}")));
    }
}
