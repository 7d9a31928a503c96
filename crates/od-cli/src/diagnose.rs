//! `odkit diagnose`: the faults in a log or on a bus, and their likely causes.

use std::path::{Path, PathBuf};

use od_model::{Dictionary, Visible};
use od_runtime::NodeId;
use od_sim::diagnose::{BusFacts, Incident, diagnose, other_protocol, rules_with_times};
use od_sim::logs::{Record, What};
use od_tools::Error;
use od_tools::interrupt::Interruptible;
use od_tools::link::Link;
use od_tools::links;
use od_wire::Instant;
use serde_json::{Value, json};

use crate::bus;
use crate::bus::names::Names;
use crate::bus::words::Narrator;
use crate::decode::read_log;
use crate::failure::Failure;
use crate::output::{self, note};
use crate::record::end;
use crate::report::{plural, plural_of};

/// Find the faults in logs or on a bus, and their likely causes
///
/// Reads candump, ASC, BLF, TRC (1.0 to 2.1), pcap, pcapng, CSV and text of other programs. Each fault is one incident, with its begin and end, its likely
/// causes in order, what to check first, and the frames that show it. With --eds mappings and consumer times are known.
///
/// Exit code 0: the logs were read; with --check 1 if there is an incident.
#[derive(clap::Args)]
pub(crate) struct Args {
    /// Logs; `-` is standard input
    #[arg(
        value_name = "LOG",
        required_unless_present = "link",
        conflicts_with = "link"
    )]
    logs: Vec<PathBuf>,
    /// Bus to listen to instead: slcan:HOST:PORT, slcan:DEVICE[@BAUD], socketcan:INTERFACE or socketcand:HOST:PORT[/BUS]
    #[arg(long, value_name = "LINK")]
    link: Option<String>,
    /// Stop listening after this time, in seconds [default: until Ctrl-C]
    #[arg(long = "for", value_name = "SECONDS", requires = "link")]
    time: Option<f64>,
    /// Bit rate in kbit/s, for the bus load [default: estimated from frames without a pause between them]
    #[arg(long, value_name = "KBIT")]
    bit_rate: Option<u16>,
    /// Dictionaries: built-in device, or EDS or DCF file, of the node with this ID, or of all nodes; may be repeated
    #[arg(long, value_name = "[ID=]FILE")]
    eds: Vec<String>,
    /// Exit code 1 if there is an incident
    #[arg(long)]
    check: bool,
    /// Format of the output
    #[arg(long, value_enum, default_value = "text")]
    format: Format,
}

#[derive(Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum Format {
    /// Lines for people
    Text,
    /// One JSON object
    Json,
    /// Markdown, for an issue or a report
    Md,
}

pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    let mut reports = Vec::new();
    match &args.link {
        Some(name) => reports.push((name.clone(), listen(args, name)?)),
        None => {
            for path in &args.logs {
                for (channel, records) in read(path)? {
                    let name = if channel.is_empty() {
                        path.display().to_string()
                    } else {
                        format!("{}, channel {channel}", path.display())
                    };
                    reports.push((name, records));
                }
            }
        }
    }
    let mut texts = Vec::new();
    let mut all = Vec::new();
    let mut count = 0;
    for (name, records) in &reports {
        let names = Names::read(&args.eds)?;
        let of = |node: u8| -> Option<Dictionary<'_>> {
            Some(names.given(NodeId::new(node)?)?.dictionary)
        };
        let known = BusFacts {
            bit_rate: args.bit_rate,
            dictionary: Some(&of),
        };
        let incidents = diagnose(records, known);
        let other = other_protocol(records);
        if let Some(why) = other {
            note!("{name}: this is not CANopen: {why}");
        }
        count += incidents.len();
        let lines = lines(args, records)?;
        match args.format {
            Format::Text => texts.push(text(name, records, &incidents, &lines)),
            Format::Md => texts.push(markdown(name, records, &incidents, &lines)),
            Format::Json => {
                let incidents: Vec<Value> =
                    incidents.iter().map(|one| in_json(one, &lines)).collect();
                all.push(json!({ "log": name, "records": records.len(), "other_protocol": other, "incidents": incidents }));
            }
        }
    }
    output::print(&match args.format {
        Format::Json => format!("{:#}", json!({ "logs": all })),
        Format::Text | Format::Md => texts.join("\n\n"),
    })?;
    if args.check && count > 0 {
        return Err(Failure::Reported(1));
    }
    Ok(())
}

/// The records of each channel, which is a bus of its own.
fn read(path: &Path) -> Result<Vec<(String, Vec<Record>)>, Failure> {
    let shown = path.display();
    let mut log = read_log(path)?;
    if log.lacks_times {
        let left_out: Vec<&str> = rules_with_times().collect();
        note!(
            "{shown}: the log has no times, so these rules cannot look at it: {}; `candump -L` records times",
            left_out.join(", ")
        );
    }
    Ok(log.take_channels())
}

fn listen(args: &Args, name: &str) -> Result<Vec<Record>, Failure> {
    let mut bus = Interruptible::new(links::open_measuring(name, args.bit_rate)?, bus::stop()?);
    if args.time.is_none() {
        note!("listening until Ctrl-C");
    }
    let until = end(&bus, args.time);
    let mut records = Vec::new();
    loop {
        match bus.receive(until) {
            Ok(Some(heard)) => records.push(Record {
                at: heard.at,
                sent: false,
                what: What::Frame(heard.frame),
            }),
            Ok(None) | Err(Error::Interrupted) => {
                if records.is_empty() {
                    note!(
                        "{name}: no frame was received; check that a node sends, and that the adapter has the bit rate of the bus"
                    );
                }
                return Ok(records);
            }
            Err(fault) => return Err(fault.into()),
        }
    }
}

/// Each record in words.
fn lines(args: &Args, records: &[Record]) -> Result<Vec<String>, Failure> {
    let mut narrator = Narrator::new(Names::read(&args.eds)?, "")?;
    let told = records.iter().map(|record| match record.what {
        What::Frame(frame) => narrator
            .tell(record.at, frame, record.sent)
            .map(|told| told.line())
            .unwrap_or_default(),
        What::Error(error) => format!("{:>12}  {}", format!("{:?}", record.at), error.text()),
    });
    Ok(told.collect())
}

fn summary(name: &str, records: &[Record], incidents: &[Incident]) -> String {
    let length = match records {
        [first, .., last] if first.at < last.at => {
            format!(" and {:.1} s", last.at.micros_since(first.at) as f64 / 1e6)
        }
        _ => String::new(),
    };
    format!(
        "{name}: {} in {}{length}",
        plural(incidents.len(), "incident"),
        plural_of(records.len(), "record", "records"),
    )
}

fn text(name: &str, records: &[Record], incidents: &[Incident], lines: &[String]) -> String {
    let mut out = vec![summary(name, records, incidents)];
    for (number, incident) in (1..).zip(incidents) {
        let mut lines = incident.lines(lines).into_iter();
        out.push(String::new());
        out.extend(lines.next().map(|first| format!("{number}. {first}")));
        out.extend(lines.map(|line| format!("   {line}")));
    }
    Visible(&out.join("\n")).lines().into_owned()
}

fn markdown(name: &str, records: &[Record], incidents: &[Incident], lines: &[String]) -> String {
    let cell = |text: &str| Visible(text).markdown();
    let mut out = vec![format!("# {}", cell(&summary(name, records, incidents)))];
    for (number, incident) in (1..).zip(incidents) {
        out.push(String::new());
        out.push(format!("## {number}. {}", cell(&incident.text)));
        out.push(String::new());
        out.push(incident.span());
        out.push(String::new());
        for (place, cause) in (1..).zip(&incident.causes) {
            out.push(format!(
                "{place}. {}. *Check* {}.",
                cell(&cause.text),
                cell(&cause.check)
            ));
        }
        out.push(String::new());
        out.push("```".into());
        let shown = incident
            .records
            .iter()
            .filter_map(|place| lines.get(*place));
        out.extend(shown.map(|line| Visible(line).line().into_owned()));
        out.push("```".into());
    }
    out.join("\n")
}

fn in_json(incident: &Incident, lines: &[String]) -> Value {
    let causes: Vec<Value> = incident
        .causes
        .iter()
        .map(|cause| json!({ "id": cause.id, "text": cause.text, "check": cause.check }))
        .collect();
    let frames: Vec<Value> = incident
        .records
        .iter()
        .map(|place| json!({ "record": place, "text": lines.get(*place).map(|line| line.trim()) }))
        .collect();
    let time = |at: Instant| incident.has_times.then_some(at.as_micros());
    json!({
        "rule": incident.rule,
        "text": incident.text,
        "nodes": incident.nodes,
        "begin_us": time(incident.begin),
        "end_us": time(incident.end),
        "recovered": incident.recovered,
        "causes": causes,
        "frames": frames,
    })
}
