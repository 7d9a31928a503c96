//! A device that is to be.

use std::path::PathBuf;

use od_model::Refused;
use od_runtime::{DeviceKind, NodeId};

use crate::device::VirtualDevice;

/// A device that is to be, by the name that it was asked for with.
pub struct Maker<'m> {
    /// Name of a built-in device, or path of a file.
    pub name: &'m str,
    /// The built-in device; `None`: a file describes it.
    pub kind: Option<&'static DeviceKind>,
    /// Files that describe it: no output of the bench replaces them.
    pub files: Vec<PathBuf>,
    /// Its node ID, of a redundant encoder that of the first node, as `--node-id` gives it; `None`: its own.
    pub node_id: Option<NodeId>,
    /// Makes it.
    pub make: Make<'m>,
}

/// Makes a device without power, with this node ID or else its own.
///
/// The error is the reason why the device cannot be made.
pub type Make<'m> = Box<dyn Fn(Option<NodeId>) -> Result<VirtualDevice, Refused> + 'm>;
