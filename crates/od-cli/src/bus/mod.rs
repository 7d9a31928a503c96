//! Options and actions of all commands on a bus: the link, the names, Ctrl-C.

pub(crate) mod names;
pub(crate) mod value;
pub(crate) mod words;

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, OnceLock};

use od_runtime::NodeId;
use od_tools::interrupt::Interruptible;
use od_tools::link::Link;
use od_tools::links;

use self::names::Names;
use crate::failure::Failure;
use crate::source;

/// The options of every command on a bus.
#[derive(clap::Args)]
#[group(id = "bus")]
pub(crate) struct Args {
    /// Bus: slcan:HOST:PORT, slcan:DEVICE[@BAUD], socketcan:INTERFACE or socketcand:HOST:PORT[/BUS]
    /// [default: the running `odkit sim`]
    #[arg(long, value_name = "LINK", value_parser = link)]
    pub(crate) link: Option<String>,
    /// Bit rate in kbit/s that an slcan adapter sets [default: as set in the adapter]
    #[arg(long, value_name = "KBIT")]
    pub(crate) bit_rate: Option<u16>,
    /// Names and types: built-in device, or EDS or DCF file, of the node with this ID; may be
    /// repeated [default: built-in devices by 1018h]
    #[arg(long, value_name = "[ID=]FILE")]
    pub(crate) eds: Vec<String>,
    /// Format of the output
    #[arg(long, value_enum, default_value = "text")]
    pub(crate) format: Format,
}

/// Format of the output.
#[derive(Clone, Copy, PartialEq, Eq, Debug, clap::ValueEnum)]
pub(crate) enum Format {
    /// Lines for people
    Text,
    /// One JSON object
    Json,
}

/// A link whose waits end with Ctrl-C.
pub(crate) type Bus = Interruptible<Box<dyn Link>>;

impl Args {
    /// Reads the files of `--eds`.
    pub(crate) fn names(&self) -> Result<Names, Failure> {
        Names::read(&self.eds)
    }

    /// Opens the link. Ctrl-C ends each wait on it.
    pub(crate) fn open(&self) -> Result<Bus, Failure> {
        self.open_at(self.bit_rate)
    }

    /// Like [`open`](Self::open), at another bit rate.
    pub(crate) fn open_at(&self, kbit: Option<u16>) -> Result<Bus, Failure> {
        opened(&self.name()?, kbit)
    }

    /// The link's name.
    pub(crate) fn name(&self) -> Result<String, Failure> {
        Ok(match &self.link {
            Some(name) => name.clone(),
            None => links::found::default()?,
        })
    }
}

/// Opens the bus of this name. Ctrl-C ends each wait on it, and the transfer that is open.
pub(crate) fn opened(name: &str, kbit: Option<u16>) -> Result<Bus, Failure> {
    let link = links::open_at(name, kbit)?;
    Ok(Interruptible::new(link, stop()?))
}

/// Set by Ctrl-C.
static STOP: OnceLock<Arc<AtomicBool>> = OnceLock::new();

/// Set by Ctrl-C, which has no other effect from now on.
pub(crate) fn stop() -> Result<Arc<AtomicBool>, Failure> {
    let stop = STOP.get_or_init(Arc::default);
    let handler = Arc::clone(stop);
    match ctrlc::set_handler(move || handler.store(true, Ordering::Relaxed)) {
        // A command opened a second link.
        Ok(()) | Err(ctrlc::Error::MultipleHandlers) => Ok(Arc::clone(stop)),
        Err(error) => Err(Failure::Failed(format!("cannot handle Ctrl-C: {error}"))),
    }
}

fn link(text: &str) -> Result<String, String> {
    let checked = links::check(text).map_err(|fault| fault.to_string());
    checked.map(|()| text.to_owned())
}

/// Reads a node ID, or `all`.
pub(crate) fn node_or_all(text: &str) -> Result<Option<NodeId>, String> {
    match text {
        "all" => Ok(None),
        text => source::node_id(text)
            .map(Some)
            .map_err(|why| format!("{why}, or `all`")),
    }
}
