//! Frames that a network sends periodically, and their bus load.

use od_model::TransmissionType;

use alloc::vec::Vec;

use super::node::Node;
use crate::identifiers::{Service, mapping, used};

/// Bit rates of CiA 301 in kbit/s.
pub const BIT_RATES: [u32; 8] = [1000, 800, 500, 250, 125, 50, 20, 10];

/// The event that makes a node send a frame without a period.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Trigger {
    /// An event in the node.
    Event,
    /// SYNC after an event in the node.
    SyncAfterEvent,
    /// A number of SYNC messages, whose period is not known or which no node produces.
    Syncs(u8),
    /// A remote frame.
    Request,
}

/// A frame that a node sends.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Frame {
    /// Position of the node.
    pub node: usize,
    /// The service.
    pub service: Service,
    /// CAN-ID.
    pub id: u32,
    /// Largest number of bits on the bus line: with all stuff bits, and the 3 bits between frames.
    pub bits: u32,
    /// Bytes of data.
    pub bytes: u8,
    /// Frames per second; the trigger if there is no period.
    pub rate: Result<f64, Trigger>,
}

/// Largest number of bits of a frame on the bus line (ISO 11898-1): of its `34 + 8n` bits, or `54 + 8n` with a
/// CAN-ID of 29 bits, each fourth can be followed by a stuff bit.
pub const fn frame_bits(is_extended: bool, bytes: u8) -> u32 {
    let data = 8 * bytes as u32;
    if is_extended {
        data + 67 + (54 + data - 1) / 4
    } else {
        data + 47 + (34 + data - 1) / 4
    }
}

/// The frames of the nodes except SDO, EMCY and NMT, in the order of their nodes. `sync_period` is
/// that of a SYNC producer, in microseconds; 0 if no given node decides it. A SYNC producer with the period 0 sends no SYNC.
pub fn frames(nodes: &[Node], sync_period: u32) -> Vec<Frame> {
    let mut found = Vec::new();
    let per_second = |milliseconds: f64| match milliseconds {
        0.0 => None,
        time => Some(1000.0 / time),
    };
    let own = nodes.iter().map(Node::sync_period).find(|own| *own > 0);
    let sync = per_second(f64::from(own.unwrap_or(sync_period)) / 1000.0);
    for (node, own) in nodes.iter().enumerate() {
        for used in used(&own.description, own.id) {
            if !used.sends || !used.is_valid {
                continue;
            }
            let (bytes, rate) = match used.service {
                Service::Sync => match sync {
                    Some(rate) => (u8::from(own.number(0x1019, 0) > 0), Ok(rate)),
                    None => continue,
                },
                Service::Heartbeat => match per_second(own.number(0x1017, 0).into()) {
                    Some(rate) => (1, Ok(rate)),
                    None => continue,
                },
                Service::Tpdo(number) => {
                    let mapped = mapping(&own.description, 0x19FF + number).unwrap_or_default();
                    let bits: u32 = mapped.iter().map(|value| u32::from(value.bits)).sum();
                    if bits == 0 {
                        continue;
                    }
                    let index = 0x17FF + number;
                    let timer = per_second(own.number(index, 5).into());
                    let kind = TransmissionType::new(own.number(index, 2).try_into().unwrap_or(0));
                    let rate = match kind.cycle() {
                        Some(cycle) => sync
                            .map(|sync| sync / f64::from(cycle))
                            .ok_or(Trigger::Syncs(cycle)),
                        None if kind.is_event_driven() => timer.ok_or(Trigger::Event),
                        None if kind.is_acyclic() => Err(Trigger::SyncAfterEvent),
                        None => Err(Trigger::Request),
                    };
                    (bits.div_ceil(8).min(8) as u8, rate)
                }
                _ => continue,
            };
            let bits = frame_bits(used.is_extended, bytes);
            let (service, id) = (used.service, used.id);
            found.push(Frame {
                node,
                service,
                id,
                bits,
                bytes,
                rate,
            });
        }
    }
    found
}

/// The bus load of the periodic frames in percent, at a bit rate in kbit/s.
pub fn load(frames: &[Frame], bit_rate: u32) -> f64 {
    let bits = frames
        .iter()
        .map(|frame| frame.rate.unwrap_or_default() * f64::from(frame.bits));
    // The sum of no numbers is -0.
    (0.0 + bits.sum::<f64>()) / f64::from(bit_rate.max(1)) / 10.0
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The longest frames in the literature: 55 + 10n bits, 80 + 10n with 29 bits (Davis et al., 2007).
    #[test]
    fn the_length_of_a_frame_includes_all_stuff_bits() {
        for bytes in 0..=8 {
            assert_eq!(frame_bits(false, bytes), 55 + 10 * u32::from(bytes));
            assert_eq!(frame_bits(true, bytes), 80 + 10 * u32::from(bytes));
        }
    }

    #[test]
    fn a_network_without_frames_has_no_load() {
        assert!(load(&[], 250).is_sign_positive());
    }
}
