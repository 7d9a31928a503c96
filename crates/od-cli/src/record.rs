//! `odkit record` and `odkit replay`: frames from a bus into a log, and from a log to a bus.

use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};

use od_sim::logs::{Format, Record, What};
use od_sim::serve::files::replaces_log;
use od_tools::Error;
use od_tools::link::Link;
use od_tools::replay;
use od_wire::{Duration, Instant};

use crate::bus;
use crate::decode::read_log;
use crate::failure::Failure;
use crate::files;
use crate::output::{self, note};
use crate::report::plural;

/// Record the frames of a bus, until Ctrl-C
#[derive(clap::Args)]
pub(crate) struct Args {
    /// Log to write: candump (.log) or pcapng. odkit replaces a log of the same format, and refuses any other file
    #[arg(value_name = "FILE")]
    file: PathBuf,
    /// Stop after this time, in seconds
    #[arg(long = "for", value_name = "SECONDS")]
    time: Option<f64>,
    /// Stop after this number of frames
    #[arg(long, value_name = "N")]
    count: Option<usize>,
    #[command(flatten)]
    bus: bus::Args,
}

/// Send the frames of a log, with their timing
///
/// Reads candump, ASC, BLF, TRC, pcap, pcapng, CSV and text of other programs. Frames keep their distance in time.
#[derive(clap::Args)]
pub(crate) struct Replay {
    /// Log to send
    #[arg(value_name = "LOG")]
    file: PathBuf,
    /// Factor of the speed; 0 sends without waiting
    #[arg(long, value_name = "FACTOR", default_value = "1", value_parser = speed)]
    speed: f64,
    #[command(flatten)]
    bus: bus::Args,
}

fn speed(text: &str) -> Result<f64, String> {
    let number = text.parse().ok();
    number
        .filter(|speed: &f64| speed.is_finite() && *speed >= 0.0)
        .ok_or_else(|| "write a factor such as 1, 0.5 or 10".into())
}

/// An open log file.
pub(crate) struct Recorder {
    file: BufWriter<File>,
    format: Format,
    name: String,
    /// Number of frames written.
    pub(crate) count: usize,
}

impl Recorder {
    pub(crate) fn create(path: &Path) -> Result<Self, Failure> {
        let name = path.display().to_string();
        let ending = path.extension().unwrap_or_default().to_string_lossy();
        let format = Format::of_ending(&ending.to_ascii_lowercase()).unwrap_or(Format::Candump);
        if !format.grows() {
            return Err(Failure::Usage(format!(
                "{name}: write a name that ends in .log (candump) or .pcapng"
            )));
        }
        replaces_log(path, format)
            .map_err(|refused| Failure::Failed(format!("{name}: {refused}")))?;
        let file = files::create(path)?;
        let mut recorder = Self {
            file: BufWriter::new(file),
            format,
            name,
            count: 0,
        };
        recorder.write(&format.head())?;
        Ok(recorder)
    }

    pub(crate) fn add(&mut self, at: Instant, frame: &od_wire::Frame) -> Result<(), Failure> {
        let record = Record {
            at,
            sent: false,
            what: What::Frame(*frame),
        };
        let mut bytes = Vec::new();
        self.format.add(&mut bytes, &record);
        self.count += 1;
        self.write(&bytes)
    }

    fn write(&mut self, bytes: &[u8]) -> Result<(), Failure> {
        let written = self.file.write_all(bytes);
        written.map_err(|error| Failure::Failed(format!("{}: {error}", self.name)))
    }

    /// Writes the rest of the buffer, and prints a summary.
    pub(crate) fn finish(self) -> Result<String, Failure> {
        let (name, count) = (self.name.clone(), self.count);
        self.flush()?;
        Ok(format!("{name}: {}", plural(count, "frame")))
    }

    fn flush(mut self) -> Result<(), Failure> {
        let flushed = self.file.flush();
        flushed.map_err(|error| Failure::Failed(format!("{}: {error}", self.name)))
    }
}

/// The end time of a command that runs until the user stops it.
pub(crate) fn end(link: &impl Link, seconds: Option<f64>) -> Instant {
    match seconds.map(Duration::try_from_secs_f64) {
        Some(Ok(time)) => link.now() + time,
        // Some centuries.
        _ => Instant::from_micros(u64::MAX),
    }
}

pub(crate) fn record(args: &Args) -> Result<(), Failure> {
    let mut bus = args.bus.open()?;
    let mut recorder = Recorder::create(&args.file)?;
    note!("recording; Ctrl-C ends it");
    let until = end(&bus, args.time);
    let result = loop {
        if args.count.is_some_and(|count| recorder.count >= count) {
            break Ok(());
        }
        match bus.receive(until) {
            Ok(Some(heard)) => recorder.add(heard.at, &heard.frame)?,
            Ok(None) | Err(Error::Interrupted) => break Ok(()),
            // Frames received before the error are kept.
            Err(fault) => break Err(fault.into()),
        }
    };
    drop(bus);
    let count = recorder.count;
    recorder.flush()?;
    said(&args.bus, &args.file, count, "recorded")?;
    result
}

pub(crate) fn replay(args: &Replay) -> Result<(), Failure> {
    let shown = args.file.display();
    let log = read_log(&args.file)?;
    if log.lacks_times {
        note!(
            "{shown}: the log has no times, so all frames are sent at once; `candump -L` writes times"
        );
    }
    let frames = log.records.iter().filter_map(|record| match record.what {
        What::Frame(frame) => Some((record.at, frame)),
        What::Error(_) => None,
    });
    let frames: Vec<_> = frames.collect();
    let mut bus = args.bus.open()?;
    let sent = replay::replay(&mut bus, &frames, args.speed)?;
    drop(bus);
    said(&args.bus, &args.file, sent, "sent")
}

fn said(args: &bus::Args, file: &Path, count: usize, done: &str) -> Result<(), Failure> {
    let file = file.display();
    output::print(&match args.format {
        bus::Format::Text => format!("{file}: {} {done}", plural(count, "frame")),
        bus::Format::Json => {
            format!(
                "{:#}",
                serde_json::json!({ "file": file.to_string(), "frames": count })
            )
        }
    })
}
