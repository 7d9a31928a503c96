//! `odkit conform`: the open conformance test of a CANopen slave.

use std::path::{Path, PathBuf};

use od_model::Address;
use od_sim::bus::Bus;
use od_tools::Error;
use od_tools::bench::OnBench;
use od_tools::conform::case::{Case, built_in, in_folder};
use od_tools::conform::eds::Eds;
use od_tools::conform::pulse::Pulse;
use od_tools::conform::record::{Record, Verdict};
use od_tools::conform::report::{About, Format, Report};
use od_tools::conform::rig::{RealBus, Rig};
use od_tools::conform::session::{Permissions, Session};
use od_tools::interrupt::Interruptible;
use od_tools::link::Link;
use od_tools::links;
use od_tools::master::Master;
use od_wire::NodeId;
use sha2::{Digest, Sha256};

use crate::bus;
use crate::clock::today;
use crate::failure::Failure;
use crate::files;
use crate::output;
use crate::report;
use crate::source::{self, Source};

/// Test whether a CANopen slave conforms to CiA 301, its EDS and its profile
///
/// With `--eds`, the node is on a real bus or on that of `odkit sim`. With a DEVICE, odkit simulates
/// this device in virtual time, and every case may run. Ctrl-C restores the values that the case has
/// changed and ends with a report. Exit code 1: a case failed, or the node or the link was lost.
#[derive(clap::Args)]
pub(crate) struct Args {
    /// Built-in device, or EDS or DCF file, to simulate
    #[arg(value_name = "DEVICE|FILE", conflicts_with = "link")]
    device: Option<String>,
    /// Bus of the node: slcan:HOST:PORT, slcan:DEVICE[@BAUD], socketcan:INTERFACE,
    /// socketcand:HOST:PORT[/BUS], or bench:DEVICE for a simulated device [default: the running
    /// `odkit sim`]
    #[arg(long, value_name = "LINK")]
    link: Option<String>,
    /// Node ID
    #[arg(long, value_name = "ID", value_parser = source::node_id)]
    node_id: Option<NodeId>,
    /// EDS or DCF file of the node, or a built-in device
    #[arg(long, value_name = "FILE")]
    eds: Option<String>,
    /// Run only cases or groups of this name; `*` and `?` are wildcards; may be repeated
    #[arg(long, value_name = "GLOB")]
    only: Vec<String>,
    /// Allow resets of the node
    #[arg(long)]
    allow_reset: bool,
    /// Allow save and restore commands; the cases restore the saved values
    #[arg(long)]
    allow_store: bool,
    /// Allow cases that move the axes of a drive, a short way, and set the outputs of an I/O module
    #[arg(long)]
    allow_motion: bool,
    /// Command that switches the power of the node; `on` or `off` is appended
    #[arg(long, value_name = "COMMAND")]
    power: Option<String>,
    /// Write a report: .txt, .json, .xml (JUnit), .md or .html; may be repeated
    #[arg(long, value_name = "FILE")]
    report: Vec<PathBuf>,
    /// Name of the person or company that runs the test, for the report
    #[arg(long, value_name = "NAME")]
    tester: Option<String>,
    /// Bit rate of the bus in kbit/s, for the report
    #[arg(long, value_name = "KBIT")]
    bit_rate: Option<u16>,
    /// Format of the output
    #[arg(long, value_enum, default_value = "text")]
    format: Shown,
    /// Also run the cases of this folder
    #[arg(long, value_name = "DIR")]
    cases: Vec<PathBuf>,
    /// List the cases instead
    #[arg(long)]
    list: bool,
}

#[derive(Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum Shown {
    /// A line for each case
    Text,
    /// One JSON object
    Json,
}

pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    let mut cases = built_in().to_vec();
    for folder in &args.cases {
        cases.extend(in_folder(folder)?);
    }
    let named = |case: &Case| {
        args.only.is_empty() || args.only.iter().any(|pattern| case.is_named_by(pattern))
    };
    cases.retain(named);
    if cases.is_empty() {
        return Err(Failure::Usage(
            "no case has this name; `odkit conform --list` lists all cases".into(),
        ));
    }
    if args.list {
        return output::print(&list(&cases));
    }
    let formats: Vec<_> = args
        .report
        .iter()
        .map(|path| format_of(path))
        .collect::<Result<_, _>>()?;
    for path in &args.report {
        files::claim(path)?;
    }
    let report = tested(args, &cases)?;
    // Whatever happens to the files, the result of a long test is shown.
    output::print(&match args.format {
        Shown::Text => report.render(Format::Text),
        Shown::Json => report.render(Format::Json),
    })?;
    for (path, format) in args.report.iter().zip(formats) {
        output::write(path, format!("{}\n", report.render(format)).as_bytes())?;
    }
    if report.is_pass() {
        Ok(())
    } else {
        Err(Failure::Reported(1))
    }
}

fn list(cases: &[Case]) -> String {
    let width = cases.iter().map(|case| case.id.len()).max().unwrap_or(0);
    let line = |case: &Case| format!("{:<width$}  {:<16}  {}", case.id, case.group, case.title);
    let lines: Vec<String> = cases.iter().map(line).collect();
    lines.join("\n")
}

fn format_of(path: &Path) -> Result<Format, Failure> {
    let extension = path.extension().and_then(|extension| extension.to_str());
    extension.and_then(Format::of_extension).ok_or_else(|| {
        let known: Vec<_> = Format::ALL
            .iter()
            .map(|(name, _)| format!(".{name}"))
            .collect();
        let shown = path.display();
        let known = known.join(", ");
        Failure::Usage(format!(
            "the format of {shown} is not known; the extensions are {known}"
        ))
    })
}

/// Runs the cases on the node or the simulated device.
fn tested(args: &Args, cases: &[Case]) -> Result<Report, Failure> {
    let link = match (&args.device, &args.link, &args.eds) {
        (None, None, Some(_)) => Some(links::found::default()?),
        (_, link, _) => link.clone(),
    };
    let simulated = match (&args.device, &link) {
        (Some(device), _) => Some(device.as_str()),
        (None, Some(link)) => link.strip_prefix("bench:"),
        (None, None) => {
            return Err(Failure::Usage(
                "name the device to simulate (`odkit conform gxmm`), or the EDS and the bus of the \
                 node (`--eds FILE --link slcan:127.0.0.1:2000`)"
                    .into(),
            ));
        }
    };
    let name = args.eds.as_deref().or(simulated);
    let Some(name) = name else {
        return Err(Failure::Usage(
            "add `--eds FILE`: the EDS file of the node".into(),
        ));
    };
    let eds = Source::find(name)?;
    let parsed = Eds::read(eds.text());
    if parsed.description.objects.is_empty() {
        return Err(Failure::Failed(format!(
            "{name} does not define any object"
        )));
    }
    let report =
        |link: &str, node: NodeId, (records, session): (Vec<Record>, &Session<'_>)| Report {
            about: about(args, eds.text()),
            device: parsed.title(),
            eds: name.into(),
            link: link.into(),
            node: node.raw(),
            records,
            times: session.times().clone(),
            lost: session.lost().map(str::to_owned),
        };
    if let Some(simulated) = simulated {
        let mut rig = bench(simulated, args.node_id)?;
        let node = rig.0.devices()[0].node_id();
        let source = Source::find(simulated)?;
        let fresh = |node: Option<NodeId>| source.device(node.or(args.node_id));
        let mut session = Session::new(&mut rig, &parsed, node, Permissions::ALL);
        session.simulates(simulated, &fresh);
        let records = all(&mut session, cases, false);
        let mut report = report("simulated, virtual time", node, (records, &session));
        report.about.identity = identity(&mut Master::new(rig, node));
        return Ok(report);
    }
    let node = args.node_id.unwrap_or(NodeId::ONE);
    let permissions = Permissions {
        reset: args.allow_reset,
        store: args.allow_store,
        motion: args.allow_motion,
    };
    announce(eds.text(), &parsed, permissions, cases);
    let link = link.as_deref().unwrap_or_default();
    let mut rig = RealBus {
        link: Box::new(Interruptible::new(
            links::open_measuring(link, None)?,
            bus::stop()?,
        )),
        power: args.power.clone(),
        pulse: Some(Pulse::start()),
    };
    let mut session = Session::new(&mut rig, &parsed, node, permissions);
    let records = all(&mut session, cases, true);
    let mut report = report(link, node, (records, &session));
    if report.lost.is_none() {
        report.about.identity = identity(&mut Master::new(rig.link, node));
    }
    Ok(report)
}

/// The circumstances of the test: place, time, person, program.
fn about(args: &Args, eds: &str) -> About {
    let today = today();
    let hash = Sha256::digest(eds.as_bytes());
    let mut options = vec![];
    options.extend(args.only.iter().map(|only| format!("--only {only}")));
    let flags = [
        (args.allow_reset, "--allow-reset"),
        (args.allow_store, "--allow-store"),
        (args.allow_motion, "--allow-motion"),
    ];
    options.extend(
        flags
            .iter()
            .filter(|(set, _)| *set)
            .map(|(_, name)| String::from(*name)),
    );
    options.extend(args.power.iter().map(|_| String::from("--power")));
    options.extend(
        args.cases
            .iter()
            .map(|folder| format!("--cases {}", folder.display())),
    );
    About {
        date: format!(
            "{:04}-{:02}-{:02} {:02}:{:02} UTC",
            today.year, today.month, today.day, today.hour, today.minute
        ),
        tester: args.tester.clone(),
        version: format!("odkit {}", env!("CARGO_PKG_VERSION")),
        options: options.join(" "),
        bit_rate: args.bit_rate,
        eds_hash: hash.iter().map(|byte| format!("{byte:02x}")).collect(),
        identity: Vec::new(),
        eds_text: eds.into(),
    }
}

/// Names and values of the objects by which the node identifies itself; objects that it lacks are left out.
fn identity<L: Link>(master: &mut Master<L>) -> Vec<(String, String)> {
    let number = |bytes: &[u8]| {
        let mut wide = [0; 4];
        wide.iter_mut()
            .zip(bytes)
            .for_each(|(to, byte)| *to = *byte);
        format!("{:08X}h", u32::from_le_bytes(wide))
    };
    let text = |bytes: &[u8]| {
        String::from_utf8_lossy(bytes)
            .trim_end_matches('\0')
            .to_owned()
    };
    let objects = [
        ("Device type (1000h)", 0x1000, 0, true),
        ("Vendor-ID (1018h:01)", 0x1018, 1, true),
        ("Product code (1018h:02)", 0x1018, 2, true),
        ("Revision number (1018h:03)", 0x1018, 3, true),
        ("Serial number (1018h:04)", 0x1018, 4, true),
        ("Device name (1008h)", 0x1008, 0, false),
        ("Hardware version (1009h)", 0x1009, 0, false),
        ("Software version (100Ah)", 0x100A, 0, false),
    ];
    let mut found = Vec::new();
    for (name, index, sub, is_number) in objects {
        match master.upload(Address::new(index, sub)) {
            Ok(bytes) => found.push((
                name.into(),
                if is_number {
                    number(&bytes)
                } else {
                    text(&bytes)
                },
            )),
            Err(Error::Abort(_)) => {}
            // A node that does not respond any more has no identity.
            Err(_) => break,
        }
    }
    found
}

/// A simulated device that was just switched on.
pub(crate) fn bench(name: &str, node: Option<NodeId>) -> Result<OnBench<Bus>, Failure> {
    let device = Source::find(name)?
        .device(node)
        .map_err(|why| Failure::Failed(why.into()))?;
    let mut bus = Bus::new();
    let number = bus.add(device);
    bus.start(number);
    Ok(OnBench(bus))
}

/// Runs the cases; `told` prints each on standard error as soon as it is done.
fn all(session: &mut Session<'_>, cases: &[Case], told: bool) -> Vec<Record> {
    let mut records = Vec::new();
    for (number, case) in (1..).zip(cases) {
        let record = session.run(case);
        if told {
            let word = record.verdict.word();
            let why = match &record.verdict {
                Verdict::Pass => String::new(),
                other => format!(" ({})", other.reason()),
            };
            output::note!("[{number}/{}] {word} {}{why}", cases.len(), record.id);
        }
        records.push(record);
    }
    records
}

/// Prints how long the test will take: the time that the simulated device of the same EDS needs.
fn announce(text: &str, eds: &Eds, permissions: Permissions, cases: &[Case]) {
    let options = od_sim::EdsOptions {
        node_id: None,
        lenient: true,
    };
    let (Some(device), _) = od_sim::VirtualDevice::read_eds(text, options) else {
        return;
    };
    let node = device.node_id();
    let mut bus = Bus::new();
    let number = bus.add(device);
    bus.start(number);
    let mut rig = OnBench(bus);
    let micros: u64 = {
        let mut session = Session::new(&mut rig as &mut dyn Rig, eds, node, permissions);
        let records = all(&mut session, cases, false);
        // A bench needs no time for a frame; a real bus needs about a millisecond.
        let took = |record: &Record| record.micros + 1000 * record.frames.len() as u64;
        records.iter().map(took).sum()
    };
    let seconds = micros.div_ceil(1_000_000);
    output::note!(
        "{}, about {} min {:02} s",
        report::plural(cases.len(), "case"),
        seconds / 60,
        seconds % 60
    );
}
