//! Devices that the compiler knows, as their firmware runs them.

use std::prelude::v1::*;

use od_model::Dictionary;
use od_runtime::{Application, Device, NodeId, Profile};

use crate::device::VirtualDevice;
use crate::device::application::{Behaviour, DeviceApplication};
use crate::device::source::{Loaded, Source};

impl VirtualDevice {
    /// A device with its dictionary and profile, and with a simulated encoder if it has a position (6004h).
    ///
    /// `device` is the type that `object_dictionary!` made. Services that it switches off are off here, too.
    /// A device that does not know its dictionary does not compile.
    pub fn of<D: Device>(title: &str, device: D, node_id: NodeId) -> Self {
        let application = DeviceApplication::of(dictionary::<D>());
        Self::compiled(title, &device, node_id, application)
    }

    /// A device as [`of`](Self::of) makes it, with this behaviour. The crates that `odkit new` makes call it.
    pub fn with_application<D: Device>(
        title: &str,
        device: D,
        node_id: NodeId,
        application: impl Application + Clone + Send + 'static,
    ) -> Self {
        let application = Behaviour::Own(Box::new(application)).into();
        Self::compiled(title, &device, node_id, application)
    }

    fn compiled<D: Device>(
        title: &str,
        device: &D,
        node_id: NodeId,
        application: DeviceApplication,
    ) -> Self {
        let loaded = Loaded {
            source: Source::Compiled(dictionary::<D>()),
            profile: profile(device),
        };
        Self::build(title.into(), loaded, node_id, application)
    }
}

const fn dictionary<D: Device>() -> Dictionary<'static> {
    const { D::DICTIONARY.expect("the dictionary is a constant") }
}

/// The profile of a device, without the services that it switches off. A service without a field in the profile
/// needs no entry here: it follows from the objects, and the dictionary has none of them.
fn profile<D: Device>(device: &D) -> Profile {
    let mut profile = *device.profile();
    profile.sdo.segmented_upload &= D::SEGMENTED;
    profile.sdo.segmented_download &= D::SEGMENTED;
    profile.sdo.block &= D::BLOCK;
    profile.pdo.event_on_change &= D::CHANGES;
    profile.errors.watches_sync_length &= D::SYNC_LENGTH;
    profile.lss = profile.lss.filter(|_| D::LSS);
    if !D::BEHAVIOUR {
        profile.errors.behaviour = &[];
    }
    profile
}
