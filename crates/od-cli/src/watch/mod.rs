//! `odkit watch`: values of a node over time.

mod plot;

use std::fs::File;
use std::io::{BufWriter, IsTerminal, Write};
use std::path::PathBuf;

use od_model::{DataType, Dictionary, Visible};
use od_runtime::NodeId;
use od_tools::Error;
use od_tools::master::Master;
use od_tools::objects::{self, Asked};
use od_tools::watch::{self, By, Sample, Source};
use od_wire::Duration;
use serde_json::json;

use self::plot::Plot;
use crate::bus::{self, Format, value};
use crate::failure::Failure;
use crate::files;
use crate::output::{Output, note};
use crate::{record, source};

/// Watch values of a node, until Ctrl-C
///
/// Values that a valid TPDO maps come from it; others are polled by SDO, as are those of a node that
/// sends no TPDOs for a second. A terminal shows a plot, a pipe gets a line for each value. The reason why a value
/// cannot be read is one line until it changes; JSON and CSV have a line for each attempt.
///
/// Exit code 0: all values were read; 1: at least one could not be read.
#[derive(clap::Args)]
pub(crate) struct Args {
    /// Node ID
    #[arg(value_name = "NODE", value_parser = source::node_id)]
    node: NodeId,
    /// Objects: index, name or glob
    #[arg(value_name = "OBJECT", required = true)]
    objects: Vec<String>,
    /// Time between two polls, in ms
    #[arg(long, value_name = "MS", default_value = "200")]
    every: u64,
    /// Stop after this time, in seconds
    #[arg(long = "for", value_name = "SECONDS")]
    time: Option<f64>,
    /// Stop after this number of values
    #[arg(long, value_name = "N")]
    count: Option<usize>,
    /// File for all values as CSV; `-` is standard output
    #[arg(long, value_name = "FILE")]
    csv: Option<PathBuf>,
    /// Lines instead of a plot on a terminal, too
    #[arg(long)]
    plain: bool,
    #[command(flatten)]
    bus: bus::Args,
}

/// Longest time to read one object before the watch begins.
const WHOLE: Duration = Duration::from_secs(2);

/// Destination of values.
enum Sink {
    Plot(Plot),
    Lines(Output),
    Json(Output),
    Csv(Output),
}

/// A watched value and its display.
struct Shown {
    place: String,
    name: String,
    data_type: Option<DataType>,
    /// The reason why the last attempt to read it failed.
    error: Option<od_client::Error>,
}

impl Shown {
    fn title(&self) -> String {
        format!("{} {}", self.place, self.name)
            .trim_end()
            .to_owned()
    }

    fn type_of(&self, source: &Source, bytes: &[u8]) -> DataType {
        let data_type = self.data_type;
        data_type.unwrap_or_else(|| objects::type_of(source.address, bytes))
    }
}

pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    let names = args.bus.names()?;
    let mut bus = args.bus.open()?;
    let mut master = Master::new(&mut bus, args.node).within(WHOLE);
    let dictionary = names.of(&mut master)?.map(|known| known.dictionary);
    if let Some(dictionary) = dictionary {
        master.know(dictionary);
    }
    let mut asked: Vec<Asked> = Vec::new();
    for text in &args.objects {
        asked.extend(match dictionary {
            Some(dictionary) => objects::select(dictionary, text)?,
            None => objects::probe(&mut master, text)?,
        });
    }
    let addresses: Vec<_> = asked.iter().map(|one| one.address).collect();
    let mut sources = watch::sources(&mut master, &addresses)?;
    for (source, one) in sources.iter_mut().zip(&asked) {
        source.data_type = one.entry.map(|entry| entry.data_type);
    }
    drop(master);
    let mut shown: Vec<Shown> = asked
        .iter()
        .map(|one| Shown {
            place: objects::place(dictionary, one.address),
            name: objects::name(dictionary, one.entry.as_ref()),
            data_type: one.entry.map(|entry| entry.data_type),
            error: None,
        })
        .collect();
    for (one, source) in shown.iter().zip(&sources) {
        let from = match source.by {
            By::Pdo { number, id, .. } => format!("TPDO{number}, CAN-ID {id}"),
            By::Poll => format!("SDO, every {} ms", args.every),
        };
        note!("{}: {from}", one.title());
    }
    let to_output = args
        .csv
        .as_ref()
        .is_some_and(|path| path.as_os_str() == "-");
    let mut file = match &args.csv {
        Some(path) if !to_output => Some(BufWriter::new(files::create(path)?)),
        _ => None,
    };
    let is_terminal = std::io::stdout().is_terminal() && !args.plain;
    let mut sink = match args.bus.format {
        _ if to_output => Sink::Csv(Output::new()),
        Format::Json => Sink::Json(Output::new()),
        Format::Text if is_terminal => {
            Sink::Plot(Plot::new(shown.iter().map(Shown::title).collect()))
        }
        Format::Text => Sink::Lines(Output::new()),
    };
    let head = "time,object,name,value";
    if let Sink::Csv(output) = &mut sink {
        output.line(head)?;
    }
    if let Some(file) = &mut file {
        writeln!(file, "{head}")?;
    }
    let until = record::end(&bus, args.time);
    let mut told = 0;
    let mut failed = None;
    let mut is_whole = true;
    let mut tell = |sample: &Sample| -> Result<bool, Failure> {
        if sample.at > until {
            return Ok(false);
        }
        is_whole &= sample.value.is_ok();
        let (one, source) = (&mut shown[sample.source], &sources[sample.source]);
        let goes_on = show(&mut sink, file.as_mut(), one, source, sample, dictionary)?;
        told += 1;
        Ok(goes_on && args.count.is_none_or(|count| told < count))
    };
    let every = Duration::from_millis(args.every.max(1));
    let watched = watch::watch(&mut bus, args.node, &sources, every, until, |sample| {
        tell(&sample).unwrap_or_else(|failure| {
            failed = Some(failure);
            false
        })
    });
    drop(bus);
    if let Some(file) = &mut file {
        file.flush()?;
    }
    match (failed, watched) {
        (Some(failure), _) => Err(failure),
        (None, Ok(()) | Err(Error::Interrupted)) if is_whole => Ok(()),
        (None, Ok(()) | Err(Error::Interrupted)) => Err(Failure::Reported(1)),
        (None, Err(fault)) => Err(fault.into()),
    }
}

/// Shows a value. Returns whether the pipe is still open.
fn show(
    sink: &mut Sink,
    file: Option<&mut BufWriter<File>>,
    one: &mut Shown,
    source: &Source,
    sample: &Sample,
    dictionary: Option<Dictionary<'_>>,
) -> Result<bool, Failure> {
    let micros = sample.at.as_micros();
    let at = format!("{}.{:06}", micros / 1_000_000, micros % 1_000_000);
    let plain = sample.value.as_ref().ok().map(|bytes| {
        let data_type = one.type_of(source, bytes);
        (
            value::words(dictionary, source.address, data_type, bytes),
            value::plain(data_type, bytes),
        )
    });
    let text = match (&plain, &sample.value) {
        (Some((text, _)), _) => text.clone(),
        (None, Err(error)) => error.to_string(),
        (None, Ok(_)) => String::new(),
    };
    let row = || {
        let value = match &plain {
            Some((_, serde_json::Value::String(text))) => text.clone(),
            Some((_, value)) => value.to_string(),
            None => String::new(),
        };
        let cells = [&at, &one.place, &one.name, &value];
        cells.map(|cell| Visible(cell).csv()).join(",")
    };
    if let Some(file) = file {
        writeln!(file, "{}", row())?;
    }
    let error = sample.value.as_ref().err().copied();
    let is_repeated = error.is_some() && one.error == error;
    let goes_on = match sink {
        Sink::Plot(plot) => {
            let number = plain.as_ref().and_then(|(_, value)| value.as_f64());
            plot.add(sample.source, sample.at, text, number);
            return Ok(true);
        }
        Sink::Lines(_) if is_repeated => true,
        Sink::Lines(output) => {
            output.line(&format!("{at:>12}  {}  {text}", one.title()))?;
            output.flush()?
        }
        Sink::Csv(output) => {
            output.line(&row())?;
            output.flush()?
        }
        Sink::Json(output) => {
            let value = plain.as_ref().map(|(_, value)| value);
            let line = json!({
                "time": micros as f64 / 1e6,
                "object": one.place,
                "name": one.name,
                "value": value,
                "error": error.map(|error| error.to_string()),
            });
            output.line(&line.to_string())?;
            output.flush()?
        }
    };
    one.error = error;
    Ok(goes_on)
}
