//! Section names, and the rule of a file that a tool rejects: the readers of several tools use them.

use crate::finding::{Fixability, Form, Rule};
use crate::fix::Fix;
use crate::tools::configparser::{Fault, Ini};
use crate::tools::tool::{REJECTS, Reading};

/// The node ID for which a tool reads a file.
pub(crate) const NODE_ID: i128 = 1;

/// The kind of a section by its name, with the patterns of python-canopen, which other tools use, too.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) enum Names {
    Object(u32),
    Member(u32, u32),
    /// `[2000Name]`, whatever follows.
    Labels(u32),
    Dummies,
    Other,
}

impl Names {
    pub(crate) fn of(name: &str) -> Self {
        if matches!(
            name,
            "DummyUsage" | "dummyUsage" | "Dummyusage" | "dummyusage"
        ) {
            return Self::Dummies;
        }
        let is_hex =
            |text: &str| !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_hexdigit());
        let Some((index, rest)) = name.split_at_checked(4).filter(|(index, _)| is_hex(index))
        else {
            return Self::Other;
        };
        let index = u32::from_str_radix(index, 16).unwrap_or(0);
        if rest.is_empty() {
            return Self::Object(index);
        }
        if rest.starts_with("Name") {
            return Self::Labels(index);
        }
        let sub = rest
            .strip_prefix(['S', 's', '|'])
            .and_then(|rest| rest.strip_prefix("ub"));
        match sub.filter(|sub| is_hex(sub)) {
            Some(sub) => Self::Member(index, u32::from_str_radix(sub, 16).unwrap_or(u32::MAX)),
            None => Self::Other,
        }
    }
}

pub(crate) const ENCODING: Rule = Rule {
    title: "a file that is not UTF-8, or begins with a byte order mark",
    says: "{tool} rejects the file: it is not UTF-8",
    help: "save it as ASCII or UTF-8 without a byte order mark",
    also: &[Form {
        says: "{tool} rejects the file: it begins with a byte order mark",
        ..Form::OWN
    }],
    example: "Größe in Windows-1252",
    ..REJECTS
};

pub(crate) const LINE: Rule = Rule {
    title: "a line that is not a section, a key with its value, or a comment",
    says: "{tool} rejects the file: the line is not a section, `key=value` or a comment",
    help: "make it a comment{fix}",
    also: &[Form {
        says: "{tool} rejects the file: there is text before the first section",
        ..Form::OWN
    }],
    fixability: Fixability::Safe,
    example: "AccessType",
    ..REJECTS
};

pub(crate) const TWICE: Rule = Rule {
    title: "duplicate section or key",
    says: "{tool} rejects the file: its section has `{name}` twice",
    help: "make the second one a comment{fix}",
    also: &[Form {
        says: "{tool} rejects the file: duplicate section `[{name}]`",
        help: "keep one of the two sections",
    }],
    fixability: Fixability::Safe,
    example: "DataType=0x5 twice in one section",
    ..REJECTS
};

/// Errors at which Python's `configparser` stops, by the rules of a tool.
pub(crate) fn faults(
    reading: &mut Reading,
    ini: &Ini<'_>,
    line: &'static Rule,
    twice: &'static Rule,
) {
    for fault in &ini.faults {
        reading.push(match *fault {
            Fault::NoSection(at) => line
                .at(at)
                .form(&line.also[0])
                .fix(Fix::safe().comment_out(at)),
            Fault::NoPair(at) => line.at(at).fix(Fix::safe().comment_out(at)),
            Fault::Section { name, at, first } => {
                let finding = twice.at(at).form(&twice.also[0]).fact("name", name);
                finding.related(first, "the first one is here")
            }
            Fault::Key { key, line, first } => {
                let finding = twice.at(line).fact("name", key);
                let finding = finding.related(first, "the first one is here");
                finding.fix(Fix::safe().comment_out(line))
            }
        });
    }
}
