use crate::finding::{Finding, Form, Rule, Severity::Warning};
use crate::scan::known::Form as Wanted;
use crate::scan::placed::Text;

pub(crate) static RULE: Rule = Rule {
    code: "W0609",
    severity: Warning,
    title: "value of a section that describes no object is none of its kind",
    why: "Flags are 0 or 1, numbers are numbers within their range. It is kept as text, and counts as missing.",
    source: "CiA 306-1, FileInfo, DeviceInfo, DummyUsage, DeviceComissioning",
    says: "[{section}]: `{given}` is no value of {name}",
    help: "write `0` or `1`, or leave it empty",
    also: &[NUMBER, LONG, VERSION],
    ..Rule::NEW
};

const NUMBER: Form = Form {
    help: "write a number from 0 to {most}, or leave it empty",
    ..Form::OWN
};
const LONG: Form = Form {
    help: "write a number such as `0x1A` with at most 32 bits, or leave it empty",
    ..Form::OWN
};
const VERSION: Form = Form {
    help: "write a version such as `4.0`, or leave it empty",
    ..Form::OWN
};

/// The finding about a value of a section that is not as its key wants it.
pub(crate) fn finding(section: &str, key: &str, given: &Text<'_>, wanted: Wanted) -> Finding {
    let finding = RULE.at(given.span);
    let finding = match wanted {
        Wanted::Number(u32::MAX) => finding.form(&LONG),
        Wanted::Number(most) => finding.form(&NUMBER).fact("most", most),
        Wanted::Version => finding.form(&VERSION),
        _ => finding,
    };
    finding
        .fact("section", section)
        .fact("name", key)
        .fact("given", &*given.value)
}
