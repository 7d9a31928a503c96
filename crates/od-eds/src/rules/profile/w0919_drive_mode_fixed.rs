use alloc::vec::Vec;

use crate::description::{Description, Value};
use crate::finding::{Check, Finding, Fixability, Form, Rule};
use crate::fix::Fix;
use crate::rules::profile::shared::device;
use crate::span::Spanned;
use crate::subject::start_number;
use od_model::Address;

pub(crate) static W0919: Rule = Rule {
    title: "mode of a drive with several modes is fixed",
    why: "A master selects the mode by writing 6060h. The drive refuses it, so its other modes are never used.",
    source: "CiA 402, objects 6060h and 6502h",
    says: "6502h declares {count} modes, but 6060h cannot be written",
    help: "change {AccessType} to `rw`{fix}, or declare one mode in 6502h",
    also: &[LIMITED],
    fixability: Fixability::Unsafe,
    check: Check::Device(check),
    ..Rule::of("W0919")
};

/// Sentence for a mode that the limits of 6060h exclude.
const LIMITED: Form = Form {
    says: "6502h declares mode {mode} (bit {bit}), but the limits of 6060h exclude it",
    help: "change the limits of 6060h, or clear bit {bit} of 6502h",
};

fn check(description: &Description, findings: &mut Vec<Finding>) {
    let address = Address::new(0x6060, 0);
    let Some(modes) = start_number(description, Address::new(0x6502, 0)) else {
        return;
    };
    // Bits 0 to 10 are the modes of the profile.
    let count = (modes.value & 0x7FF).count_ones();
    if let Some(entry) = description.entry(address)
        && device(description, 402).is_some()
        && count > 1
        && !entry.access.writable()
    {
        let finding = W0919.at(entry.access.span).about(address);
        let finding = finding.fact("count", count);
        let fix = Fix::unsafe_fix().replace(entry.access.span, "rw");
        findings.push(finding.related(modes.span, "supported modes").fix(fix));
    }
    if let Some(entry) = description.entry(address)
        && device(description, 402).is_some()
    {
        for bit in (0..=10_u8).filter(|bit| modes.value >> bit & 1 != 0) {
            let mode = i128::from(bit + 1);
            let limit = |limit: &Option<Spanned<Value>>, is_wrong: fn(&i128, &i128) -> bool| {
                let limit = limit.as_ref()?;
                let number = limit.integer(0)?;
                is_wrong(&number, &mode).then_some(limit.span)
            };
            let high = || limit(&entry.high, i128::lt);
            if let Some(span) = limit(&entry.low, i128::gt).or_else(high) {
                let finding = W0919.at(span).about(address).form(&LIMITED);
                let finding = finding.fact("mode", mode).fact("bit", bit);
                findings.push(finding.related(modes.span, "supported modes"));
                return;
            }
        }
    }
}
