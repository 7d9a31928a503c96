//! `odkit check`: what is wrong with EDS and DCF files.

use std::fs;

use od_model::{Diagnostic, eds};

use crate::output::{self, Output};
use crate::{Failure, report, source};

/// Check EDS and DCF files, with source line and caret
#[derive(clap::Args)]
pub(crate) struct Args {
    /// The files
    #[arg(required = true, value_name = "FILE")]
    files: Vec<String>,
}

pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    let mut output = Output::new();
    let mut all: Vec<Diagnostic> = Vec::new();
    let mut unreadable = 0;
    for path in &args.files {
        let bytes = match fs::read(path) {
            Ok(bytes) => bytes,
            Err(error) => {
                unreadable += 1;
                output.flush()?;
                output::error(&format!("{path}: {}", source::read_error(&error)));
                continue;
            }
        };
        let text = eds::decode(&bytes);
        let mut diagnostics = eds::load(&text).diagnostics;
        let shown = report::render(path, &text, &diagnostics, output::colours());
        if !shown.is_empty() && !output.line(shown.trim_end())? {
            break;
        }
        if !shown.is_empty() {
            output.line("")?;
        }
        all.append(&mut diagnostics);
    }
    let files = report::plural(args.files.len() - unreadable, "file");
    let found = report::count(all.iter()).unwrap_or_else(|| "nothing to report".into());
    let mut summary = format!("{files} checked: {found}");
    if unreadable > 0 {
        summary = format!(
            "{summary}; {} not readable",
            report::plural(unreadable, "file")
        );
    }
    output.line(&summary)?;
    output.flush()?;
    if unreadable > 0 || all.iter().any(Diagnostic::is_error) {
        return Err(Failure::Reported(1));
    }
    Ok(())
}
