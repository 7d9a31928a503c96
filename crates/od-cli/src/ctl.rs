//! `odkit ctl`: sends lines to a running bench of `odkit sim`.

use std::io::{BufRead, BufReader, ErrorKind, Write};

use clap::ValueEnum;
use od_sim::serve::ControlAddress;

use crate::failure::Failure;
use crate::output::Output;

/// Send lines to a running `odkit sim --control PATH`
///
/// The lines are those that `odkit sim --link -` accepts (SCRIPTS.md): `power cycle 2s`,
/// `shaft rpm 60`, `fault battery-low on`, `set 1017h = 500`, `emcy 4200h`, `use 2`, frames; and
/// `stats`. Each line gets its answer when it is done. A frame is done when the bus line has carried it.
///
/// Exit code 0: every line is done; 1: no bench answers, or it cannot carry out a line; 2: a
/// line cannot be read. The lines after it are not sent.
#[derive(clap::Args)]
pub(crate) struct Args {
    /// Control socket: unix:PATH, tcp:HOST:PORT, or a path
    #[arg(value_parser = ControlAddress::parse)]
    address: ControlAddress,
    /// Lines to send, one argument each
    #[arg(value_name = "LINE", required = true)]
    lines: Vec<String>,
    /// Format of `stats`
    #[arg(long, default_value = "text")]
    format: Format,
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Format {
    Text,
    Json,
}

pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    let address = &args.address;
    let lost = |error: std::io::Error| {
        Failure::Failed(match error.kind() {
            ErrorKind::NotFound | ErrorKind::ConnectionRefused => {
                format!("{address}: no `odkit sim --control {address}` runs here")
            }
            _ => format!("{address}: {error}"),
        })
    };
    let mut connection = BufReader::new(address.connect().map_err(lost)?);
    let mut output = Output::new();
    for line in args.lines.iter().flat_map(|text| text.lines()) {
        let sent = match line.trim() {
            "stats" if args.format == Format::Json => "stats json",
            line => line,
        };
        let stream = connection.get_mut();
        let written = stream.write_all(format!("{sent}\n").as_bytes());
        // A bench that refuses the connection gives the reason.
        let written = written.and_then(|()| stream.flush());
        loop {
            let mut answer = String::new();
            let read = connection.read_line(&mut answer).map_err(lost)?;
            if read == 0 {
                written.map_err(lost)?;
                return Err(Failure::Failed(format!("{address}: odkit sim has ended")));
            }
            let answer = answer.trim_end();
            let (kind, text) = answer.split_once(' ').unwrap_or((answer, ""));
            let message = || format!("`{line}`: {text}");
            match kind {
                "|" => {
                    output.line(text)?;
                    continue;
                }
                "ok" if text.is_empty() => {}
                "ok" => {
                    output.line(text)?;
                }
                "wrong" => return Err(Failure::Usage(message())),
                _ => return Err(Failure::Failed(message())),
            }
            break;
        }
        output.flush()?;
    }
    Ok(())
}
