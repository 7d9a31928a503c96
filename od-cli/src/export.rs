//! `odkit export`: the EDS of a device.

use od_model::eds;

use crate::output::{self, Output};
use crate::source::Source;
use crate::{Failure, report};

/// Write the EDS of a built-in device, or a file in its canonical form
#[derive(clap::Args)]
pub(crate) struct Args {
    /// Built-in device, or EDS or DCF file
    #[arg(value_name = "DEVICE|FILE")]
    device: String,
    /// File to write; standard output where none is given
    #[arg(long, short, value_name = "FILE")]
    output: Option<std::path::PathBuf>,
}

pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    let text = match Source::find(&args.device)? {
        Source::BuiltIn(kind) => kind.eds(),
        Source::File { path, text } => canonical(&path, &text)?,
    };
    if let Some(path) = &args.output {
        return std::fs::write(path, text).map_err(|error| {
            Failure::Failed(format!("{} cannot be written: {error}", path.display()))
        });
    }
    let mut output = Output::new();
    for line in text.lines() {
        if !output.line(line)? {
            return Ok(());
        }
    }
    output.flush().map(|_| ())
}

/// A file as the writer writes it. What could not be read keeps its text, and is told.
fn canonical(path: &str, text: &str) -> Result<String, Failure> {
    let parsed = eds::parse(text);
    if parsed.description.objects.is_empty() {
        return Err(Failure::Failed(format!(
            "{path} describes no object; is it an EDS or DCF file?"
        )));
    }
    let errors: Vec<_> = parsed
        .diagnostics
        .into_iter()
        .filter(|d| d.is_error())
        .collect();
    output::note_text(&report::render(
        path,
        text,
        &errors,
        output::error_colours(),
    ));
    Ok(eds::write(&parsed.description))
}
