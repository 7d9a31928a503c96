//! Node lists (CiA 306-3) that contradict themselves or their DCFs: a rule that their reader reports.

use alloc::format;
use alloc::string::String;

use crate::finding::{Finding, Fixability, Form, Rule, Severity::Error};
use crate::fix::Fix;
use crate::scan::number::{before_comment, number};
use crate::scan::section::Text;
use crate::span::Span;

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
    let finding = match number(given) {
        Some(_) => finding,
        None => finding.severity_of(Error),
    };
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
    let finding = W1207.given(given).form(&PRESENT).severity_of(Error);
    let finding = finding.fact("id", id);
    let place = without_comment(given);
    match word(before_comment(given)) {
        Some(true) => finding.fix(Fix::safe().replace(place, "1")),
        Some(false) => finding.fix(Fix::unsafe_fix().replace(place, "0")),
        None => finding,
    }
}

/// The meaning of a word that people write for a flag, in English and in German.
pub(super) fn word(given: &str) -> Option<bool> {
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
