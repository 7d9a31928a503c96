//! `odkit check`: what is wrong with EDS and DCF files, and mending it.

use od_eds::Document;
use od_eds::check::parse_allow;
use od_eds::fix;
use od_eds::fix::Applicability;
use od_eds::{Finding, Severity};

use crate::failure::Failure;
use crate::output::{self, Output};
use crate::report;
use crate::source::Source;
use checked::{Checked, Summary};

mod checked;
mod files;
mod github;
mod json;
mod mend;
mod sarif;

/// Check EDS and DCF files, with source line and caret; mend what can be mended
///
/// `odkit explain CODE` says what a finding means. A comment `;odkit-allow=CODE reason` allows a
/// finding: before the first section for the whole file, in a section for what it is about.
#[derive(clap::Args)]
#[command(
    after_help = "Exit codes: 0 no errors (and nothing for --diff to show), 1 errors are left, \
                        a file cannot be read or written, or --diff shows something, 2 wrong usage"
)]
pub(crate) struct Args {
    /// Files, and folders to look for EDS and DCF files in
    #[arg(required = true, value_name = "FILE|FOLDER")]
    files: Vec<String>,
    /// Mend what can be mended without changing what a file says
    #[arg(long)]
    fix: bool,
    /// Mend also by likely guesses: look at the result
    #[arg(long)]
    unsafe_fixes: bool,
    /// Show what would be mended, as a diff; write nothing
    #[arg(long)]
    diff: bool,
    /// Do not report this code, or not for this object: `W0311`, `W0311:2000`
    #[arg(long, value_name = "CODE[:INDEX]", value_parser = parse_allow)]
    allow: Vec<(&'static str, Option<u16>)>,
    /// How to report
    #[arg(long, value_enum, default_value_t = Format::Text)]
    format: Format,
    /// Show remarks, too (the machine formats always have them)
    #[arg(long)]
    remarks: bool,
    /// Warnings count as errors do
    #[arg(long)]
    strict: bool,
}

#[derive(Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum Format {
    /// Source line and caret
    Text,
    /// One object for all files
    Json,
    /// SARIF 2.1.0, for code scanning
    Sarif,
    /// Annotations of GitHub Actions
    Github,
}

impl Args {
    /// How far fixes go, if there are to be any.
    fn level(&self) -> Option<Applicability> {
        match (self.unsafe_fixes, self.fix || self.diff) {
            (true, _) => Some(Applicability::Unsafe),
            (false, true) => Some(Applicability::Safe),
            (false, false) => None,
        }
    }

    fn find(&self, document: &Document) -> Vec<Finding> {
        let mut findings = document.load().diagnostics;
        findings.retain(|finding| {
            let index = finding.object.map(|address| address.index);
            let allows = |(code, object): &(&str, Option<u16>)| {
                *code == finding.code() && (object.is_none() || *object == index)
            };
            !self.allow.iter().any(allows)
        });
        findings
    }

    /// Reads, checks and mends one file. An overlaid one is not mended: nobody knows in which
    /// of its files.
    fn check(&self, path: &str) -> Checked {
        let mut checked = match Source::file(path) {
            Ok(file) => Checked::new(file),
            Err(why) => return Checked::unreadable(path, why),
        };
        let file = &checked.file;
        let is_overlaid = file.is_overlaid();
        match self.level().filter(|_| !is_overlaid) {
            None => checked.findings = self.find(file.document()),
            Some(level) => {
                let mended = fix::mend(file.document(), level, |file| self.find(file));
                if self.diff {
                    checked.shown = mend::difference(path, file.text(), mended.document.text());
                } else if mended.edits > 0 {
                    checked.failed = mend::write(path, mended.document.bytes()).err();
                }
                (checked.mended, checked.findings) = (mended.edits, mended.findings);
                checked.file.replace(mended.document);
            }
        }
        if is_overlaid {
            for finding in &mut checked.findings {
                finding.fix = None;
            }
        }
        if self.format == Format::Text && (is_overlaid || !self.diff) {
            let wanted = |finding: &&Finding| self.remarks || finding.severity() > Severity::Info;
            let wanted: Vec<_> = checked.findings.iter().filter(wanted).cloned().collect();
            checked.shown = checked.file.render(&wanted, output::colours());
        }
        checked
    }
}

pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    let paths = files::find(&args.files);
    let checked = files::at_once(&paths, |path| args.check(path));
    let summary = Summary::of(&checked);
    let mut output = Output::new();
    match args.format {
        _ if args.diff => text(args, &checked, &summary, &mut output)?,
        Format::Text => text(args, &checked, &summary, &mut output)?,
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
    let wrong = summary.errors > 0 || args.strict && summary.warnings > 0;
    if wrong || summary.failed > 0 || args.diff && summary.mended > 0 {
        return Err(Failure::Reported(1));
    }
    Ok(())
}

fn text(
    args: &Args,
    checked: &[Checked],
    summary: &Summary,
    output: &mut Output,
) -> Result<(), Failure> {
    for file in checked {
        if !file.shown.is_empty() && (!output.line(file.shown.trim_end())? || !output.line("")?) {
            return Ok(());
        }
    }
    let all = checked.iter().flat_map(|file| &file.findings);
    let found = report::count(all).unwrap_or_else(|| "nothing to report".into());
    let files = report::plural(summary.files, "file");
    let mut line = format!("{files} checked: {found}");
    if summary.mended > 0 {
        let places = report::plural(summary.mended, "place");
        line = match args.diff {
            true => format!("{line}, with {places} mended as shown"),
            false => format!("{line}, {places} mended"),
        };
    }
    // Only what was read could be mended.
    let unwritten = |file: &&Checked| file.failed.is_some() && file.mended > 0;
    let unwritten = checked.iter().filter(unwritten).count();
    for (count, what) in [
        (summary.failed - unwritten, "readable"),
        (unwritten, "writable"),
    ] {
        if count > 0 {
            let files = report::plural(count, "file");
            line = format!("{line}; {files} not {what}");
        }
    }
    output.line(&line)?;
    for hint in hints(args, checked, summary) {
        output.line(&hint)?;
    }
    Ok(())
}

/// What else could be done about it.
fn hints(args: &Args, checked: &[Checked], summary: &Summary) -> Vec<String> {
    let mut hints = Vec::new();
    if summary.remarks > 0 && !args.remarks && !args.diff {
        hints.push("remarks are not shown: `--remarks` shows them".to_owned());
    }
    let fixes = |level| {
        let all = checked.iter().flat_map(|file| &file.findings);
        all.filter_map(|finding| finding.fix.as_ref())
            .filter(|fix| fix.applicability == level)
            .count()
    };
    for (level, option) in [
        (Applicability::Safe, "--fix"),
        (Applicability::Unsafe, "--unsafe-fixes"),
    ] {
        let count = fixes(level);
        if count > 0 && args.level().is_none_or(|own| own < level) {
            let count = report::plural(count, "finding");
            hints.push(format!("`{option}` mends {count}"));
        }
    }
    hints
}
