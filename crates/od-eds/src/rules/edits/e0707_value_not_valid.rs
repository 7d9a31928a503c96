use crate::fact::{Fact, Key};
use crate::finding::{Finding, Rule, Severity::Error};
use crate::patch::target::Target;
use crate::rules::values::shared::{NOT_VALID, WHOLE};
use crate::span::{Span, Spanned};
use od_model::{DataType, Kind};

pub(crate) static RULE: Rule = Rule {
    code: "E0707",
    severity: Error,
    title: "value of an edit is not valid for its type",
    why: "A default or a limit is a value of its type. odkit keeps the value of the base.",
    source: "odkit, object_dictionary!",
    example: "add 0x2000 { name = \"Gain\"; type = u8; default = 300 }",
    says: NOT_VALID,
    help: "write {form}",
    also: &[WHOLE],
    ..Rule::NEW
};

/// The finding about a value, as it is given, that is not valid for the type.
pub(crate) fn finding(
    target: &Spanned<Target>,
    at: Span,
    key: Key,
    given: &str,
    data_type: DataType,
) -> Finding {
    let finding = target.finding(&RULE, at).key(key);
    let finding = finding.fact("type", data_type);
    match data_type.kind() {
        Kind::Record => finding.form(&WHOLE).fact("right", DataType::Unsigned32),
        _ => finding
            .fact("given", given)
            .fact("form", Fact::FormOf(data_type)),
    }
}
