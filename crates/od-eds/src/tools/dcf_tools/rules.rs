//! The rules of dcf-tools.

use crate::finding::{Fixability, Form, Rule};
use crate::tools::shared;
use crate::tools::tool::{Differences, REJECTS};

pub(super) const SOURCE: &str = "dcf-tools 2.4.2 of PyPI, dcf/lint.py and dcf/device.py";

pub(super) static DIFFERENCES: Differences =
    Differences::new(["T0211", "T0212", "T0213", "T0214"], SOURCE);

pub(super) static NOT_TEXT: Rule = Rule {
    code: "T0201",
    source: SOURCE,
    ..shared::ENCODING
};

pub(super) static NO_PAIR: Rule = Rule {
    code: "T0202",
    source: SOURCE,
    ..shared::LINE
};

pub(super) static DOUBLE: Rule = Rule {
    code: "T0203",
    source: SOURCE,
    ..shared::TWICE
};

pub(super) static UNKNOWN: Rule = Rule {
    code: "T0204",
    title: "a section, a key or a word that the tool does not know",
    source: SOURCE,
    says: "{tool} rejects the file: it does not know the key `{name}` of `[{section}]`",
    help: "make the line a comment{fix}",
    also: &[
        Form {
            says: "{tool} rejects the file: it does not know the section `[{section}]`",
            help: "make its lines comments",
        },
        Form {
            says: "{tool} rejects the file: it does not know `{name}={value}`",
            help: "write a value of CiA 306-1",
        },
    ],
    fixability: Fixability::Unsafe,
    example: "[Tools]",
    ..REJECTS
};

pub(super) static MISSING: Rule = Rule {
    code: "T0205",
    title: "a section or a key that the tool needs is missing",
    source: SOURCE,
    says: "{tool} rejects the file: `[{section}]` has no `{name}`",
    help: "add `{name}`",
    also: &[Form {
        says: "{tool} rejects the file: section `[{section}]` is missing",
        help: "add the section",
    }],
    example: "no [ManufacturerObjects]",
    ..REJECTS
};

pub(super) static NUMBER: Rule = Rule {
    code: "T0206",
    title: "a value that the tool cannot read as a number",
    source: SOURCE,
    says: "{tool} rejects the file: it cannot read `{name}={value}`",
    help: "write `{name}={text}`{fix}",
    also: &[
        Form {
            help: "write a number such as `0x10`",
            ..Form::OWN
        },
        Form {
            help: "write the bits of the real, such as `0x3FC00000` for 1.5 in a REAL32",
            ..Form::OWN
        },
    ],
    fixability: Fixability::Safe,
    example: "DefaultValue=1.5",
    ..REJECTS
};

pub(super) static LIST: Rule = Rule {
    code: "T0207",
    title: "a list of objects that the tool does not accept",
    source: SOURCE,
    says: "{tool} rejects the file: {what} in `[{section}]`",
    help: "correct the list",
    example: "6000h in [ManufacturerObjects]",
    ..REJECTS
};

pub(super) static MEMBERS: Rule = Rule {
    code: "T0208",
    title: "sub-objects of an object that the tool does not accept",
    source: SOURCE,
    says: "{tool} rejects the file: {what} in `[{section}]`",
    help: "correct the object and its sub-objects",
    example: "SubNumber=3 with 2 sub-objects",
    ..REJECTS
};

pub(super) static RANGE: Rule = Rule {
    code: "T0209",
    title: "a value that is beyond its type or its limits as the tool reads them",
    source: SOURCE,
    says: "{tool} rejects the file: {name} `{value}` is beyond {what}",
    help: "write a decimal number inside the limits",
    example: "DefaultValue=0xFF of an INTEGER8",
    ..REJECTS
};

pub(super) static REFERENCE: Rule = Rule {
    code: "T0210",
    title: "an object that another one needs is missing",
    source: SOURCE,
    says: "{tool} rejects the file: {what} needs {object}, which is not in the file or its lists",
    help: "add the object, or correct the one that needs it",
    example: "1400h without 1600h",
    ..REJECTS
};
