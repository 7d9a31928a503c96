//! `--for all`: a line for each tool.

use clap::builder::{PossibleValue, PossibleValuesParser};
use od_eds::tools::{TOOLS, Tool, Verdict, tool};
use od_eds::{Eds, Finding, say};

use super::checked::Checked;
use crate::report;

/// All tools, as a table.
const ALL: &str = "all";

/// The values that `--for` accepts.
pub(super) fn names() -> PossibleValuesParser {
    let of = |tool: &&'static Tool| PossibleValue::new(tool.name).help(tool.source);
    let all = PossibleValue::new(ALL).help("A table of all tools instead of the findings");
    PossibleValuesParser::new(TOOLS.iter().map(of).chain([all]))
}

/// The tools with these names; `true` if all are shown as a table.
pub(super) fn chosen(names: &[String]) -> (Vec<&'static Tool>, bool) {
    if names.iter().any(|name| name.eq_ignore_ascii_case(ALL)) {
        return (TOOLS.to_vec(), true);
    }
    let mut chosen: Vec<&'static Tool> = Vec::new();
    for tool in names.iter().filter_map(|name| tool(name)) {
        if !chosen.contains(&tool) {
            chosen.push(tool);
        }
    }
    (chosen, false)
}

/// The path, then a line for odkit and each tool: name, verdict, first finding.
pub(super) fn of(checked: &Checked) -> String {
    let is_own = |finding: &&Finding| !finding.code().starts_with('T');
    let own: Vec<Finding> = checked.findings.iter().filter(is_own).cloned().collect();
    let count = report::count(own.iter()).unwrap_or_else(|| "nothing to report".into());
    let mut rows = vec![("odkit".to_owned(), count, String::new())];
    for tool in &checked.tools {
        let findings = checked.of_tool(tool);
        let name = format!(
            "{} {}",
            tool.name,
            if tool.tried {
                tool.version
            } else {
                "(not tried)"
            }
        );
        let verdict = match checked.verdict(tool) {
            verdict if verdict == Verdict::Accepts.name() && !tool.tried => "no known fault",
            verdict => verdict,
        };
        rows.push((name, verdict.to_owned(), first(&findings, tool)));
    }
    let width = |column: fn(&(String, String, String)) -> &String| {
        let widths = rows.iter().map(|row| column(row).chars().count());
        widths.max().unwrap_or(0)
    };
    let (names, verdicts) = (width(|row| &row.0), width(|row| &row.1));
    let mut out = format!("{}\n", checked.file.path);
    for (name, verdict, first) in &rows {
        let line = format!("  {name:names$}  {verdict:verdicts$}  {first}");
        out.push_str(line.trim_end());
        out.push('\n');
    }
    out
}

/// The most severe findings in short, such as `17: the line is not valid (and 2 more)`.
fn first(findings: &[Finding], tool: &Tool) -> String {
    let gravest = findings.iter().map(Finding::severity).max();
    let of_rank = || findings.iter().filter(|it| Some(it.severity()) == gravest);
    let Some(finding) = of_rank().next() else {
        return String::new();
    };
    let sentence = say(finding, &Eds);
    let place = sentence
        .span
        .map_or(String::new(), |span| format!("{}: ", span.line));
    let object = sentence
        .address
        .map_or(String::new(), |at| format!("{at}: "));
    let message = sentence.message.replace(['\r', '\n'], " ");
    let message = message
        .strip_prefix(tool.name)
        .unwrap_or(&message)
        .trim_start();
    let message = message
        .strip_prefix("rejects the file: ")
        .unwrap_or(message);
    let more = match of_rank().count() - 1 {
        0 => String::new(),
        more => format!(" (and {more} more)"),
    };
    format!("{place}{object}{message}{more}")
}
