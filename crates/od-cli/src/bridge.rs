//! `odkit bridge`: links that share a bus without simulated nodes.

use od_sim::serve;

use crate::failure::Failure;
use crate::live::Live;

/// Join links to one bus, such as a CAN interface and a page in a browser
///
/// A frame from one link is sent over all others. Press Ctrl-C to stop.
///
/// Links: slcan:HOST:PORT (TCP), slcan:pty (a pseudo-terminal), slcan:/dev/ttyUSB0[@BAUD] (a host on a
/// serial line), socketcand:HOST:PORT, socketcan:can0 (Linux), ws:HOST:PORT (the page of odkit in a browser;
/// the address to paste there is printed), and - (frames on standard input and output).
#[derive(clap::Args)]
pub(crate) struct Args {
    #[command(flatten)]
    live: Live<false>,
}

pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    let Live(options) = &args.live;
    if options.links.len() < 2 {
        return Err(Failure::Usage(
            "a bridge has two ends; give --link twice, such as `--link socketcan:can0 --link \
             ws:127.0.0.1:29538`"
                .into(),
        ));
    }
    Ok(serve::run(&[], options)?)
}
