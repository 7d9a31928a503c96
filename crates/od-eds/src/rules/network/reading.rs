//! Rules of the readers of projects and node lists: errors that end the reading of a node or of a network.

use alloc::format;

use crate::finding::{Finding, Form, Rule};
use crate::span::Span;

pub(crate) static E1216: Rule = Rule {
    title: "key of a network is missing",
    why: "Without the key a tool cannot tell which device the node is, or which node ID it has, and stops.",
    source: "dcf-tools, dcfgen; CiA 306-3, Topology",
    example: "left: {node_id: 2}",
    says: "{node}: the key `{key}` is missing",
    help: "add `{key}: {example}`",
    also: &[OF_LIST, SECTION_MISSING],
    ..Rule::of("E1216")
};

/// Sentence for a node of a node list without a file.
const OF_LIST: Form = Form {
    says: "{key} is missing",
    help: "add `{key}=` and the name of the DCF, or write `{present}=0`",
};

/// Sentence for a section that each network has.
const SECTION_MISSING: Form = Form {
    says: "the section {key} is missing",
    help: "add {key} with its nodes",
};

/// Returns the finding about a key that the node at `span` of a project lacks; `example` is a value.
pub fn missing_key(node: &str, key: &str, example: &str, span: Span) -> Finding {
    let finding = E1216.at(span).fact("node", node).fact("key", key);
    finding.fact("example", example)
}

/// Returns the finding about a section that a network lacks.
pub fn missing_section(name: &str) -> Finding {
    let finding = E1216.at(Span {
        line: 1,
        column: 1,
        ..Span::default()
    });
    finding.form(&SECTION_MISSING).fact("key", name)
}

pub(crate) fn e1216_no_file(id: u8, span: Span) -> Finding {
    let finding = E1216.at(span).form(&OF_LIST);
    let finding = finding.fact("key", format!("Node{id}DCFName"));
    finding.fact("present", format!("Node{id}Present"))
}

pub(crate) static E1217: Rule = Rule {
    title: "file of a node cannot be used",
    why: "Without the objects of the device no tool can configure the node.",
    source: "dcf-tools, dcfgen; CiA 306-3, Topology",
    example: "dcf: none.eds",
    says: "{node}: {file}: {why}",
    help: "write the path of an EDS, a DCF or an XDD; it begins in the folder of this file",
    ..Rule::of("E1217")
};

/// Returns the finding about the file of a node, which is named at `span`.
pub fn unusable_file(node: &str, file: &str, why: &str, span: Span) -> Finding {
    let finding = E1217.at(span).fact("node", node).fact("file", file);
    finding.fact("why", why)
}

pub(crate) static E1218: Rule = Rule {
    title: "text of a network cannot be read",
    why: "The text is not YAML, or it is larger than any network.",
    source: "YAML 1.1; CiA 306-3",
    example: "a: [1",
    says: "{why}",
    ..Rule::of("E1218")
};

/// Returns the finding about a text that cannot be read from `span` on.
pub fn unreadable(why: &str, span: Span) -> Finding {
    E1218.at(span).fact("why", why)
}
