//! `odkit nmt`: NMT commands.

use clap::ValueEnum;
use od_runtime::NodeId;
use od_tools::nmt;
use od_wire::Duration;
use od_wire::nmt::{Command, State};
use serde_json::json;

use crate::bus::{self, Format};
use crate::failure::Failure;
use crate::output;

/// Send an NMT command to a node, or to all
///
/// The heartbeat of the node confirms the command; its boot-up message confirms a reset.
#[derive(clap::Args)]
pub(crate) struct Args {
    /// Node ID, or `all`
    #[arg(value_name = "NODE|all", value_parser = node)]
    node: std::option::Option<NodeId>,
    /// Command
    #[arg(value_name = "COMMAND")]
    command: Order,
    /// Longest time to wait for the new state, in ms
    #[arg(long, value_name = "MS", default_value = "1000")]
    wait: u64,
    #[command(flatten)]
    bus: bus::Args,
}

#[derive(Clone, Copy, ValueEnum)]
enum Order {
    /// To Operational
    Start,
    /// To Stopped
    Stop,
    /// To Pre-operational
    Preop,
    /// Reset node
    Reset,
    /// Reset communication
    ResetComm,
}

/// Reads the first argument; the command in its place is the order of other tools.
fn node(text: &str) -> Result<Option<NodeId>, String> {
    match Order::from_str(text, true) {
        Ok(_) => Err(format!("the node comes first: `odkit nmt NODE {text}`")),
        Err(_) => bus::node_or_all(text),
    }
}

pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    let command = match args.command {
        Order::Start => Command::Start,
        Order::Stop => Command::Stop,
        Order::Preop => Command::EnterPreOperational,
        Order::Reset => Command::ResetNode,
        Order::ResetComm => Command::ResetCommunication,
    };
    let mut bus = args.bus.open()?;
    let wait = Duration::from_millis(args.wait);
    let states = nmt::command(&mut bus, args.node, command, wait)?;
    drop(bus);
    let name = |state: State| match state {
        State::Initialising => "boot-up message".to_owned(),
        state => state.to_string(),
    };
    if args.bus.format == Format::Json {
        let states = states
            .iter()
            .map(|(node, state)| json!({ "node": node.raw(), "state": name(*state) }));
        let states: Vec<_> = states.collect();
        return output::print(&format!("{:#}", json!({ "sent": true, "states": states })));
    }
    if states.is_empty() {
        return output::print("sent; no heartbeat or boot-up message confirmed it");
    }
    let lines = states
        .iter()
        .map(|(node, state)| format!("node {:<3}  {}", node.raw(), name(*state)));
    output::print(&lines.collect::<Vec<_>>().join("\n"))
}
