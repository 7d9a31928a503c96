//! What is so on the bench at one moment.

use std::format;
use std::prelude::v1::*;

use od_model::typed::Scalar;
use od_model::{Address, DataType, Kind as TypeKind};

use super::condition::{Fact, How, Kind, Test};
use crate::bus::Bus;
use crate::device::VirtualDevice;
use od_model::values;

/// What was found: does it hold, and what is it, in words.
pub(super) type Found = Result<(bool, String), String>;

impl Fact {
    /// Looks at the bench. `turns` is where the device's shaft was when the step began.
    ///
    /// # Errors
    /// Why it cannot be so at all: no such object, a value that is none.
    pub(super) fn look(&self, bus: &mut Bus, device: usize, turns: Option<f64>) -> Found {
        let gone = || format!("there is no device {}", device + 1);
        let now = bus.now();
        match &self.kind {
            Kind::Value(address, test) => bus
                .with(device, |one, now| {
                    let data_type = data_type(one, *address)?;
                    match one.is_powered() {
                        true => compare(data_type, &one.read(*address, now), test),
                        false => {
                            values_fit(data_type, test)?;
                            Ok((false, "the device has no power".into()))
                        }
                    }
                })
                .ok_or_else(gone)?,
            Kind::Saved(address, test) => bus
                .with(device, |one, _| {
                    let data_type = data_type(one, *address)?;
                    let saved = one.saved();
                    let Some(bytes) = one.saved_bytes(&saved, *address) else {
                        return Err(format!("{address} is not kept in the EEPROM"));
                    };
                    match test {
                        Some(test) => compare(data_type, &bytes, test),
                        None => {
                            let same = one.is_unsaved(&saved, *address) == Some(false);
                            let there = values::show(data_type, &bytes);
                            Ok((same, format!("there it is {there}")))
                        }
                    }
                })
                .ok_or_else(gone)?,
            Kind::Terminators(test) => numbers(f64::from(bus.line.terminators), test),
            _ => {
                let one = bus.devices().get(device).ok_or_else(gone)?;
                self.outside(one, one.shaft(now), turns)
            }
        }
    }

    fn outside(
        &self,
        one: &VirtualDevice,
        shaft: Option<crate::world::ShaftView>,
        turns: Option<f64>,
    ) -> Found {
        let shaft = || shaft.ok_or_else(|| String::from("this device has no shaft"));
        match &self.kind {
            Kind::State(wanted) => {
                let state = match one.is_powered() {
                    true => one.state().name().to_lowercase(),
                    false => "off".into(),
                };
                Ok((state == *wanted, format!("it is {state}")))
            }
            Kind::Led { green, led } => {
                if !one.has_leds() {
                    return Err("this device has no LED".into());
                }
                let leds = one.leds();
                let is = if *green { leds.0 } else { leds.1 };
                Ok((is == *led, format!("it is {}", is.name())))
            }
            Kind::NodeId(test) => numbers(f64::from(one.node_id().raw()), test),
            Kind::BitRate(test) => match one.bit_rate() {
                Some(rate) => numbers(f64::from(rate), test),
                None => Err("this device has no bit rate of its own".into()),
            },
            Kind::Turned(test) => {
                let now = shaft()?.turns;
                numbers((now - turns.unwrap_or(now)).abs(), test)
            }
            Kind::Rpm(test) => numbers(shaft()?.rpm, test),
            Kind::Broken(name) => {
                if !one.faults().contains(&name.as_str()) {
                    return Err(format!("this device has no fault `{name}`"));
                }
                let broken = one.is_broken(name);
                let words = if broken { "it is broken" } else { "it works" };
                Ok((broken, words.into()))
            }
            // These were looked at before.
            Kind::Value(..)
            | Kind::Saved(..)
            | Kind::Quiet(_)
            | Kind::Undisturbed
            | Kind::Terminators(_) => Ok((false, String::new())),
        }
    }
}

fn data_type(device: &VirtualDevice, address: Address) -> Result<DataType, String> {
    match device.dictionary().find(address) {
        Ok(entry) => Ok(entry.data_type),
        Err(_) => Err(format!("there is no object {address}")),
    }
}

/// Does the value of the lesson suit the type?
fn values_fit(data_type: DataType, test: &Test) -> Result<(), String> {
    for part in test.text.split("..") {
        values::parse(data_type, part)?;
    }
    Ok(())
}

fn compare(data_type: DataType, bytes: &[u8], test: &Test) -> Found {
    values_fit(data_type, test)?;
    let now = format!("it is {}", values::show(data_type, bytes));
    if matches!(test.how, How::Equal | How::Unequal) {
        let same = values::parse(data_type, &test.text)? == bytes;
        return Ok((same == (test.how == How::Equal), now));
    }
    let Some(value) = as_number(data_type, bytes) else {
        return Err(format!("{data_type} has no order; write `=` or `!=`"));
    };
    numbers(value, test).map(|(holds, _)| (holds, now))
}

/// Good enough for an order: what people compare is far below 2⁵³.
fn as_number(data_type: DataType, bytes: &[u8]) -> Option<f64> {
    if data_type.size() != Some(bytes.len()) {
        return None;
    }
    match data_type.kind() {
        TypeKind::Boolean | TypeKind::Unsigned => Some(u64::from_wire(bytes) as f64),
        TypeKind::Signed => Some(i64::from_wire(bytes) as f64),
        TypeKind::Real => match *bytes {
            [a, b, c, d] => Some(f32::from_le_bytes([a, b, c, d]).into()),
            _ => Some(f64::from_bits(u64::from_wire(bytes))),
        },
        TypeKind::Text | TypeKind::Bytes | TypeKind::Record => None,
    }
}

fn numbers(value: f64, test: &Test) -> Found {
    let (low, high) = test.text.split_once("..").unwrap_or((&test.text, ""));
    let wanted = number(low).ok_or_else(|| format!("`{low}` is no number"))?;
    let holds = match test.how {
        How::Equal => value == wanted,
        How::Unequal => value != wanted,
        How::Below => value < wanted,
        How::AtMost => value <= wanted,
        How::Above => value > wanted,
        How::AtLeast => value >= wanted,
        How::Between => {
            let high = number(high).ok_or_else(|| format!("`{high}` is no number"))?;
            (wanted..=high).contains(&value)
        }
    };
    // Thousandths are what a person can see of a shaft.
    let shown = (value * 1000.0).round() / 1000.0;
    Ok((holds, format!("it is {shown}")))
}

/// A number as lessons write it: whole in any form, or with a point.
pub(super) fn number(text: &str) -> Option<f64> {
    let text = text.trim();
    match values::integer(text) {
        Some(whole) => Some(whole as f64),
        None => text.parse::<f64>().ok().filter(|value| value.is_finite()),
    }
}
