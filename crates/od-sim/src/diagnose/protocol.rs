//! Whether a log is of a CANopen bus.

use std::collections::BTreeMap;
use std::prelude::v1::*;

use od_wire::Frame;

use crate::logs::{Record, What};

/// What the frames of a CAN-ID say: seen as CANopen, or as none.
#[derive(Clone, Copy, Default)]
struct Sign {
    /// A frame that only CANopen explains.
    is_canopen: bool,
    /// A frame that CANopen does not know.
    is_other: bool,
}

/// Why the frames of a log are not CANopen, in one sentence; `None`: they are, or may be.
///
/// CANopen uses CAN-IDs of 11 bits. Each service has its CAN-IDs and its lengths (CiA 301, 7.3.5), and some CAN-IDs are not
/// used. A bus may have frames of another protocol beside CANopen.
pub fn other_protocol(records: &[Record]) -> Option<&'static str> {
    let mut signs: BTreeMap<u16, Sign> = BTreeMap::new();
    let mut extended = 0;
    for record in records {
        let What::Frame(frame) = &record.what else {
            continue;
        };
        let Some(id) = frame.id().as_standard() else {
            extended += 1;
            continue;
        };
        let sign = signs.entry(id).or_default();
        match is_canopen(id, frame) {
            Some(true) => sign.is_canopen = true,
            Some(false) => sign.is_other = true,
            None => {}
        }
    }
    if signs.is_empty() {
        return (extended > 0).then_some(
            "all CAN-IDs have 29 bits, as in J1939, NMEA 2000 and ISOBUS; CANopen uses CAN-IDs of 11 bits",
        );
    }
    let count = |is: fn(&Sign) -> bool| signs.values().filter(|sign| is(sign)).count();
    let canopen = count(|sign| sign.is_canopen && !sign.is_other);
    let other = count(|sign| sign.is_other);
    (other >= MOST && other > canopen * 2).then_some(
        "CAN-IDs and lengths are not those of CANopen (heartbeats have 1 byte, EMCY and SDO messages have 8), as on the bus of a vehicle",
    )
}

/// With fewer CAN-IDs, a device may have a fault, or frames of its manufacturer.
const MOST: usize = 3;

/// Returns whether a frame is one of CANopen, by the pre-defined connection set (CiA 301, 7.3.5); `None`: it may be.
fn is_canopen(id: u16, frame: &Frame) -> Option<bool> {
    let data = frame.data();
    let state = |state: u8| matches!(state & 0x7F, 0 | 4 | 5 | 0x7F);
    Some(match id {
        0 => matches!(data, [1 | 2 | 0x80 | 0x81 | 0x82, 0..=127]),
        0x080 if data.len() > 1 => false,
        0x081..=0x0FF if frame.is_remote() || data.len() != 8 => false,
        0x701..=0x77F if frame.is_remote() => return None,
        0x701..=0x77F => matches!(data, [one] if state(*one)),
        // SDO: some clients send fewer than eight bytes.
        0x581..=0x5FF if data.len() != 8 => false,
        // LSS.
        0x7E4 | 0x7E5 => data.len() == 8,
        // CAN-IDs that no COB-ID may have: 001h to 07Fh, 101h to 180h, 6E0h to 6FFh, 701h to 7FFh (CiA 301, table 40). CiA 302-2
        // uses 071h to 076h.
        0x001..=0x070 | 0x077..=0x07F | 0x101..=0x180 | 0x6E0..=0x6FF | 0x780..=0x7FF => false,
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::logs::read;

    fn said(text: &str) -> Option<&'static str> {
        other_protocol(&read(text.as_bytes()).expect("a log").records)
    }

    #[test]
    fn a_log_of_29_bits_is_not_canopen() {
        let said = said("(0.1) can0 0CF00400#F07D7D0020000000\n(0.2) can0 18FEF100#FF\n");
        assert!(said.is_some_and(|said| said.contains("J1939")));
    }

    #[test]
    fn a_log_of_a_vehicle_is_not_canopen() {
        let car = "(0.1) can0 0C4#00112233445566\n(0.2) can0 130#0011223344\n(0.3) can0 7DF#02010C0000000000\n(0.4) can0 181#00\n";
        assert!(said(car).is_some_and(|said| said.contains("vehicle")));
    }

    #[test]
    fn canopen_is_known_beside_another_protocol_and_with_few_services() {
        for text in [
            "(0.1) can0 0CF00400#F07D7D0020000000\n(0.2) can0 181#00\n",
            "(0.1) can0 181#00\n(0.2) can0 281#00\n",
            "(0.1) can0 705#05\n(0.2) can0 000#0105\n(0.3) can0 085#00\n(0.3) can0 130#00\n(0.4) can0 7DF#00\n(0.5) can0 000#0100\n",
            "(0.1) can0 071#\n(0.2) can0 073#\n(0.3) can0 074#\n(0.4) can0 076#\n",
            "",
        ] {
            let records = read(text.as_bytes()).map(|log| log.records);
            assert_eq!(other_protocol(&records.unwrap_or_default()), None, "{text}");
        }
    }
}
