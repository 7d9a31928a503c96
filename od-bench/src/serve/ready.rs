//! One line of JSON for the program that started the bench, when everything listens.

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};

use super::control::place::Place;
use super::failure::Failure;
use super::json::Json;
use super::links::opened::{Opened, Protocol};
use crate::bus::Bus;

/// A file that is there while the bench can be reached.
pub(super) struct Ready(PathBuf);

impl Ready {
    /// Removes what an earlier bench left.
    ///
    /// # Errors
    /// The path is not one of a file.
    pub(super) fn at(path: &Path) -> Result<Self, Failure> {
        let failed = |why: &str| Failure::Failed(format!("--ready-file {}: {why}", path.display()));
        match fs::symlink_metadata(path) {
            Ok(there) if !there.is_file() => {
                return Err(failed("it is not a file; give another path"));
            }
            Ok(_) => fs::remove_file(path).map_err(|error| failed(&error.to_string()))?,
            Err(_) => {}
        }
        Ok(Self(path.to_owned()))
    }

    /// Writes the file whole: it is there with all of its content, or not at all.
    ///
    /// # Errors
    /// It cannot be written.
    pub(super) fn write(&self, json: &Json) -> Result<(), Failure> {
        let Self(path) = self;
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        let new = path.with_file_name(format!(".{name}.{}", std::process::id()));
        let _ = fs::remove_file(&new);
        let mut file = fs::OpenOptions::new();
        let file = file.write(true).create_new(true).open(&new);
        let written = file.and_then(|mut file| file.write_all(format!("{json}\n").as_bytes()));
        written
            .and_then(|()| fs::rename(&new, path))
            .map_err(|error| {
                let _ = fs::remove_file(&new);
                Failure::Failed(format!("--ready-file {}: {error}", path.display()))
            })
    }
}

impl Drop for Ready {
    fn drop(&mut self) {
        let _ = fs::remove_file(&self.0);
    }
}

/// Links with their ports and paths, nodes, control socket.
pub(super) fn report(links: &[Opened], bus: &Bus, control: Option<&Place>) -> Json {
    let nodes = (1_u64..).zip(bus.devices()).map(|(number, device)| {
        let node_id = match device.is_configured() {
            true => u64::from(device.node_id().raw()).into(),
            false => Json::Null,
        };
        Json::Object(vec![
            ("number", number.into()),
            ("title", device.title().into()),
            ("node_id", node_id),
            ("serial", u64::from(device.lss_address()[3]).into()),
        ])
    });
    let control = control.map_or(Json::Null, |place| place.to_string().into());
    Json::Object(vec![
        ("version", 1.into()),
        ("pid", u64::from(std::process::id()).into()),
        ("links", Json::List(links.iter().map(link).collect())),
        ("nodes", Json::List(nodes.collect())),
        ("control", control),
    ])
}

fn link(link: &Opened) -> Json {
    let (kind, key, place) = match link {
        Opened::Listener(protocol, _, address) => (protocol.name(), "address", address.to_string()),
        Opened::Ends(ends) => match ends.protocol {
            Protocol::CanFrame => ("socketcan", "interface", ends.name.clone()),
            Protocol::Lines => ("-", "path", ends.name.clone()),
            protocol => (protocol.name(), "path", ends.name.clone()),
        },
    };
    Json::Object(vec![("link", kind.into()), (key, place.into())])
}
