//! Contradictions between the nodes of a network.

use alloc::collections::BTreeMap;
use alloc::format;
use alloc::string::String;
use alloc::vec::Vec;

use super::load::{frames, load};
use super::node::{Node, Setting};
use crate::finding::Finding;
use crate::identifiers::{Service, Used, mapping, used};
use crate::rules::network::nodes::{
    e1201_same_node_id, e1202_same_can_id, e1204_consumer_time_too_short, e1210_can_id_reserved,
    w1203_no_producer, w1203_no_sync, w1205_bus_load, w1206_pdo_too_short,
};
use crate::span::Span;

/// Bus load in percent above which frames of low priority come late.
const HIGH: f64 = 80.0;

/// Returns the findings about a network. Its nodes, with the master if there is one, have the values after their
/// writes ([`Node::apply`]). A master takes part in each PDO, so it does not count as
/// a second producer. `bit_rate` is in kbit/s, `sync_period` as in [`frames`].
pub fn check(
    nodes: &[Node],
    master: Option<usize>,
    bit_rate: u32,
    sync_period: u32,
) -> Vec<Finding> {
    let mut found = Vec::new();
    let mut ids: BTreeMap<u8, &Node> = BTreeMap::new();
    for node in nodes {
        match ids.get(&node.id) {
            Some(first) => found.push(e1201_same_node_id(first, node)),
            None => drop(ids.insert(node.id, node)),
        }
    }
    let has_sync = sync_period > 0 || nodes.iter().any(|node| node.sync_period() > 0);
    let all: Vec<Vec<Used>> = nodes.iter().map(|node| valid(node, has_sync)).collect();
    let mut sent = BTreeMap::new();
    let order = (0..nodes.len())
        .filter(|at| Some(*at) != master)
        .chain(master);
    for at in order {
        for used in all[at].iter().filter(|used| used.sends) {
            let is_partner = Some(at) == master && matches!(used.service, Service::Tpdo(_));
            let key = (used.is_extended, used.id);
            match sent.get(&key) {
                Some(&(other, own)) if !is_partner && nodes[at].id != nodes[other as usize].id => {
                    let first = &nodes[other as usize];
                    let (first, second) = (named(first, own), named(&nodes[at], used.service));
                    found.push(e1202_same_can_id(&first, &second, used.id));
                }
                Some(_) => {}
                None => drop(sent.insert(key, (at as u32, used.service))),
            }
        }
    }
    for (at, (node, own)) in nodes.iter().zip(&all).enumerate() {
        // A master has the CAN-IDs of its nodes.
        let own_ids = own.iter().filter(|_| Some(at) != master);
        for used in own_ids.filter(|used| is_set_by_network(used)) {
            found.extend(e1210_can_id_reserved(&named(node, used.service), used.id));
        }
        for used in own.iter().filter(|used| !used.sends) {
            let producer = sent.get(&(used.is_extended, used.id));
            match (used.service, producer) {
                (Service::Rpdo(_), Some(&(from, Service::Tpdo(number)))) => {
                    let from = &nodes[from as usize];
                    found.extend(length(node, used.service, from, number));
                }
                (Service::Rpdo(_) | Service::Time, None) => {
                    let what = format!("CAN-ID {:03X}h", used.id);
                    found.push(w1203_no_producer(&named(node, used.service), &what));
                }
                (Service::Sync, None) => {
                    if let Some(pdo) = synchronous(node, own) {
                        let own = master.map(|at| nodes[at].place_of(SYNC_PERIOD));
                        found.push(w1203_no_sync(&named(node, pdo), used.id, own));
                    }
                }
                _ => {}
            }
        }
        heartbeats(node, nodes, &mut found);
    }
    let load = load(&frames(nodes, sync_period), bit_rate);
    if load > HIGH {
        found.push(w1205_bus_load(load, bit_rate));
    }
    found
}

/// The setting of a project for the period of the master's SYNC.
const SYNC_PERIOD: Setting = Setting::Key("sync_period");

fn valid(node: &Node, has_sync: bool) -> Vec<Used> {
    let used = used(&node.description, node.id).into_iter();
    let valid = used.filter(|used| used.is_valid && used.id != 0);
    valid
        .filter(|used| match used.service {
            Service::Sync => !used.sends || has_sync,
            // A PDO without a mapping is never sent.
            Service::Tpdo(number) => bits(node, 0x19FF + number) > 0,
            Service::Rpdo(number) => bits(node, 0x15FF + number) > 0,
            _ => true,
        })
        .collect()
}

/// Returns whether a network sets the CAN-ID of this service, and whether it has 11 bits.
fn is_set_by_network(used: &Used) -> bool {
    let is_set = matches!(
        used.service,
        Service::Tpdo(_) | Service::Rpdo(_) | Service::Time
    );
    is_set && !used.is_extended
}

fn bits(node: &Node, index: u16) -> u32 {
    let mapped = mapping(&node.description, index);
    // A multiplexed PDO has 64.
    mapped.map_or(64, |mapped| {
        mapped.iter().map(|value| u32::from(value.bits)).sum()
    })
}

/// A node and its service in words, with the place where the network sets the service.
fn named(node: &Node, service: Service) -> (String, Span) {
    let setting = match service {
        Service::Tpdo(number) => Setting::Pdo("tpdo", number),
        Service::Rpdo(number) => Setting::Pdo("rpdo", number),
        Service::Time => Setting::Key("time_cob_id"),
        _ => Setting::Key("node_id"),
    };
    let name = format!("{service} of {}", node.name);
    (name, node.place_of(setting))
}

/// The first valid PDO of the node that waits for SYNC.
fn synchronous(node: &Node, used: &[Used]) -> Option<Service> {
    let waits = |used: &&Used| match used.service {
        Service::Tpdo(_) | Service::Rpdo(_) => {
            node.has_entry(used.address.index, 2)
                && matches!(node.number(used.address.index, 2), 0..=240 | 252)
        }
        _ => false,
    };
    used.iter().find(waits).map(|used| used.service)
}

fn length(node: &Node, service: Service, from: &Node, number: u16) -> Option<Finding> {
    let Service::Rpdo(own) = service else {
        return None;
    };
    let (mapped, sent) = (
        bits(node, 0x15FF + own).div_ceil(8),
        bits(from, 0x19FF + number).div_ceil(8),
    );
    (mapped > sent).then(|| {
        let (to, from) = (named(node, service), named(from, Service::Tpdo(number)));
        w1206_pdo_too_short(&to, mapped, &from, sent)
    })
}

/// The heartbeats that a node watches (1016h).
fn heartbeats(node: &Node, nodes: &[Node], found: &mut Vec<Finding>) {
    for sub in node.members(0x1016) {
        let value = node.number(0x1016, sub);
        let (id, time) = (value >> 16 & 0xFF, value & 0xFFFF);
        if time == 0 || !(1..=127).contains(&id) {
            continue;
        }
        let producer = nodes.iter().find(|other| u32::from(other.id) == id);
        match producer.map(|producer| (producer, producer.number(0x1017, 0))) {
            Some((producer, own)) if own > 0 => {
                if time <= own {
                    found.push(e1204_consumer_time_too_short(node, time, producer, own));
                }
            }
            _ => {
                let what = format!("the heartbeat of node {id}");
                let consumer = format!("heartbeat consumer 1016h:{sub:02X} of {}", node.name);
                let place = node.place_of(Setting::Key("heartbeat_consumer"));
                found.push(w1203_no_producer(&(consumer, place), &what));
            }
        }
    }
}
