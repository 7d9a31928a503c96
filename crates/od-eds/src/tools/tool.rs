//! A tool that reads device files, and the result of reading one.

use alloc::collections::BTreeMap;
use alloc::string::String;
use alloc::vec::Vec;

use crate::fact::Key;
use crate::finding::{Finding, Fixability, Form, Rule, Severity};
use crate::log::KEPT;

/// Reads the text under a key as a value of this type.
pub(crate) type ReadValue = fn(Key, &str, i128) -> Option<Read>;

/// A program or a library that reads EDS and DCF files.
#[derive(Debug)]
pub struct Tool {
    /// Its name in `--for`.
    pub name: &'static str,
    /// The version that the rules describe.
    pub version: &'static str,
    /// The package that was run, or the public text that describes the behaviour.
    pub source: &'static str,
    /// Whether the rules were compared with the tool itself.
    pub tried: bool,
    /// Rules about content that it rejects, drops or reads differently.
    pub rules: &'static [&'static Rule],
    pub(crate) read: fn(&Input<'_>) -> Reading,
    /// Reads the text of a value as the tool does; `None` if this is not known.
    pub(crate) value: Option<ReadValue>,
    /// Rules for findings about single values; `None` if they are not known.
    pub(crate) differences: Option<&'static Differences>,
}

impl PartialEq for Tool {
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name
    }
}

/// The text of a file, as a tool receives it.
pub(crate) struct Input<'a> {
    /// The text after a byte order mark; `None` if it is not UTF-8.
    pub(crate) text: Option<&'a str>,
    /// The bytes of the file after the mark.
    pub(crate) bytes: &'a [u8],
    /// The text as odkit decodes it.
    pub(crate) decoded: &'a str,
    /// Whether it begins with the byte order mark of UTF-8.
    pub(crate) has_mark: bool,
}

/// A value as a tool reads it.
#[derive(Clone, PartialEq, Debug)]
pub enum Read {
    /// A number, limited to 127 bits.
    Number(i128),
    /// A real.
    Real(f64),
    /// A text.
    Text(String),
    /// Bytes.
    Bytes(Vec<u8>),
}

/// One value of an object as a tool reads it; an outer `None` is a field that the tool does not have.
#[derive(Clone, PartialEq, Debug, Default)]
#[allow(missing_docs)] // the fields are the keys' names
pub struct ReadEntry {
    pub name: Option<String>,
    pub data_type: Option<i128>,
    pub access: Option<String>,
    pub mappable: Option<bool>,
    pub default: Option<Option<Read>>,
    pub parameter: Option<Option<Read>>,
    pub low: Option<Option<Read>>,
    pub high: Option<Option<Read>>,
}

/// The result of reading a file with a tool.
#[derive(Clone, Debug, Default)]
pub struct Reading {
    /// The errors at which it stops, and other findings of its rules.
    pub findings: Vec<Finding>,
    /// The values by index and sub-index; not used if the tool rejects the file.
    pub entries: BTreeMap<(u32, u32), ReadEntry>,
    /// Objects whose sub-objects it makes when a program accesses them.
    pub on_demand: Vec<u32>,
    /// The node ID for which it computes values; `None` for the requested one.
    pub node_id: Option<i128>,
    rejects: bool,
}

impl Reading {
    /// Returns whether the tool rejects the file.
    pub fn is_rejected(&self) -> bool {
        self.rejects
    }

    /// Adds a finding of a tool's rule. Of more than [`KEPT`] only the first error is kept.
    pub(crate) fn push(&mut self, finding: Finding) {
        let is_first_error = finding.is_error() && !self.rejects;
        self.rejects |= is_first_error;
        if self.findings.len() < KEPT || is_first_error {
            self.findings.push(finding);
        }
    }
}

/// Rules of a tool's findings about single values.
#[derive(Debug)]
pub(crate) struct Differences {
    /// An object or a sub-object that it does not read.
    pub(crate) drops: Rule,
    /// A default or configured value that it drops or reads as another one.
    pub(crate) value: Rule,
    /// A limit that it drops or reads as another one.
    pub(crate) limit: Rule,
    /// A name, type, access or mapping that it reads as another one.
    pub(crate) field: Rule,
}

/// Sentences about a value: the tool drops it, and the text that all chosen tools read.
pub(crate) const DROPPED: Form = Form {
    says: "{tool} drops {key}, which is {own}",
    ..Form::OWN
};
pub(crate) const READS_WRITE: Form = Form {
    help: "write `{text}`{fix}",
    ..Form::OWN
};
pub(crate) const DROPPED_WRITE: Form = Form {
    says: DROPPED.says,
    help: READS_WRITE.help,
};

const DIFFERS: Rule = Rule {
    says: "{tool} reads {key} as {read}, not as {own}",
    also: &[DROPPED, READS_WRITE, DROPPED_WRITE],
    fixability: Fixability::Safe,
    ..OTHERWISE
};

impl Differences {
    /// The rules with these codes.
    pub(crate) const fn new(codes: [&'static str; 4], source: &'static str) -> Self {
        let [drops, value, limit, field] = codes;
        Self {
            drops: Rule {
                code: drops,
                source,
                title: "an object that the tool does not read",
                why: "The tool reads the file, and a program that uses it does not find the object.",
                says: "{tool} does not read the object",
                example: "ObjectType=0x5",
                also: &[Form {
                    says: "{tool} finds no object in the file",
                    ..Form::OWN
                }],
                ..OTHERWISE
            },
            value: Rule {
                code: value,
                source,
                title: "a value that the tool drops or reads as another one",
                why: "The tool reads the file, and a program that uses it works with another value.",
                example: "DefaultValue=010",
                ..DIFFERS
            },
            limit: Rule {
                code: limit,
                source,
                title: "a limit that the tool drops or reads as another one",
                why: "The tool reads the file, and a program that uses it checks values against another limit.",
                example: "HighLimit=1e3",
                ..DIFFERS
            },
            field: Rule {
                code: field,
                source,
                title: "a name, type, access or mapping that the tool reads as another one",
                why: "The tool reads the file, and a program that uses it finds another description of the object.",
                example: "PdoMapping=1",
                ..DIFFERS
            },
        }
    }
}

/// A rule about an error at which a tool stops.
pub(crate) const REJECTS: Rule = Rule {
    severity: Severity::Error,
    why: "The tool stops there and reads nothing of the file.",
    buildable: true,
    ..Rule::NEW
};

/// A rule about content that a tool drops or reads differently.
pub(crate) const OTHERWISE: Rule = Rule {
    severity: Severity::Warning,
    why: "The tool reads the file, but a part of it differently from the standard.",
    buildable: true,
    ..Rule::NEW
};
