//! A device of the command line before it is made.

use std::path::PathBuf;

use od_model::Refused;
use od_runtime::{DeviceKind, NodeId};

use crate::device::VirtualDevice;

/// A device of the command line before it is made, with its name there.
pub struct Maker<'m> {
    /// Name of a built-in device, or path of a file.
    pub name: &'m str,
    /// The built-in device; `None`: a file describes it.
    pub kind: Option<&'static DeviceKind>,
    /// Files that describe it: no output of the bench may replace them.
    pub files: Vec<PathBuf>,
    /// Its node ID from `--node-id`, for a redundant encoder that of the first node; `None`: its own.
    pub node_id: Option<NodeId>,
    /// Makes the device.
    pub make: Make<'m>,
}

/// Makes a device without power, with this node ID or otherwise its own.
///
/// The error is the reason why the device cannot be made.
pub type Make<'m> = Box<dyn Fn(Option<NodeId>) -> Result<VirtualDevice, Refused> + 'm>;
