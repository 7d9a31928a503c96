//! Projects of dcfgen: rules about their keys and values.

use alloc::format;
use alloc::vec::Vec;

use super::list::word;
use crate::catalogue::{Eds, say};
use crate::finding::{Finding, Fixability, Form, Rule, Severity::Error};
use crate::fix::Fix;
use crate::network::BIT_RATES;
use crate::network::keys::{Keys, names};
use crate::network::node::Node;
use crate::network::write::Unfit;
use crate::scan::forms::near;
use crate::scan::number::number;
use crate::span::Span;
use crate::subject::shown;
use od_model::Address;

pub(crate) static W1208: Rule = Rule {
    title: "key of a project is misspelled or given twice",
    why: "dcfgen ignores a key that it does not know, and the node keeps the value of its EDS. Of equal keys it uses the last.",
    source: "dcf-tools, dcfgen; ros2_canopen",
    example: "heartbeat_produce: 100",
    says: "{node}: `{given}` is not a key of dcfgen",
    help: "write `{right}`",
    fixability: Fixability::Either,
    also: &[TWICE_IN_PROJECT],
    ..Rule::of("W1208")
};

/// Sentence for a key that the same mapping has before.
const TWICE_IN_PROJECT: Form = Form {
    says: "duplicate key `{given}`; dcfgen uses the last",
    help: "remove one of the two lines",
};

/// The finding about a key at `span` of a project that its mapping has before at `first`. If the first is a whole line
/// (`is_line`), a fix removes it: nobody reads it. It is only safe if both have the same value (`is_same`).
pub fn key_twice(given: &str, span: Span, first: Span, is_line: bool, is_same: bool) -> Finding {
    let finding = W1208.at(span).form(&TWICE_IN_PROJECT);
    let finding = finding
        .fact("given", given)
        .related(first, "first given here");
    let fix = if is_same {
        Fix::safe()
    } else {
        Fix::unsafe_fix()
    };
    if is_line {
        finding.fix(fix.remove_line(first))
    } else {
        finding
    }
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
    fixability: Fixability::Unsafe,
    also: &[
        UNFIT,
        INDEX,
        NO_NUMBER,
        TOO_LARGE,
        NODE_ID_RANGE,
        PDO_NUMBER,
    ],
    ..Rule::of("E1214")
};

/// Sentence for a value that no write can have.
const UNFIT: Form = Form {
    says: "{why}",
    help: "write a value that the device can have, or remove the setting",
};

/// Sentence for an index with hexadecimal digits, but without `0x`.
const INDEX: Form = Form {
    says: "{node}: the index `{given}` is decimal, and the device has no object {index:04X}h",
    help: "write `{right}`",
};

/// Sentence for a text where a number is due.
const NO_NUMBER: Form = Form {
    says: "{node}: {key} `{given}` is not a number",
    help: "write a number, such as `1000` or `0x3E8`",
};

/// Sentence for a number that is too large or negative.
const TOO_LARGE: Form = Form {
    says: "{node}: {key} `{given}` is not valid",
    help: "write a number from 0 to {most}",
};

/// Sentence for a number that no node has.
const NODE_ID_RANGE: Form = Form {
    help: "write 1 to 127",
    ..TOO_LARGE
};

/// Sentence for a PDO that CiA 301 does not have.
const PDO_NUMBER: Form = Form {
    says: "{node}: {key} has `{given}`, which is not the number of a PDO",
    help: "write 1 to 512",
};

/// Returns the finding about a value that the device of a node cannot have; `span` is the place of the setting, `index` that
/// of its index, with the text of the project.
pub fn unfit(node: &Node, unfit: &Unfit, span: Span, index: Option<(&str, Span)>) -> Finding {
    let has = |index| node.description.objects.contains_key(&index);
    let meant = index.and_then(|(given, span)| {
        let decimal = given.parse().ok().filter(|index| !has(*index))?;
        let meant = u16::from_str_radix(given, 16)
            .ok()
            .filter(|index| has(*index))?;
        Some((given, span, decimal, format!("0x{meant:04X}")))
    });
    if let Some((given, span, decimal, right)) = meant {
        let finding = E1214.at(span).form(&INDEX).fact("node", node.name.as_str());
        let finding = finding
            .fact("given", given)
            .fact("index", i128::from(decimal));
        let fix = Fix::unsafe_fix().replace(span, right.as_str());
        return finding.fact("right", right).fix(fix);
    }
    let finding = E1214.at(span).form(&UNFIT).about(unfit.address);
    finding.fact("why", unfit.why.as_str())
}

/// Returns the finding about a value at `span` that is not a number up to `most`; `most` is `None` if each number is valid.
/// Its fix writes the number that the text means: without its unit or its quotes.
pub fn not_a_number(
    node: &str,
    key: &str,
    given: &str,
    is_number: bool,
    most: Option<u32>,
    span: Span,
) -> Finding {
    let finding = E1214.at(span).fact("node", node).fact("key", key);
    let finding = finding.fact("given", given);
    let finding = match most {
        Some(127) => finding.form(&NODE_ID_RANGE),
        Some(most) if is_number => finding.form(&TOO_LARGE).fact("most", most),
        _ => finding.form(&NO_NUMBER),
    };
    let meant = meant_number(key, given).filter(|_| !is_number);
    let meant = meant.filter(|meant| most.is_none_or(|most| (0..=most.into()).contains(meant)));
    match meant {
        Some(meant) => finding.fix(Fix::unsafe_fix().replace(span, format!("{meant}"))),
        None => finding,
    }
}

/// Returns the finding about a number below `rpdo` or `tpdo`, at `span`, that no PDO has.
pub fn no_pdo(node: &str, key: &str, given: &str, span: Span) -> Finding {
    let finding = E1214.at(span).form(&PDO_NUMBER).fact("node", node);
    finding.fact("key", key).fact("given", given)
}

/// The number that a text means for a key: a number of an EDS, or one with a unit of time.
fn meant_number(key: &str, given: &str) -> Option<i128> {
    let text = given.trim();
    if let Some(number) = number(text) {
        return Some(number);
    }
    let end = text.find(|c: char| !c.is_ascii_digit())?;
    let (digits, unit) = text.split_at(end);
    let microseconds = match unit.trim() {
        "us" | "µs" => 1,
        "ms" => 1_000,
        "s" => 1_000_000,
        _ => return None,
    };
    let own = match key {
        "sync_period" | "sync_window" => 1,
        "inhibit_time" | "emcy_inhibit_time" | "nmt_inhibit_time" => 100,
        "heartbeat_producer" | "guard_time" | "event_timer" | "event_deadline" | "boot_time" => {
            1_000
        }
        _ => return None,
    };
    let time = digits.parse::<i128>().ok()?.checked_mul(microseconds)?;
    (time % own == 0).then_some(time / own)
}

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
