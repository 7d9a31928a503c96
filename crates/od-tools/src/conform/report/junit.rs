//! The report as JUnit XML, a test suite for each group.

use od_model::{Visible, is_hidden};

use super::run::{Narrator, Report, groups, source};
use crate::conform::record::{Record, Verdict};

pub(super) fn render(report: &Report) -> String {
    let seconds = |micros: u64| format!("{}.{:06}", micros / 1_000_000, micros % 1_000_000);
    let counts = report.counts();
    let total: u64 = report.records.iter().map(|record| record.micros).sum();
    let mut lines = vec![
        String::from(r#"<?xml version="1.0" encoding="UTF-8"?>"#),
        format!(
            r#"<testsuites name="odkit conform: {}" tests="{}" failures="{}" skipped="{}" time="{}">"#,
            escape(&report.device),
            report.records.len(),
            counts.fail,
            counts.skipped + counts.not_applicable,
            seconds(total)
        ),
    ];
    let mut narrator = Narrator::new(report);
    lines.push("  <properties>".into());
    for (name, value) in report.head() {
        lines.push(format!(
            r#"    <property name="{}" value="{}"/>"#,
            escape(name),
            escape(&value)
        ));
    }
    lines.push("  </properties>".into());
    for (group, records) in groups(report) {
        let fails = records.iter().filter(|record| record.verdict.is_fail());
        let spared = |record: &&&Record| {
            matches!(
                record.verdict,
                Verdict::Skipped(_) | Verdict::NotApplicable(_)
            )
        };
        let time: u64 = records.iter().map(|record| record.micros).sum();
        lines.push(format!(
            r#"  <testsuite name="{}" tests="{}" failures="{}" skipped="{}" time="{}">"#,
            escape(group),
            records.len(),
            fails.count(),
            records.iter().filter(spared).count(),
            seconds(time)
        ));
        for record in records {
            lines.push(format!(
                r#"    <testcase name="{}" classname="{}" time="{}">"#,
                escape(&record.id),
                escape(group),
                seconds(record.micros)
            ));
            let reason = escape(&record.verdict.reason());
            match &record.verdict {
                Verdict::Pass => {}
                Verdict::Fail { .. } => lines.push(format!(
                    r#"      <failure message="{reason}">{}</failure>"#,
                    escape(&source(record))
                )),
                Verdict::Skipped(_) => {
                    lines.push(format!(r#"      <skipped message="{reason}"/>"#));
                }
                Verdict::NotApplicable(_) => lines.push(format!(
                    r#"      <skipped message="not applicable: {reason}"/>"#
                )),
            }
            let frames = narrator.lines(record);
            lines.push(format!(
                "      <system-out>{}</system-out>",
                escape(&frames.join("\n"))
            ));
            lines.push("    </testcase>".into());
        }
        lines.push("  </testsuite>".into());
    }
    lines.push("</testsuites>".into());
    lines.join("\n")
}

/// Text for XML and HTML, also inside quotes; invisible characters are escaped.
pub fn escape(text: &str) -> String {
    let mut out = String::new();
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            '\n' | '\t' => out.push(c),
            c if is_hidden(c) => out.push_str(&Visible(c.encode_utf8(&mut [0; 4])).line()),
            c => out.push(c),
        }
    }
    out
}
