//! Classifies frames only by the predefined connection set (CiA 301, table 38).

use od_model::Address;
use od_wire::Frame;
use od_wire::nmt;
use od_wire::sdo::{Request, Response};

/// Service, node and object of a frame, without knowledge of its device.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Tag {
    /// Index of its name in [`TAGS`].
    pub tag: u8,
    /// Its sender or receiver; 0: none, or all nodes.
    pub node: u8,
    /// The object of an SDO request or response.
    pub object: Option<Address>,
}

/// Short names of the services, with one for each PDO, from the device's point of view.
pub const TAGS: [&str; 16] = [
    "CAN", "NMT", "SYNC", "TIME", "EMCY", "PDO1", "RPDO1", "PDO2", "RPDO2", "PDO3", "RPDO3",
    "PDO4", "RPDO4", "SDO", "HB", "LSS",
];

const CAN: u8 = 0;
const NMT: u8 = 1;
const SYNC: u8 = 2;
const TIME: u8 = 3;
const EMCY: u8 = 4;
const PDO: u8 = 5;
const SDO: u8 = 13;
const HEARTBEAT: u8 = 14;
const LSS: u8 = 15;

/// The service, the node and the object of a frame.
pub fn tag(frame: &Frame) -> Tag {
    let of = |tag, node| Tag {
        tag,
        node,
        object: None,
    };
    let Some(id) = frame.id().as_standard() else {
        return of(CAN, 0);
    };
    let node = (id & 0x7F) as u8;
    match id {
        0x000 => of(
            NMT,
            nmt::Repr::parse(frame.data()).map_or(0, |repr| repr.node),
        ),
        0x080 => of(SYNC, 0),
        0x100 => of(TIME, 0),
        0x7E4 | 0x7E5 => of(LSS, 0),
        _ if node == 0 => of(CAN, 0),
        0x081..=0x0FF => of(EMCY, node),
        0x181..=0x57F => of(PDO + (id >> 7) as u8 - 3, node),
        0x581..=0x67F => Tag {
            tag: SDO,
            node,
            object: object(frame, id < 0x600),
        },
        0x701..=0x77F => of(HEARTBEAT, node),
        _ if id < 0x7E4 => of(CAN, node),
        _ => of(CAN, 0),
    }
}

/// The object of an SDO frame; segments contain none.
fn object(frame: &Frame, is_response: bool) -> Option<Address> {
    if frame.is_remote() || frame.dlc() < 4 {
        return None;
    }
    if is_response {
        object_of_response(&Response::parse(frame.bytes()))
    } else {
        object_of_request(&Request::parse(frame.bytes()))
    }
}

pub(super) fn object_of_request(request: &Request) -> Option<Address> {
    match request {
        Request::InitiateUpload { address }
        | Request::InitiateDownload { address, .. }
        | Request::InitiateBlockUpload { address, .. }
        | Request::InitiateBlockDownload { address, .. }
        | Request::Abort { address, .. } => Some(*address),
        _ => None,
    }
}

pub(super) fn object_of_response(response: &Response) -> Option<Address> {
    match response {
        Response::InitiateUpload { address, .. }
        | Response::InitiateDownload { address, .. }
        | Response::InitiateBlockUpload { address, .. }
        | Response::InitiateBlockDownload { address, .. }
        | Response::Abort { address, .. } => Some(*address),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::logs::candump::parse_frame;

    #[test]
    fn frames_have_a_service_a_node_and_an_object() {
        for (text, name, node, object) in [
            ("000#0105", "NMT", 5, None),
            ("000#01", "NMT", 0, None),
            ("080#", "SYNC", 0, None),
            ("085#", "EMCY", 5, None),
            ("100#", "TIME", 0, None),
            ("181#00", "PDO1", 1, None),
            ("205#00", "RPDO1", 5, None),
            ("57F#00", "RPDO4", 127, None),
            (
                "585#4304600000000000",
                "SDO",
                5,
                Some(Address::new(0x6004, 0)),
            ),
            (
                "605#4018100200000000",
                "SDO",
                5,
                Some(Address::new(0x1018, 2)),
            ),
            ("605#0004600000000000", "SDO", 5, None),
            ("705#05", "HB", 5, None),
            ("7E5#04", "LSS", 0, None),
            ("180#", "CAN", 0, None),
            ("6A1#", "CAN", 0x21, None),
            ("00000181#00", "CAN", 0, None),
        ] {
            let tag = tag(&parse_frame(text).expect(text));
            assert_eq!(TAGS[usize::from(tag.tag)], name, "{text}");
            assert_eq!((tag.node, tag.object), (node, object), "{text}");
        }
    }
}
