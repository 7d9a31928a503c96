//! SDO frames of client and server (CiA 301, chapter 7.2.4.3).

mod fields;
mod request;
mod response;
mod segment;

pub use fields::{address, end, number, toggle, wants_crc};
pub use request::Request;
pub use response::{Response, expedited_len, expedited_upload, upload_command};
pub use segment::{Segment, block_segment, block_segments, crc16, crc16_after, segment, unused};

#[cfg(test)]
mod tests {
    use od_model::Address;

    use super::*;

    #[test]
    fn every_command_byte_survives_a_round_trip() {
        for command in 0..=0xFFu8 {
            let bytes = [command, 0x10, 0x20, 3, 4, 0, 0, 0];
            let request = Request::parse(&bytes);
            assert_eq!(Request::parse(&request.emit()), request, "{command:02X}");
            let response = Response::parse(&bytes);
            assert_eq!(Response::parse(&response.emit()), response, "{command:02X}");
        }
    }

    #[test]
    fn the_fast_functions_give_the_same_result() {
        let address = Address::new(0x6004, 3);
        for len in 1..=4u8 {
            let response = Response::InitiateUpload {
                address,
                size: Some(len.into()),
                expedited: Some([1, 2, 3, 4]),
            };
            assert_eq!(expedited_upload(address, len, 0x0403_0201), response.emit());
        }
    }

    #[test]
    fn the_trace_of_the_bus_cover_manual_reads_as_printed() {
        // 000, chapter 6.4: 40 02 60 00 -> 43 02 60 00 00 00 00 20
        let response = Response::InitiateUpload {
            address: Address::new(0x6002, 0),
            size: Some(4),
            expedited: Some([0, 0, 0, 0x20]),
        };
        assert_eq!(
            response.emit(),
            [0x43, 0x02, 0x60, 0x00, 0x00, 0x00, 0x00, 0x20]
        );
        assert_eq!(
            Request::parse(&[0x22, 0x01, 0x60, 0, 0, 0x10, 0, 0]),
            Request::InitiateDownload {
                address: Address::new(0x6001, 0),
                size: None,
                expedited: Some([0, 0x10, 0, 0]),
            }
        );
    }
}
