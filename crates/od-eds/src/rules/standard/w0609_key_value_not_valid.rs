use crate::finding::{Finding, Form, Rule, Severity};
use crate::scan::known::Form as Wanted;
use crate::scan::placed::Text;

pub(crate) static RULE: Rule = Rule {
    code: "W0609",
    severity: Severity::Warning,
    buildable: true,
    title: "value outside the object sections is not valid",
    why: "A tool cannot use the value. odkit keeps it as text and treats it as missing. A flag is 0 or 1, and each number has a range.",
    source: "CiA 306-1, FileInfo, DeviceInfo, DummyUsage, DeviceComissioning",
    says: "{name} `{given}` in [{section}] is not valid",
    help: "write `0` or `1`, or leave the value empty",
    also: &[NUMBER, LONG, VERSION],
    ..Rule::NEW
};

const NUMBER: Form = Form {
    help: "write a number from 0 to {most}, or leave the value empty",
    ..Form::OWN
};
const LONG: Form = Form {
    help: "write a number such as `0x1A` with at most 32 bits, or leave the value empty",
    ..Form::OWN
};
const VERSION: Form = Form {
    help: "write `4.0`, `4.1` or `4.2`, the versions of CiA 306",
    ..Form::OWN
};

/// The finding about a value of a section that its key does not allow.
pub(crate) fn finding(section: &str, key: &str, given: &Text<'_>, wanted: Wanted) -> Finding {
    let finding = RULE.at(given.span);
    let finding = match wanted {
        Wanted::Number(u32::MAX) => finding.form(&LONG),
        Wanted::Number(most) => finding.form(&NUMBER).fact("most", most),
        Wanted::Version => finding.form(&VERSION),
        _ => finding,
    };
    // A number of the device that no tool can use; dates and versions of the file are for people.
    let finding = if section.eq_ignore_ascii_case("DeviceInfo") {
        finding.severity_of(Severity::Error)
    } else {
        finding
    };
    finding
        .fact("section", section)
        .fact("name", key)
        .fact("given", &*given.value)
}
