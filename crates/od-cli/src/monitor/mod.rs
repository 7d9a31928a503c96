//! `odkit monitor`: shows the frames of a bus as they are received.

mod screen;
mod stats;

use std::io::IsTerminal;
use std::path::PathBuf;

use od_tools::Error;
use od_tools::filter::Filter;
use od_tools::link::Link;
use od_wire::Instant;

use self::stats::Stats;
use crate::bus::words::Narrator;
use crate::bus::{self, Bus, Format};
use crate::failure::Failure;
use crate::output::{self, Output};
use crate::record::{self, Recorder};

/// Bit rate in kbit/s for the bus load if none is given.
const RATE: u16 = 500;

/// Show the frames of a bus in words, until Ctrl-C
///
/// On a terminal: in order or by COB-ID with rates and jitter (Tab), filter (/), pause (Space), record
/// (r), quit (q). With --plain, or into a pipe, a line for each frame.
#[derive(clap::Args)]
pub(crate) struct Args {
    /// Lines instead of a console
    #[arg(long)]
    plain: bool,
    /// One line for each COB-ID, with rate and jitter; with --plain at the end
    #[arg(long)]
    by_id: bool,
    /// Frames that are shown: `node:5 sdo`, `185:7FF`, `position`, `!hb`, `(emcy or nmt)`
    #[arg(long, value_name = "FILTER", default_value = "")]
    filter: String,
    /// File for all frames: candump (.log) or pcapng. It replaces a log of this format; any other file
    /// is refused
    #[arg(long, value_name = "FILE")]
    record: Option<PathBuf>,
    /// Stop after this time, in seconds
    #[arg(long = "for", value_name = "SECONDS")]
    time: Option<f64>,
    /// Stop after this number of frames that are shown
    #[arg(long, value_name = "N")]
    count: Option<usize>,
    #[command(flatten)]
    bus: bus::Args,
}

pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    let names = args.bus.names()?;
    let wrong = |mistake| Failure::Usage(format!("--filter: {mistake}"));
    let filter = Filter::parse(&args.filter).map_err(wrong)?;
    let rate = args.bus.bit_rate.unwrap_or(RATE);
    let name = args.bus.name()?;
    let bus = args.bus.open()?;
    let mut recorder = args.record.as_deref().map(Recorder::create).transpose()?;
    let until = record::end(&bus, args.time);
    let is_console = !args.plain
        && args.count.is_none()
        && args.bus.format == Format::Text
        && std::io::stdout().is_terminal()
        && std::io::stdin().is_terminal();
    let result = if is_console {
        let narrator = Narrator::new(names, "")?;
        let view = screen::View {
            title: name,
            rate,
            by_id: args.by_id,
            filter,
            filter_text: args.filter.clone(),
        };
        screen::run(bus, narrator, view, &mut recorder, until)
    } else {
        let narrator = Narrator::new(names, &args.filter)?;
        plain(args, bus, narrator, recorder.as_mut(), (rate, until))
    };
    // Frames received before an error are kept.
    if let Some(recorder) = recorder {
        output::note!("{}", recorder.finish()?);
    }
    result
}

fn plain(
    args: &Args,
    mut bus: Bus,
    mut narrator: Narrator,
    mut recorder: Option<&mut Recorder>,
    (rate, until): (u16, Instant),
) -> Result<(), Failure> {
    let mut output = Output::new();
    let mut stats = Stats::default();
    let mut shown = 0;
    let result = loop {
        if args.count.is_some_and(|count| shown >= count) {
            break Ok(());
        }
        let heard = match bus.receive(until) {
            Ok(Some(heard)) if heard.at <= until => heard,
            Ok(_) | Err(Error::Interrupted) => break Ok(()),
            Err(fault) => break Err(fault.into()),
        };
        if let Some(recorder) = &mut recorder {
            recorder.add(heard.at, &heard.frame)?;
        }
        let Some(told) = narrator.tell(heard.at, heard.frame, false) else {
            continue;
        };
        shown += 1;
        let goes_on = match (args.by_id, args.bus.format) {
            (true, _) => {
                stats.add(&told);
                true
            }
            (false, Format::Text) => output.line(&told.line())?,
            (false, Format::Json) => {
                let fields = narrator.fields(&told.frame);
                output.line(&told.json(&fields).to_string())?
            }
        };
        if !(goes_on && output.flush()?) {
            break Ok(());
        }
    };
    drop(output);
    if args.by_id {
        output::print(&match args.bus.format {
            Format::Text => stats.table().join("\n"),
            Format::Json => format!("{:#}", stats.json(bus.now(), rate)),
        })?;
    }
    result
}
