//! Links to real buses, by the name that `--link` takes.

pub mod found;
mod ports;
mod slcan;
#[cfg(target_os = "linux")]
mod socketcan;
mod socketcand;
mod stamps;
mod stream;

use od_sim::links::address::Address;

use self::slcan::Slcan;
use self::socketcand::Socketcand;
use self::stream::Stream;
use crate::error::Error;
use crate::link::Link;

/// Forms of a link's name, for messages.
const FORMS: &str = "`slcan:HOST:PORT`, `slcan:DEVICE[@BAUD]`, `socketcan:INTERFACE` or \
                     `socketcand:HOST:PORT[/BUS]`";

/// Opens a link by its name: `slcan:HOST:PORT`, `slcan:DEVICE[@BAUD]`, `socketcan:INTERFACE` or
/// `socketcand:HOST:PORT[/BUS]`.
///
/// # Errors
/// [`Error::Usage`] if the name is not that of a link, [`Error::Link`] if it cannot be opened.
pub fn open(name: &str) -> Result<Box<dyn Link>, Error> {
    open_at(name, None)
}

/// As [`open`], at a bit rate in kbit/s that the link has to set.
///
/// # Errors
/// As [`open`]; [`Error::Usage`] also if this kind of link cannot set the bit rate.
pub fn open_at(name: &str, kbit: Option<u16>) -> Result<Box<dyn Link>, Error> {
    Ok(open_between_threads(name, kbit)?)
}

/// As [`open_at`], a link that measures when a frame was on the bus, and not when it was read: an slcan adapter is asked
/// for time stamps. Some adapters remember this setting; the end of the link resets it.
///
/// # Errors
/// As [`open_at`].
pub fn open_measuring(name: &str, kbit: Option<u16>) -> Result<Box<dyn Link>, Error> {
    Ok(opened(name, kbit, true)?)
}

/// As [`open_at`], a link that any thread may use.
///
/// # Errors
/// As [`open_at`].
pub fn open_between_threads(name: &str, kbit: Option<u16>) -> Result<Box<dyn Link + Send>, Error> {
    opened(name, kbit, false)
}

fn opened(name: &str, kbit: Option<u16>, stamps: bool) -> Result<Box<dyn Link + Send>, Error> {
    let (address, bus) = parse(name)?;
    if let (Some(kbit), Address::SocketCan(_) | Address::Socketcand(_)) = (kbit, &address) {
        return Err(Error::Usage(format!(
            "{name} cannot set the bit rate; its computer does: `sudo ip link set can0 type can \
             bitrate {kbit}000`"
        )));
    }
    match address {
        Address::Serial(path, baud) => {
            let name = format!("slcan:{path}");
            let port = ports::serial(&path, baud)?;
            Ok(Box::new(Stream::open(
                port,
                Slcan::new(kbit, stamps),
                name,
            )?))
        }
        Address::Slcan(place) => {
            let (stream, name) = ports::connect("slcan", &place)?;
            Ok(Box::new(Stream::open(
                stream,
                Slcan::new(kbit, stamps),
                name,
            )?))
        }
        Address::Socketcand(place) => {
            let (stream, name) = ports::connect("socketcand", &place)?;
            Ok(Box::new(Stream::open(stream, Socketcand::new(bus), name)?))
        }
        Address::SocketCan(name) => interface(&name),
    }
}

/// Checks a link's name, without opening it.
///
/// # Errors
/// [`Error::Usage`]: what to write instead.
pub fn check(name: &str) -> Result<(), Error> {
    parse(name).map(drop)
}

/// The address, and for socketcand the name of the bus.
fn parse(name: &str) -> Result<(Address, &str), Error> {
    let (address, bus) = match name.split_once('/') {
        Some((address, bus)) if name.starts_with("socketcand:") => (address, bus),
        _ => (name, "can0"),
    };
    if bus.is_empty() || bus.contains([' ', '<', '>']) {
        return Err(Error::Usage(format!(
            "`{name}` is not a valid link; write {FORMS}"
        )));
    }
    match Address::parse(address, FORMS) {
        Ok(address) => Ok((address, bus)),
        Err(refused) => Err(Error::Usage(refused.to_string())),
    }
}

#[cfg(target_os = "linux")]
fn interface(name: &str) -> Result<Box<dyn Link + Send>, Error> {
    Ok(Box::new(self::socketcan::Interface::open(name)?))
}

/// Only Linux has such interfaces.
#[cfg(not(target_os = "linux"))]
fn interface(_: &str) -> Result<Box<dyn Link + Send>, Error> {
    Err(Error::Usage(String::from(
        "SocketCAN needs Linux; use an slcan adapter: `--link slcan:COM3`",
    )))
}

#[cfg(test)]
mod tests {
    use super::check;

    #[test]
    fn a_socketcand_may_have_a_bus() {
        for name in [
            "socketcand:127.0.0.1:28600",
            "socketcand:127.0.0.1:28600/vcan1",
            "slcan:/dev/ttyUSB0",
        ] {
            assert_eq!(check(name), Ok(()), "{name}");
        }
        for name in ["", "slcan:host", "socketcand:1/", "socketcand:1/a b"] {
            assert!(check(name).is_err(), "{name}");
        }
    }
}
