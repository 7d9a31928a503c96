//! Rules about the entries of 1016h: no node is monitored twice, each node ID is valid, and it is that of another node.

use alloc::collections::BTreeMap;
use alloc::vec::Vec;

use crate::finding::{Check, Finding, Fixability, Rule};
use crate::fix::Fix;
use crate::span::Span;
use crate::subject::{Entry, Object, start_number};

pub(crate) static E0650: Rule = Rule {
    buildable: true,
    title: "heartbeat consumer watches a node twice",
    why: "CiA 301 allows one entry for each node. The device aborts the download of the second entry.",
    source: "CiA 301, object 1016h",
    says: "node {node} has a heartbeat time in an entry before",
    help: "write 0{fix}, or the node ID of another node in bits 16 to 23",
    fixability: Fixability::Unsafe,
    check: Check::Object(check_twice),
    ..Rule::of("E0650")
};

fn check_twice(object: &Object<'_>, findings: &mut Vec<Finding>) {
    let mut known = BTreeMap::new();
    for (entry, span, node) in consumers(object).filter(|(_, _, node)| (1..=127).contains(node)) {
        match known.get(&node) {
            None => drop(known.insert(node, span)),
            Some(first) => {
                let finding = finding(&E0650, &entry, span, node);
                findings.push(finding.related(*first, "first time of this node"));
            }
        }
    }
}

pub(crate) static W0651: Rule = Rule {
    title: "heartbeat consumer watches a node that cannot exist",
    why: "The device ignores the entry, so it watches no node. Bits 16 to 23 are the node ID, 1 to 127, bits 0 to 15 the time.",
    source: "CiA 301, object 1016h",
    says: "node ID {node} is not valid, but the entry has a heartbeat time",
    help: "write a node ID from 1 to 127 in bits 16 to 23, or 0 for no entry{fix}",
    fixability: Fixability::Unsafe,
    check: Check::Object(check_nobody),
    ..Rule::of("W0651")
};

fn check_nobody(object: &Object<'_>, findings: &mut Vec<Finding>) {
    let wrong = consumers(object).filter(|(_, _, node)| !(1..=127).contains(node));
    findings.extend(wrong.map(|(entry, span, node)| finding(&W0651, &entry, span, node)));
}

pub(crate) static W0652: Rule = Rule {
    title: "node monitors its own heartbeat",
    why: "A node does not receive its own heartbeat, so after the first one of a node with the same ID it reports an error.",
    source: "CiA 301, object 1016h",
    says: "the entry monitors node {node}, which is this node",
    help: "write the node ID of another node in bits 16 to 23, or 0 for no entry{fix}",
    fixability: Fixability::Unsafe,
    check: Check::Object(check_itself),
    ..Rule::of("W0652")
};

fn check_itself(object: &Object<'_>, findings: &mut Vec<Finding>) {
    let own = object.description.commissioned_node_id();
    let wrong = consumers(object).filter(|(_, _, node)| own.is_some_and(|own| own == *node));
    findings.extend(wrong.map(|(entry, span, node)| finding(&W0652, &entry, span, node)));
}

/// The finding about an entry of a node, with the fix that empties the entry.
fn finding(rule: &'static Rule, entry: &Entry<'_>, span: Span, node: u8) -> Finding {
    let finding = rule.on(entry, span).fact("node", node);
    finding.fix(Fix::unsafe_fix().replace(span, "0"))
}

/// The entries of 1016h that have a heartbeat time, with their node IDs.
fn consumers<'a>(object: &Object<'a>) -> impl Iterator<Item = (Entry<'a>, Span, u8)> + use<'a> {
    let is_consumer = object.index == 0x1016;
    let entries = object.entries();
    entries.filter_map(move |entry| {
        let used = is_consumer && (1..=127).contains(&entry.address.sub);
        let number = start_number(entry.description, entry.address).filter(|_| used)?;
        let span = number.span.or(entry.span);
        let [low, high, node, _] = u32::try_from(number.value).ok()?.to_le_bytes();
        (low != 0 || high != 0).then_some((entry, span, node))
    })
}
