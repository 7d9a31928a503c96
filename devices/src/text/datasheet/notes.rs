//! The note of the datasheet about one value.

use std::format;
use std::prelude::v1::*;
use std::string::ToString;

use odkit::Address;
use odkit::encoder::{EncoderProfile, Role};

use super::services;
use odkit::DeviceKind;

/// Returns the note on a value; empty if the value has no note.
pub(super) fn note(kind: &DeviceKind, address: Address) -> String {
    if let Some(note) = kind
        .encoder()
        .and_then(|encoder| encoder_note(encoder, address))
    {
        return note;
    }
    match (address.index, address.sub) {
        (0x1010, 1..) => "\"save\": 65766173h".into(),
        (0x1011, 1..) => "\"load\": 64616F6Ch".into(),
        (0x1800 | 0x1801, 2) => format!("accepts {}", services::types(kind.profile.pdo.tpdo_types)),
        (0x1800, 5) | (0x6200, 0) if kind.dictionary.entry(0x6200, 0).is_some() => {
            let twin = if address.sub == 5 {
                "6200h"
            } else {
                "1800h:05"
            };
            format!("one value with {twin}")
        }
        _ => String::new(),
    }
}

/// The note about a value of an encoder.
fn encoder_note(encoder: &EncoderProfile, address: Address) -> Option<String> {
    if let Some(note) = encoder
        .role(address)
        .and_then(|role| note_of(role, encoder))
    {
        return Some(note);
    }
    if let Some((one, other)) = encoder
        .links
        .iter()
        .find(|(one, other)| *one == address || *other == address)
    {
        let twin = if *one == address { other } else { one };
        return Some(format!("one value with {twin}"));
    }
    let mut movements = encoder.movements();
    let (_, movement) = movements.find(|(_, movement)| movement.selector == Some(address))?;
    Some(takes(movement.sources.iter().map(|(number, _)| number)))
}

/// The note about the effect of an object on the encoder.
fn note_of(role: &Role, encoder: &EncoderProfile) -> Option<String> {
    Some(match role {
        Role::OneOf(list) => takes(list.iter()),
        Role::NodeId => "takes effect at the next start".into(),
        Role::BitRate => {
            let codes = encoder.bit_rates.iter().enumerate();
            let known = codes.filter(|(_, rate)| **rate != 0);
            let takes = takes(known.map(|(code, _)| code));
            format!("{takes}; takes effect at the next start")
        }
        Role::InjectedError => "accepts the codes of the table above; 0 clears them".into(),
        Role::Seconds => "seconds over the device's life".into(),
        Role::SecondsSinceStart => "seconds since the last start".into(),
        Role::Cycles => "number of power-ons".into(),
        Role::TimeStamp => "microseconds, modulo 65536".into(),
        Role::RawPosition => "of the sensor, modulo 2^32".into(),
        _ => return None,
    })
}

/// The values that an object accepts.
fn takes(numbers: impl Iterator<Item = impl ToString>) -> String {
    let numbers: Vec<String> = numbers.map(|number| number.to_string()).collect();
    format!("accepts {}", numbers.join(", "))
}
