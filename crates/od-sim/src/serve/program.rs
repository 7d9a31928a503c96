//! The `main` of a crate with a device of its own.

use std::process::ExitCode;

use od_runtime::NodeId;

use super::error::Error;
use super::fleet::Maker;
use super::options::{self, Options};
use super::run::run;
use super::terminal::{note, print};
use crate::device::VirtualDevice;

/// Runs a device until Ctrl-C, with the options of the command line (`--help` lists them), and
/// returns the exit code of the process.
///
/// `name` is the path of the file that describes the device, for masters. `make` gets the node ID of
/// the command line, or `None`.
///
/// ```no_run
/// use od_sim::VirtualDevice;
/// use od_devices::bus_cover::gxmm;
/// use od_runtime::NodeId;
///
/// fn main() -> std::process::ExitCode {
///     od_sim::serve::main("mine.eds", |node_id| {
///         VirtualDevice::of("mine", gxmm::Device, node_id.unwrap_or(NodeId::ONE))
///     })
/// }
/// ```
pub fn main(name: &str, make: impl Fn(Option<NodeId>) -> VirtualDevice) -> ExitCode {
    let mut arguments = std::env::args_os().map(|argument| argument.to_string_lossy().into_owned());
    let program = arguments.next().unwrap_or_default();
    let arguments: Vec<String> = arguments.collect();
    if arguments.iter().any(|one| one == "-h" || one == "--help") {
        return end(print(&help(&program)).map_err(Error::from));
    }
    end(options::parse(arguments)
        .map_err(|why| Error::Usage(format!("{why}; `--help` lists the options")))
        .and_then(|options| serve(name, &make, &options)))
}

fn serve(
    name: &str,
    make: &impl Fn(Option<NodeId>) -> VirtualDevice,
    options: &Options,
) -> Result<(), Error> {
    let maker = Maker {
        name,
        kind: None,
        files: vec![name.into()],
        node_id: None,
        make: Box::new(|node_id| Ok(make(node_id))),
    };
    run(&[maker], options)
}

fn help(program: &str) -> String {
    let file = program.rsplit(['/', '\\']).next().unwrap_or(program);
    format!(
        "Run the device; masters connect over slcan, SocketCAN or socketcand\n\nUsage: {file} \
         [OPTIONS]\n\n{}",
        options::help().trim_end()
    )
}

/// The exit code: 0, 1 for a failure, 2 for wrong usage.
fn end(result: Result<(), Error>) -> ExitCode {
    let Err(failure) = result else {
        return ExitCode::SUCCESS;
    };
    note(&format!("error: {failure}"));
    ExitCode::from(match failure {
        Error::Usage(_) => 2,
        Error::Failed(_) => 1,
    })
}
