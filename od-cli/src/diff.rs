//! `odkit diff`: differences between two dictionaries, or a dictionary and a node on a bus.

mod show;

use od_bus::compare as device;
use od_bus::links;
use od_bus::master::Master;
use od_eds::Tables;
use od_eds::diff::{Difference, Impact, compare};
use od_runtime::NodeId;

use crate::failure::Failure;
use crate::source::{self, Source};

/// Compare two object dictionaries, or one with a node on a bus
///
/// An object only in the second dictionary is added, an object only in the first is removed. A
/// difference is breaking if a master configured for the first device may fail with the second.
#[derive(clap::Args)]
pub(crate) struct Args {
    /// Built-in device, or EDS or DCF file
    #[arg(value_name = "DEVICE|FILE")]
    before: String,
    /// Built-in device, or EDS or DCF file, to compare with
    #[arg(
        value_name = "DEVICE|FILE",
        required_unless_present = "live",
        conflicts_with = "live"
    )]
    after: Option<String>,
    /// Compare with the node on this bus: slcan:HOST:PORT
    #[arg(long, value_name = "LINK")]
    live: Option<String>,
    /// Node ID of the node on the bus
    #[arg(long, value_name = "ID", default_value = "1", value_parser = source::node_id, requires = "live")]
    node_id: NodeId,
    /// Also list current values that differ from the default values
    #[arg(long, requires = "live")]
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
    let (found, second) = match (&args.after, &args.live) {
        (Some(after), _) => {
            let found = compare(before.dictionary(), tables(after)?.dictionary());
            (found, after.clone())
        }
        (None, Some(link)) => {
            let mut client = Master::new(links::open(link)?, args.node_id);
            let found = device::compare(before.dictionary(), &mut client, args.values)?;
            (found, format!("node {} on {link}", args.node_id.raw()))
        }
        // The argument parser requires one of them.
        (None, None) => (Vec::new(), String::new()),
    };
    let titles = [args.before.clone(), second];
    show::print(args.format, &titles, &found)?;
    let fails = |difference: &Difference| match args.fail_on {
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
