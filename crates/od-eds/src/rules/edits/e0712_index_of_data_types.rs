use crate::fact::Fact;
use crate::finding::{Finding, Form, Rule, Severity::Error};
use crate::patch::target::Target;
use crate::span::Spanned;

pub(crate) static RULE: Rule = Rule {
    code: "E0712",
    severity: Error,
    title: "added object has an index of the data types",
    why: "Below 1000h CiA 301 has data types (0001h to 001Fh, 0020h to 025Fh) and reserved indices; a mapping entry such as 0005h maps a dummy. odkit ignores the statement.",
    source: "CiA 301, object dictionary structure; odkit, object_dictionary!",
    example: "add 0x0005 { name = \"Order\"; type = u8 }",
    says: "{object} is below 1000h, where CiA 301 has data types",
    help: "write an index from `0x2000` to `0x5FFF` for an object of your own",
    also: &[ZERO],
    ..Rule::NEW
};

/// Index 0, which is nothing.
const ZERO: Form = Form {
    says: "{object} is not an index of an object",
    ..Form::OWN
};

/// The finding about an `add` below 1000h.
pub(crate) fn finding(target: &Spanned<Target>) -> Finding {
    let finding = target.finding(&RULE, target.span);
    let finding = finding.fact("object", Fact::Index(target.index));
    if target.index == 0 {
        finding.form(&ZERO)
    } else {
        finding
    }
}
