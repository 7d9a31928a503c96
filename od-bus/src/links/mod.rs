//! Links to real buses, by the name that `--link` takes.

pub mod found;
mod ports;
mod slcan;
#[cfg(target_os = "linux")]
mod socketcan;
mod socketcand;
mod stream;

use self::slcan::Slcan;
use self::socketcand::Socketcand;
use self::stream::Stream;
use crate::fault::Fault;
use crate::link::Link;

/// Forms of a link's name, for messages.
const FORMS: &str = "`slcan:HOST:PORT`, `slcan:DEVICE[@BAUD]`, `socketcan:INTERFACE` or \
                     `socketcand:HOST:PORT[/BUS]`";
/// The rate of a serial line if none is given, in bit/s.
const BAUD: u32 = 115_200;

/// Opens a link by its name: `slcan:HOST:PORT`, `slcan:DEVICE[@BAUD]`, `socketcan:INTERFACE` or
/// `socketcand:HOST:PORT[/BUS]`.
///
/// # Errors
/// [`Fault::Usage`] if the name is not that of a link, [`Fault::Link`] if it cannot be opened.
pub fn open(name: &str) -> Result<Box<dyn Link>, Fault> {
    open_at(name, None)
}

/// As [`open`], at a bit rate in kbit/s that the link has to set.
///
/// # Errors
/// As [`open`]; [`Fault::Usage`] also if this kind of link cannot set the bit rate.
pub fn open_at(name: &str, kbit: Option<u16>) -> Result<Box<dyn Link>, Fault> {
    Ok(open_between_threads(name, kbit)?)
}

/// As [`open_at`], a link that any thread may use.
///
/// # Errors
/// As [`open_at`].
pub fn open_between_threads(name: &str, kbit: Option<u16>) -> Result<Box<dyn Link + Send>, Fault> {
    check(name)?;
    let (kind, place) = name.split_once(':').unwrap_or((name, ""));
    if let (Some(kbit), "socketcan" | "socketcand") = (kbit, kind) {
        return Err(Fault::Usage(format!(
            "{name} cannot set the bit rate; its computer does: `sudo ip link set can0 type can \
             bitrate {kbit}000`"
        )));
    }
    match kind {
        "slcan" if is_device(place) => {
            let (path, baud) = device(place)?;
            let name = format!("slcan:{path}");
            let port = ports::serial(path, baud)?;
            Ok(Box::new(Stream::open(port, Slcan::new(kbit), name)?))
        }
        "slcan" => {
            let (stream, name) = ports::connect(kind, place)?;
            Ok(Box::new(Stream::open(stream, Slcan::new(kbit), name)?))
        }
        "socketcand" => {
            let (place, bus) = place.split_once('/').unwrap_or((place, "can0"));
            let (stream, name) = ports::connect(kind, place)?;
            Ok(Box::new(Stream::open(stream, Socketcand::new(bus), name)?))
        }
        _ => interface(place),
    }
}

/// Checks a link's name, without opening it.
///
/// # Errors
/// [`Fault::Usage`]: what to write instead.
pub fn check(name: &str) -> Result<(), Fault> {
    let is_right = match name.split_once(':') {
        Some((_, "")) => false,
        Some(("slcan", place)) if is_device(place) => device(place).is_ok(),
        Some(("slcan", place)) => is_address(place),
        Some(("socketcand", place)) => {
            let (place, bus) = place.split_once('/').unwrap_or((place, "can0"));
            is_address(place) && !bus.is_empty() && !bus.contains([' ', '<', '>'])
        }
        Some(("socketcan", _)) => true,
        _ => false,
    };
    if is_right {
        Ok(())
    } else {
        Err(Fault::Usage(format!(
            "`{name}` is not a valid link; write {FORMS}"
        )))
    }
}

/// A path, or a port of Windows.
fn is_device(place: &str) -> bool {
    place.starts_with(['/', '.']) || place.to_ascii_uppercase().starts_with("COM")
}

/// A path and a baud rate.
fn device(place: &str) -> Result<(&str, u32), Fault> {
    let Some((path, baud)) = place.rsplit_once('@') else {
        return Ok((place, BAUD));
    };
    match baud.parse() {
        Ok(baud) if baud > 0 => Ok((path, baud)),
        _ => Err(Fault::Usage(format!(
            "`{baud}` is not a valid baud rate; write `slcan:{path}@{BAUD}`"
        ))),
    }
}

/// `HOST:PORT`, or a port.
fn is_address(place: &str) -> bool {
    match place.rsplit_once(':') {
        Some((host, port)) => !host.is_empty() && port.parse::<u16>().is_ok(),
        None => place.parse::<u16>().is_ok(),
    }
}

#[cfg(target_os = "linux")]
fn interface(name: &str) -> Result<Box<dyn Link + Send>, Fault> {
    Ok(Box::new(self::socketcan::Interface::open(name)?))
}

/// Only Linux has such interfaces.
#[cfg(not(target_os = "linux"))]
fn interface(_: &str) -> Result<Box<dyn Link + Send>, Fault> {
    Err(Fault::Usage(String::from(
        "SocketCAN needs Linux; use an slcan adapter: `--link slcan:COM3`",
    )))
}

#[cfg(test)]
mod tests {
    use super::check;

    #[test]
    fn a_link_has_a_kind_and_a_place() {
        for name in [
            "slcan:29536",
            "slcan:localhost:1",
            "slcan:[::1]:1",
            "slcan:/dev/ttyUSB0",
            "slcan:COM3@9600",
            "socketcan:can0",
            "socketcand:127.0.0.1:28600",
            "socketcand:127.0.0.1:28600/vcan1",
        ] {
            assert_eq!(check(name), Ok(()), "{name}");
        }
        for name in [
            "",
            "can0",
            "slcan",
            "slcan:",
            "slcan:host",
            "slcan::1",
            "slcan:a:99999",
            "slcan:/dev/x@0",
            "socketcan:",
            "socketcand:1/",
            "udp:1",
        ] {
            assert!(check(name).is_err(), "{name}");
        }
    }
}
