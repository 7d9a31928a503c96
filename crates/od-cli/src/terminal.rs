//! The terminal as the host of a script: finds devices by name, prints frames as candump lines.

use od_model::Refused;
use std::path::{Path, PathBuf};

use od_runtime::{Frame, Instant, NodeId};
use od_sim::VirtualDevice;
use od_sim::logs::candump::format_line;
use od_sim::script::{Host, Origin};

use crate::failure::Failure;
use crate::output::Output;
use crate::source::Source;

/// Makes devices, with EDS files beside the script, and shows frames.
pub(crate) struct Terminal<'a> {
    folder: PathBuf,
    /// Device and node ID for a script without a `device` line.
    unnamed: (&'a str, Option<NodeId>),
    /// Output for frames; `None`: frames are not shown.
    pub(crate) output: Option<Output>,
    /// Whether frames of the script are shown, too.
    pub(crate) echo: bool,
    /// Seed of the draws of a script.
    pub(crate) seed: u64,
    /// Reason why frames are no longer shown.
    pub(crate) broken: Option<Failure>,
}

impl<'a> Terminal<'a> {
    /// A host that shows nothing.
    pub(crate) fn beside(script: &Path, unnamed: (&'a str, Option<NodeId>)) -> Self {
        Self {
            folder: script.parent().map(Path::to_path_buf).unwrap_or_default(),
            unnamed,
            output: None,
            echo: false,
            seed: 0,
            broken: None,
        }
    }

    /// Prints a line. If the pipe is closed, the script still runs and gives its exit code.
    pub(crate) fn line(&mut self, line: &str) {
        let Some(output) = self.output.as_mut().filter(|_| self.broken.is_none()) else {
            return;
        };
        match output.line(line) {
            Ok(true) => {}
            Ok(false) => self.broken = Some(Failure::Reported(1)),
            Err(failure) => self.broken = Some(failure),
        }
    }
}

impl Host for Terminal<'_> {
    fn device(
        &mut self,
        name: Option<&str>,
        node_id: Option<NodeId>,
    ) -> Result<VirtualDevice, Refused> {
        let (unnamed, unnamed_id) = self.unnamed;
        let (source, node_id) = match name {
            Some(name) => (Source::find_in(name, &self.folder), node_id),
            None => (Source::find(unnamed), node_id.or(unnamed_id)),
        };
        let source = source.map_err(|failure| failure.to_string())?;
        source.device(node_id)
    }

    fn seed(&mut self) -> u64 {
        self.seed
    }

    fn frame(&mut self, at: Instant, origin: Origin, frame: &Frame) {
        if self.output.is_some() && (self.echo || origin != Origin::Script) {
            self.line(&format_line(at, "can0", frame));
        }
    }
}
