//! `odkit scan`: the nodes of a bus.

use od_model::Visible;
use od_tools::link::Link;
use od_tools::scan::{self, FoundNode, Scan, ScanTimes, SdoFault};
use od_wire::Duration;
use serde_json::{Value, json};

use crate::bus::{self, Format, names::Names};
use crate::failure::Failure;
use crate::output::{self, note};
use crate::report::plural;

/// Find the nodes on a bus
///
/// Listens to heartbeats and boot-up messages, then asks each node ID from 1 to 127 by SDO: state,
/// identity, device name, and which built-in device or file of --eds fits. Two nodes with one node
/// ID are reported. Nothing changes on the bus.
///
/// Exit code 0: nodes were found; 1: no node was found, or two have the same node ID.
#[derive(clap::Args)]
pub(crate) struct Args {
    #[command(flatten)]
    bus: bus::Args,
    /// Find the bit rate first, by listening only (slcan adapters)
    #[arg(long, conflicts_with = "bit_rate")]
    detect: bool,
    /// Time to listen before the first request, in ms; with --detect at each bit rate
    #[arg(long, value_name = "MS")]
    listen: Option<u64>,
    /// Time for each answer, in ms
    #[arg(long, value_name = "MS", default_value = "200")]
    answer: u64,
}

pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    let names = args.bus.names()?;
    let default = ScanTimes::default();
    let times = ScanTimes {
        listen: args.listen.map_or(default.listen, Duration::from_millis),
        answer: Duration::from_millis(args.answer),
    };
    let rate = if args.detect {
        Some(detect(args)?)
    } else {
        None
    };
    let mut bus = match rate {
        Some(rate) => args.bus.open_at(Some(rate))?,
        None => args.bus.open()?,
    };
    let scan = look(&mut bus, times)?;
    drop(bus);
    output::print(&match args.bus.format {
        Format::Text => text(&scan, rate, &names),
        Format::Json => format!("{:#}", report(&scan, rate, &names)),
    })?;
    let has_conflict = scan.nodes.iter().any(|node| !node.conflict.is_empty());
    if scan.nodes.is_empty() || has_conflict {
        Err(Failure::Reported(1))
    } else {
        Ok(())
    }
}

fn look(link: &mut impl Link, times: ScanTimes) -> Result<Scan, Failure> {
    let mut bar = output::Bar::new("scanning");
    let scan = scan::scan(link, times, |percent| bar.show(percent))?;
    bar.clear();
    Ok(scan)
}

/// The bit rate in kbit/s.
fn detect(args: &Args) -> Result<u16, Failure> {
    let mut bus = args.bus.open()?;
    let wait = Duration::from_millis(args.listen.unwrap_or(2000));
    let rate = scan::detect(&mut bus, wait, |rate| {
        note!("listening at {rate} kbit/s");
    })?;
    rate.ok_or_else(|| {
        Failure::Failed(
            "no frame came at any bit rate; switch the power of a node off and on for its boot-up \
             message, or listen longer with `--listen 10000`"
                .into(),
        )
    })
}

fn text(scan: &Scan, rate: Option<u16>, names: &Names) -> String {
    let mut lines = Vec::new();
    if let Some(rate) = rate {
        lines.push(format!("bit rate {rate} kbit/s"));
    }
    for one in &scan.nodes {
        let known = names
            .fitting(Some(one.node), one.identity)
            .map(|known| known.name);
        lines.push(format!(
            "node {:<3}  {:<16}  {}",
            one.node.raw(),
            state(one),
            title(one)
        ));
        let numbers = ["vendor-ID", "product code", "revision", "serial number"];
        let numbers = numbers.iter().zip(one.identity).filter_map(|(name, part)| {
            let part = part?;
            Some(match *name {
                "serial number" => format!("{name} {part}"),
                name => format!("{name} {part:X}h"),
            })
        });
        let numbers: Vec<String> = numbers.collect();
        if !numbers.is_empty() {
            lines.push(format!("          {}", numbers.join(", ")));
        }
        if let Some(known) = known {
            lines.push(format!("          fits {known}"));
        }
        if !one.conflict.is_empty() {
            let is_one = one.conflict.iter().all(|serial| *serial == one.conflict[0]);
            let serials: Vec<String> = one.conflict.iter().map(u32::to_string).collect();
            lines.push(if is_one {
                format!(
                    "          conflict: {} to one request, with the same serial number {}: the node responds twice, or two \
                     devices have this node ID and no serial number of their own",
                    plural(serials.len(), "response"),
                    serials[0]
                )
            } else {
                format!(
                    "          conflict: {} answer with this node ID (serial numbers {})",
                    plural(serials.len(), "node"),
                    serials.join(", ")
                )
            });
        }
    }
    if scan.has_unconfigured {
        lines.push("the bus has LSS slaves without a node ID; `odkit lss scan` finds them".into());
    }
    lines.push(match scan.nodes.len() {
        0 => "no node answers; check power, bit rate and terminators".into(),
        count => plural(count, "node"),
    });
    lines.join("\n")
}

/// The state, if it is known.
fn state(one: &FoundNode) -> String {
    match (one.state, one.has_booted, one.answers) {
        (Some(state), _, _) => state.to_string(),
        (None, true, _) => "booted".into(),
        // A node in Stopped would not respond.
        (None, false, _) => "no heartbeat".into(),
    }
}

fn title(one: &FoundNode) -> String {
    let mut parts: Vec<String> = Vec::new();
    let [name, hardware, software] = &one.texts;
    let is_shown = |text: &&String| !text.is_empty();
    parts.extend(
        name.as_ref()
            .filter(is_shown)
            .map(|name| Visible(name).to_string()),
    );
    if let Some(device_type) = one.device_type {
        parts.push(match device_type & 0xFFFF {
            0 => "no device profile".into(),
            profile => format!("CiA {profile}"),
        });
    }
    for (what, text) in [("hardware", hardware), ("software", software)] {
        if let Some(text) = text.as_ref().filter(is_shown) {
            parts.push(format!("{what} {}", Visible(text)));
        }
    }
    if let Some(fault) = one.fault {
        parts.push(
            match fault {
                SdoFault::OtherObject => "its SDO responses do not belong to the requests",
                SdoFault::TooShort => "its SDO responses are shorter than 8 bytes",
                SdoFault::Once => {
                    "responds to the first SDO request only: it is too slow, or another node uses its CAN-ID"
                }
            }
            .into(),
        );
    } else if !one.answers {
        parts.push("does not respond to SDO requests".into());
    } else if one.device_type.is_none() && parts.is_empty() {
        parts.push("1000h cannot be read; `odkit get` shows the reason".into());
    }
    parts.join(", ")
}

fn report(scan: &Scan, rate: Option<u16>, names: &Names) -> Value {
    let node = |one: &FoundNode| {
        let [vendor, product, revision, serial] = one.identity;
        let [name, hardware, software] = &one.texts;
        json!({
            "node": one.node.raw(),
            "state": one.state.map(|state| state.name()),
            "booted": one.has_booted,
            "sdo": one.answers,
            "sdo_wrong": one.fault.is_some(),
            "device_type": one.device_type,
            "vendor_id": vendor,
            "product_code": product,
            "revision_number": revision,
            "serial_number": serial,
            "name": name,
            "hardware_version": hardware,
            "software_version": software,
            "fits": names.fitting(Some(one.node), one.identity).map(|known| known.name),
            "conflict": one.conflict,
        })
    };
    json!({
        "bit_rate": rate,
        "nodes": scan.nodes.iter().map(node).collect::<Vec<_>>(),
        "unconfigured": scan.has_unconfigured,
    })
}
