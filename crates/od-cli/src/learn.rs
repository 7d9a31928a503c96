//! `odkit learn`: makes an EDS from a device.

use std::path::PathBuf;

use od_model::Visible;
use od_tools::learn::record::{Watch, record};
use od_tools::learn::{Learned, Options, Stored, learn, stored};
use od_tools::link::Link;
use od_tools::links;
use od_wire::{Duration, NodeId};

use crate::clock::today;
use crate::failure::Failure;
use crate::source;
use crate::{bus, conform, files, output};

/// Make an EDS from a node on a bus
///
/// If the node stores its own EDS (1021h), odkit reads it. Otherwise odkit reads all objects from 1000h to 9FFFh, and
/// tests which of them can be written, without changing a value.
/// Comments in the file list what odkit could not find out: types of objects that no standard
/// defines, limits, which values are saved, and each object whose transfer failed.
///
/// Exit code 0: the file has every object; 1: the node does not respond, or violates the protocol in the transfer of an
/// object, which is noted, and the file has all others.
#[derive(clap::Args)]
pub(crate) struct Args {
    /// Node ID
    #[arg(value_name = "NODE", value_parser = source::node_id)]
    node: NodeId,
    /// Bus of the node: slcan:HOST:PORT, slcan:DEVICE[@BAUD], socketcan:INTERFACE,
    /// socketcand:HOST:PORT[/BUS], or bench:DEVICE for a simulated device [default: the running
    /// `odkit sim`]
    #[arg(long, value_name = "LINK")]
    link: Option<String>,
    /// Write to this file instead of standard output
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Read all objects even if the node stores its own EDS (1021h)
    #[arg(long)]
    ignore_stored: bool,
    /// Probe limits by writing values, and restore the values, also after Ctrl-C; a node in
    /// Pre-operational that does not respond to LSS is asked again in Stopped
    #[arg(long)]
    allow_writes: bool,
    /// Also record the behaviour for `odkit sim`: responses, refused reads, values that change,
    /// periods of heartbeat and TPDOs; it is added to the file as comments
    #[arg(long)]
    twin: bool,
    /// With `--twin`: how long to listen, and then how long to read the values that change
    #[arg(long, value_name = "SECONDS", default_value = "10", value_parser = clap::value_parser!(u64).range(1..=600), requires = "twin")]
    seconds: u64,
    /// With `--twin`: reset and start the node, for boot-up time, errors at start, and PDOs
    #[arg(long, requires = "twin")]
    allow_reset: bool,
}

pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    args.output.as_deref().map(files::claim).transpose()?;
    let link = match &args.link {
        Some(link) => link.clone(),
        None => links::found::default()?,
    };
    let link: Box<dyn Link> = match link.strip_prefix("bench:") {
        Some(device) => Box::new(conform::bench(device, Some(args.node))?),
        None => Box::new(bus::opened(&link, None)?),
    };
    learned(args, link)
}

/// The EDS that the node stores (1021h).
fn stored_eds(args: &Args, link: &mut Box<dyn Link>) -> Result<Option<String>, Failure> {
    let node = args.node.raw();
    Ok(match stored(link, args.node)? {
        Some(Stored::Eds(text)) => {
            output::note!(
                "this is the EDS that node {node} stores (1021h); add `--ignore-stored` to read all objects"
            );
            Some(text)
        }
        Some(Stored::Unreadable(why)) => {
            output::note!("node {node} stores its own EDS (1021h), but {why}");
            None
        }
        _ => None,
    })
}

fn learned(args: &Args, mut link: Box<dyn Link>) -> Result<(), Failure> {
    let options = Options {
        writes: args.allow_writes,
        today: Some(today()),
    };
    if !(args.ignore_stored || args.allow_writes || args.twin)
        && let Some(text) = stored_eds(args, &mut link)?
    {
        return output::save(args.output.as_deref(), &Visible(&text).lines());
    }
    let progress = |index: u16| {
        if args.output.is_some() {
            output::note!("reading {index:04X}h to {:04X}h", index | 0xFFF);
        }
    };
    let Learned {
        description,
        left,
        faults,
    } = learn(&mut link, args.node, options, progress)?;
    if description.objects.is_empty() {
        return Err(Failure::Failed(format!(
            "node {} has no objects from 1000h to 9FFFh",
            args.node.raw()
        )));
    }
    let mut text = od_eds::write(&description);
    if args.twin && left.is_none() {
        let watch = Watch {
            length: Duration::from_secs(args.seconds),
            reset: args.allow_reset,
        };
        let seen = record(&mut link, args.node, &description, watch)?;
        text.push('\n');
        text.push_str(&seen.recorded.to_string());
        for lacking in seen.lacking {
            output::note!("the twin does not have {lacking}");
        }
    }
    output::save(args.output.as_deref(), &Visible(&text).lines())?;
    for fault in &faults {
        output::note!("{}", Visible(fault));
    }
    match left {
        None if !faults.is_empty() => Err(Failure::Reported(1)),
        Some(fault) => {
            output::note!(
                "not all limits were probed; the file has all objects and the limits found so far"
            );
            Err(fault.into())
        }
        None => Ok(()),
    }
}
