//! Frames against what a checkpoint waits for.

use od_model::Address;
use od_runtime::{AbortCode, Frame};
use od_wire::nmt::Repr;
use od_wire::{emcy, sdo};

use super::condition::{Frames, Seen, Who};
use crate::script::Origin;

impl Seen {
    /// Is it such a frame? `device` is the number of the device that has to send it.
    pub(super) fn matches(&self, origin: Origin, device: Option<usize>, frame: &Frame) -> bool {
        let by = match (self.who, origin) {
            (Who::Learner, Origin::Script) | (Who::Anybody, _) => true,
            (Who::Device, Origin::Device(sender)) => device.is_none_or(|wanted| wanted == sender),
            _ => false,
        };
        by && self.what.matches(frame)
    }
}

impl Frames {
    fn matches(&self, frame: &Frame) -> bool {
        let id = frame.id().as_standard().unwrap_or(u16::MAX);
        match self {
            Self::Pattern(pattern) => pattern.matches(frame),
            Self::Nmt(wanted, node) => {
                id == 0
                    && Repr::parse(frame.data()).is_some_and(|nmt| {
                        nmt.command == *wanted && node.is_none_or(|node| node == nmt.node)
                    })
            }
            Self::BootUp => {
                (0x701..=0x77F).contains(&id) && !frame.is_remote() && frame.data() == [0]
            }
            Self::Emcy(code) => {
                (0x081..=0x0FF).contains(&id)
                    && emcy::Repr::parse(frame.data())
                        .is_some_and(|emcy| code.is_none_or(|code| code == emcy.code))
            }
            Self::Abort(code) => answer(frame).is_some_and(|answer| {
                matches!(answer, sdo::Response::Abort { code: came, .. }
                    if code.map(AbortCode::code).is_none_or(|code| code == came))
            }),
            Self::Read(wanted) => answered(frame, *wanted, true),
            Self::Written(wanted) => answered(frame, *wanted, false),
        }
    }
}

fn answer(frame: &Frame) -> Option<sdo::Response> {
    let id = frame.id().as_standard()?;
    let answers = (0x581..=0x5FF).contains(&id) && frame.dlc() == 8 && !frame.is_remote();
    answers.then(|| sdo::Response::parse(frame.bytes()))
}

fn answered(frame: &Frame, wanted: Address, upload: bool) -> bool {
    match answer(frame) {
        Some(
            sdo::Response::InitiateUpload { address, .. }
            | sdo::Response::InitiateBlockUpload { address, .. },
        ) => upload && address == wanted,
        Some(
            sdo::Response::InitiateDownload { address }
            | sdo::Response::InitiateBlockDownload { address, .. },
        ) => !upload && address == wanted,
        _ => false,
    }
}
