use crate::finding::{Finding, Fixability, Form, Rule, Severity::Error};
use crate::fix::Fix;
use crate::span::{Span, Spanned};
use od_model::ObjectCode;

pub(crate) static RULE: Rule = Rule {
    code: "E0305",
    severity: Error,
    title: "VAR or DOMAIN has sub-objects",
    why: "A tool that trusts ObjectType misses the sub-objects. odkit assumes a RECORD, and uses the value of the VAR as sub-index 0 if that is missing.",
    source: "CiA 301, object codes",
    fixability: Fixability::Unsafe,
    says: "{code} cannot have sub-objects",
    help: "write `{ObjectType=0x9}` for a RECORD{fix}, or `{ObjectType=0x8}` for an ARRAY",
    also: &[COMPACT],
    ..Rule::NEW
};

/// Sentence for an object with CompactSubObj.
const COMPACT: Form = Form {
    help: "write `{ObjectType=0x8}` for an ARRAY{fix}",
    ..Form::OWN
};

/// The finding about sub-objects of an object whose code allows none, at its code if that is given.
pub(crate) fn finding(member: Span, code: Spanned<ObjectCode>, compact: bool) -> Finding {
    let finding = RULE.at(code.span.or(member)).fact("code", *code);
    let finding = match code.span.line {
        0 => finding,
        _ => finding.related(member, "this is a sub-object of it"),
    };
    let fix = |right| Fix::unsafe_fix().replace(code.span, right);
    if compact {
        finding.form(&COMPACT).fix(fix("0x8"))
    } else {
        finding.fix(fix("0x9"))
    }
}
