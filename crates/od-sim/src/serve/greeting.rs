//! Greeting of a live bench: its devices, and commands to try next.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use od_runtime::NodeId;

use super::control::address::ControlAddress;
use super::error::Error;
use super::fleet::Maker;
use super::hint;
use super::links::opened::{Opened, Protocol};
use super::options::Options;
use super::terminal::{note, print as print_line};
use crate::bus::Bus;
use crate::device::VirtualDevice;
use crate::device::services::Services;
use crate::links::adapter::RATES;

/// What a person can type at a link on standard input.
const CONSOLE: &str = "\nstandard input takes frames (601#4000100000000000) and script lines \
                       for the\nworld outside the bus (power cycle 2s, shaft rpm 60, use 2)\n";

/// Prints the greeting to standard output, or to standard error if standard output carries frames.
pub(super) fn print(
    first: Option<&Maker<'_>>,
    args: &Options,
    bus: &Bus,
    links: &[Opened],
    control: Option<&ControlAddress>,
) -> Result<(), Error> {
    for (device, wanted) in bus.devices().iter().zip(&args.node_ids) {
        let node = device.node_id();
        if let Some(wanted) = wanted
            && *wanted != node
        {
            note(&format!(
                "the EEPROM contains node ID {node}; `--node-id {wanted}` applies to an empty EEPROM only"
            ));
        }
    }
    for (id, count) in shared(bus.devices()) {
        note(&format!(
            "warning: {count} devices have node ID {id}, and their frames collide; give each its own \
             with `--node-id`"
        ));
    }
    if args.quiet {
        return Ok(());
    }
    let has_frames =
        |link: &Opened| matches!(link, Opened::Ends(ends) if ends.protocol == Protocol::Lines);
    let to_error = links.iter().any(has_frames);
    let mut text = text(args, bus, links);
    if let Some(address) = control {
        // Writing to a String cannot fail.
        let _ = writeln!(
            text,
            "control {address}; `odkit ctl {address} \"power cycle 2s\"`"
        );
    }
    if let (Some(device), Some(first)) = (bus.devices().first(), first) {
        if hint::is_due(to_error) {
            for link in links {
                help(&mut text, link, first, device, args.bitrate);
            }
        } else {
            text.push_str("the commands to connect are further up in this terminal\n")
        }
        text.push_str("\nPress Ctrl-C to stop.");
    }
    if to_error {
        note(&text);
        return Ok(());
    }
    Ok(print_line(&text)?)
}

/// Node IDs of several devices, each with their number.
fn shared(devices: &[VirtualDevice]) -> BTreeMap<NodeId, usize> {
    let mut counts = BTreeMap::new();
    for device in devices.iter().filter(|device| device.is_configured()) {
        *counts.entry(device.node_id()).or_default() += 1;
    }
    counts.retain(|_, count| *count > 1);
    counts
}

fn text(args: &Options, bus: &Bus, links: &[Opened]) -> String {
    let places: Vec<String> = links.iter().map(place).collect();
    let places = places.join(", ");
    let mut text = String::new();
    // Writing to a String cannot fail.
    let devices = bus.devices();
    if devices.is_empty() {
        let _ = writeln!(text, "{places}");
        for link in links {
            if let Opened::Listener(Protocol::WebSocket(gate), _, address) = link {
                page(&mut text, &gate.address(*address));
            }
        }
        text.push_str("\nPress Ctrl-C to stop.\n");
        return text;
    }
    if let [device] = devices {
        let (title, node) = (device.title(), node(device));
        let _ = writeln!(text, "{title}, {node}; {places}");
    } else {
        let _ = writeln!(text, "{} devices; {places}", devices.len());
        for (number, device) in (1..).zip(devices) {
            let (title, node) = (device.title(), node(device));
            let _ = writeln!(text, "{number:>3}  {node:<10}  {title}");
        }
    }
    for device in devices {
        services(&mut text, device, devices.len() > 1);
    }
    let files: Vec<_> = args
        .eeproms
        .iter()
        .map(|path| path.display().to_string())
        .collect();
    let eeprom = match files.len() {
        0 => "in memory; `--eeprom FILE` saves it to a file".to_owned(),
        given if given < devices.len() => {
            format!("{}; the other nodes in memory", files.join(", "))
        }
        _ => files.join(", "),
    };
    let _ = writeln!(text, "EEPROM {eeprom}");
    text
}

/// `node 5`, or `no node ID`.
pub(super) fn node(device: &VirtualDevice) -> String {
    if device.is_configured() {
        format!("node {}", device.node_id())
    } else {
        String::from("no node ID")
    }
}

/// Services that the EDS of a device enables, and those that it promises but odkit does not simulate.
fn services(text: &mut String, device: &VirtualDevice, several: bool) {
    let Services { on, missing } = device.services();
    let of = if several {
        format!("{}: ", node(device))
    } else {
        String::new()
    };
    for (label, services) in [("services", on), ("not supported", missing)] {
        if !services.is_empty() {
            let _ = writeln!(text, "{of}{label}: {}", services.join(", "));
        }
    }
    let (switches, _) = device.switches();
    if switches != 0 {
        let _ = writeln!(
            text,
            "{of}rotary switches at {switches:02}: 2101h and LSS set the node ID after `switch node 0`"
        );
    }
}

fn place(link: &Opened) -> String {
    match link {
        Opened::Listener(Protocol::Socketcand, _, address) => format!("socketcand on {address}"),
        Opened::Listener(Protocol::WebSocket(gate), _, address) => {
            format!("pages on {}", gate.address(*address))
        }
        Opened::Listener(_, _, address) => format!("slcan on {address}"),
        Opened::Ends(ends) => match ends.protocol {
            Protocol::Slcan => format!("slcan on {}", ends.name),
            Protocol::CanFrame => format!("SocketCAN on {}", ends.name),
            _ => "standard input and output".into(),
        },
    }
}

/// Describes how the page of odkit reaches a WebSocket.
fn page(text: &mut String, address: &str) {
    let _ = writeln!(
        text,
        "\nthe page of odkit: open Connect and paste\n  {address}\nor, while `cargo xtask play` serves it, open\n  \
         http://127.0.0.1:8080/#bus={address}"
    );
}

/// Commands that reach the first device over this link.
fn help(text: &mut String, link: &Opened, maker: &Maker<'_>, device: &VirtualDevice, bitrate: u32) {
    let slcan = |channel: &str| {
        let connect = format!(
            "interface='slcan', channel='{channel}',\n                  \
             bitrate={bitrate}, sleep_after_open=0"
        );
        (connect, "canopen pyserial")
    };
    let (connect, needs) = match link {
        Opened::Listener(Protocol::Socketcand, _, address) => {
            let (host, port) = (address.ip(), address.port());
            let connect = format!(
                "interface='socketcand', channel='can0',\n                  host='{host}', port={port}"
            );
            (connect, "canopen")
        }
        Opened::Listener(Protocol::WebSocket(gate), _, address) => {
            return page(text, &gate.address(*address));
        }
        Opened::Listener(_, _, address) => slcan(&format!("socket://{address}")),
        Opened::Ends(ends) => match ends.protocol {
            Protocol::Slcan => slcan(&ends.name),
            Protocol::CanFrame => {
                let connect = format!("interface='socketcan', channel='{}'", ends.name);
                (connect, "canopen")
            }
            _ => {
                text.push_str(CONSOLE);
                return;
            }
        },
    };
    let node = device.node_id().raw();
    let scan = if device.is_configured() {
        String::new()
    } else {
        fast_scan(node)
    };
    let (description, read) = match maker.kind {
        Some(_) => (
            "canopen.ObjectDictionary()".to_owned(),
            "sdo.upload(0x1000, 0).hex()",
        ),
        None => (format!("{:?}", maker.name), "sdo[0x1000].raw"),
    };
    let _ = writeln!(
        text,
        "
python-canopen (pip install {needs})
  import canopen
  network = canopen.Network()
  network.connect({connect})
{scan}  node = network.add_node({node}, {description})
  print(node.{read})"
    );
    candump(text, link, node, bitrate);
}

/// Lines that give a device without a node ID this one, by LSS fastscan.
fn fast_scan(node: u8) -> String {
    format!(
        "  network.lss.fast_scan()
  network.lss.configure_node_id({node})
  network.lss.store_configuration()
  network.lss.send_switch_state_global(network.lss.WAITING_STATE)\n"
    )
}

/// Commands for candump; none for a link that Linux tools cannot open.
fn candump(text: &mut String, link: &Opened, node: u8, bitrate: u32) {
    // A bit rate without a number of slcan gets that of 500 kbit/s.
    let number = RATES
        .iter()
        .position(|kbit| u32::from(*kbit) * 1000 == bitrate);
    let speed = number.unwrap_or(6);
    let request = 0x600 + u16::from(node);
    let send = format!("{request:03X}#4000100000000000");
    let _ = match link {
        Opened::Listener(Protocol::Slcan, _, address) => writeln!(
            text,
            "
candump, as root on Linux
  socat pty,raw,echo=0,link=/dev/ttyodkit tcp:{address} &
  slcand -o -c -s{speed} ttyodkit can0
  ip link set can0 up
  candump can0 &
  cansend can0 {send}"
        ),
        Opened::Ends(ends) if ends.protocol == Protocol::Slcan => writeln!(
            text,
            "
candump, as root on Linux
  slcand -o -c -s{speed} {} can0
  ip link set can0 up
  candump can0 &
  cansend can0 {send}",
            ends.name
        ),
        Opened::Ends(ends) if ends.protocol == Protocol::CanFrame => writeln!(
            text,
            "
candump
  candump {name} &
  cansend {name} {send}",
            name = ends.name
        ),
        _ => Ok(()),
    };
}
