//! A device of one's own, run like `odkit sim` runs the built-in ones.

use std::process::ExitCode;

use clap::Parser;
use od_bench::VirtualDevice;
use od_runtime::NodeId;

use crate::sim::{self, Maker, Options};

/// Run the device; masters connect over slcan, SocketCAN or socketcand
#[derive(Parser)]
#[command(max_term_width = 100)]
struct Cli {
    #[command(flatten)]
    options: Options,
}

/// Runs a device over the links of `odkit sim`, with its options but those that choose a
/// device, until Ctrl-C; answers with the exit code of the process.
///
/// `make` is given the node ID of the command line, or `None` where none was given.
///
/// ```no_run
/// use od_devices::bus_cover::gxmm;
/// use od_bench::VirtualDevice;
/// use od_runtime::NodeId;
///
/// fn main() -> std::process::ExitCode {
///     od_cli::serve("mine", |node_id| {
///         VirtualDevice::of("mine", gxmm::DICTIONARY, node_id.unwrap_or(NodeId::ONE))
///     })
/// }
/// ```
pub fn serve(name: &str, make: impl Fn(Option<NodeId>) -> VirtualDevice) -> ExitCode {
    let cli = match Cli::try_parse() {
        Ok(cli) => cli,
        Err(error) => {
            crate::output::print_or_ignore(&error);
            return ExitCode::from(u8::try_from(error.exit_code()).unwrap_or(2));
        }
    };
    let maker = Maker {
        name,
        make: Box::new(|node_id| Ok(make(node_id))),
    };
    crate::exit(sim::serve(&[maker], &cli.options))
}
