//! The report as Markdown: what was tested, a summary, the failures, a table for each group, and what does not apply.

use od_model::Visible;

use super::run::{Narrator, Report, groups, millis, source};
use crate::conform::record::Verdict;

pub(super) fn render(report: &Report) -> String {
    let cell = |text: &str| Visible(text).markdown();
    let mut lines = vec![
        format!("# Conformance test of {}", cell(&report.device)),
        String::new(),
        format!("{}.", report.summary()),
    ];
    if let Some(why) = &report.lost {
        lines.push(String::new());
        lines.push(format!("**The run ended early: {}.**", cell(why)));
    }
    lines.extend(["", "| | |", "|---|---|"].map(String::from));
    for (name, value) in report.head() {
        lines.push(format!("| {name} | {} |", cell(&value)));
    }
    lines.extend(
        [
            "",
            "## Summary",
            "",
            "| Group | Passed | Failed | Skipped | Not applicable |",
            "|---|---|---|---|---|",
        ]
        .map(String::from),
    );
    for (group, counts) in report.by_group() {
        lines.push(format!(
            "| {} | {} | {} | {} | {} |",
            cell(group),
            counts.pass,
            counts.fail,
            counts.skipped,
            counts.not_applicable
        ));
    }
    if !report.timings().is_empty() {
        lines.push(String::new());
        lines.push("| Time | Measured | 50 % | 95 % | Longest |".into());
        lines.push("|---|---|---|---|---|".into());
    }
    for (name, count, all) in report.timings() {
        let [middle, most, longest] = all.map(millis);
        lines.push(format!(
            "| {name} | {count} | {middle} | {most} | {longest} |"
        ));
    }
    let mut narrator = Narrator::new(report);
    for record in report.failures() {
        lines.push(String::new());
        lines.push(format!("## {} failed", record.id));
        lines.push(String::new());
        lines.push(format!(
            "{} ({})",
            cell(&record.title),
            cell(&source(record))
        ));
        lines.push(String::new());
        lines.push(format!("{}.", cell(&record.verdict.reason())));
        for note in &record.notes {
            lines.push(String::new());
            lines.push(format!("{}.", cell(note)));
        }
        lines.push(String::new());
        lines.push("```".into());
        let frames = narrator.lines(record);
        lines.extend(frames.iter().map(|line| Visible(line).line().into_owned()));
        lines.push("```".into());
    }
    for (group, mut records) in groups(report) {
        records.retain(|record| !matches!(record.verdict, Verdict::NotApplicable(_)));
        if records.is_empty() {
            continue;
        }
        lines.push(String::new());
        lines.push(format!("## {}", cell(group)));
        lines.push(String::new());
        lines.push("| Verdict | Case | What is right | Clause | |".into());
        lines.push("|---|---|---|---|---|".into());
        for record in records {
            let word = match record.verdict {
                Verdict::Fail { .. } => "**fail**",
                _ => record.verdict.word(),
            };
            lines.push(format!(
                "| {word} | {} | {} | {} | {} |",
                record.id,
                cell(&record.title),
                cell(&source(record)),
                cell(&record.verdict.reason())
            ));
        }
    }
    lines.extend(
        [
            "",
            "## Not applicable",
            "",
            "| Case | What is right | Why not |",
            "|---|---|---|",
        ]
        .map(String::from),
    );
    for record in &report.records {
        if let Verdict::NotApplicable(why) = &record.verdict {
            lines.push(format!(
                "| {} | {} | {} |",
                record.id,
                cell(&record.title),
                cell(why)
            ));
        }
    }
    lines.join("\n")
}
