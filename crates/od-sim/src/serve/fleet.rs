//! Makes the devices of the command line.

use std::path::{Path, PathBuf};

use od_model::Refused;
use od_runtime::storage::{File, Owner, image};
use od_runtime::{DeviceKind, Instant, NodeId};

use super::error::Error;
use super::options::Options;
use super::terminal::note;
use crate::chance::drawn;
use crate::device::VirtualDevice;
use crate::words::plural;

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

/// A device with its place on a shaft.
pub(super) struct PlacedDevice {
    /// It starts without power.
    pub(super) device: VirtualDevice,
    /// Index of the device whose shaft it uses, if it has no shaft of its own.
    pub(super) beside: Option<usize>,
}

/// Makes the devices; each channel of a redundant encoder is one device.
pub(super) fn make(makers: &[Maker<'_>], args: &Options) -> Result<Vec<PlacedDevice>, Error> {
    let nodes: Vec<(&Maker<'_>, u8)> = makers
        .iter()
        .flat_map(|maker| {
            let channels = maker.kind.map_or(1, |kind| kind.channels);
            (0..channels).map(move |channel| (maker, channel))
        })
        .collect();
    fits(args, nodes.len())?;
    let mut placed: Vec<PlacedDevice> = Vec::new();
    let mut has_shaft = false;
    for (at, (maker, channel)) in nodes.into_iter().enumerate() {
        let mut device = set_up(maker, channel, args, &placed)?;
        let beside = match channel {
            0 => {
                has_shaft |= set_shaft(args, at, &mut device);
                None
            }
            // The shaft of the first channel turns it.
            channel => Some(at - usize::from(channel)),
        };
        placed.push(PlacedDevice { device, beside });
    }
    let option = match (args.rpm, args.position) {
        (Some(_), _) => Some("--rpm"),
        (None, Some(_)) => Some("--position"),
        (None, None) => None,
    };
    if let Some(option) = option.filter(|_| !has_shaft) {
        return Err(Error::Usage(format!(
            "no device has a shaft of its own for `{option}`; remove the option, or add an encoder"
        )));
    }
    Ok(placed)
}

/// Refuses options that are given for more devices than there are.
fn fits(args: &Options, count: usize) -> Result<(), Error> {
    for (option, given) in [
        ("--node-id", args.node_ids.len()),
        ("--serial", args.serials.len()),
        ("--eeprom", args.eeproms.len()),
    ] {
        if given > count {
            let devices = plural(count, "device");
            return Err(Error::Usage(format!(
                "`{option}` is given {given} times for {devices}"
            )));
        }
    }
    if args.eeprom_reset && args.eeproms.is_empty() {
        let why = "`--eeprom-reset` needs `--eeprom FILE`";
        return Err(Error::Usage(why.into()));
    }
    Ok(())
}

/// Makes the next device of the bench, with the node ID, serial number and EEPROM that the options give it.
fn set_up(
    maker: &Maker<'_>,
    channel: u8,
    args: &Options,
    placed: &[PlacedDevice],
) -> Result<VirtualDevice, Error> {
    let at = placed.len();
    let wanted = args.node_ids.get(at).copied();
    let wanted = wanted.or_else(|| maker.node_id.filter(|_| channel == 0).map(Some));
    let device = one(maker, wanted, placed)?;
    let mut device = match wanted {
        Some(Some(_)) => device.with_node_switch(),
        _ => device.delivered(),
    };
    let serial = args.serials.get(at).copied();
    if let Some(number) = serial.or_else(|| free(&device, placed)) {
        device = device.with_serial_number(number);
    }
    device.set_domain_size(args.domain_size);
    if let Some(path) = args.eeproms.get(at) {
        regular(path)?;
        let file = eeprom(path, maker.name, &device, args.eeprom_reset)?;
        device = device.with_storage(Box::new(file));
    }
    Ok(device)
}

/// Refuses a path that exists but cannot hold an EEPROM; opening a FIFO would wait for its other end.
fn regular(path: &Path) -> Result<(), Error> {
    match path.metadata() {
        Ok(data) if !data.is_file() => {
            let (path, kind) = (
                path.display(),
                if data.is_dir() {
                    "directory"
                } else {
                    "device or FIFO"
                },
            );
            Err(Error::Usage(format!(
                "`--eeprom {path}` names a {kind}; write the path of a regular file"
            )))
        }
        // A missing file is created; an unreadable one reports its error when it is opened.
        _ => Ok(()),
    }
}

/// Opens the file with the EEPROM of a device.
fn eeprom(path: &Path, name: &str, device: &VirtualDevice, reset: bool) -> Result<File, Error> {
    let owner = Owner {
        name,
        identity: &device.identity(),
        device: image::device(&device.dictionary()),
    };
    let open = if reset { File::open_erased } else { File::open };
    let file = open(path, device.storage_needed(), &owner).map_err(|error| {
        let help = if error.can_be_erased() {
            "; give the device another file, or add `--eeprom-reset` to erase this one"
        } else {
            ""
        };
        Error::Failed(format!("{error}{help}"))
    })?;
    if let Some(repaired) = file.repaired() {
        note(&format!("{}: {repaired}", path.display()));
    }
    Ok(file)
}

/// Makes a device with the given node ID, otherwise its own, otherwise the next free one.
fn one(
    maker: &Maker<'_>,
    wanted: Option<Option<NodeId>>,
    others: &[PlacedDevice],
) -> Result<VirtualDevice, Error> {
    let wanted = match wanted {
        Some(None) => return unconfigured(maker),
        wanted => wanted.flatten(),
    };
    let device = (maker.make)(wanted).map_err(|why| Error::Failed(why.into()))?;
    let others = others.iter().map(|other| &other.device);
    let others = others.filter(|other| other.is_configured());
    let used: Vec<NodeId> = others.map(VirtualDevice::node_id).collect();
    let is_used = |id: NodeId| used.contains(&id);
    let own = device.node_id();
    let Some(last) = used.last().map(|id| id.raw()) else {
        return Ok(device);
    };
    // A DCF names its node ID; other devices follow the device before them.
    if wanted.is_some() || own != NodeId::ONE && !is_used(own) {
        return Ok(device);
    }
    let mut free = (last..=127).chain(1..last).filter_map(NodeId::new);
    match free.find(|id| !is_used(*id)) {
        Some(id) => (maker.make)(Some(id)).map_err(|why| Error::Failed(why.into())),
        None => Err(Error::Usage(
            "a bus has 127 node IDs; start another `odkit sim` for the other devices".into(),
        )),
    }
}

/// A device that LSS gives its node ID.
fn unconfigured(maker: &Maker<'_>) -> Result<VirtualDevice, Error> {
    let device = (maker.make)(None).map_err(|why| Error::Failed(why.into()))?;
    let name = maker.name;
    device
        .without_node_id()
        .map_err(|why| Error::Usage(format!("`--node-id none` does not fit {name}: {why}")))
}

/// Returns the next free serial number if another device has the LSS address of this one.
fn free(device: &VirtualDevice, others: &[PlacedDevice]) -> Option<u32> {
    let own = device.lss_address();
    let others = others.iter().map(|other| other.device.lss_address());
    let alike: Vec<u32> = others
        .filter(|other| other[..3] == own[..3])
        .map(|other| other[3])
        .collect();
    let next = alike.iter().max()?.wrapping_add(1);
    alike.contains(&own[3]).then_some(next)
}

/// Places and turns the shaft of a device as the options say. Returns `false` if the device has no
/// shaft for one of these options.
fn set_shaft(args: &Options, at: usize, device: &mut VirtualDevice) -> bool {
    let now = Instant::ZERO;
    if let Some(seed) = args.seed {
        device.turn_to(anywhere(seed, at), now);
    }
    let placed = args
        .position
        .is_none_or(|raw| device.set_position(raw, now));
    let turns = args.rpm.is_none_or(|rpm| device.set_rpm(rpm, now));
    placed && turns
}

/// Random revolutions of the device at a place, the same for the same seed.
fn anywhere(seed: u64, at: usize) -> f64 {
    // 16 bits of turns and 32 bits of angle: the resolution of the largest of our encoders.
    (drawn(seed, at as u64) >> 16) as f64 / 4_294_967_296.0
}

#[cfg(test)]
mod tests {
    use super::anywhere;

    #[test]
    fn the_same_seed_gives_the_same_positions() {
        assert_eq!(anywhere(7, 0), anywhere(7, 0));
        let places: Vec<f64> = (0..20)
            .flat_map(|seed| [anywhere(seed, 0), anywhere(seed, 1)])
            .collect();
        for (at, place) in places.iter().enumerate() {
            assert!((0.0..65536.0).contains(place), "{place}");
            assert!(!places[..at].contains(place));
        }
    }
}
