//! 12: nodes of a network that do not fit together: rules that `network::check` and the readers of networks report.

use alloc::format;
use alloc::string::String;
use alloc::vec::Vec;

use crate::catalogue::{Eds, say};
use crate::finding::{Finding, Fixability, Form, Rule, Severity::Error};
use crate::fix::Fix;
use crate::network::BIT_RATES;
use crate::network::keys::{Keys, names};
use crate::network::node::{Node, Setting};
use crate::scan::forms::near;
use crate::scan::number::{before_comment, number};
use crate::scan::section::Text;
use crate::span::Span;
use crate::subject::shown;
use od_model::Address;

table! {
    E1201 (example)
    E1202 (example)
    W1203 (example)
    E1204 (example)
    W1205 (example)
    W1206 (example)
    W1207 (example)
    W1208 (example)
    E1209 (example)
    E1210 (example)
    W1211 (example)
    E1212 (example)
    W1213 (example)
    E1214 (example)
    W1215 (example)
}

pub(crate) static E1201: Rule = Rule {
    title: "two nodes have one node ID",
    why: "Both nodes answer each SDO request, and send with the same CAN-IDs: the bus reports bit errors, and the master cannot tell them apart.",
    source: "CiA 301, node ID",
    example: "two nodes with node_id: 5",
    says: "{first} and {second} have node ID {id}",
    help: "give each node a node ID of its own, from 1 to 127",
    ..Rule::of("E1201")
};

pub(crate) fn e1201_same_node_id(first: &Node, second: &Node) -> Finding {
    let place = |node: &Node| node.place_of(Setting::Key("node_id"));
    let finding = E1201.at(place(second)).related(place(first), FIRST);
    let finding = finding.fact("first", first.name.as_str());
    let finding = finding.fact("second", second.name.as_str());
    finding.fact("id", second.id)
}

/// Label of the first of two nodes or services.
const FIRST: &str = "{first}";

pub(crate) static E1202: Rule = Rule {
    title: "two nodes send one CAN-ID",
    why: "Two frames with one CAN-ID that begin at the same time have a bit error, which no arbitration resolves; and no receiver can tell which node sent a frame.",
    source: "CiA 301, pre-defined connection set; ISO 11898-1",
    example: "TPDO 1 of two nodes has cob_id: 0x181",
    says: "{first} and {second} have CAN-ID {id:03X}h",
    help: "give one of them another COB-ID, or make it not valid",
    ..Rule::of("E1202")
};

pub(crate) fn e1202_same_can_id(first: &Named, second: &Named, id: u32) -> Finding {
    let finding = E1202.at(second.1).related(first.1, FIRST);
    let finding = finding.fact("first", first.0.as_str());
    let finding = finding.fact("second", second.0.as_str());
    finding.fact("id", i128::from(id))
}

/// A service of a node in words, and its place in the project or the node list.
type Named = (String, Span);

pub(crate) static W1203: Rule = Rule {
    title: "consumer without a producer",
    why: "A node waits for a message that no node of the network sends: an RPDO keeps its values, a heartbeat consumer reports an error.",
    source: "CiA 301, PDO, SYNC, TIME and heartbeat",
    example: "1016h:01 = 0x000503E8, without node 5",
    says: "{consumer} waits for {what}, which no node sends",
    help: "add the producer, or make the consumer not valid",
    also: &[SYNC, SYNC_OF_MASTER],
    ..Rule::of("W1203")
};

/// Sentence for a synchronous PDO in a node list.
const SYNC: Form = Form {
    says: "{consumer} is synchronous, but no node sends SYNC (CAN-ID {id:03X}h)",
    help: "set bit 30 of 1005h and a period in 1006h in one node, or write another transmission type",
};

/// Sentence for a synchronous PDO in a project.
const SYNC_OF_MASTER: Form = Form {
    help: "write `sync_period: 10000` (microseconds) in `master`, or another transmission type",
    ..SYNC
};

pub(crate) fn w1203_no_producer(consumer: &Named, what: &str) -> Finding {
    let finding = W1203.at(consumer.1).fact("consumer", consumer.0.as_str());
    finding.fact("what", what)
}

/// The finding about a synchronous PDO without SYNC; `master` is the place where a project sets the period, or that of
/// its master.
pub(crate) fn w1203_no_sync(consumer: &Named, id: u32, master: Option<Span>) -> Finding {
    let finding = W1203.at(consumer.1).form(match master {
        Some(_) => &SYNC_OF_MASTER,
        None => &SYNC,
    });
    let finding = finding.fact("consumer", consumer.0.as_str()).fact("id", id);
    finding.related(master.unwrap_or_default(), "the master sends no SYNC")
}

pub(crate) static E1204: Rule = Rule {
    title: "heartbeat consumer time is too short",
    why: "The consumer time is not longer than the time between two heartbeats, so the consumer reports an error although the producer works.",
    source: "CiA 301, consumer heartbeat time (1016h)",
    example: "1016h:01 = 0x00050064 for a node 5 with 1017h = 100",
    says: "{consumer} waits {time} ms for the heartbeat of {producer}, which comes every {period} ms",
    help: "write at least 1.5 times the producer heartbeat time to 1016h",
    ..Rule::of("E1204")
};

pub(crate) fn e1204_consumer_time_too_short(
    consumer: &Node,
    time: u32,
    producer: &Node,
    period: u32,
) -> Finding {
    let place = consumer.place_of(Setting::Key("heartbeat_consumer"));
    let produced = producer.place_of(Setting::Key("heartbeat_producer"));
    let finding = E1204.at(place).related(produced, "the producer");
    let finding = finding.fact("consumer", consumer.name.as_str());
    let finding = finding.fact("time", i128::from(time));
    let finding = finding.fact("producer", producer.name.as_str());
    finding.fact("period", i128::from(period))
}

pub(crate) static W1205: Rule = Rule {
    title: "bus load is too high",
    why: "The periodic frames, with all stuff bits, take more than 80 % of the time: frames of low priority come late, and from 100 % on some never come.",
    source: "ISO 11898-1, frame format",
    example: "50 TPDOs of 8 bytes every 10 ms at 250 kbit/s",
    says: "periodic frames take up to {percent} % of {rate} kbit/s",
    help: "send them less often, or use a higher bit rate",
    ..Rule::of("W1205")
};

/// The finding about the bus load in percent.
pub(crate) fn w1205_bus_load(load: f64, rate: u32) -> Finding {
    let finding = W1205.finding().fact("percent", load as i128);
    finding.fact("rate", i128::from(rate))
}

pub(crate) static W1206: Rule = Rule {
    title: "PDO is shorter than its consumer maps",
    why: "A node does not process a PDO that is shorter than its mapping, and sends EMCY 8210h.",
    source: "CiA 301, PDO length and EMCY error code 8210h",
    example: "TPDO 1 with 2 bytes, received by an RPDO with 4",
    says: "{consumer} maps {mapped:byte|bytes}, but {producer} sends {sent:byte|bytes}",
    help: "map as many bytes as the producer sends, or map more objects in the producer",
    ..Rule::of("W1206")
};

pub(crate) fn w1206_pdo_too_short(
    consumer: &Named,
    mapped: u32,
    producer: &Named,
    sent: u32,
) -> Finding {
    let finding = W1206.at(consumer.1).related(producer.1, "the producer");
    let finding = finding.fact("consumer", consumer.0.as_str());
    let finding = finding.fact("producer", producer.0.as_str());
    let finding = finding.fact("mapped", i128::from(mapped));
    finding.fact("sent", i128::from(sent))
}

pub(crate) static W1207: Rule = Rule {
    title: "node list contradicts itself or a DCF",
    why: "A configuration tool leaves the node out, or configures it for another node ID or bit rate than it has.",
    source: "CiA 306-3, Topology; CiA 306-1, DeviceComissioning",
    example: "Node5DCFName=drive.dcf, and NodeID=6 in drive.dcf",
    says: "Nodes is {given}, but {count:node is|nodes are} present",
    help: "write `Nodes=0x{count:02X}`",
    fixability: Fixability::Either,
    also: &[
        NODE_ID, PRESENT, OTHER_ID, RENUMBER, BIT_RATE, KEY, TOPOLOGY, NAME, SECTION, TWICE,
    ],
    ..Rule::of("W1207")
};

/// Sentence for the key of a node that cannot exist.
const NODE_ID: Form = Form {
    says: "`{key}`: a node ID is 1 to 127; odkit ignores the node",
    help: "write the node ID of the node",
};

/// Sentence for a value of NodeXPresent.
const PRESENT: Form = Form {
    says: "Node{id}Present is `{given}`",
    help: "write 1 if the node is present, otherwise 0 (odkit assumes 1)",
};

/// Sentence for the NodeID of a DCF.
const OTHER_ID: Form = Form {
    says: "the node ID is {id} in this list, but NodeID is {own} in the DCF",
    help: "use one node ID in both files",
};

/// Sentence for the NodeID of a DCF that no node of the list has.
const RENUMBER: Form = Form {
    help: "write `Node{own}DCFName`, or use one node ID in both files",
    ..OTHER_ID
};

/// Sentence for the bit rate of a DCF.
const BIT_RATE: Form = Form {
    says: "Baudrate is {own} in the DCF, but {first} in that of an earlier node",
    help: "write one Baudrate in the DCFs of all nodes",
};

/// Sentence for a key that looks like one of CiA 306-3.
const KEY: Form = Form {
    says: "`{key}` is not a key of a node list",
    help: "write `{right}`",
};

/// Sentence for a section that looks like one with nodes.
const TOPOLOGY: Form = Form {
    says: "[{given}] is not a section of a node list; odkit reads it as [{right}]",
    help: "write `[{right}]`",
};

/// Sentence for the name of two nodes.
const NAME: Form = Form {
    says: "node {id} has the name `{given}`, as node {other} has",
    help: "give each node a name of its own: it is the name of its concise DCF",
};

/// Sentence for a second section of the same name.
const SECTION: Form = Form {
    says: "duplicate section [{given}]",
    help: "move the nodes of both into one section, or number the sections of several networks",
};

/// Sentence for a key that the section has before.
const TWICE: Form = Form {
    says: "duplicate key `{key}`; odkit uses the first",
    help: "remove one of the two lines",
};

/// The finding about a key that the section has before with the value `first`; `value` is that of the second.
pub(crate) fn w1207_key_twice(key: &Text<'_>, value: &Text<'_>, first: &Pair<'_>) -> Finding {
    let finding = W1207.at(key.span).form(&TWICE);
    let finding = finding.fact("key", key.as_ref());
    let finding = finding.related(first.0.span, "first given here");
    if value == first.1 {
        finding.fix(Fix::safe().remove_line(key.span))
    } else {
        finding
    }
}

/// A key of a node list and its value.
type Pair<'a> = (&'a Text<'a>, &'a Text<'a>);

/// The finding about a key that is probably misspelled, with the right one. It `is_needed` if its node is not complete
/// without it, and `is_free` if the section does not have the right one.
pub(crate) fn w1207_key_misspelled(
    key: &Text<'_>,
    right: &str,
    is_needed: bool,
    is_free: bool,
) -> Finding {
    let finding = W1207.at(key.span).form(&KEY).fact("key", key.as_ref());
    let finding = finding.fact("right", right);
    let finding = if is_free {
        finding.fix(Fix::unsafe_fix().replace(key.span, right))
    } else {
        finding
    };
    if is_needed {
        finding.severity_of(Error)
    } else {
        finding
    }
}

/// The finding about a section whose name is probably misspelled, with the right name.
pub(crate) fn w1207_section_misspelled(name: &Text<'_>, right: &str) -> Finding {
    let finding = W1207.given(name).form(&TOPOLOGY).severity_of(Error);
    let fix = Fix::unsafe_fix().replace(name.span, right);
    finding.fact("right", right).fix(fix)
}

pub(crate) fn w1207_same_name(name: &Text<'_>, id: u8, other: u8) -> Finding {
    let finding = W1207.given(name).form(&NAME).severity_of(Error);
    finding.fact("id", id).fact("other", other)
}

pub(crate) fn w1207_duplicate_section(header: Span, name: &Text<'_>) -> Finding {
    let finding = W1207.at(header).form(&SECTION);
    finding.fact("given", name.as_ref())
}

/// The finding about `Nodes`. A larger count is only safe if it is `certain`: no key of a node is wrong. A lower one never
/// is: a node may be missing.
pub(crate) fn w1207_node_count(given: &Text<'_>, count: usize, certain: bool) -> Finding {
    let grows = number(given).is_some_and(|given| given < count as i128);
    let fix = if grows && certain {
        Fix::safe()
    } else {
        Fix::unsafe_fix()
    };
    let finding = W1207.given(given).fact("count", count);
    finding.fix(fix.replace(without_comment(given), format!("0x{count:02X}")))
}

/// The part of a value before a comment.
fn without_comment(given: &Text<'_>) -> Span {
    Span {
        end: given.span.start + before_comment(given).len() as u32,
        ..given.span
    }
}

pub(crate) fn w1207_node_id_not_valid(key: &Text<'_>) -> Finding {
    let finding = W1207.at(key.span).form(&NODE_ID).severity_of(Error);
    finding.fact("key", key.as_ref())
}

pub(crate) fn w1207_present_not_valid(given: &Text<'_>, id: u8) -> Finding {
    let finding = W1207.given(given).form(&PRESENT).fact("id", id);
    let place = without_comment(given);
    match word(before_comment(given)) {
        Some(true) => finding.fix(Fix::safe().replace(place, "1")),
        Some(false) => finding.fix(Fix::unsafe_fix().replace(place, "0")),
        None => finding,
    }
}

/// The meaning of a word that people write for a flag, in English and in German.
fn word(given: &str) -> Option<bool> {
    let word = given.trim().to_ascii_lowercase();
    match word.as_str() {
        "yes" | "y" | "true" | "on" | "enable" | "enabled" | "1" | "ja" | "wahr" | "ein" => {
            Some(true)
        }
        "no" | "n" | "false" | "off" | "none" | "disable" | "disabled" | "0" | "nein"
        | "falsch" | "aus" => Some(false),
        _ => None,
    }
}

/// The finding about a DCF whose NodeID differs; `keys` are those of the node in the list, each with the key for the node
/// ID of the DCF. They are empty if the list has such a node.
pub(crate) fn w1207_node_id_differs(
    file: &Text<'_>,
    id: u8,
    own: u8,
    keys: &[(Span, String)],
) -> Finding {
    let form = if keys.is_empty() {
        &OTHER_ID
    } else {
        &RENUMBER
    };
    let finding = W1207.at(file.span).form(form).severity_of(Error);
    let fix = keys.iter().fold(Fix::unsafe_fix(), |fix, (key, right)| {
        fix.replace(*key, right.as_str())
    });
    finding.fact("id", id).fact("own", own).fix(fix)
}

pub(crate) fn w1207_bit_rate_differs(file: &Text<'_>, own: u32, first: u32) -> Finding {
    let finding = W1207.at(file.span).form(&BIT_RATE).severity_of(Error);
    finding.fact("own", own).fact("first", first)
}

pub(crate) static W1208: Rule = Rule {
    title: "key of a project is misspelled or given twice",
    why: "dcfgen ignores a key that it does not know, and the node keeps the value of its EDS. Of equal keys it uses the last.",
    source: "dcf-tools, dcfgen; ros2_canopen",
    example: "heartbeat_produce: 100",
    says: "{node}: `{given}` is not a key of dcfgen",
    help: "write `{right}`",
    fixability: Fixability::Unsafe,
    also: &[TWICE_IN_PROJECT],
    ..Rule::of("W1208")
};

/// Sentence for a key that the same mapping has before.
const TWICE_IN_PROJECT: Form = Form {
    says: "duplicate key `{given}`; dcfgen uses the last",
    help: "remove one of the two lines",
};

/// The finding about a key at `span` of a project that its mapping has before at `first`.
pub fn key_twice(given: &str, span: Span, first: Span) -> Finding {
    let finding = W1208.at(span).form(&TWICE_IN_PROJECT);
    finding
        .fact("given", given)
        .related(first, "first given here")
}

/// Returns the finding about a key of a node at `span`, if it looks like one that dcfgen knows; `has` tells which keys the
/// node has.
pub fn misspelled_key(
    node: &str,
    given: &str,
    known: Keys,
    span: Span,
    has: &dyn Fn(&str) -> bool,
) -> Option<Finding> {
    let right = match names(known).find(|own| own.eq_ignore_ascii_case(given)) {
        Some(own) => Some(own).filter(|_| names(known).all(|own| own != given)),
        None => near(given, names(known)),
    }?;
    let finding = W1208.at(span).fact("node", node).fact("given", given);
    let finding = finding.fact("right", right);
    Some(if has(right) {
        finding
    } else {
        finding.fix(Fix::unsafe_fix().replace(span, right))
    })
}

pub(crate) static E1209: Rule = Rule {
    title: "PDO of a project maps an object that is not mappable",
    why: "The node aborts the download of the mapping entry, and the master does not boot it. dcfgen writes the entry all the same, and so does odkit.",
    source: "CiA 301, PDO mapping parameter; CiA 306-1, PDOMapping and AccessType",
    example: "mapping: [{index: 0x1017}]",
    says: "{node}: {object} \"{name}\" is not mappable",
    help: "map another object",
    also: &[DIRECTION],
    ..Rule::of("E1209")
};

/// Sentence for an object of the other direction.
const DIRECTION: Form = Form {
    says: "{node}: {object} \"{name}\" is `{access}` and cannot be mapped into {pdo}",
    ..Form::OWN
};

/// Returns the finding about an object of a node in the mapping of a PDO at `span`, if the device cannot map it.
pub fn not_mappable(node: &Node, is_rpdo: bool, address: Address, span: Span) -> Option<Finding> {
    let object = node.description.objects.get(&address.index)?;
    let entry = object.entries.get(&address.sub)?;
    let access = *entry.access;
    let fits = if is_rpdo {
        access.maps_to_rpdo()
    } else {
        access.maps_to_tpdo()
    };
    let finding = E1209.at(span).about(address);
    let finding = finding.fact("node", node.name.as_str());
    let finding = finding.fact("object", shown(object, address));
    let finding = finding.fact("name", entry.name.as_str());
    match (*entry.mappable, fits) {
        (true, true) => None,
        (false, _) => Some(finding),
        (true, false) => {
            let pdo = if is_rpdo { "an RPDO" } else { "a TPDO" };
            let finding = finding.form(&DIRECTION).fact("access", access);
            Some(finding.fact("pdo", pdo))
        }
    }
}

pub(crate) static E1210: Rule = Rule {
    title: "CAN-ID of a network is reserved for another service",
    why: "A message with a CAN-ID of NMT, SDO, error control or LSS disturbs that service in all nodes.",
    source: "CiA 301, restricted CAN-IDs",
    example: "cob_id: 0x5F0",
    says: "{service} has CAN-ID {id:03X}h, which CiA 301 reserves for {owner}",
    help: "write a CAN-ID that CiA 301 leaves free, such as 0x181 to 0x57F for PDOs",
    ..Rule::of("E1210")
};

/// The finding about a service with this CAN-ID; `None` if no other service has it.
pub(crate) fn e1210_can_id_reserved(service: &Named, id: u32) -> Option<Finding> {
    let (_, owner) = od_model::restricted(id)?;
    let finding = E1210.at(service.1).fact("service", service.0.as_str());
    let finding = finding.fact("id", i128::from(id));
    Some(finding.fact("owner", owner.name()))
}

pub(crate) static W1211: Rule = Rule {
    title: "bit rate of a project is not one of CiA 301",
    why: "A device that knows the bit rates of CiA 301 only does not come on the bus. dcfgen writes the number into the DCF of the master.",
    source: "CiA 301, bit rates; dcf-tools, dcfgen",
    example: "baudrate: 300",
    says: "the bit rate is {rate} kbit/s",
    help: "write 10, 20, 50, 125, 250, 500, 800 or 1000, the bit rate of the nodes",
    also: &[BIT_RATE_WITH_UNIT, BIT_RATE_WORD],
    fixability: Fixability::Unsafe,
    ..Rule::of("W1211")
};

/// Sentence for a bit rate in bit/s.
const BIT_RATE_WITH_UNIT: Form = Form {
    says: "the bit rate is `{given}`, but its unit is kbit/s",
    help: "write {right}",
};

/// Sentence for a bit rate that is not a number.
const BIT_RATE_WORD: Form = Form {
    says: "the bit rate `{given}` is not a number",
    ..Form::OWN
};

/// Returns the finding about the bit rate of a project, which is in kbit/s, at `span`, if CiA 301 does not have it. `rate`
/// is its number, if it is one.
pub fn unusual_bit_rate(given: &str, rate: Option<u32>, span: Span) -> Option<Finding> {
    if rate.is_some_and(|rate| BIT_RATES.contains(&rate)) {
        return None;
    }
    let finding = W1211.at(span);
    let finding = match rate {
        Some(_) => finding,
        None => finding.severity_of(Error),
    };
    Some(match (meant_bit_rate(given), rate) {
        (Some(right), _) => {
            let fix = Fix::unsafe_fix().replace(span, format!("{right}"));
            let finding = finding.form(&BIT_RATE_WITH_UNIT).fact("given", given);
            finding.fact("right", right).fix(fix)
        }
        (None, Some(rate)) => finding.fact("rate", i128::from(rate)),
        (None, None) => finding.form(&BIT_RATE_WORD).fact("given", given),
    })
}

/// The bit rate of CiA 301 in kbit/s that a text with a unit means: 500 for `500000`, `500k`, `500 kbit/s` or `0.5M`.
fn meant_bit_rate(given: &str) -> Option<u32> {
    let end = given.find(|c: char| !c.is_ascii_digit() && c != '.' && c != '_');
    let (digits, unit) = given.split_at(end.unwrap_or(given.len()));
    let number: f64 = digits.replace('_', "").parse().ok()?;
    let kilobits = match unit.trim_start().chars().next() {
        Some('k' | 'K') => number,
        Some('m' | 'M') => number * 1000.0,
        Some('b' | 'B') | None => number / 1000.0,
        Some(_) => return None,
    };
    let mut known = BIT_RATES.iter().copied();
    known.find(|rate| f64::from(*rate) == kilobits)
}

pub(crate) static E1212: Rule = Rule {
    title: "project writes an object that is read-only",
    why: "The node aborts the download, and the master does not boot it. dcfgen writes the entry all the same, and so does odkit.",
    source: "CiA 306-1, AccessType; dcf-tools, dcfgen",
    example: "sdo: [{index: 0x1001, value: 0}]",
    says: "{node}: AccessType of {object} \"{name}\" is `{access}`",
    help: "remove the entry, or write another object",
    ..Rule::of("E1212")
};

/// Returns the finding about an object of a node that a project writes at `span`, if a master cannot write it.
pub fn read_only(node: &Node, address: Address, span: Span) -> Option<Finding> {
    let object = node.description.objects.get(&address.index)?;
    let entry = object.entries.get(&address.sub)?;
    let finding = E1212.at(span).about(address);
    let finding = finding.fact("node", node.name.as_str());
    let finding = finding.fact("object", shown(object, address));
    let finding = finding.fact("name", entry.name.as_str());
    let is_read_only = !entry.access.writable();
    is_read_only.then(|| finding.fact("access", *entry.access))
}

pub(crate) static W1213: Rule = Rule {
    title: "setting of SYNC in a project without a SYNC",
    why: "The master sends no SYNC, so the setting has no effect.",
    source: "CiA 301, SYNC; dcf-tools, dcfgen",
    example: "sync_window: 1000, without sync_period",
    says: "`{key}` has no effect without `sync_period`",
    help: "write `sync_period: 10000` (microseconds) in `master`, or remove `{key}`",
    ..Rule::of("W1213")
};

/// The finding about a setting of SYNC at `span` of a master that sends no SYNC.
pub fn no_sync(key: &str, span: Span) -> Finding {
    W1213.at(span).fact("key", key)
}

pub(crate) static E1214: Rule = Rule {
    title: "value of a project is not valid for its node",
    why: "The node aborts the download and the master does not boot it, or the node does not work as intended with the value.",
    source: "CiA 301 and device profiles, as for the value of an EDS",
    example: "transmission: 245",
    says: "{node}: {object}: {why} ({code})",
    help: "write another value; `odkit explain {code}` explains the rule",
    ..Rule::of("E1214")
};

/// The rules about the value of one object, and about values that go together. Those about COB-IDs are not among them:
/// the nodes of a network are compared with each other.
const OF_VALUES: [&str; 17] = [
    "E0414", "E0501", "E0505", "E0509", "E0512", "E0537", "W0511", "W0524", "W0525", "W0535",
    "W0536", "W0648", "W0649", "W0914", "W0915", "W0917", "W0952",
];

/// Returns the findings about values that a project writes: those that a check has only with the writes of the node.
/// `place` gives the place of what writes an object.
pub fn unfit_values(node: &Node, place: &dyn Fn(Address) -> Span) -> Vec<Finding> {
    if node.writes.is_empty() {
        return Vec::new();
    }
    let checked = |node: &Node| {
        let findings = crate::check::check(&node.description).into_iter();
        let own = findings.filter(|finding| OF_VALUES.contains(&finding.code()));
        own.filter_map(|finding| Some((finding.code(), finding.object?, finding)))
            .collect::<Vec<_>>()
    };
    let before = checked(node);
    let mut written = node.clone();
    written.apply();
    let new = checked(&written).into_iter().filter(|(code, object, _)| {
        let mut same = before.iter();
        !same.any(|(own, of, _)| (own, of) == (code, object))
    });
    new.filter_map(|(code, address, found)| {
        let object = written.description.objects.get(&address.index)?;
        let finding = E1214.at(place(address)).severity_of(found.severity);
        let finding = finding.about(address).fact("node", node.name.as_str());
        let finding = finding.fact("object", shown(object, address));
        let finding = finding.fact("code", code);
        Some(finding.fact("why", say(&found, &Eds).message))
    })
    .collect()
}

pub(crate) static W1215: Rule = Rule {
    title: "text in a project instead of a flag",
    why: "dcfgen reads each text that is not empty as true, also `\"false\"` and `nein`.",
    source: "dcf-tools, dcfgen; YAML 1.1, bool",
    example: "mandatory: nein",
    says: "{node}: {key} is the text `{given}`, which dcfgen reads as true",
    help: "write `true` or `false`",
    fixability: Fixability::Either,
    ..Rule::of("W1215")
};

/// Returns the finding about a text at `span` instead of a flag, unless it is a quoted word for true. The fix is safe if
/// the text means what dcfgen reads.
pub fn text_of_flag(node: &str, key: &str, given: &str, span: Span) -> Option<Finding> {
    let is_true = |word: &str| word.eq_ignore_ascii_case(given.trim());
    if ["true", "yes", "on"].into_iter().any(is_true) {
        return None;
    }
    let finding = W1215.at(span).fact("node", node).fact("key", key);
    let finding = finding.fact("given", given);
    Some(match word(given) {
        Some(true) => finding.fix(Fix::safe().replace(span, "true")),
        Some(false) => {
            let fix = Fix::unsafe_fix().replace(span, "false");
            finding.severity_of(Error).fix(fix)
        }
        None => finding,
    })
}
