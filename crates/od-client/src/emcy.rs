//! EMCY consumer (CiA 301, chapter 7.2.7).

use od_wire::{Frame, NodeId};

pub use od_wire::emcy::Emcy;

/// Returns the EMCY message in a frame with the default CAN-ID, 80h plus the node ID.
///
/// `None` for any other frame. Nodes with another COB-ID in 1014h are not recognised.
pub fn parse(frame: &Frame) -> Option<(NodeId, Emcy)> {
    let id = frame.id().as_standard()?.checked_sub(0x80)?;
    let node = NodeId::new(u8::try_from(id).ok()?)?;
    Some((node, Emcy::parse(frame.data())?))
}

#[cfg(test)]
mod tests {
    use od_wire::CanId;

    use super::*;

    #[test]
    fn an_emcy_message_has_a_can_id_of_81h_to_ffh_and_eight_bytes() {
        let bytes = [0x30, 0x81, 0x11, 1, 2, 3, 4, 5];
        let node_of = |id| parse(&Frame::standard(id, &bytes)).map(|(node, _)| node.raw());
        assert_eq!((node_of(0x81), node_of(0xFF)), (Some(1), Some(127)));
        for id in [0x00, 0x7F, 0x80, 0x100, 0x181] {
            assert_eq!(node_of(id), None, "{id:03X}");
        }
        let (_, emcy) = parse(&Frame::standard(0x85, &bytes)).expect("an EMCY message");
        assert_eq!(
            (emcy.code, emcy.register, emcy.info),
            (0x8130, 0x11, [1, 2, 3, 4, 5])
        );
        let [short @ .., _] = bytes;
        assert_eq!(parse(&Frame::standard(0x85, &short)), None);
        assert_eq!(parse(&Frame::full(CanId::extended(0x85), bytes)), None);
        let remote = Frame::remote(CanId::standard(0x85), 8).unwrap();
        assert_eq!(parse(&remote), None);
    }
}
