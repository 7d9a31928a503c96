//! A CAN interface of Linux.

use super::opened::Opened;
use crate::serve::error::Error;

/// Opens an interface that exists and is up.
#[cfg(target_os = "linux")]
pub(super) fn open(name: &str) -> Result<Opened, Error> {
    let interface = super::interface::Interface::open(name)
        .map_err(|error| Error::Failed(advice(name, &error)))?;
    Ok(Opened::Ends(super::opened::Ends {
        name: name.to_owned(),
        protocol: super::opened::Protocol::CanFrame,
        port: Box::new(interface),
    }))
}

/// Message for an error, with the commands that help.
#[cfg(target_os = "linux")]
fn advice(name: &str, error: &std::io::Error) -> String {
    /// "Address family not supported by protocol": a kernel without CAN.
    const EAFNOSUPPORT: i32 = 97;
    const EPROTONOSUPPORT: i32 = 93;
    const ENODEV: i32 = 19;
    const ENXIO: i32 = 6;
    let virtual_one = format!(
        "sudo modprobe vcan && sudo ip link add {name} type vcan && sudo ip link set {name} up"
    );
    match error.raw_os_error() {
        Some(EAFNOSUPPORT | EPROTONOSUPPORT) => String::from(
            "this kernel does not support SocketCAN; load it with `sudo modprobe can-raw`, or use \
             `--link slcan:127.0.0.1:29536` in a container or without the module",
        ),
        Some(ENODEV | ENXIO) if name.starts_with("vcan") => {
            format!("CAN interface `{name}` does not exist; create it with `{virtual_one}`")
        }
        Some(ENODEV | ENXIO) => format!(
            "CAN interface `{name}` does not exist; `ip link show type can` lists the real ones, \
             which `sudo ip link set {name} up type can bitrate 500000` starts; a virtual one \
             is made with `sudo modprobe vcan && sudo ip link add vcan0 type vcan && sudo ip \
             link set vcan0 up`"
        ),
        _ if error.kind() == std::io::ErrorKind::PermissionDenied => format!(
            "{name} cannot be opened: {error}; give odkit the right to use raw sockets, such as \
             with `sudo setcap cap_net_raw+ep $(command -v odkit)`"
        ),
        _ => format!("{name}: {error}; `ip -details link show {name}` shows its configuration"),
    }
}

/// Only Linux has such interfaces.
#[cfg(not(target_os = "linux"))]
pub(super) fn open(_: &str) -> Result<Opened, Error> {
    Err(Error::Failed(String::from(
        "SocketCAN needs Linux; use `--link slcan:127.0.0.1:29536`",
    )))
}
