//! The options of a live bench, for every program that runs one.

use std::path::PathBuf;

use od_model::{Refused, values};
use od_runtime::NodeId;

use super::control::address::ControlAddress;
use super::links::{Link, web_socket};
use super::log;
use crate::grammar::size;

/// Options for running devices.
#[derive(Clone, PartialEq, Debug)]
pub struct Options {
    /// Node ID of each device, in their order; `None`: it starts without one.
    pub node_ids: Vec<Option<NodeId>>,
    /// Serial number of each device (1018h:04), in their order.
    pub serials: Vec<u32>,
    /// Links for masters; without any, slcan on port 29536 of this computer.
    pub links: Vec<Link>,
    /// Origins of pages that may use a WebSocket, besides those of this computer.
    pub origins: Vec<String>,
    /// Space for each string and DOMAIN that masters write, in bytes, in devices that a file describes.
    pub domain_size: u32,
    /// EEPROM file of each device, in their order; a device without one keeps its EEPROM in memory.
    pub eeproms: Vec<PathBuf>,
    /// Erase the EEPROM files at the start.
    pub eeprom_reset: bool,
    /// Raw position of the shaft at the start, in steps.
    pub position: Option<u64>,
    /// Speed of the shaft in revolutions per minute.
    pub rpm: Option<f64>,
    /// Seed for start positions of the shafts.
    pub seed: Option<u64>,
    /// Bit rate in the connection lines of the greeting, in bit/s.
    pub bitrate: u32,
    /// Limit of TCP clients at a time; further ones are refused.
    pub max_clients: usize,
    /// Address of the control socket.
    pub control: Option<ControlAddress>,
    /// Log file of the bus: pcapng if its name ends in .pcapng, otherwise candump.
    pub log: Option<PathBuf>,
    /// File that exists while the bench can be reached; `-`: a line on standard output.
    pub ready_file: Option<PathBuf>,
    /// Print problems only, no greeting and no news.
    pub quiet: bool,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            node_ids: Vec::new(),
            serials: Vec::new(),
            links: Vec::new(),
            origins: Vec::new(),
            domain_size: 1 << 20,
            eeproms: Vec::new(),
            eeprom_reset: false,
            position: None,
            rpm: None,
            seed: None,
            bitrate: 500_000,
            max_clients: 512,
            control: None,
            log: None,
            ready_file: None,
            quiet: false,
        }
    }
}

/// One option as written: `--name VALUE`, or `--name` if its value is "".
#[derive(Debug)]
pub struct Choice {
    /// Without the two dashes.
    pub name: &'static str,
    /// Placeholder of its value in help texts; empty: it has none.
    pub value: &'static str,
    /// Description, for help texts.
    pub help: &'static str,
    /// Value if the option is missing, for help texts.
    pub default: Option<&'static str>,
    /// It may be repeated.
    pub repeats: bool,
    /// The option that excludes it.
    pub conflicts: Option<&'static str>,
    set: fn(&mut Options, &str) -> Result<(), Refused>,
}

impl Choice {
    /// Stores a value in the options.
    ///
    /// # Errors
    /// The value is invalid; the message says why.
    pub fn set(&self, options: &mut Options, value: &str) -> Result<(), Refused> {
        (self.set)(options, value)
    }
}

const PLAIN: Choice = Choice {
    name: "",
    value: "",
    help: "",
    default: None,
    repeats: false,
    conflicts: None,
    set: |_, _| Ok(()),
};

/// Every option, in the order of help texts.
pub const CHOICES: [Choice; 17] = [
    Choice {
        name: "node-id",
        value: "N",
        help: "Node ID of the node at the start, 1 to 127, or `none` (255): the node waits for LSS. Repeat the \
               option for each further node (a redundant encoder has two). It also sets the rotary switches \
               of an encoder (1 to 99). Without the option a node gets 1, or the next free node ID",
        repeats: true,
        set: |options, text| {
            let node_id = match text {
                "none" | "255" => None,
                text => Some(node_id(text)?),
            };
            options.node_ids.push(node_id);
            Ok(())
        },
        ..PLAIN
    },
    Choice {
        name: "serial",
        value: "NUMBER",
        help: "Serial number of the node (1018h:04); repeat the option for each further node. Without it nodes \
               of one type get different ones",
        repeats: true,
        set: |options, text| {
            let value = values::integer(text).and_then(|value| u32::try_from(value).ok());
            let value = value.ok_or("write a number of at most 32 bits, such as 4712 or 0x1268")?;
            options.serials.push(value);
            Ok(())
        },
        ..PLAIN
    },
    Choice {
        name: "link",
        value: "LINK",
        help: "Link for masters; may be repeated [default: slcan:127.0.0.1:29536]",
        repeats: true,
        set: |options, text| Link::parse(text).map(|value| options.links.push(value)),
        ..PLAIN
    },
    Choice {
        name: "slcan",
        value: "HOST:PORT",
        help: "Same as --link slcan:HOST:PORT; port 0 selects a free port",
        set: |options, text| {
            let link = Link::parse(&format!("slcan:{text}"))?;
            options.links.insert(0, link);
            Ok(())
        },
        ..PLAIN
    },
    Choice {
        name: "origin",
        value: "URL",
        help: "Origin of a page that may use a ws link, such as https://example.org; may be repeated. \
               Pages of this computer may use it anyway",
        repeats: true,
        set: |options, text| {
            options.origins.push(web_socket::origin(text)?);
            Ok(())
        },
        ..PLAIN
    },
    Choice {
        name: "eeprom",
        value: "FILE",
        help: "File for the values that a node saves (1010h); a file of another device is refused. Repeat the \
               option for each further node \
               [default: in memory]",
        repeats: true,
        set: |options, text| {
            options.eeproms.push(PathBuf::from(text));
            Ok(())
        },
        ..PLAIN
    },
    Choice {
        name: "domain-size",
        value: "SIZE",
        help: "Room in bytes for each string and DOMAIN that masters write, such as 1025, 64KiB or 1MiB; a \
               longer default value has the room that it needs. Only for devices that a file describes",
        default: Some("1MiB"),
        set: |options, text| {
            let bytes = size::parse(text);
            let bytes = bytes.ok_or("write a number of bytes, such as 1025, 64KiB or 1MiB")?;
            options.domain_size = bytes;
            Ok(())
        },
        ..PLAIN
    },
    Choice {
        name: "eeprom-reset",
        help: "Erase the files of --eeprom at the start, even if another device saved them",
        set: |options, _| {
            options.eeprom_reset = true;
            Ok(())
        },
        ..PLAIN
    },
    Choice {
        name: "position",
        value: "STEPS",
        help: "Raw position of each encoder's shaft at the start in steps (497042 or 0x79592)",
        set: |options, text| position(text).map(|value| options.position = Some(value)),
        ..PLAIN
    },
    Choice {
        name: "rpm",
        value: "RPM",
        help: "Speed of each encoder's shaft in revolutions per minute; negative: backwards",
        set: |options, text| speed(text).map(|value| options.rpm = Some(value)),
        ..PLAIN
    },
    Choice {
        name: "seed",
        value: "NUMBER",
        help: "Seed for random start positions of the shafts",
        conflicts: Some("position"),
        set: |options, text| number(text).map(|value| options.seed = Some(value)),
        ..PLAIN
    },
    Choice {
        name: "bitrate",
        value: "BIT/S",
        help: "Bit rate in the printed commands; the simulated bus has no bit rate",
        default: Some("500000"),
        set: |options, text| number(text).map(|value| options.bitrate = value),
        ..PLAIN
    },
    Choice {
        name: "max-clients",
        value: "N",
        help: "Maximum number of TCP clients; further ones are refused",
        default: Some("512"),
        set: |options, text| number(text).map(|value| options.max_clients = value),
        ..PLAIN
    },
    Choice {
        name: "control",
        value: "unix:PATH|tcp:HOST:PORT",
        help: "Socket for the lines of `odkit ctl` while the bench runs: power, shaft, faults, values, `stats`. \
               Only this user can open it (TCP: each user of this computer)",
        set: |options, text| ControlAddress::parse(text).map(|value| options.control = Some(value)),
        ..PLAIN
    },
    Choice {
        name: "log",
        value: "FILE",
        help: "Log file of all frames with their times of day: pcapng if the name ends in .pcapng, \
               otherwise candump. odkit replaces a log of the same format, and refuses any other file",
        set: |options, text| {
            log::format(text.as_ref())?;
            options.log = Some(PathBuf::from(text));
            Ok(())
        },
        ..PLAIN
    },
    Choice {
        name: "ready-file",
        value: "PATH",
        help: "File of this user that is written when everything listens, in JSON: process and its start, \
               links with their ports and paths, nodes, control socket; `-`: one line on standard output, \
               which also has the token of a ws link. odkit replaces the ready file of an earlier bench, and \
               refuses any other file",
        set: |options, text| {
            options.ready_file = Some(PathBuf::from(text));
            Ok(())
        },
        ..PLAIN
    },
    Choice {
        name: "quiet",
        value: "",
        help: "Print problems only",
        set: |options, _| {
            options.quiet = true;
            Ok(())
        },
        ..PLAIN
    },
];

/// Reads a node ID.
///
/// # Errors
/// The number is not 1 to 127.
pub fn node_id(text: &str) -> Result<NodeId, Refused> {
    let number = values::integer(text).and_then(|value| u8::try_from(value).ok());
    let node = number.and_then(NodeId::new);
    node.ok_or_else(|| "write a node ID from 1 to 127".into())
}

fn position(text: &str) -> Result<u64, Refused> {
    let value = values::integer(text).and_then(|value| u64::try_from(value).ok());
    value.ok_or_else(|| "write a number of steps, such as 497042 or 0x79592".into())
}

fn speed(text: &str) -> Result<f64, Refused> {
    let value = text.parse().ok().filter(|rpm: &f64| rpm.is_finite());
    value.ok_or_else(|| "write a number of revolutions per minute, such as 60 or -1.5".into())
}

fn number<T: std::str::FromStr<Err: std::fmt::Display>>(text: &str) -> Result<T, Refused> {
    text.parse()
        .map_err(|error: T::Err| error.to_string().into())
}

/// Reads the arguments of a program with exactly these options.
///
/// # Errors
/// The argument that is wrong, and why.
pub(super) fn parse(arguments: impl IntoIterator<Item = String>) -> Result<Options, String> {
    let mut options = Options::default();
    let mut given: Vec<&str> = Vec::new();
    let mut arguments = arguments.into_iter();
    while let Some(argument) = arguments.next() {
        let (name, value) = match argument.split_once('=') {
            Some((name, value)) => (name, Some(value.to_owned())),
            None => (argument.as_str(), None),
        };
        let known = |choice: &&Choice| name.strip_prefix("--") == Some(choice.name);
        let Some(choice) = CHOICES.iter().find(known) else {
            return Err(format!("unexpected argument `{argument}`"));
        };
        let clash = choice.conflicts.filter(|other| given.contains(other));
        let clash = clash.or_else(|| {
            let other = |other: &&Choice| other.conflicts == Some(choice.name);
            let other = CHOICES.iter().find(other)?.name;
            given.contains(&other).then_some(other)
        });
        if let Some(other) = clash {
            return Err(format!("`{name}` cannot be used with `--{other}`"));
        }
        if given.contains(&choice.name) && !choice.repeats {
            return Err(format!("`{name}` is given twice"));
        }
        given.push(choice.name);
        let value = match (choice.value, value) {
            ("", None) => String::new(),
            ("", Some(_)) => return Err(format!("`{name}` has no value")),
            (form, value) => match value.or_else(|| arguments.next()) {
                Some(value) => value,
                None => return Err(format!("`{name}` needs a value, {form}")),
            },
        };
        choice
            .set(&mut options, &value)
            .map_err(|why| format!("`{value}` is not valid for `{name}`: {why}"))?;
    }
    Ok(options)
}

/// The options as a help text lists them.
pub(super) fn help() -> String {
    let mut text = String::from("Options:\n");
    for choice in &CHOICES {
        let Choice {
            name, value, help, ..
        } = choice;
        let value = match *value {
            "" => String::new(),
            value => format!(" <{value}>"),
        };
        text.push_str(&format!("      --{name}{value}\n          {help}\n"));
        if let Some(default) = choice.default {
            text.push_str(&format!("          [default: {default}]\n"));
        }
    }
    text.push_str("  -h, --help\n          Print help\n");
    text
}

#[cfg(test)]
mod tests;
