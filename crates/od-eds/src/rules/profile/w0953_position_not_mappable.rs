use alloc::vec::Vec;

use crate::fact::Fact;
use crate::finding::{Check, Finding, Fixability, Rule};
use crate::fix::Fix;
use crate::rules::profile::shared::device;
use crate::subject::Entry;

pub(crate) static W0953: Rule = Rule {
    title: "position value cannot be mapped",
    why: "No TPDO can send the position value.",
    source: "CiA 406, object 6004h",
    fixability: Fixability::Unsafe,
    says: "{object} (position value) cannot be mapped into a PDO",
    help: "write `{PDOMapping=1}`{fix}",
    check: Check::Entry(check),
    ..Rule::of("W0953")
};

fn check(entry: &Entry<'_>, findings: &mut Vec<Finding>) {
    let is_position = matches!(entry.address.index, 0x6004 | 0x6008) && entry.address.sub == 0;
    if is_position && !*entry.mappable && device(entry.description, 406).is_some() {
        let fix = match entry.mappable.span.line {
            0 => Fix::unsafe_fix().below(entry.span, "PDOMapping=1"),
            _ => Fix::unsafe_fix().replace(entry.mappable.span, "1"),
        };
        let finding = W0953.on(entry, entry.mappable.span);
        findings.push(
            finding
                .fact("object", Fact::Index(entry.address.index))
                .fix(fix),
        );
    }
}
