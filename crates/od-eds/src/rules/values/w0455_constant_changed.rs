use alloc::vec::Vec;

use crate::description::Value;
use crate::finding::{Check, Finding, Fixability, Form, Rule};
use crate::fix::Fix;
use crate::scan::number::number;
use crate::subject::Entry;
use od_model::Access;

pub(crate) static W0455: Rule = Rule {
    title: "DCF gives a constant another value",
    why: "The device refuses a download of the value, or a master that does not write constants works with a value that the device does not have.",
    source: "CiA 306-1, AccessType and ParameterValue",
    says: "the value of this `const` object differs from its {DefaultValue}",
    help: "remove {ParameterValue}{fix}, or write the {AccessType} that the device has",
    fixability: Fixability::Unsafe,
    also: &[IDENTITY],
    check: Check::Entry(check),
    ..Rule::of("W0455")
};

/// Sentence for a number that tells what the device is.
const IDENTITY: Form = Form {
    says: "each device of this type has the same {object}, but its value differs from its {DefaultValue}",
    help: "remove {ParameterValue}{fix}, or write the file of the device that has this value",
};

fn check(entry: &Entry<'_>, findings: &mut Vec<Finding>) {
    let is_const = *entry.access == Access::Const;
    let is_0 = |value: &Value| value.integer(0) == Some(0);
    if (is_const || is_identity(entry) && !entry.access.writable())
        && let Some(given) = &entry.parameter
        && let Some(default) = &entry.default
        && given.value != default.value
        && (is_const || !is_0(default))
    {
        let finding = W0455.on(entry, given.span);
        let finding = if is_const {
            finding
        } else {
            finding.form(&IDENTITY).fact("object", entry.shown())
        };
        let finding = finding.related(default.span, "its constant value");
        findings.push(finding.fix(Fix::unsafe_fix().remove_line(given.span)));
    }
}

/// Returns whether this is a number that tells a master what the device is: device type, vendor-ID, or product code, and
/// `[DeviceInfo]` does not have its configured value.
fn is_identity(entry: &Entry<'_>) -> bool {
    let field = match (entry.address.index, entry.address.sub) {
        (0x1000, 0) => return true,
        (0x1018, 1) => "VendorNumber",
        (0x1018, 2) => "ProductNumber",
        _ => return false,
    };
    let info = entry.description.section("DeviceInfo");
    let given = info.and_then(|info| number(info.get(field)?));
    let own = entry.parameter.as_ref().and_then(|own| own.integer(0));
    given.is_none() || given != own
}
