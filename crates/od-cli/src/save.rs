//! `odkit save` and `odkit restore`: 1010h and 1011h.

use od_model::Address;
use od_runtime::NodeId;
use od_tools::Error;
use od_tools::master::Master;
use od_wire::Duration;
use serde_json::json;

use crate::bus::{self, Format, value};
use crate::failure::Failure;
use crate::{output, source};

/// Maximum time that a node may need to write its memory.
pub(crate) const PATIENCE: Duration = Duration::from_secs(10);

/// Arguments of both commands.
#[derive(clap::Args)]
pub(crate) struct Args {
    /// Node ID
    #[arg(value_name = "NODE", value_parser = source::node_id)]
    node: NodeId,
    /// Parameters: the sub-index of 1010h and 1011h, or its name
    #[arg(long, value_name = "GROUP", default_value = "all", value_parser = group)]
    group: u8,
    #[command(flatten)]
    bus: bus::Args,
}

fn group(text: &str) -> Result<u8, String> {
    match text {
        "all" => Ok(1),
        "communication" => Ok(2),
        "application" => Ok(3),
        "manufacturer" => Ok(4),
        text => text
            .parse()
            .ok()
            .filter(|sub| (1..=127).contains(sub))
            .ok_or_else(|| {
                "write all, communication, application, manufacturer, or a sub-index from 1 to 127"
                    .into()
            }),
    }
}

pub(crate) fn save(args: &Args) -> Result<(), Failure> {
    write(args, Address::new(0x1010, args.group), b"save", "saved")
}

pub(crate) fn restore(args: &Args) -> Result<(), Failure> {
    let node = args.node.raw();
    let done = format!("default values are restored with the next reset: `odkit nmt {node} reset`");
    write(args, Address::new(0x1011, args.group), b"load", &done)
}

fn write(args: &Args, address: Address, signature: &[u8], done: &str) -> Result<(), Failure> {
    let mut master = Master::patient(args.bus.open()?, args.node, PATIENCE);
    let written = Error::or_abort(master.download(address, signature))?;
    drop(master);
    let node = args.node.raw();
    if let Err(code) = written {
        let why = format!("node {node}: {address}: {}", value::abort(code));
        return Err(Failure::Failed(why));
    }
    output::print(&match args.bus.format {
        Format::Text => format!("node {node}: {done}"),
        Format::Json => format!(
            "{:#}",
            json!({ "node": node, "object": address.to_string(), "done": true })
        ),
    })
}
