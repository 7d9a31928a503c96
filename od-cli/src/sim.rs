//! `odkit sim`: live nodes that masters reach over slcan, SocketCAN, socketcand or WebSocket.

use od_bench::serve::{self, Maker};

use crate::failure::Failure;
use crate::live::Live;
use crate::source::Source;

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
    /// Built-in devices, or EDS or DCF files
    #[arg(value_name = "DEVICE|FILE", required_unless_present = "more")]
    devices: Vec<String>,
    /// Another device on the bus; may be repeated
    #[arg(long = "device", value_name = "DEVICE|FILE")]
    more: Vec<String>,
    #[command(flatten)]
    live: Live<true>,
}

pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    let mut makers = Vec::new();
    for name in args.devices.iter().chain(&args.more) {
        let source = Source::find(name)?;
        makers.push(Maker {
            name,
            kind: source.kind,
            make: Box::new(move |node_id| source.device(node_id)),
        });
    }
    Ok(serve::run(&makers, &args.live.0)?)
}
