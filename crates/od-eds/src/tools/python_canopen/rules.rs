//! The rules of python-canopen.

use crate::finding::{Fixability, Form, Rule};
use crate::tools::shared;
use crate::tools::tool::{Differences, OTHERWISE, REJECTS};

pub(super) const SOURCE: &str = "canopen 2.4.1 of PyPI, canopen/objectdictionary/eds.py";

pub(super) static DIFFERENCES: Differences =
    Differences::new(["T0111", "T0112", "T0113", "T0114"], SOURCE);

pub(super) static ENCODING: Rule = Rule {
    code: "T0101",
    source: SOURCE,
    ..shared::ENCODING
};

pub(super) static LINE: Rule = Rule {
    code: "T0102",
    source: SOURCE,
    ..shared::LINE
};

pub(super) static TWICE: Rule = Rule {
    code: "T0103",
    source: SOURCE,
    ..shared::TWICE
};

pub(super) static MISSING: Rule = Rule {
    code: "T0104",
    title: "a key that the tool needs is missing",
    source: SOURCE,
    says: "{tool} rejects the file: `[{section}]` lacks `{name}`; the tool distinguishes upper and lower case",
    help: "add `{line}`{fix}",
    also: &[Form {
        help: "add `{line}`",
        ..Form::OWN
    }],
    fixability: Fixability::Either,
    example: "[DummyUsage] without Dummy0001",
    ..REJECTS
};

pub(super) static NUMBER: Rule = Rule {
    code: "T0105",
    title: "a value that the tool cannot read as a number",
    source: SOURCE,
    says: "{tool} rejects the file: it cannot read `{name}={value}` as a number",
    help: "write `{text}`{fix}",
    also: &[Form {
        help: "write a number such as `0x10`",
        ..Form::OWN
    }],
    fixability: Fixability::Either,
    example: "VendorNumber=",
    ..REJECTS
};

pub(super) static ORDER: Rule = Rule {
    code: "T0106",
    title: "a sub-object whose object is not in front of it",
    source: SOURCE,
    says: "{tool} rejects the file: no section in front of `[{section}]` makes object {object}",
    help: "put the section of the object in front of its sub-objects, with an ObjectType of VAR, DOMAIN, ARRAY or RECORD",
    example: "[2000sub1] above [2000]",
    ..REJECTS
};

pub(super) static NAMES: Rule = Rule {
    code: "T0107",
    title: "names of sub-objects for an object without sub-index 1",
    source: SOURCE,
    says: "{tool} rejects the file: object {object} of `[{section}]` has no sub-index 1 in front of it",
    help: "give the object CompactSubObj, or remove the section",
    example: "[2000Name] of a VAR",
    ..REJECTS
};

pub(super) static COMPACT: Rule = Rule {
    code: "T0115",
    title: "sub-objects of CompactSubObj, which the tool makes on demand",
    source: SOURCE,
    says: "{tool} makes the sub-objects of CompactSubObj on demand: sub-index 0 has no value, and names come out differently",
    help: "write a section for each sub-object",
    also: &[Form {
        says: "{tool} does not read `[{section}]`: the sub-objects of CompactSubObj have no values of their own",
        ..Form::OWN
    }],
    example: "CompactSubObj=4",
    ..OTHERWISE
};
