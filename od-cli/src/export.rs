//! `odkit export`: the EDS of a device.

use crate::Failure;
use crate::output::{self, Output};
use crate::source::{Source, Text};

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
        Source::BuiltIn(kind) => od_devices::text::eds(kind),
        Source::File(file) => canonical(&file)?,
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
fn canonical(file: &Text) -> Result<String, Failure> {
    let (description, findings) = file.parse()?;
    let errors: Vec<_> = findings.into_iter().filter(|d| d.is_error()).collect();
    output::note_text(&file.render(&errors, output::error_colours()));
    Ok(od_eds::canonical(&description))
}
