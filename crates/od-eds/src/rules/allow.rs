//! Rules whose codes begin with 08: findings that a file allows: rules that `allow` reports.

use crate::finding::{Finding, Fixability, Rule};
use crate::fix::Fix;
use crate::span::Span;

table! {
    W0801
    W0802
    I0803
}

pub(crate) static W0801: Rule = Rule {
    title: "odkit-allow names no rule",
    why: "The finding that the author has judged is still reported. `;odkit-allow=` accepts codes of findings in a file, separated by commas; odkit ignores any other code.",
    source: "odkit",
    says: "`{given}` is not the code of a finding",
    help: "write a code such as `W0311`; `odkit explain --list` lists them all",
    ..Rule::of("W0801")
};

/// The finding about a code that does not exist, or that no file can allow.
pub(crate) fn w0801_allow_without_rule(given: &str, span: Span) -> Finding {
    W0801.at(span).fact("given", given)
}

pub(crate) static W0802: Rule = Rule {
    title: "odkit-allow gives no reason",
    why: "The next person who reads the file cannot judge whether the finding is still acceptable. odkit allows nothing without a reason.",
    source: "odkit",
    says: "`odkit-allow={codes}` gives no reason",
    help: "write `;odkit-allow={codes} ` and the reason",
    ..Rule::of("W0802")
};

pub(crate) fn w0802_allow_without_reason(codes: &str, span: Span) -> Finding {
    W0802.at(span).fact("codes", codes)
}

pub(crate) static I0803: Rule = Rule {
    title: "odkit-allow matches no finding",
    why: "The finding was corrected, and the comment would hide it if it came back.",
    source: "odkit",
    fixability: Fixability::Unsafe,
    says: "`odkit-allow={code}` matches no finding",
    help: "remove the line{fix}",
    ..Rule::of("I0803")
};

pub(crate) fn i0803_allow_without_finding(code: &'static str, span: Span) -> Finding {
    let fix = Fix::unsafe_fix().remove_line(span);
    I0803.at(span).fact("code", code).fix(fix)
}
