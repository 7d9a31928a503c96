//! `odkit learn`: an EDS from a device.

use std::path::PathBuf;

use od_bus::interrupt::Interruptible;
use od_bus::learn::{Options, learn};
use od_bus::links;
use od_wire::NodeId;

use crate::failure::Failure;
use crate::source;
use crate::{bus, conform, output};

/// Make an EDS from a node on a bus
///
/// Reads all objects from 1000h to 9FFFh, and tries which can be written without changing a value.
/// Comments in the file say what could not be known: types of objects that no standard has,
/// limits, which values are saved.
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
    /// Probe limits by writing values, and put the values back, also after Ctrl-C
    #[arg(long)]
    allow_writes: bool,
}

pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    let options = Options {
        writes: args.allow_writes,
    };
    let told = |index: u16| {
        if args.output.is_some() {
            output::note!("reading {index:04X}h to {:04X}h", index | 0xFFF);
        }
    };
    let link = match &args.link {
        Some(link) => link.clone(),
        None => links::found::default()?,
    };
    let description = match link.strip_prefix("bench:") {
        Some(device) => learn(
            conform::bench(device, Some(args.node))?,
            args.node,
            options,
            told,
        )?,
        None => {
            let link = Interruptible::new(links::open(&link)?, bus::stop()?);
            learn(link, args.node, options, told)?
        }
    };
    if description.objects.is_empty() {
        return Err(Failure::Failed(format!(
            "node {} has no objects from 1000h to 9FFFh",
            args.node.raw()
        )));
    }
    output::save(args.output.as_deref(), &od_eds::write(&description))
}
