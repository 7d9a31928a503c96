//! The devices of a bus in a channel: `gxmm@1,eam_mt@2,my.eds+coarse.overlay@5`.

use std::fs;

use od_devices::DEVICES;
use od_eds::Finding;
use od_runtime::{DeviceKind, NodeId};
use od_sim::bus::Bus;
use od_sim::{EdsOptions, VirtualDevice};
use pyo3::prelude::*;

use crate::faults::Fault;
use crate::files::source::Source;

/// Names and titles of the built-in devices.
#[pyfunction]
pub(crate) fn devices() -> Vec<(&'static str, &'static str)> {
    DEVICES.iter().map(|kind| (kind.name, kind.title)).collect()
}

/// The name of a bus in a channel, and its devices: `line=gxmm@1`.
pub(crate) fn split(channel: &str) -> (Option<&str>, &str) {
    let is_name = |name: &str| {
        let fits = |letter: char| letter.is_alphanumeric() || "_-. ".contains(letter);
        !name.trim().is_empty() && name.chars().all(fits)
    };
    match channel.split_once('=') {
        Some((name, devices)) if is_name(name) => (Some(name.trim()), devices),
        _ => (None, channel),
    }
}

/// Returns whether this can be the name of a bus without devices in its name.
pub(crate) fn is_list(devices: &str) -> bool {
    devices.contains(['@', ',', '+'])
        || od_devices::find(devices.trim()).is_some()
        || fs::metadata(devices.trim()).is_ok()
}

/// Adds the devices of a list to a bus, and their names to `names`. They have no power yet.
///
/// # Errors
/// A list without a device, a device that does not exist, a file that cannot be read, a node ID that is not valid.
/// Returns the first place of each, and its line in a script.
pub(crate) fn add(
    bus: &mut Bus,
    names: &mut Vec<String>,
    list: &str,
) -> Result<Vec<(usize, String)>, Fault> {
    let mut added = Vec::new();
    for word in list
        .split(',')
        .map(str::trim)
        .filter(|word| !word.is_empty())
    {
        let (name, node) = match word.rsplit_once('@') {
            Some((name, node)) => (name, Some(node_id(word, node)?)),
            None => (word, None),
        };
        let made = Made::of(name)?;
        let first = bus.devices().len();
        for channel in 0..made.channels() {
            let number = |id: NodeId| NodeId::new(id.raw().checked_add(channel)?);
            let wanted = match node {
                Some(id) => Some(number(id).ok_or_else(|| {
                    Fault::value(format!(
                        "`{word}` needs two node IDs, and the second is 128"
                    ))
                })?),
                None => None,
            };
            let device = made.device(bus, wanted)?;
            let place = match channel {
                0 => bus.add(device),
                _ => bus.add_beside(device, first),
            };
            let base = name.rsplit(['/', '\\']).next().unwrap_or(name);
            names.push(free_name(names, base, channel));
            if channel == 0 {
                added.push((place, line(name, bus, place)));
            }
        }
    }
    if added.is_empty() {
        let why = format!(
            "`{list}` names no device; write for example `gxmm@1`, or `Bench()` for a bus without devices"
        );
        return Err(Fault::value(why));
    }
    Ok(added)
}

/// The line of a device in a script.
fn line(name: &str, bus: &Bus, place: usize) -> String {
    let Some(device) = bus.devices().get(place) else {
        return String::new();
    };
    let own = device.lss_address();
    let mut others = bus
        .devices()
        .iter()
        .take(place)
        .map(VirtualDevice::lss_address);
    let serial = if others.any(|other| other[..3] == own[..3]) {
        format!(" serial {}", own[3])
    } else {
        String::new()
    };
    let name = if name.contains(char::is_whitespace) {
        format!("\"{name}\"")
    } else {
        name.to_owned()
    };
    format!("device {name} node {}{serial}", device.node_id().raw())
}

fn node_id(word: &str, node: &str) -> Result<NodeId, Fault> {
    let id = node.trim().parse().ok().and_then(NodeId::new);
    id.ok_or_else(|| {
        Fault::value(format!(
            "`{word}`: `{node}` is not a node ID; write 1 to 127"
        ))
    })
}

/// A name that no other device has: `gxmm`, `gxmm-2`; the second channel of a device is `eam_red.2`.
pub(crate) fn free_name(names: &[String], base: &str, channel: u8) -> String {
    if let (1.., Some(last)) = (channel, names.last()) {
        return format!("{last}.{}", channel + 1);
    }
    let numbered = |number: usize| match number {
        1 => base.to_owned(),
        _ => format!("{base}-{number}"),
    };
    let mut all = (1..=names.len() + 1).map(numbered);
    all.find(|name| !names.contains(name))
        .unwrap_or_else(|| base.to_owned())
}

/// Source of devices.
pub(crate) enum Made {
    Kind(&'static DeviceKind),
    /// A file, or a base with an overlay.
    Text(Source),
}

impl Made {
    /// # Errors
    /// It does not exist, or cannot be read.
    pub(crate) fn of(name: &str) -> Result<Self, Fault> {
        let source = Source::find(name).map_err(|fault| match fault {
            // It may be a name or a path.
            Fault::Missing(why) => Fault::Value(why),
            other => other,
        })?;
        Ok(match source.kind {
            Some(kind) => Self::Kind(kind),
            None => Self::Text(source),
        })
    }

    fn channels(&self) -> u8 {
        match self {
            Self::Kind(kind) => kind.channels,
            Self::Text(..) => 1,
        }
    }

    /// The device with a node ID: its own if that is free, or else the next free one.
    fn device(&self, bus: &Bus, wanted: Option<NodeId>) -> Result<VirtualDevice, Fault> {
        let used: Vec<u8> = bus
            .devices()
            .iter()
            .map(|one| one.node_id().raw())
            .collect();
        let mut device = self.make(wanted)?;
        if wanted.is_none() && used.contains(&device.node_id().raw()) {
            let last = used.last().copied().unwrap_or(0);
            let mut others = (last..=127).chain(1..last).filter(|id| !used.contains(id));
            let free = others.find_map(NodeId::new);
            let free = free.ok_or_else(|| Fault::value("all 127 node IDs of the bus are used"))?;
            device = self.make(Some(free))?;
        }
        let device = device.delivered();
        // Devices with one LSS address cannot be distinguished.
        let own = device.lss_address();
        let others = bus.devices().iter().map(VirtualDevice::lss_address);
        let alike: Vec<u32> = others
            .filter(|one| one[..3] == own[..3])
            .map(|one| one[3])
            .collect();
        Ok(match alike.iter().max() {
            Some(last) if alike.contains(&own[3]) => {
                device.with_serial_number(last.wrapping_add(1))
            }
            _ => device,
        })
    }

    /// # Errors
    /// The file is not that of a valid device.
    pub(crate) fn make(&self, node_id: Option<NodeId>) -> Result<VirtualDevice, Fault> {
        match self {
            Self::Kind(kind) => Ok(VirtualDevice::new(kind, node_id.unwrap_or(NodeId::ONE))),
            Self::Text(source) => {
                let options = EdsOptions {
                    node_id,
                    lenient: false,
                };
                let device = VirtualDevice::from_eds(source.document.text(), options);
                device.map_err(|mut findings| {
                    findings.retain(Finding::is_unsound);
                    Fault::Value(source.words(&findings.iter().collect::<Vec<_>>()))
                })
            }
        }
    }
}
