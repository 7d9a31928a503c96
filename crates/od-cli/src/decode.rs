//! `odkit decode`: logs in words, CSV or JSON.

use std::path::{Path, PathBuf};

use od_sim::dbc::Database;
use od_sim::diagnose::other_protocol;
use od_sim::logs::{self, Log, What};

use crate::bus::names::Names;
use crate::bus::words::{CSV, Narrator};
use crate::failure::{Failure, read_error};
use crate::files;
use crate::output::{self, Output, note};
use crate::report::{plural, plural_of};

/// Show logs in words, as CSV or as JSON
///
/// Reads candump, ASC, BLF, TRC (1.0 to 2.1), pcap, pcapng, CSV and text of other programs. With --eds values have names and types.
///
/// Exit code 0: all lines were read; 1: a file is not a log, or lines of it could not be read.
#[derive(clap::Args)]
pub(crate) struct Args {
    /// Logs; `-` is standard input
    #[arg(value_name = "LOG", required = true)]
    logs: Vec<PathBuf>,
    /// Names and types: built-in device, or EDS or DCF file, of the node with this ID, or of all nodes;
    /// may be repeated
    #[arg(long, value_name = "[ID=]FILE")]
    eds: Vec<String>,
    /// DBC file whose signals are shown beside each frame, with name, value and unit; may be repeated
    #[arg(long, value_name = "FILE")]
    dbc: Vec<PathBuf>,
    /// Frames that are shown: `node:5 sdo`, `185:7FF`, `position`, `!hb`
    #[arg(long, value_name = "FILTER", default_value = "")]
    filter: String,
    /// Format of the output
    #[arg(long, value_enum, default_value = "text")]
    format: Format,
}

#[derive(Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum Format {
    /// A line for each frame
    Text,
    /// A row for each frame
    Csv,
    /// One JSON object with all frames and their values
    Json,
}

pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    let mut read = Vec::new();
    for path in &args.logs {
        read.push((path.display(), read_log(path)?));
    }
    let databases = args
        .dbc
        .iter()
        .map(|path| database(path))
        .collect::<Result<Vec<_>, _>>()?;
    let mut skipped = 0;
    let mut output = Output::new();
    let mut frames = Vec::new();
    if args.format == Format::Csv {
        let signals = if args.dbc.is_empty() { "" } else { ",signals" };
        output.line(&format!("{CSV}{signals}"))?;
    }
    for (path, log) in read {
        // A transfer does not continue in the next log.
        let narrator = Narrator::new(Names::read(&args.eds)?, &args.filter)?;
        let mut narrator = narrator.with_databases(databases.clone());
        if log.lacks_times {
            note!("{path}: the log has no times; `candump -ta` or `candump -L` writes them");
        }
        if let [first, .., last] = &log.channels[..] {
            let count = log.channels.len();
            note!("{path}: the frames of {count} channels ({first} to {last}) are shown together");
        }
        if let Some(why) = other_protocol(&log.records) {
            note!("{path}: this is not CANopen: {why}");
        }
        skipped += log.skipped.len();
        for record in &log.records {
            let frame = match record.what {
                What::Frame(frame) => frame,
                What::Error(error) => {
                    let is_all = args.filter.is_empty() && args.format == Format::Text;
                    if is_all {
                        let at = format!("{:?}", record.at);
                        output.line(&format!("{at:>12}  {}", error.text()))?;
                    }
                    continue;
                }
            };
            let Some(told) = narrator.tell(record.at, frame, record.sent) else {
                continue;
            };
            let goes_on = match args.format {
                Format::Text => output.line(&told.line())?,
                Format::Csv => output.line(&told.csv())?,
                Format::Json => {
                    frames.push(told.json(&narrator.fields(&told.frame)));
                    true
                }
            };
            if !goes_on {
                return Ok(());
            }
        }
    }
    output.flush()?;
    drop(output);
    if args.format == Format::Json {
        let report = serde_json::json!({ "frames": frames, "skipped": skipped });
        output::print(&format!("{report:#}"))?;
    }
    match skipped {
        0 => Ok(()),
        count => Err(Failure::Failed(format!(
            "{} could not be read",
            plural(count, "line")
        ))),
    }
}

/// Reads a log, from standard input if the path is `-`, and reports lines that are not frames.
///
/// # Errors
/// The file cannot be read, or it is not a log.
pub(crate) fn read_log(path: &Path) -> Result<Log, Failure> {
    let shown = path.display();
    let failed = |why: String| Failure::Failed(format!("{shown}: {why}"));
    let bytes = files::read_or_stdin(path).map_err(|error| failed(read_error(&error)))?;
    let log = logs::read(&bytes).map_err(|why| failed(why.to_string()))?;
    let skipped = log.skipped.iter().map(|line| format!("{shown}: {line}"));
    output::problems(&shown, skipped);
    if log.others > 0 {
        let entries = plural_of(log.others, "entry", "entries");
        note!("{shown}: not CAN frames (events, other protocols): {entries}");
    }
    Ok(log)
}

fn database(path: &Path) -> Result<Database, Failure> {
    let failed = |why: String| Failure::Failed(format!("{}: {why}", path.display()));
    let bytes = crate::files::read(path).map_err(|error| failed(read_error(&error)))?;
    let database = Database::read(&bytes).map_err(|why| failed(why.to_string()))?;
    if database.left_out() > 0 {
        let signals = plural_of(database.left_out(), "signal", "signals");
        note!(
            "{}: not shown, as no frame of 8 bytes can hold them: {signals}",
            path.display()
        );
    }
    Ok(database)
}
