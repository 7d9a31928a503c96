//! Addresses of links, for programs that listen there and programs that connect: `slcan:HOST:PORT`,
//! `slcan:DEVICE[@BAUD]`, `socketcand:HOST:PORT`, `socketcan:INTERFACE`.

use std::format;
use std::prelude::v1::*;

use od_model::Refused;

/// Bit rate of a serial line if the address has none.
pub const BAUD: u32 = 115_200;

/// Address of a link.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum Address {
    /// slcan over TCP, at `HOST:PORT`.
    Slcan(String),
    /// socketcand, at `HOST:PORT`.
    Socketcand(String),
    /// slcan over a serial line: path and bit rate.
    Serial(String, u32),
    /// A CAN interface of Linux.
    SocketCan(String),
}

impl Address {
    /// Reads an address. `forms` lists the forms that the caller accepts, for the message.
    ///
    /// # Errors
    /// The text is not a valid address.
    pub fn parse(text: &str, forms: &str) -> Result<Self, Refused> {
        match text.split_once(':') {
            Some((_, "")) => {}
            Some(("slcan", place)) if is_device(place) => {
                let (path, baud) = place.rsplit_once('@').unwrap_or((place, ""));
                let given = path.len() < place.len();
                let baud = if given { baud.parse().ok() } else { Some(BAUD) };
                let baud = baud.filter(|baud| *baud > 0).ok_or_else(|| {
                    format!(
                        "`{place}` has no valid bit rate after `@`; write `slcan:{path}@{BAUD}`"
                    )
                })?;
                return Ok(Self::Serial(path.to_owned(), baud));
            }
            Some(("slcan", place)) => return Ok(Self::Slcan(tcp(place)?)),
            Some(("socketcand", place)) => return Ok(Self::Socketcand(tcp(place)?)),
            Some(("socketcan", name)) => return Ok(Self::SocketCan(name.to_owned())),
            _ => {}
        }
        Err(format!("`{text}` is not a valid link; write {forms}").into())
    }
}

/// A path, or a port of Windows.
fn is_device(place: &str) -> bool {
    place.starts_with(['/', '.']) || place.to_ascii_uppercase().starts_with("COM")
}

/// Reads `HOST:PORT`, or a port of this computer, and returns it as `HOST:PORT`.
///
/// # Errors
/// The text is not a valid address.
pub fn tcp(place: &str) -> Result<String, Refused> {
    let (host, port) = place.rsplit_once(':').unwrap_or(("127.0.0.1", place));
    let is_number = !port.is_empty() && port.bytes().all(|byte| byte.is_ascii_digit());
    let why = match port.parse::<u16>() {
        Ok(port) if is_number && !host.is_empty() => return Ok(format!("{host}:{port}")),
        Err(_) if is_number && !host.is_empty() => {
            format!("port {port} of `{place}` is outside the range 0 to 65535")
        }
        _ => format!("`{place}` is not a valid address"),
    };
    Err(format!("{why}; write HOST:PORT, such as 127.0.0.1:29536").into())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_address_has_a_kind_and_a_place() {
        let serial = |path: &str, baud| Address::Serial(path.into(), baud);
        for (text, address) in [
            ("slcan:29536", Address::Slcan("127.0.0.1:29536".into())),
            ("slcan:localhost:1", Address::Slcan("localhost:1".into())),
            ("slcan:[::1]:65535", Address::Slcan("[::1]:65535".into())),
            (
                "socketcand:0.0.0.0:1",
                Address::Socketcand("0.0.0.0:1".into()),
            ),
            ("socketcan:vcan0", Address::SocketCan("vcan0".into())),
            ("slcan:/dev/ttyUSB0", serial("/dev/ttyUSB0", 115_200)),
            ("slcan:COM3@9600", serial("COM3", 9600)),
        ] {
            assert_eq!(Address::parse(text, "a form"), Ok(address), "{text}");
        }
        for (text, why) in [
            ("", "`` is not a valid link; write a form"),
            ("slcan", "is not a valid link"),
            ("slcan:", "is not a valid link"),
            ("can0", "is not a valid link"),
            ("udp:1", "is not a valid link"),
            ("socketcan:", "is not a valid link"),
            (
                "slcan:/dev/ttyS0@",
                "no valid bit rate after `@`; write `slcan:/dev/ttyS0@115200`",
            ),
            ("slcan:/dev/x@0", "no valid bit rate after `@`"),
            (
                "slcan:127.0.0.1:99999",
                "port 99999 of `127.0.0.1:99999` is outside",
            ),
            (
                "slcan:nowhere",
                "`nowhere` is not a valid address; write HOST:PORT",
            ),
            ("slcan::1", "is not a valid address"),
            ("slcan:127.0.0.1:+1", "is not a valid address"),
            ("socketcand:127.0.0.1:", "is not a valid address"),
            ("socketcand:127.0.0.1:-1", "is not a valid address"),
        ] {
            let refused = Address::parse(text, "a form").expect_err(text);
            assert!(refused.to_string().contains(why), "{text}: {refused}");
        }
    }
}
