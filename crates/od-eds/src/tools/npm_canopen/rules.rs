//! The rules of the package `canopen` of npm.

use crate::finding::{Fixability, Form, Rule};
use crate::tools::tool::{Differences, REJECTS};

pub(super) const SOURCE: &str =
    "canopen 6.2.1 of npm, source/eds.js and functions/type_to_raw.js; ini 3.0.1";

pub(super) static DIFFERENCES: Differences =
    Differences::new(["T0311", "T0312", "T0313", "T0314"], SOURCE);

pub(super) static MISSING: Rule = Rule {
    code: "T0301",
    title: "a key that the tool needs is missing",
    source: SOURCE,
    says: "{tool} rejects the file: `[{section}]` has no `{name}`",
    help: "add `{name}`",
    example: "an object without ParameterName",
    ..REJECTS
};

pub(super) static EXTRA: Rule = Rule {
    code: "T0302",
    title: "a key that the tool does not allow for the ObjectType",
    source: SOURCE,
    says: "{tool} rejects the file: `{name}` is not allowed for an object of this type",
    help: "make the line a comment{fix}",
    fixability: Fixability::Safe,
    example: "AccessType of a RECORD, PDOMapping of a DOMAIN",
    ..REJECTS
};

pub(super) static CODE: Rule = Rule {
    code: "T0303",
    title: "an ObjectType that the tool does not know",
    source: SOURCE,
    says: "{tool} rejects the file: it does not know ObjectType {value}",
    help: "write the ObjectType of a VAR (0x7), ARRAY (0x8), RECORD (0x9) or DOMAIN (0x2)",
    example: "ObjectType=0x1",
    ..REJECTS
};

pub(super) static PARENT: Rule = Rule {
    code: "T0304",
    title: "a sub-object whose object has no sub-objects",
    source: SOURCE,
    says: "{tool} rejects the file: object {object} of `[{section}]` is missing, or is not an ARRAY or RECORD",
    help: "give the object a section with ObjectType 0x8 or 0x9",
    also: &[Form {
        says: "{tool} rejects the file: `[{section}]` has no valid sub-index for a sub-object of object {object}",
        help: "write a sub-index from 0 to FE",
    }],
    example: "[2000sub1] of a VAR",
    ..REJECTS
};

pub(super) static TWICE: Rule = Rule {
    code: "T0305",
    title: "duplicate object, in another case",
    source: SOURCE,
    says: "{tool} rejects the file: duplicate object {object}",
    help: "keep one of the two sections",
    example: "[100A] and [100a]",
    ..REJECTS
};

pub(super) static RANGE: Rule = Rule {
    code: "T0306",
    title: "a DefaultValue that the tool cannot store in its type",
    source: SOURCE,
    says: "{tool} rejects the file: it cannot store `{name}={value}` in its type",
    help: "write a decimal number of the type{fix}",
    fixability: Fixability::Safe,
    example: "DefaultValue=0xFF of an INTEGER8",
    ..REJECTS
};

pub(super) static LIMITS: Rule = Rule {
    code: "T0307",
    title: "a HighLimit that is below LowLimit as the tool reads them",
    source: SOURCE,
    says: "{tool} rejects the file: HighLimit is below LowLimit as it reads them",
    help: "write decimal numbers of the type",
    example: "LowLimit=0x80 and HighLimit=0x7F of an INTEGER8",
    ..REJECTS
};
