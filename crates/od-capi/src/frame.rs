//! Frames in the form of C.

use odkit::{CanId, Frame};

use crate::types::{ODKIT_EXTENDED, ODKIT_REMOTE, odkit_frame};

/// `None` if it is not a classical CAN frame.
pub(crate) fn from_c(frame: &odkit_frame) -> Option<Frame> {
    let id = match frame.flags & ODKIT_EXTENDED {
        0 if frame.id <= 0x7FF => CanId::standard(frame.id as u16),
        ODKIT_EXTENDED if frame.id <= 0x1FFF_FFFF => CanId::extended(frame.id),
        _ => return None,
    };
    if frame.len > 8 || frame.flags & !(ODKIT_EXTENDED | ODKIT_REMOTE) != 0 {
        return None;
    }
    match frame.flags & ODKIT_REMOTE {
        0 => Some(Frame::with_dlc(id, frame.data, frame.len)),
        _ => Frame::remote(id, frame.len),
    }
}

pub(crate) fn to_c(frame: &Frame) -> odkit_frame {
    let flag = |set, flag| if set { flag } else { 0 };
    odkit_frame {
        id: frame.id().raw(),
        flags: flag(frame.id().is_extended(), ODKIT_EXTENDED)
            | flag(frame.is_remote(), ODKIT_REMOTE),
        len: frame.dlc(),
        data: *frame.bytes(),
    }
}
