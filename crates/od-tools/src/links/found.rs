//! Buses that this computer can reach.

use od_sim::serve::running;

use crate::error::Error;

/// A network interface of this type is a CAN interface (`ARPHRD_CAN` of Linux).
const CAN: &str = "280";

/// The link to the running `odkit sim` of this user.
///
/// # Errors
/// None runs, or several do; the text lists values for `--link`.
pub fn default() -> Result<String, Error> {
    let mut running = running::links();
    match running.len() {
        1 => Ok(running.remove(0)),
        0 => {
            let found = interfaces();
            let list = if found.is_empty() {
                String::from("no CAN interface or serial port was found")
            } else {
                format!("interfaces found: {}", found.join(", "))
            };
            Err(Error::Link(format!(
                "no `odkit sim` runs; start one, or add `--link`, such as `--link socketcan:can0`\n\
                 {list}"
            )))
        }
        count => Err(Error::Link(format!(
            "{count} benches of `odkit sim` run; add `--link` with one of: {}",
            running.join(", ")
        ))),
    }
}

/// The CAN interfaces and serial ports of this computer, as `--link` takes them.
pub fn interfaces() -> Vec<String> {
    let mut found = Vec::new();
    for entry in std::fs::read_dir("/sys/class/net")
        .into_iter()
        .flatten()
        .flatten()
    {
        let kind = std::fs::read_to_string(entry.path().join("type")).unwrap_or_default();
        if kind.trim() == CAN {
            found.push(format!("socketcan:{}", entry.file_name().to_string_lossy()));
        }
    }
    let ports = serial2::SerialPort::available_ports().unwrap_or_default();
    let ports = ports.iter().map(|port| format!("slcan:{}", port.display()));
    // Every PC has these ports, also without an adapter.
    found.extend(ports.filter(|port| !port.starts_with("slcan:/dev/ttyS")));
    found.sort();
    found
}
