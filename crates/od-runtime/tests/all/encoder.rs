//! Which dictionaries of an unknown family count as encoders (CiA 406).

use crate::support::{rows, tables, unsigned};
use od_model::{Access, DataType};
use od_runtime::encoder::EncoderProfile;

fn is_encoder(device_type: u64, data_type: DataType, access: Access) -> bool {
    let mut rows = rows();
    rows[0].5 = unsigned(device_type);
    rows.push((0x6004, 0, data_type, access, true, None));
    EncoderProfile::for_dictionary(tables(rows).dictionary()).is_some()
}

#[test]
fn another_device_with_6004h_is_not_an_encoder() {
    use Access::{Ro, Rw};
    use DataType::{Unsigned8, Unsigned32};
    assert!(is_encoder(0x0002_0196, Unsigned32, Ro));
    assert!(is_encoder(0x000A_0196, Unsigned32, Ro), "a safe one");
    assert!(!is_encoder(0x0002_0192, Unsigned32, Ro), "a drive");
    assert!(!is_encoder(0x0002_0196, Unsigned32, Rw));
    assert!(!is_encoder(0x0002_0196, Unsigned8, Ro));
    assert!(EncoderProfile::for_dictionary(tables(rows()).dictionary()).is_none());
}
