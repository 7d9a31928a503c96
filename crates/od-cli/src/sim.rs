//! `odkit sim`: live nodes that masters reach over slcan, SocketCAN, socketcand or WebSocket.

use std::path::Path;

use od_runtime::NodeId;
use od_sim::serve::{self, Maker};

use crate::failure::Failure;
use crate::live::Live;
use crate::source::{Source, node_id};

/// Run live nodes; masters connect over slcan, SocketCAN, socketcand or WebSocket
///
/// All devices and masters share one bus: a frame of one reaches all others over every link. Time is
/// real. Press Ctrl-C to stop.
///
/// Links: slcan:HOST:PORT (TCP), slcan:pty (a pseudo-terminal, whose path is printed),
/// slcan:/dev/ttyUSB0[@BAUD] (serial), socketcand:HOST:PORT, socketcan:vcan0 (Linux),
/// ws:HOST:PORT (the page of odkit in a browser; the address to paste there is printed), and -
/// (standard input takes frames and script lines such as `power cycle 2s`; standard output is a
/// candump log).
#[derive(clap::Args)]
pub(crate) struct Args {
    /// Built-in devices, or EDS or DCF files; with a node ID as in gxmm@5, several as in gxmm@1,eam_mt@2
    #[arg(value_name = "DEVICE|FILE[@ID]", required_unless_present = "more")]
    devices: Vec<String>,
    /// Another device on the bus; may be repeated
    #[arg(long = "device", value_name = "DEVICE|FILE[@ID]")]
    more: Vec<String>,
    #[command(flatten)]
    live: Live<true>,
}

pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    let mut makers = Vec::new();
    for word in args.devices.iter().chain(&args.more) {
        for (name, node_id) in devices(word)? {
            let source = Source::find(name)?;
            makers.push(Maker {
                name,
                kind: source.kind,
                files: source.files(),
                node_id,
                make: Box::new(move |node_id| source.device(node_id)),
            });
        }
    }
    let is_numbered = makers.iter().any(|maker| maker.node_id.is_some());
    if is_numbered && !args.live.0.node_ids.is_empty() {
        let why = "`--node-id` and `@` both give node IDs; write one of them for all devices";
        return Err(Failure::Usage(why.into()));
    }
    Ok(serve::run(&makers, &args.live.0)?)
}

/// The devices of `gxmm@1,eam_mt@2` with their node IDs; the path of a file may have these characters.
fn devices(word: &str) -> Result<Vec<(&str, Option<NodeId>)>, Failure> {
    let is_file = |name: &str| Path::new(name).exists();
    if is_file(word) {
        return Ok(vec![(word, None)]);
    }
    let names = word.split(',').map(|name| match name.rsplit_once('@') {
        Some((device, id)) if !is_file(name) => match node_id(id) {
            Ok(id) => Ok((device, Some(id))),
            Err(why) => Err(Failure::Usage(format!("`{name}`: {why} after `@`"))),
        },
        _ => Ok((name, None)),
    });
    names.collect()
}
