//! Number of findings of each rule.

use std::collections::BTreeMap;

use od_eds::check::rule;
use od_eds::fix::Applicability;
use serde::Serialize;

use super::checked::Checked;

/// One rule.
#[derive(Serialize)]
struct Count {
    code: &'static str,
    title: &'static str,
    findings: usize,
    files: usize,
    /// Findings with a safe fix.
    safe: usize,
    /// Findings with an unsafe fix.
    r#unsafe: usize,
}

/// The rules with findings, the most frequent first.
fn counts(checked: &[Checked]) -> Vec<Count> {
    let mut counts: BTreeMap<&'static str, (Count, usize)> = BTreeMap::new();
    for (at, file) in checked.iter().enumerate() {
        for finding in &file.findings {
            let code = finding.code();
            let title = rule(code).map_or("", |rule| rule.title);
            let count = Count {
                code,
                title,
                findings: 0,
                files: 0,
                safe: 0,
                r#unsafe: 0,
            };
            let (count, last) = counts.entry(code).or_insert((count, usize::MAX));
            count.findings += 1;
            count.files += usize::from(*last != at);
            *last = at;
            match finding.fix.as_ref().map(|fix| fix.applicability) {
                Some(Applicability::Safe) => count.safe += 1,
                Some(Applicability::Unsafe) => count.r#unsafe += 1,
                None => {}
            }
        }
    }
    let mut counts: Vec<Count> = counts.into_values().map(|(count, _)| count).collect();
    counts.sort_by_key(|count| core::cmp::Reverse(count.findings));
    counts
}

/// A line for each rule.
pub(super) fn text(checked: &[Checked]) -> String {
    let mut out = String::new();
    for count in counts(checked) {
        let Count { code, title, .. } = count;
        let fixable = match (count.safe, count.r#unsafe) {
            (0, 0) => String::new(),
            (0, more) => format!(" ({more} with an unsafe fix)"),
            (safe, 0) => format!(" ({safe} with a safe fix)"),
            (safe, more) => format!(" ({safe} with a safe fix, {more} with an unsafe fix)"),
        };
        let files = crate::report::plural(count.files, "file");
        out.push_str(&format!(
            "{:>7}  {code}  {title} in {files}{fixable}\n",
            count.findings
        ));
    }
    out
}

/// The same as JSON.
pub(super) fn json(checked: &[Checked]) -> String {
    // Numbers and texts cannot fail to serialise.
    let value = serde_json::to_value(counts(checked)).unwrap_or_default();
    format!("{value:#}")
}
