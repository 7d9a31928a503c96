//! `odkit sim`: live nodes that masters reach over slcan, SocketCAN or socketcand.

mod adapter;
mod clients;
mod fleet;
mod greeting;
mod link;
mod live;

use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, sync_channel};
use std::time::Duration;

use od_bench::VirtualDevice;
use od_model::values;
use od_runtime::NodeId;

use crate::Failure;
use crate::source::{self, Source};
use clients::Input;
use link::{Ends, Link, Opened};
use live::Live;

/// Run live nodes; masters connect over slcan, SocketCAN or socketcand
///
/// Several devices and several masters share the bus: frames of one reach all others, whatever
/// link they come by. Time is real. Ctrl-C ends it.
///
/// Links: slcan:HOST:PORT (TCP), slcan:pty (a pseudo-terminal, whose path is printed),
/// slcan:/dev/ttyUSB0[@BAUD] (serial), socketcand:HOST:PORT, socketcan:vcan0 (Linux), and -
/// (standard input and output: frames and lines like `power cycle 2s`, as scripts have them,
/// go in; a candump log comes out).
#[derive(clap::Args)]
pub(crate) struct Args {
    /// Built-in devices, or EDS or DCF files
    #[arg(value_name = "DEVICE|FILE", required_unless_present = "more")]
    devices: Vec<String>,
    /// One more device on the bus; may be given again
    #[arg(long = "device", value_name = "DEVICE|FILE")]
    more: Vec<String>,
    #[command(flatten)]
    options: Options,
}

/// How devices run, whichever they are.
#[derive(clap::Args)]
pub(crate) struct Options {
    /// Node ID that a device starts with, 1 to 127; given again it is for the next device (a
    /// redundant encoder is two).
    /// A device without one takes 1, or the next that is free
    #[arg(long = "node-id", value_name = "N", value_parser = source::node_id)]
    node_ids: Vec<NodeId>,
    /// How masters reach the bus; may be given again [default: slcan:127.0.0.1:29536]
    #[arg(long = "link", value_name = "LINK", value_parser = Link::parse)]
    links: Vec<Link>,
    /// The same as --link slcan:HOST:PORT; port 0 takes any free one
    #[arg(long, value_name = "HOST:PORT")]
    slcan: Option<String>,
    /// File that keeps what 1010h saves; in memory where none is given. Given again it is for
    /// the next device
    #[arg(long = "eeprom", value_name = "FILE")]
    eeproms: Vec<PathBuf>,
    /// Raw position of the shaft at the start, in steps (497042 or 0x79592)
    #[arg(long, value_name = "STEPS", value_parser = position)]
    position: Option<u64>,
    /// How fast the shaft turns, revolutions a minute; negative: the other way
    #[arg(long, value_name = "RPM", allow_negative_numbers = true)]
    rpm: Option<f64>,
    /// Let the shafts start anywhere; the same number is the same place
    #[arg(long, value_name = "NUMBER", conflicts_with = "position")]
    seed: Option<u64>,
    /// Bit rate to show in the connection lines; this bus has none
    #[arg(long, value_name = "BIT/S", default_value_t = 500_000)]
    bitrate: u32,
}

fn position(text: &str) -> Result<u64, String> {
    let value = values::integer(text).and_then(|value| u64::try_from(value).ok());
    value.ok_or_else(|| String::from("a position is a number of steps, like 497042 or 0x79592"))
}

/// Inputs that may wait for the bus; more make their senders wait.
const INPUTS: usize = 1024;
/// Links that are clients themselves have the numbers below this one.
const LINKS: usize = 64;

pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    let names: Vec<&String> = args.devices.iter().chain(&args.more).collect();
    let mut sources = Vec::new();
    for name in &names {
        sources.push((name.as_str(), Source::find(name)?));
    }
    let makers: Vec<Maker<'_>> = sources
        .iter()
        .map(|(name, source)| Maker {
            name,
            make: Box::new(|node_id| source.device(node_id)),
        })
        .collect();
    serve(&makers, &args.options)
}

/// A device that is to be, by the name that it was asked for with.
pub(crate) struct Maker<'m> {
    pub(crate) name: &'m str,
    pub(crate) make: Make<'m>,
}

/// Makes it with this node ID, or the one that it has by itself.
type Make<'m> = Box<dyn Fn(Option<NodeId>) -> Result<VirtualDevice, Failure> + 'm>;

/// Puts the devices on a bus and runs it until Ctrl-C.
pub(crate) fn serve(makers: &[Maker<'_>], args: &Options) -> Result<(), Failure> {
    let devices = fleet::make(makers, args)?;
    let opened = open(args)?;
    let (inputs, waiting) = sync_channel(INPUTS);
    let (wake, stop) = (inputs.clone(), Arc::new(AtomicBool::new(false)));
    let stopped = Arc::clone(&stop);
    ctrlc::set_handler(move || {
        stop.store(true, Ordering::Relaxed);
        // Where this finds no room the bus is awake, and where the bus has ended already,
        // so has the program.
        let _ = wake.try_send(Input::Stop);
    })
    .map_err(|error| Failure::Failed(format!("Ctrl-C cannot be watched: {error}")))?;
    let ends = opened.iter().filter(|link| matches!(link, Opened::Ends(_)));
    let ends = ends.count();
    let mut live = Live::new(devices, ends, ends < opened.len());
    let first = makers.first().map_or("", |maker| maker.name);
    greeting::print(first, args, &live.bus, &opened)?;
    let clients = Arc::new(AtomicUsize::new(LINKS));
    let mut outputs = Vec::new();
    for (number, link) in (0..).zip(opened) {
        match link {
            Opened::Listener(kind, listener, _) => {
                clients::accept(listener, kind, Arc::clone(&clients), inputs.clone());
            }
            Opened::Ends(ends) => outputs.push(join(number, ends, &inputs)?),
        }
    }
    drop(inputs);
    live.run(&waiting, &stopped);
    for output in outputs {
        finish(&output, &stopped);
    }
    Ok(())
}

fn open(args: &Options) -> Result<Vec<Opened>, Failure> {
    let mut links = args.links.clone();
    if let Some(place) = &args.slcan {
        links.insert(0, Link::Tcp(adapter::Kind::Slcan, place.clone()));
    }
    if links.is_empty() {
        links.push(Link::Tcp(adapter::Kind::Slcan, "127.0.0.1:29536".into()));
    }
    let consoles = links.iter().filter(|link| **link == Link::Console).count();
    if consoles > 1 || links.len() > LINKS {
        let why = "there is one standard input, and room for 64 links";
        return Err(Failure::Usage(why.into()));
    }
    links.iter().map(Link::open).collect()
}

/// A link that is a client itself.
fn join(
    number: u64,
    ends: Ends,
    inputs: &std::sync::mpsc::SyncSender<Input>,
) -> Result<Receiver<()>, Failure> {
    let gone = inputs.clone();
    // Nothing else wakes up a reader of standard input when standard output closes.
    let close = move || drop(gone.send(Input::Gone(number)));
    let (reading, writing) = (ends.reading, ends.writing);
    let done = clients::join(
        number, ends.name, ends.kind, reading, writing, close, inputs,
    )?;
    Ok(done)
}

/// Waits until all that was said is written, or Ctrl-C.
fn finish(output: &Receiver<()>, stopped: &AtomicBool) {
    let patience = Duration::from_millis(100);
    while let Err(RecvTimeoutError::Timeout) = output.recv_timeout(patience) {
        if stopped.load(Ordering::Relaxed) {
            return;
        }
    }
}
