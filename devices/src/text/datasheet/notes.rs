//! What is to be said of one value beside its row.

use std::format;
use std::prelude::v1::*;

use odkit::Address;

use super::services;
use odkit::DeviceKind;

/// The note on a value, empty where there is none.
pub(super) fn note(kind: &DeviceKind, address: Address) -> String {
    let encoder = kind.encoder;
    let is = |wanted: Option<Address>| wanted == Some(address);
    if let Some((_, list)) = encoder.lists.iter().find(|(at, _)| *at == address) {
        let numbers: Vec<String> = list.iter().map(u8::to_string).collect();
        return format!("takes {}", numbers.join(", "));
    }
    if let Some((one, other)) = encoder
        .links
        .iter()
        .find(|(one, other)| *one == address || *other == address)
    {
        let twin = if *one == address { other } else { one };
        return format!("one value with {twin}");
    }
    let movement = encoder
        .movements
        .iter()
        .find(|movement| movement.selector == Some(address));
    if let Some(movement) = movement {
        let numbers = movement
            .sources
            .iter()
            .map(|(number, _)| number.to_string());
        return format!("takes {}", numbers.collect::<Vec<_>>().join(", "));
    }
    if is(encoder.injection.map(|injection| injection.code)) {
        return "takes the codes of the table above; 0 ends them".into();
    }
    match (address.index, address.sub) {
        (index, 0) if Some(index) == encoder.node_id => "acts at the next start".into(),
        (index, 0) if Some(index) == encoder.bit_rate => {
            let rates = encoder.bit_rates;
            let known: Vec<String> = (0..rates.len())
                .filter(|code| rates[*code] != 0)
                .map(|code| code.to_string())
                .collect();
            format!("takes {}; acts at the next start", known.join(", "))
        }
        (0x1010, 1..) => "\"save\": 65766173h".into(),
        (0x1011, 1..) => "\"load\": 64616F6Ch".into(),
        (0x1800 | 0x1801, 2) => format!("takes {}", services::types(kind.profile.pdo.tpdo_types)),
        (0x1800, 5) | (0x6200, 0) if kind.dictionary.entry(0x6200, 0).is_some() => {
            let twin = if address.sub == 5 {
                "6200h"
            } else {
                "1800h:05"
            };
            format!("one value with {twin}")
        }
        _ if is(encoder.seconds) => "seconds over the device's life".into(),
        _ if is(encoder.seconds_since_start) => "seconds since the last start".into(),
        _ if is(encoder.cycles) => "how often power came".into(),
        _ if is(encoder.time_stamp) => "microseconds, modulo 65536".into(),
        _ if is(encoder.raw_position) => "of the sensor, modulo 2^32".into(),
        _ => String::new(),
    }
}
