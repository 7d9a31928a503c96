//! Objects that may change: by a frame that is not an SDO request, and together with others.

use od_runtime::Frame;
use od_sim::VirtualDevice;
use od_wire::lss;

use super::input::COUPLED;

/// The objects, and those that change with them.
pub(super) fn coupled(objects: &[u16]) -> Vec<u16> {
    let is_touched = |group: &&&[u16]| objects.iter().any(|index| group.contains(index));
    let others = COUPLED.iter().filter(is_touched);
    let others = others.flat_map(|group| group.iter().copied());
    objects.iter().copied().chain(others).collect()
}

/// LSS store configuration (CiA 305).
const LSS_STORE: u8 = 0x17;

/// RPDOs that a device may have.
const RPDOS: u16 = 16;

/// The objects that a frame may change without an SDO transfer; `None` if the frame has
/// nothing to do with objects.
pub(super) fn by_frame(device: &VirtualDevice, frame: &Frame) -> Option<Vec<u16>> {
    let id = frame.id().as_standard()?;
    if id == lss::MASTER {
        // It stores the node ID and the bit rate, in the objects that contain them.
        let stores = frame.data().first() == Some(&LSS_STORE);
        return Some(if stores { vec![0x2100, 0x2101] } else { vec![] });
    }
    if id == 0x600 + u16::from(device.node_id().raw()) {
        return None;
    }
    let stored = |index: u16, sub: u8| device.stored(index, sub);
    let is_sync = stored(0x1005, 0).is_some_and(|value| value & 0x7FF == u64::from(id));
    // An RPDO changes its mapped objects; a synchronous one does so with the next SYNC.
    let rpdos = (0..RPDOS).filter(|number| {
        stored(0x1400 + number, 1).is_some_and(|cob_id| {
            cob_id & 0x8000_0000 == 0 && (is_sync || cob_id & 0x7FF == u64::from(id))
        })
    });
    let mapped = rpdos.flat_map(|number| (1..=8).map(move |sub| (0x1600 + number, sub)));
    let objects = mapped.filter_map(|(index, sub)| Some((stored(index, sub)? >> 16) as u16));
    let objects: Vec<u16> = objects.filter(|index| *index != 0).collect();
    (!objects.is_empty()).then(|| coupled(&objects))
}
