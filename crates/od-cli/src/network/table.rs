//! The report of a network as text: nodes, frames, bus load.

use std::fmt::Write;

use od_eds::network::{self, BIT_RATES, Frame, Trigger};

use od_model::Visible;

use super::project::Network;
use crate::report::plural;

/// The tables of a network, and the files that were written.
pub(super) fn table(
    network: &Network,
    bit_rate: Option<u32>,
    sync_period: u32,
    files: &[(String, Vec<u8>)],
) -> String {
    let mut out = String::new();
    let named = match network.name.as_str() {
        "" => String::new(),
        name => format!(" `{}`", Visible(name)),
    };
    let rate = bit_rate.map_or(String::new(), |rate| format!(", {rate} kbit/s"));
    let count = plural(network.nodes.len(), "node");
    // Writing to a String cannot fail.
    let _ = writeln!(out, "Network{named}: {count}{rate}\n");
    let _ = writeln!(
        out,
        "{:>4}  {:<24} {:>6}  concise DCF",
        "node", "name", "writes"
    );
    for node in &network.nodes {
        let file = format!("{}.bin", node.name);
        let own = files.iter().find(|(name, _)| *name == file);
        let file = own.map_or(String::new(), |(name, bytes)| {
            format!("{name}, {}", plural(bytes.len(), "byte"))
        });
        let (id, name, writes) = (node.id, Visible(&node.name), node.writes.len());
        let line = format!("{id:>4}  {name:<24} {writes:>6}  {file}");
        let _ = writeln!(out, "{}", line.trim_end());
    }
    let mut frames = network::frames(&network.nodes, sync_period);
    frames.sort_by_key(|frame| frame.id);
    let _ = writeln!(
        out,
        "\n{:>8}  {:<12} {:<24} {:>5}  period",
        "CAN-ID", "service", "from", "bytes"
    );
    for frame in &frames {
        let from = Visible(&network.nodes[frame.node].name);
        let (id, service) = (format!("{:03X}h", frame.id), frame.service);
        let line = format!(
            "{id:>8}  {service:<12} {from:<24} {:>5}  {}",
            frame.bytes,
            period(frame)
        );
        let _ = writeln!(out, "{}", line.trim_end());
    }
    let periodic = frames.iter().filter(|frame| frame.rate.is_ok()).count();
    let _ = writeln!(
        out,
        "\nBus load of {} with all stuff bits; SDO, EMCY and events come on top",
        plural(periodic, "periodic frame")
    );
    for rate in BIT_RATES {
        let load = network::load(&frames, rate);
        let mark = if Some(rate) == bit_rate {
            "  <- this network"
        } else {
            ""
        };
        let _ = writeln!(out, "{rate:>5} kbit/s  {load:>7.2} %{mark}");
    }
    out
}

fn period(frame: &Frame) -> String {
    match frame.rate {
        Ok(rate) => format!("{} ms", (1e6 / rate).round() / 1e3),
        Err(Trigger::Event) => "on event".into(),
        Err(Trigger::SyncAfterEvent) => "at SYNC after an event".into(),
        Err(Trigger::Syncs(1)) => "at each SYNC".into(),
        Err(Trigger::Syncs(count)) => format!("at each {count} SYNC messages"),
        Err(Trigger::Request) => "on request".into(),
    }
}
