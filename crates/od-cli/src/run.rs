//! `odkit run`: a script on a device in virtual time.

use std::path::Path;

use od_runtime::NodeId;
use od_sim::script;
use od_sim::script::{Reason, Script};

use crate::failure::{Failure, read_error};
use crate::files;
use crate::output::{self, Output, note};
use crate::terminal::Terminal;
use crate::{report, source};

/// Run a script in virtual time: candump lines in, candump lines out
///
/// Exit code 0: every expectation held; 1: an expectation failed (it is shown with the frame or
/// value that came instead); 2: the script cannot be read or carried out. The same script gives the
/// same output.
#[derive(clap::Args)]
pub(crate) struct Args {
    /// The script, or `-` for standard input
    script: String,
    /// Built-in device or EDS file for a script without a `device` line
    #[arg(long, default_value = "gxmm", value_name = "DEVICE|FILE")]
    device: String,
    /// Node ID of that device
    #[arg(long, value_name = "N", value_parser = source::node_id)]
    node_id: Option<NodeId>,
    /// Seed of what `random` lines draw
    #[arg(long, value_name = "N", default_value_t = 0)]
    seed: u64,
    /// Also print the frames that the script sends
    #[arg(long)]
    echo: bool,
}

pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    let script = script_of(&args.script, &read(&args.script)?)?;
    let unnamed = (args.device.as_str(), args.node_id);
    let mut host = Terminal::beside(Path::new(&args.script), unnamed);
    host.output = Some(Output::new());
    host.echo = args.echo;
    host.seed = args.seed;
    let result = script::run(&script, &mut host);
    if let Some(mut output) = host.output {
        output.flush()?;
    }
    if let Some(Failure::Failed(message)) = host.broken {
        return Err(Failure::Failed(message));
    }
    match result {
        Ok(summary) => {
            if summary.held > 0 {
                let count = report::plural(summary.held, "expectation");
                note!("{count} held, {:?} s", summary.end);
            }
            Ok(())
        }
        Err(stop) => {
            let message = format!("{}: {stop}", args.script);
            output::error(&message);
            Err(Failure::Reported(match stop.reason {
                Reason::Failed { .. } => 1,
                Reason::Impossible(_) => 2,
            }))
        }
    }
}

/// The lines of a script; mistakes are printed.
pub(crate) fn script_of(path: &str, text: &str) -> Result<Script, Failure> {
    Script::parse(text).map_err(|problems| {
        let lines = problems.iter().map(|problem| format!("{path}:{problem}"));
        output::problems(path, lines);
        let count = report::plural(problems.len(), "line");
        Failure::Usage(format!("{path}: {count} cannot be read; see SCRIPTS.md"))
    })
}

/// The text of a script, or of standard input.
pub(crate) fn read(path: &str) -> Result<String, Failure> {
    match files::read_or_stdin(path) {
        Ok(bytes) => String::from_utf8(bytes)
            .map_err(|_| Failure::Usage(format!("{path}: the file is not UTF-8"))),
        Err(error) => Err(Failure::Usage(format!("{path}: {}", read_error(&error)))),
    }
}
