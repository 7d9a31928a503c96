//! The frames of a node as a DBC, the format of bus analysers for the names of signals.

mod message;
mod names;

use alloc::collections::BTreeSet;
use alloc::format;
use alloc::string::String;
use alloc::vec::Vec;
use core::fmt::Write;

use crate::description::Description;
use crate::finding::Finding;
use crate::identifiers::{Service, Used, used};
use crate::rules::convert::w1113_same_can_id;
use message::{Message, Sign, Signal};
use names::{quoted, symbol};

/// Longest name that every tool reads; a longer one is also stored completely in an attribute.
const SHORT: usize = 32;

/// Returns the DBC of a node with this node ID, and findings about content that it lacks.
///
/// PDOs have the mapping of the description. PDOs that are not valid are included, unless another message
/// has their CAN-ID.
pub fn write(description: &Description, node: u8) -> (String, Vec<Finding>) {
    let mut found = Vec::new();
    let mut messages = alloc::vec![message::nmt()];
    let mut ids = BTreeSet::from([0]);
    let mut all = used(description, node);
    // An invalid service leaves its CAN-ID to valid services.
    all.sort_by_key(|used| !used.is_valid);
    for used in all {
        let Some(message) = message::message(description, &used, node, &mut found) else {
            continue;
        };
        if ids.insert(message.id) {
            messages.push(message);
        } else if is_lost(&used) {
            found.push(w1113_same_can_id(used.address, used.id));
        }
    }
    messages.sort_by_key(|message| message.id);
    crate::finding::sort(&mut found);
    (text(description, node, &messages), found)
}

/// Returns whether to report a lost message: a PDO, or a service with a valid CAN-ID.
fn is_lost(used: &Used) -> bool {
    match used.service {
        Service::Tpdo(_) | Service::Rpdo(_) => true,
        _ => used.is_valid && used.id != 0,
    }
}

fn text(description: &Description, node: u8, messages: &[Message]) -> String {
    let product = description
        .section("DeviceInfo")
        .and_then(|info| info.get("ProductName"));
    let product = product.map_or("", |product| product.trim());
    let own = match product {
        "" => format!("N{node}"),
        product => format!("N{node}_{}", symbol(product)),
    };
    let own = short(&own, &mut BTreeSet::new());
    let mut out = String::from("VERSION \"\"\n\nNS_ :\n\nBS_:\n\n");
    // Writing to a String cannot fail, here and below.
    let _ = writeln!(out, "BU_: {own}\n");
    let mut after = String::new();
    let mut kinds = String::new();
    let mut long = String::new();
    let mut names = BTreeSet::new();
    for message in messages {
        let id = message.id;
        let (sender, receiver) = if message.sends {
            (own.as_str(), "Vector__XXX")
        } else {
            ("Vector__XXX", own.as_str())
        };
        let name = short(&message.name, &mut names);
        let _ = writeln!(out, "BO_ {id} {name}: {} {sender}", message.length);
        if !message.comment.is_empty() {
            let _ = writeln!(after, "CM_ BO_ {id} {};", quoted(&message.comment));
        }
        let mut names = BTreeSet::new();
        for signal in &message.signals {
            let name = short(&signal.name, &mut names);
            let line = line(signal, &name, receiver);
            out.push_str(&line);
            if name != signal.name {
                let whole = quoted(&signal.name);
                let _ = writeln!(
                    long,
                    "BA_ \"SystemSignalLongSymbol\" SG_ {id} {name} {whole};"
                );
            }
            if !signal.comment.is_empty() {
                let _ = writeln!(after, "CM_ SG_ {id} {name} {};", quoted(&signal.comment));
            }
            kind(&mut kinds, id, signal, &name);
        }
        out.push('\n');
    }
    out.push_str(&after);
    if !long.is_empty() {
        out.push_str(
            "BA_DEF_ SG_ \"SystemSignalLongSymbol\" STRING ;\n\
             BA_DEF_DEF_ \"SystemSignalLongSymbol\" \"\";\n",
        );
        out.push_str(&long);
    }
    // Tables of values must come before the types of reals.
    let (tables, reals): (Vec<&str>, Vec<&str>) =
        kinds.lines().partition(|line| line.starts_with("VAL_ "));
    for line in tables.into_iter().chain(reals) {
        let _ = writeln!(out, "{line}");
    }
    out
}

/// A name that is short enough and different from the previous ones.
fn short(name: &str, taken: &mut BTreeSet<String>) -> String {
    let mut candidate: String = name.chars().take(SHORT).collect();
    let mut number = 2;
    while !taken.insert(candidate.clone()) {
        let suffix = format!("_{number}");
        candidate = name.chars().take(SHORT - suffix.len()).collect::<String>() + &suffix;
        number += 1;
    }
    candidate
}

fn line(signal: &Signal, name: &str, receiver: &str) -> String {
    let sign = if signal.sign == Sign::Unsigned {
        '+'
    } else {
        '-'
    };
    let (low, high) = signal.limits.unwrap_or((0, 0));
    let (first, bits, unit) = (signal.first, signal.bits, quoted(&signal.unit));
    format!(" SG_ {name} : {first}|{bits}@1{sign} (1,0) [{low}|{high}] {unit} {receiver}\n")
}

/// The table of values, or the type of a real.
fn kind(out: &mut String, id: u32, signal: &Signal, name: &str) {
    if signal.sign == Sign::Real {
        let code = if signal.bits == 32 { 1 } else { 2 };
        let _ = writeln!(out, "SIG_VALTYPE_ {id} {name} : {code};");
    }
    if !signal.values.is_empty() {
        let values = signal.values.iter();
        let values: String = values
            .map(|(value, text)| format!(" {value} {}", quoted(text)))
            .collect();
        let _ = writeln!(out, "VAL_ {id} {name}{values} ;");
    }
}
