//! A device that plays a recording.

use std::mem;
use std::prelude::v1::*;

use od_runtime::{Frame, Instant, NoApplication};
use od_wire::nmt::State;

use super::Recorded;
use super::play::{Due, Playing};
use crate::device::VirtualDevice;
use crate::device::application::Behaviour;
use crate::device::role::Role;

impl VirtualDevice {
    /// Plays a recording instead of simulating an application. Call it before the power is switched on.
    pub fn play_recorded(&mut self, recorded: Recorded) {
        let profile = &mut self.node.device_mut().profile;
        if let Some(micros) = recorded
            .boot_up
            .and_then(|micros| u32::try_from(micros).ok())
        {
            profile.nmt.reset_node_us = micros;
            profile.nmt.reset_communication_us = micros;
        }
        profile.sdo.segmented_download &= !recorded.no_segments;
        profile.sdo.block &= !recorded.no_blocks;
        self.node.application.behaviour = Behaviour::Plain(NoApplication);
        let node = self.node_id().raw();
        let dictionary = self.dictionary();
        let configured = |index, sub| {
            let entry = dictionary.entry(index, sub);
            let default = entry.and_then(|entry| entry.default.integer(node));
            default
                .and_then(|number| number.try_into().ok())
                .unwrap_or(0)
        };
        let playing = Playing::new(recorded, configured);
        self.role = Role::Recorded(Box::new(playing));
    }

    /// Takes the frames of the node, and returns the frame that is due now.
    pub(crate) fn poll_recorded(&mut self, now: Instant) -> Option<Frame> {
        // The recording reads the device, so it cannot be a part of it during this call.
        let Role::Recorded(mut playing) = mem::take(&mut self.role) else {
            return None;
        };
        playing.look(self.state(), |index, sub| self.stored(index, sub));
        while let Some(frame) = self.node.poll_transmit(now) {
            let tpdo = self.tpdo_of(&playing, &frame);
            playing.sent(now, self.node_id(), frame, tpdo);
        }
        let frame = playing.take(now, self.node_id(), self.state());
        self.role = Role::Recorded(playing);
        frame
    }

    /// The number of the TPDO with this CAN-ID, if it has a period.
    fn tpdo_of(&self, playing: &Playing, frame: &Frame) -> Option<u16> {
        let id = u64::from(frame.id().as_standard()?);
        playing.tpdos().find(|tpdo| {
            let cob_id = self.stored(0x1800 + (tpdo - 1), 1);
            cob_id.is_some_and(|cob_id| cob_id & 0x8000_07FF == id)
        })
    }

    /// Returns whether the recording responds to a request instead of the node.
    pub(crate) fn refuses_recorded(&mut self, now: Instant, frame: &Frame) -> bool {
        let serves = matches!(self.state(), State::PreOperational | State::Operational);
        let node = self.node_id();
        match &mut self.role {
            Role::Recorded(playing) if serves && self.node.is_powered() => {
                playing.refuses(now, node, frame)
            }
            _ => false,
        }
    }

    /// Sets the values and reports the errors that are due.
    pub(crate) fn happens_recorded(&mut self, now: Instant) {
        while let Role::Recorded(playing) = &mut self.role
            && let Some(due) = playing.happens(now)
        {
            // The node refuses values and errors that it cannot have in its state.
            let _ = match due {
                Due::Value(address, bytes) => self.set_value(address, &bytes, now),
                Due::Error(error) => {
                    self.raise_error(error.code, error.register, Some(error.info), now)
                }
            };
        }
    }
}
