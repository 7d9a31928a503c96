//! Spellings of a value that have one meaning, but that not every tool reads.

use crate::fact::Key;
use crate::finding::{Finding, Fixability, Rule, Severity::Error};
use crate::fix::Fix;
use crate::scan::section::Text;

/// The defaults of a rule about a spelling: a safe fix writes the value in the form that every tool reads.
const fn spelling(code: &'static str) -> Rule {
    Rule {
        source: "CiA 306-1, numbers",
        fixability: Fixability::Safe,
        help: "write `{key={right}}`{fix}",
        ..Rule::of(code)
    }
}

/// The defaults of a rule about a spelling that CiA 306 does not have: python-canopen loses the value or the file, dcf-tools
/// and canopen-rs lose the file.
const fn foreign(code: &'static str) -> Rule {
    Rule {
        severity: Error,
        buildable: true,
        ..spelling(code)
    }
}

pub(crate) static I0408: Rule = Rule {
    title: "number with a leading 0 is octal",
    why: "`010` is 8 in C and in odkit, but 10 in some tools.",
    says: "odkit reads `{given}` as octal",
    ..spelling("I0408")
};

pub(crate) static W0409: Rule = Rule {
    title: "number with a leading 0 is not octal",
    why: "`08` is not a valid octal number. odkit reads it as decimal; many EDS parsers reject it.",
    says: "odkit reads `{given}` as decimal",
    ..foreign("W0409")
};

pub(crate) static I0410: Rule = Rule {
    title: "negative number in two's complement",
    why: "In a signed type, a hexadecimal number can be the bit pattern: FFh is -1 in an INTEGER8. odkit reads it so; some tools do not.",
    says: "odkit reads `{given}` as a negative number",
    ..spelling("I0410")
};

pub(crate) static I0411: Rule = Rule {
    buildable: true,
    title: "$NODEID formula is not written as `$NODEID+n`",
    why: "odkit also reads another order, other case and blanks; some tools do not. Without `$NODEID` no tool finds the node ID, and the finding is an error.",
    source: "CiA 306-1, $NODEID",
    says: "odkit reads `{given}` as `$NODEID` plus a number",
    ..spelling("I0411")
};

pub(crate) static W0419: Rule = Rule {
    title: "byte string is not hexadecimal",
    why: "An OCTET_STRING or a DOMAIN is written as hexadecimal bytes. odkit uses the codes of the characters.",
    source: "CiA 306-1, object sections",
    says: "`{given}` is not a string of hexadecimal bytes",
    ..spelling("W0419")
};

pub(crate) static W0420: Rule = Rule {
    title: "number has a suffix or a decimal point",
    why: "`0x10L` and `5.0` are how other languages write integers. odkit reads the integer; many EDS parsers reject it.",
    says: "odkit reads `{given}` as an integer",
    ..foreign("W0420")
};

pub(crate) static W0421: Rule = Rule {
    title: "BOOLEAN is neither 0 nor 1",
    why: "`true` and `false` are words of other formats. odkit reads them as 1 and 0; many EDS parsers reject them.",
    source: "CiA 306-1, object sections",
    says: "odkit reads `{given}` as a number",
    ..foreign("W0421")
};

pub(crate) static W0422: Rule = Rule {
    title: "hexadecimal number without `0x`",
    why: "`FF` and `1Fh` are how other formats write 0xFF and 0x1F. odkit reads them so; many EDS parsers reject them.",
    says: "odkit reads `{given}` as hexadecimal",
    ..foreign("W0422")
};

pub(crate) static W0423: Rule = Rule {
    title: "decimal comma",
    why: "odkit reads the comma as a decimal point; many EDS parsers reject it.",
    says: "odkit reads `{given}` with a decimal point",
    ..foreign("W0423")
};

pub(crate) static W0424: Rule = Rule {
    title: "word instead of the value of CiA 306",
    why: "Types and object codes are numbers, PDOMapping is 0 or 1, and AccessType is one of six words. odkit reads what the word means; many EDS parsers reject it.",
    source: "CiA 306-1, object sections",
    says: "odkit reads `{given}` as `{right}`",
    ..foreign("W0424")
};

/// The finding about a value that odkit reads, though not every tool does.
pub(crate) fn read_as(rule: &'static Rule, key: Key, given: &Text<'_>, right: &str) -> Finding {
    rule.at(given.span)
        .key(key)
        .fact("given", &*given.value)
        .fact("right", right)
        .fix(Fix::safe().replace(given.span, right))
}
