//! `odkit export`: the EDS of a built-in device.

use std::path::PathBuf;

use crate::failure::Failure;
use crate::output;
use crate::source::Source;

/// Write the EDS of a built-in device, or a file in its canonical form
#[derive(clap::Args)]
pub(crate) struct Args {
    /// Built-in device, or EDS or DCF file
    #[arg(value_name = "DEVICE|FILE")]
    device: String,
    /// Output file [default: standard output]
    #[arg(long, short, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Accept that the target lacks objects of the source
    #[arg(long)]
    lossy: bool,
}

pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    let (description, lost) = Source::find(&args.device)?.complete(false)?;
    output::save(args.output.as_deref(), &od_eds::canonical(&description))?;
    lost.judge(args.lossy)
}
