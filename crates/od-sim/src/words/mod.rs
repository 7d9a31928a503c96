//! Frames in plain words, with the names of the objects.
//!
//! [`explain`] describes a single frame; a [`Decoder`] also remembers the object of a
//! segmented or block transfer.

mod control;
mod description;
mod emcy;
mod fields;
pub mod fold;
mod lss;
mod pdo;
mod sdo;
mod sorted;
mod tag;
#[cfg(all(test, feature = "eds"))]
mod tests;
mod value;

use std::prelude::v1::*;

use od_runtime::Frame;

pub(crate) use control::command_text;
pub use description::{Service, Words};
pub(crate) use description::{bytes, plural};
#[cfg(feature = "serve")]
pub(crate) use emcy::emcy_text;
pub use fields::{Field, fields};
pub use pdo::layout;
pub use tag::{TAGS, Tag, tag};
pub(crate) use value::show as value_text;

use self::sorted::Sorted;
use crate::device::VirtualDevice;

/// Describes a single frame in words.
pub fn explain(devices: &[VirtualDevice], frame: &Frame) -> Words {
    Decoder::default().explain(devices, frame)
}

/// Describes a sequence of frames in words.
#[derive(Clone, Debug, Default)]
pub struct Decoder {
    transfers: Sorted<u8, sdo::Transfer>,
}

impl Decoder {
    /// Describes the next frame of the bus. `devices` provides names and mappings; frames of other
    /// nodes are described by the predefined connection set.
    pub fn explain(&mut self, devices: &[VirtualDevice], frame: &Frame) -> Words {
        if let Some(words) = pdo::explain(devices, frame).or_else(|| emcy::explain(devices, frame))
        {
            return words;
        }
        let Some(id) = frame.id().as_standard() else {
            return Words::new(Service::Unknown, None, "no service uses this CAN-ID");
        };
        let node = (id & 0x7F) as u8;
        match id {
            0x000 => control::nmt(frame),
            0x080 => control::sync(frame),
            0x100 => Words::new(Service::Time, None, "time stamp"),
            0x081..=0x0FF => {
                let device = devices.iter().find(|device| device.node_id().raw() == node);
                emcy::words(node, device, frame)
            }
            0x181..=0x57F => pdo::by_identifier(id, frame),
            0x581..=0x5FF | 0x601..=0x67F => {
                let device = devices.iter().find(|device| device.node_id().raw() == node);
                let transfer = self.transfers.get_or_default(node);
                sdo::explain(transfer, device, id < 0x600, node, frame)
            }
            0x701..=0x77F => control::error_control(node, frame),
            0x7E4 => lss::response(frame),
            0x7E5 => lss::request(frame),
            _ => Words::new(Service::Unknown, None, "no service uses this CAN-ID"),
        }
    }
}
