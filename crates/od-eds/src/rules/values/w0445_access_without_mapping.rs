use alloc::vec::Vec;

use crate::fact::Key;
use crate::finding::{Check, Finding, Fixability, Rule};
use crate::fix::Fix;
use crate::subject::Entry;
use od_model::Access;

pub(crate) static W0445: Rule = Rule {
    title: "AccessType `rwr` or `rww`, but not mappable",
    why: "`rwr` and `rww` give the PDO direction of a mappable object. They have no effect on an object that is not mappable.",
    source: "CiA 306-1, AccessType",
    fixability: Fixability::Unsafe,
    says: "{AccessType} `{access}` gives a PDO direction, but the object is not mappable",
    help: "write `{AccessType=rw}`{fix}, or `{PDOMapping=1}` if the object is mappable",
    check: Check::Entry(check),
    ..Rule::of("W0445")
};

fn check(entry: &Entry<'_>, findings: &mut Vec<Finding>) {
    let denied = !*entry.mappable && !entry.is_unread(Key::PdoMapping);
    if matches!(*entry.access, Access::Rwr | Access::Rww) && denied {
        // The vendor decides on PDOMapping; no tool uses the direction without it.
        let fix = Fix::unsafe_fix().replace(entry.access.span, "rw");
        let finding = W0445
            .on(entry, entry.access.span)
            .fact("access", *entry.access);
        findings.push(finding.fix(fix));
    }
}
