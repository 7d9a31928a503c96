//! Writes one line of JSON for the program that started the bench, when all links are open.

use std::fs;
use std::path::{Path, PathBuf};

use serde::Serialize;

use super::control::address::ControlAddress;
use super::error::Error;
use super::files::{self, Beside};
use super::links::opened::{Opened, Protocol};
use super::process;
use crate::bus::Bus;

/// A file that exists while the bench can be reached.
pub(super) struct Ready {
    path: PathBuf,
    /// Written content; empty before.
    written: String,
}

impl Ready {
    /// Removes the file of an earlier bench.
    ///
    /// # Errors
    /// The path belongs to another kind of file.
    pub(super) fn at(path: &Path) -> Result<Self, Error> {
        let failed = |why: &str| Error::Failed(format!("--ready-file {}: {why}", path.display()));
        match fs::symlink_metadata(path) {
            Ok(there) if !there.is_file() => {
                return Err(failed("it is not a file; give another path"));
            }
            Ok(_) if !is_ready_file(path) => {
                return Err(failed(
                    "the file exists and is not a ready file of odkit; give another path, or delete \
                     the file",
                ));
            }
            Ok(_) => fs::remove_file(path).map_err(|error| failed(&error.to_string()))?,
            Err(_) => {}
        }
        Ok(Self {
            path: path.to_owned(),
            written: String::new(),
        })
    }

    /// Writes the file in one step, so that no reader sees a part of it.
    ///
    /// # Errors
    /// The file cannot be written.
    pub(super) fn write(&mut self, line: &str) -> Result<(), Error> {
        let path = &self.path;
        self.written = format!("{line}\n");
        // Other users must not read the ports of this bench.
        let written = Beside::write(path, self.written.as_bytes(), true).and_then(Beside::put);
        written.map_err(|error| Error::Failed(format!("--ready-file {}: {error}", path.display())))
    }
}

impl Drop for Ready {
    fn drop(&mut self) {
        // Another bench may have written its own file there.
        let is_own = |content: Vec<u8>| content == self.written.as_bytes();
        if !self.written.is_empty() && fs::read(&self.path).is_ok_and(is_own) {
            let _ = fs::remove_file(&self.path);
        }
    }
}

/// Returns whether a file is empty or a report of a bench.
fn is_ready_file(path: &Path) -> bool {
    let Some(head) = files::head(path) else {
        return path.metadata().is_ok_and(|file| file.len() == 0);
    };
    let head: serde_json::Value = serde_json::from_slice(&head).unwrap_or_default();
    head["version"].is_u64() && head["pid"].is_u64() && head["links"].is_array()
}

/// Links with their ports and paths, nodes, and the control socket.
#[derive(Serialize)]
struct Report<'b> {
    version: u8,
    pid: u32,
    /// Start time of the process: with its number it identifies one process for ever.
    started: u64,
    links: Vec<Link>,
    nodes: Vec<Node<'b>>,
    control: Option<String>,
}

#[derive(Serialize)]
struct Link {
    link: &'static str,
    #[serde(flatten)]
    place: Reached,
}

/// The address for masters to reach a link.
#[derive(Serialize)]
#[serde(rename_all = "lowercase")]
enum Reached {
    Address(String),
    Url(String),
    Interface(String),
    Path(String),
}

#[derive(Serialize)]
struct Node<'b> {
    /// Counted from 1.
    number: usize,
    title: &'b str,
    node_id: Option<u8>,
    serial: u32,
}

/// The line for programs. Only the program that started the bench gets the tokens of its links: `with_tokens`.
pub(super) fn report(
    links: &[Opened],
    bus: &Bus,
    control: Option<&ControlAddress>,
    with_tokens: bool,
) -> String {
    let nodes = (1..).zip(bus.devices()).map(|(number, device)| Node {
        number,
        title: device.title(),
        node_id: device.is_configured().then(|| device.node_id().raw()),
        serial: device.lss_address()[3],
    });
    line(&Report {
        version: 1,
        pid: std::process::id(),
        started: process::started(std::process::id()).unwrap_or(0),
        links: links.iter().map(|one| link(one, with_tokens)).collect(),
        nodes: nodes.collect(),
        control: control.map(ControlAddress::to_string),
    })
}

fn link(link: &Opened, with_tokens: bool) -> Link {
    let (link, place) = match link {
        Opened::Listener(Protocol::WebSocket(gate), _, address) => {
            let url = if with_tokens {
                gate.address(*address)
            } else {
                format!("ws://{address}/")
            };
            ("ws", Reached::Url(url))
        }
        Opened::Listener(protocol, _, address) => {
            (protocol.name(), Reached::Address(address.to_string()))
        }
        Opened::Ends(ends) => match ends.protocol {
            Protocol::CanFrame => ("socketcan", Reached::Interface(ends.name.clone())),
            Protocol::Lines => ("-", Reached::Path(ends.name.clone())),
            protocol => (protocol.name(), Reached::Path(ends.name.clone())),
        },
    };
    Link { link, place }
}

/// One line of JSON.
pub(super) fn line(report: &impl Serialize) -> String {
    // This cannot fail: all maps of a report have text keys, and NaN becomes null.
    serde_json::to_string(report).expect("it has fields only")
}
