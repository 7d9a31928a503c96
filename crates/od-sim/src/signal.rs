//! A value in the frames of a bus, as a number: in a PDO, or in an SDO response.

use od_client::pdo;
use od_model::{Address, DataType, Kind};
use od_wire::sdo::{Response, expedited_len};
use od_wire::{CanId, Frame, NodeId};

/// Place of a value in frames.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Place {
    /// Bits of a PDO.
    Mapped {
        /// CAN-ID of the PDO.
        id: CanId,
        /// Its lowest bit, 0 to 63.
        first: u8,
        /// Its length in bits, 1 to 64.
        bits: u8,
    },
    /// The response to an SDO upload of up to four bytes.
    Read {
        /// The SDO server.
        node: NodeId,
        /// The object.
        address: Address,
    },
}

/// A value that some frames contain.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Signal {
    /// Its place.
    pub place: Place,
    /// Its type; a type that is not a number counts as UNSIGNED.
    pub data_type: DataType,
}

impl Signal {
    /// The value in a frame; `None`: the frame does not contain it.
    pub fn value(&self, frame: &Frame) -> Option<f64> {
        let (value, bits) = match self.place {
            Place::Mapped { id, first, bits } => {
                let is_it = frame.id() == id && !frame.is_remote();
                (
                    pdo::bits(frame.data(), first, bits).filter(|_| is_it)?,
                    bits,
                )
            }
            Place::Read { node, address } => self.read(node, address, frame)?,
        };
        let unused = 64 - u32::from(bits);
        Some(match self.data_type.kind() {
            Kind::Signed => ((value << unused) as i64 >> unused) as f64,
            Kind::Real if bits == 32 => f32::from_bits(value as u32).into(),
            Kind::Real => f64::from_bits(value),
            _ => value as f64,
        })
    }

    fn read(&self, node: NodeId, address: Address, frame: &Frame) -> Option<(u64, u8)> {
        if frame.id() != node.plus(0x580) || frame.is_remote() || frame.dlc() < 8 {
            return None;
        }
        let Response::InitiateUpload {
            address: about,
            size,
            expedited: Some(data),
        } = Response::parse(frame.bytes())
        else {
            return None;
        };
        let len = expedited_len(size, self.data_type.size()).max(1);
        let bits = 8 * len as u8;
        let value = pdo::bits(&data, 0, bits).filter(|_| about == address)?;
        Some((value, bits))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::logs::candump::parse_frame;

    #[track_caller]
    fn check(place: Place, data_type: DataType, frame: &str, value: Option<f64>) {
        let frame = parse_frame(frame).expect(frame);
        assert_eq!(Signal { place, data_type }.value(&frame), value, "{frame}");
    }

    const fn mapped(first: u8, bits: u8) -> Place {
        let id = CanId::standard(0x181);
        Place::Mapped { id, first, bits }
    }

    #[test]
    fn a_mapped_value_has_its_bits_its_sign_and_its_type() {
        use DataType::{Integer16, Real32, Real64, Unsigned8, Unsigned32};
        check(
            mapped(0, 32),
            Unsigned32,
            "181#01020304",
            Some(67_305_985.0),
        );
        check(mapped(8, 16), Integer16, "181#01FEFF", Some(-2.0));
        check(mapped(4, 3), Unsigned8, "181#F0", Some(7.0));
        check(mapped(0, 3), Integer16, "181#07", Some(-1.0));
        check(mapped(0, 32), Real32, "181#0000C03F", Some(1.5));
        check(mapped(0, 64), Real64, "181#000000000000F8BF", Some(-1.5));
        check(mapped(0, 1), DataType::Boolean, "181#01", Some(1.0));
    }

    #[test]
    fn other_frames_and_short_frames_have_no_value() {
        for frame in ["182#01020304", "181#010203", "181#R4", "00000181#01020304"] {
            check(mapped(0, 32), DataType::Unsigned32, frame, None);
        }
        check(mapped(0, 0), DataType::Unsigned32, "181#01", None);
        check(
            mapped(60, 8),
            DataType::Unsigned8,
            "181#0102030405060708",
            None,
        );
    }

    #[test]
    fn a_value_of_an_upload_has_a_node_and_an_object() {
        let node = NodeId::ONE;
        let address = Address::new(0x6004, 0);
        let place = Place::Read { node, address };
        let of = |frame, value| check(place, DataType::Integer32, frame, value);
        of("581#4304600005000000", Some(5.0));
        of("581#43046000FFFFFFFF", Some(-1.0));
        of("581#4B046000FEFF0000", Some(-2.0));
        // Without a size the length is that of the type.
        of("581#42046000FEFFFFFF", Some(-2.0));
        for other in [
            "582#4304600005000000",
            "581#4305600005000000",
            "601#4004600000000000",
            "581#8004600000000206",
            "581#4104600009000000",
        ] {
            of(other, None);
        }
    }
}
