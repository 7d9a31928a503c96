//! The report as Markdown: a table for each group, then what failed.

use od_model::Visible;

use super::run::{self, Report, groups, millis};
use crate::conform::record::Verdict;

pub(super) fn render(report: &Report) -> String {
    let cell = |text: &str| Visible(text).markdown();
    let mut lines = vec![
        format!("# Conformance test of {}", cell(&report.device)),
        String::new(),
        format!(
            "Node {} on {}, against {}. {}.",
            report.node,
            cell(&report.link),
            cell(&report.eds),
            report.summary()
        ),
    ];
    if let Some(why) = &report.lost {
        lines.push(String::new());
        lines.push(format!("**The run ended early: {}.**", cell(why)));
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
    for (group, records) in groups(report) {
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
                cell(&record.clause),
                cell(&record.verdict.reason())
            ));
        }
    }
    for record in report
        .records
        .iter()
        .filter(|record| record.verdict.is_fail())
    {
        lines.push(String::new());
        lines.push(format!("## {} failed", record.id));
        lines.push(String::new());
        lines.push("```".into());
        lines.extend(record.frames.iter().map(run::frame));
        lines.push("```".into());
    }
    lines.join("\n")
}
