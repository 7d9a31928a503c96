//! `odkit check`: findings in device descriptions, and their fixes.

use std::time::Duration;

use od_eds::Document;
use od_eds::check::parse_allow;
use od_eds::fix;
use od_eds::fix::{Applicability, Held};
use od_eds::tools::{self, Tool};
use od_eds::{Finding, Parsed, Severity};
use similar::TextDiff;

use crate::config::Config;
use crate::failure::Failure;
use crate::files::rewrite;
use crate::output::{self, Output};
use crate::report;
use crate::source::Source;
use crate::workers::at_once;
use checked::{Checked, Summary};

mod checked;
mod files;
mod github;
mod json;
mod lines;
mod sarif;
mod statistics;
mod table;

/// Check EDS and DCF files; show findings with source line and caret, and apply fixes
///
/// `odkit explain CODE` explains a finding. A comment `;odkit-allow=CODE reason` allows a finding:
/// before the first section in the whole file, inside a section for the object of that section.
#[derive(clap::Args)]
#[command(
    after_help = "Exit codes: 0 no errors (with --diff: and nothing to fix), 1 errors, a file that \
                        cannot be read or written, or a diff that is shown, 2 wrong usage"
)]
pub(crate) struct Args {
    /// Files, or folders that are searched for EDS, DCF, XDD and XDC files
    #[arg(required = true, value_name = "FILE|FOLDER")]
    files: Vec<String>,
    /// Apply safe fixes (the meaning of the file does not change)
    #[arg(long)]
    fix: bool,
    /// Also apply unsafe fixes; review the result
    #[arg(long)]
    unsafe_fixes: bool,
    /// Show the fixes as a diff; write nothing
    #[arg(long)]
    diff: bool,
    /// Also report what these tools reject, drop or read differently; `all` shows a table of all tools
    #[arg(long = "for", value_name = "TOOL", value_delimiter = ',', ignore_case = true,
          value_parser = table::names())]
    tools: Vec<String>,
    /// Do not report this rule, or not for this object: `W0311`, `W0311:2000`
    #[arg(long, value_name = "CODE[:INDEX]", value_parser = parse_allow)]
    allow: Vec<(&'static str, Option<u16>)>,
    /// Format of the report
    #[arg(long, visible_alias = "format", value_enum, default_value_t = Format::Full)]
    output_format: Format,
    /// Show how often each rule reports, not the findings
    #[arg(long)]
    statistics: bool,
    /// Show remarks too (JSON and SARIF always contain them)
    #[arg(long)]
    remarks: bool,
    /// Treat warnings as errors
    #[arg(long)]
    strict: bool,
}

#[derive(Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum Format {
    /// Findings with source line and caret
    #[value(alias = "text")]
    Full,
    /// One line for each finding
    Concise,
    /// One line for each finding, below the name of its file
    Grouped,
    /// One JSON object for all files
    Json,
    /// SARIF 2.1.0, for code scanning
    Sarif,
    /// Annotations of GitHub Actions
    Github,
}

impl Args {
    /// Level of the fixes to apply, if any.
    fn level(&self) -> Option<Applicability> {
        match (self.unsafe_fixes, self.fix || self.diff) {
            (true, _) => Some(Applicability::Unsafe),
            (false, true) => Some(Applicability::Safe),
            (false, false) => None,
        }
    }

    fn find(
        &self,
        document: &Document,
        path: &str,
        config: &Config,
        tools: &[&'static Tool],
    ) -> Parsed {
        let mut parsed = document.load();
        if !tools.is_empty() {
            let of_tools = tools::check(document, &parsed.description, tools);
            parsed.findings.extend(of_tools);
            parsed
                .findings
                .sort_by_key(|finding| finding.span().map_or(u32::MAX, |span| span.line));
        }
        config.apply(path, &mut parsed.findings);
        parsed.findings.retain(|finding| {
            let index = finding.object.map(|address| address.index);
            let allows = |(code, object): &(&str, Option<u16>)| {
                *code == finding.code() && (object.is_none() || *object == index)
            };
            !self.allow.iter().any(allows)
        });
        parsed
    }

    /// Reads, checks and fixes one file. A file with an overlay is not fixed: odkit cannot know which of
    /// the two files to change.
    fn check(&self, path: &str) -> Checked {
        let mut checked = match Source::file(path) {
            Ok(file) => Checked::new(file),
            Err(why) => return Checked::unreadable(path, why),
        };
        let config = match Config::of(path) {
            Ok(config) => config,
            Err(why) => {
                checked.misused = Some(why.to_string());
                return checked;
            }
        };
        let named = if self.tools.is_empty() {
            &config.tools
        } else {
            &self.tools
        };
        let (tools, is_table) = table::chosen(named);
        checked.tools.clone_from(&tools);
        let file = &checked.file;
        let is_overlaid = file.is_overlaid();
        match self.level().filter(|_| !is_overlaid) {
            None => {
                let parsed = self.find(file.document(), path, &config, &tools);
                checked.names = report::names(&parsed.description, &parsed.findings);
                checked.findings = parsed.findings;
            }
            Some(level) => {
                let find = |file: &Document| self.find(file, path, &config, &tools).findings;
                let done = fix::fix(file.document(), level, find);
                let description = done.document.parse().description;
                checked.names = report::names(&description, &done.findings);
                if self.diff {
                    checked.shown = difference(path, file.text(), done.document.text());
                } else if done.edits > 0 {
                    checked.failed = rewrite(path, done.document.bytes()).err();
                }
                (checked.fixed, checked.findings) = (done.edits, done.findings);
                checked.held = done.held;
                checked.file.replace(done.document);
            }
        }
        if is_overlaid {
            for finding in &mut checked.findings {
                finding.fix = None;
            }
        }
        let remarks = self.remarks || config.remarks;
        checked.strict = config.strict;
        if !self.statistics && (is_overlaid || !self.diff) {
            let wanted = |finding: &&Finding| remarks || finding.severity() > Severity::Info;
            let wanted: Vec<_> = checked.findings.iter().filter(wanted).cloned().collect();
            checked.shown = match self.output_format {
                Format::Full if is_table => table::of(&checked),
                Format::Full => checked
                    .file
                    .render(&wanted, &checked.names, output::colours()),
                Format::Concise => lines::concise(&checked, wanted),
                Format::Grouped => lines::grouped(&checked, wanted),
                _ => String::new(),
            };
        }
        checked
    }
}

pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    let paths = files::find(&args.files);
    let checked = at_once(&paths, |path| args.check(path));
    if let Some(why) = checked.iter().find_map(|file| file.misused.clone()) {
        return Err(Failure::Usage(why));
    }
    let summary = Summary::of(&checked);
    let mut output = Output::new();
    match args.output_format {
        Format::Json if args.statistics => drop(output.line(&statistics::json(&checked))?),
        _ if args.statistics => {
            let counts = statistics::text(&checked);
            if !counts.is_empty() {
                output.line(counts.trim_end())?;
            }
            text(args, &checked, &summary, &mut output)?;
        }
        _ if args.diff => text(args, &checked, &summary, &mut output)?,
        Format::Full | Format::Concise | Format::Grouped => {
            text(args, &checked, &summary, &mut output)?;
        }
        Format::Json => drop(output.line(&json::report(&checked, &summary))?),
        Format::Sarif => drop(output.line(&sarif::report(&checked))?),
        Format::Github => {
            for file in &checked {
                for line in github::lines(file, args.remarks) {
                    output.line(&line)?;
                }
            }
        }
    }
    output.flush()?;
    for file in &checked {
        if let Some(why) = &file.failed {
            output::error(&format!("{}: {why}", file.file.path));
        }
    }
    let warned = |file: &Checked| {
        let mut findings = file.findings.iter();
        findings.any(|finding| finding.severity() == Severity::Warning)
    };
    let strict = checked
        .iter()
        .any(|file| (args.strict || file.strict) && warned(file));
    let wrong = summary.errors > 0 || strict;
    if wrong || summary.failed > 0 || args.diff && summary.fixed > 0 {
        return Err(Failure::Reported(1));
    }
    Ok(())
}

/// Fixes that are held back; the text report gives the reasons.
const HELD: usize = 20;

fn text(
    args: &Args,
    checked: &[Checked],
    summary: &Summary,
    output: &mut Output,
) -> Result<(), Failure> {
    let apart = args.output_format != Format::Concise;
    for file in checked.iter().filter(|file| !file.shown.is_empty()) {
        let shown = file.shown.trim_end();
        let goes_on = match args.output_format {
            Format::Full if !args.diff => output.coloured(shown)?,
            _ => output.line(shown)?,
        };
        if !goes_on || apart && !output.line("")? {
            return Ok(());
        }
    }
    let all = checked.iter().flat_map(|file| &file.findings);
    let mut line = format!("{} checked", report::plural(summary.files, "file"));
    let mut sign = ",";
    if summary.files > 0 {
        let found = report::count(all).unwrap_or_else(|| "nothing to report".into());
        line = format!("{line}: {found}");
        sign = ";";
    }
    if summary.fixed > 0 {
        let places = report::plural(summary.fixed, "place");
        let how = if args.diff { " as shown" } else { "" };
        line = format!("{line}{sign} {places} fixed{how}");
    }
    // Only a file that could be read has fixes.
    let unwritten = |file: &&Checked| file.failed.is_some() && file.fixed > 0;
    let unwritten = checked.iter().filter(unwritten).count();
    for (count, what) in [(summary.failed - unwritten, "read"), (unwritten, "written")] {
        if count > 0 {
            let files = report::plural(count, "file");
            line = format!("{line}{sign} {files} could not be {what}");
        }
    }
    output.line(&line)?;
    let held = |file: &Checked| {
        let path = file.file.path.clone();
        let line = move |held: &Held| {
            let line = held.finding.span().map_or(0, |span| span.line);
            let code = held.finding.code();
            format!(
                "{path}:{line}: the fix of {code} is held back: {}",
                held.why
            )
        };
        file.held.iter().map(line).collect::<Vec<_>>()
    };
    let held: Vec<String> = checked.iter().flat_map(held).collect();
    for line in held.iter().take(HELD) {
        output.line(line)?;
    }
    if let Some(more @ 1..) = held.len().checked_sub(HELD) {
        output.line(&format!(
            "{more} more held back; `--output-format json` lists all"
        ))?;
    }
    for hint in hints(args, checked, summary) {
        output.line(&hint)?;
    }
    Ok(())
}

/// Lines that name the options for remarks and fixes.
fn hints(args: &Args, checked: &[Checked], summary: &Summary) -> Vec<String> {
    let mut hints = Vec::new();
    if summary.remarks > 0 && !args.remarks && !args.diff {
        hints.push("add `--remarks` to show remarks".to_owned());
    }
    let fixable = |level| {
        let all = checked.iter().flat_map(|file| &file.findings);
        let fixes = all.filter_map(|finding| finding.fix.as_ref());
        let count = fixes.filter(|fix| fix.applicability == level).count();
        count * usize::from(args.level().is_none_or(|own| own < level))
    };
    let finding = |count| report::plural(count, "finding");
    match (fixable(Applicability::Safe), fixable(Applicability::Unsafe)) {
        (0, 0) => {}
        (0, more) => hints.push(format!("{} fixable with `--unsafe-fixes`", finding(more))),
        (safe, 0) => hints.push(format!("{} fixable with `--fix`", finding(safe))),
        (safe, more) => hints.push(format!(
            "{} fixable with `--fix`, {more} more with `--unsafe-fixes`",
            finding(safe)
        )),
    }
    hints
}

/// Time after which a diff of many lines shows more lines than it must.
const DIFF_TIME: Duration = Duration::from_millis(500);

/// A unified diff between two texts; empty if they are equal.
fn difference(path: &str, before: &str, after: &str) -> String {
    let mut config = TextDiff::configure();
    let diff = config.timeout(DIFF_TIME).diff_lines(before, after);
    let shown = diff
        .unified_diff()
        .context_radius(3)
        .header(path, path)
        .to_string();
    // A carriage return would move the cursor of a terminal back.
    shown.replace('\r', "")
}
