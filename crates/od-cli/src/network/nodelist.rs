//! `nodelist.cpj`: the networks of a project and the DCF of each node (CiA 306-3).

use std::collections::BTreeMap;

use ini::{Ini, ParseOption, Properties};
use od_eds::network::{Node, saved};
use od_eds::{Description, network};

use super::project::Network;

/// Reads the networks of a node list; `load` reads the description at a path.
///
/// # Errors
/// The text is not a node list, or a description cannot be read; in words.
pub(super) fn read(
    text: &str,
    load: &dyn Fn(&str) -> Result<Description, String>,
) -> Result<Vec<Network>, String> {
    // A backslash in a path is not an escape.
    let options = ParseOption {
        enabled_escape: false,
        enabled_quote: false,
        ..ParseOption::default()
    };
    let file = Ini::load_from_str_opt(text, options).map_err(|error| error.to_string())?;
    let mut networks = Vec::new();
    for (name, keys) in file.iter() {
        let is_network = |name: &str| name.to_ascii_lowercase().starts_with("topology");
        if name.is_some_and(is_network) {
            networks.push(topology(keys, load)?);
        }
    }
    if networks.is_empty() {
        Err("the section [Topology] is missing".into())
    } else {
        Ok(networks)
    }
}

/// The values that are not empty, by their keys in lower case; the first of equal keys is used.
fn values(keys: &Properties) -> BTreeMap<String, &str> {
    let mut values = BTreeMap::new();
    for (key, value) in keys.iter().filter(|(_, value)| !value.trim().is_empty()) {
        values
            .entry(key.to_ascii_lowercase())
            .or_insert(value.trim());
    }
    values
}

fn topology(
    keys: &Properties,
    load: &dyn Fn(&str) -> Result<Description, String>,
) -> Result<Network, String> {
    let values = values(keys);
    let get = |key: &str| values.get(&key.to_ascii_lowercase()).copied();
    let mut network = Network {
        name: get("NetName").unwrap_or_default().into(),
        ..Network::default()
    };
    for id in 1..=127_u8 {
        // The number is decimal; some tools write hexadecimal digits.
        let key = |what: &str| {
            let decimal = get(&format!("Node{id}{what}"));
            decimal.or_else(|| get(&format!("Node0x{id:02X}{what}")))
        };
        let is_present = key("Present").and_then(od_model::values::integer);
        let Some(path) = key("DCFName").filter(|_| is_present != Some(0)) else {
            if is_present.is_some_and(|present| present != 0) {
                return Err(format!("Node{id}DCFName is missing"));
            }
            continue;
        };
        let path = path.replace('\\', "/");
        let description = load(&path).map_err(|why| format!("node {id}: {path}: {why}"))?;
        let rate = description.commissioning().and_then(|own| own.bit_rate);
        network.bit_rate = network.bit_rate.or(rate.map(u32::from));
        let name = key("Name").map_or(format!("node{id}"), Into::into);
        let mut node: Node = network::Node::new(name, id, description);
        node.writes = saved(&node)?;
        if !node.writes.is_empty() {
            node.configuration_file = format!("{}.bin", node.name);
        }
        network.nodes.push(node);
    }
    Ok(network)
}
