//! `odkit diff`: differences between two dictionaries, or a dictionary and a node on a bus.

mod show;

use od_eds::Tables;
use od_eds::diff::{Difference, Field, Impact, compare};
use od_runtime::NodeId;
use od_tools::compare as device;
use od_tools::links;
use od_tools::master::Master;

use crate::bus;
use crate::failure::Failure;
use crate::source::{self, Source};

/// Compare two object dictionaries, or one with a node on a bus
///
/// An object only in the second dictionary is added, an object only in the first is removed. A
/// difference is breaking if a master configured for the first device may fail with the second.
///
/// With a node on a bus, `diff` compares the descriptions: which objects the node has, the length of their values, their
/// access when they are read, and values that the file declares constant. `--values` also compares each current value with
/// the default value of the file.
///
/// Exit code 0: the comparison is done; 1: a difference of --fail-on was found, or the node violates the protocol in the
/// transfer of an object.
#[derive(clap::Args)]
pub(crate) struct Args {
    /// Built-in device, or EDS or DCF file
    #[arg(value_name = "DEVICE|FILE")]
    before: String,
    /// Built-in device, or EDS or DCF file, to compare with
    #[arg(
        value_name = "DEVICE|FILE",
        required_unless_present_any = ["link", "node_id"],
        conflicts_with_all = ["link", "node_id"]
    )]
    after: Option<String>,
    /// Compare with a node on this bus: slcan:HOST:PORT, slcan:DEVICE[@BAUD], socketcan:INTERFACE or
    /// socketcand:HOST:PORT[/BUS] [default with `--node-id`: the running `odkit sim`]
    #[arg(long, alias = "live", value_name = "LINK")]
    link: Option<String>,
    /// Node ID of the node on the bus [default: 1]
    #[arg(long, value_name = "ID", value_parser = source::node_id)]
    node_id: Option<NodeId>,
    /// Also list current values that differ from the default values
    #[arg(long, conflicts_with = "after")]
    values: bool,
    /// Format of the output
    #[arg(long, value_enum, default_value = "text")]
    format: show::Format,
    /// Exit with code 1 if a difference of this kind is found
    #[arg(long, value_enum, value_name = "WHAT")]
    fail_on: Option<FailOn>,
}

#[derive(Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
enum FailOn {
    /// Breaking differences
    Breaking,
    /// Any difference
    Any,
}

pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    let before = tables(&args.before)?;
    let (found, second) = match &args.after {
        Some(after) => {
            let found = compare(before.dictionary(), tables(after)?.dictionary());
            (found, after.clone())
        }
        None => {
            let link = match &args.link {
                Some(link) => link.clone(),
                None => links::found::default()?,
            };
            let node = args.node_id.unwrap_or(NodeId::ONE);
            let mut client = Master::new(bus::opened(&link, None)?, node);
            let found = device::compare(before.dictionary(), &mut client, args.values)?;
            (found, format!("node {node} on {link}"))
        }
    };
    let titles = [args.before.clone(), second];
    show::print(args.format, &titles, &found)?;
    let fails = |difference: &Difference| match args.fail_on {
        _ if difference.field == Field::Transfer => true,
        Some(FailOn::Any) => true,
        Some(FailOn::Breaking) => difference.impact == Impact::Breaking,
        None => false,
    };
    if found.iter().any(fails) {
        return Err(Failure::Reported(1));
    }
    Ok(())
}

fn tables(name: &str) -> Result<Tables, Failure> {
    Ok(Tables::new(&Source::find(name)?.parse()?.description))
}
