use alloc::format;
use alloc::vec::Vec;

use crate::description::Description;
use crate::finding::{Check, Finding, Fixability, Rule};
use crate::fix::Fix;
use crate::rules::profile::shared::Encoder;
use od_model::Address;

pub(crate) static W0952: Rule = Rule {
    title: "range does not match the revolutions",
    why: "The position jumps where the encoder starts again. The total measuring range (6002h) is the measuring units per revolution (6001h) times the revolutions, or divides that product.",
    source: "CiA 406, objects 6001h and 6002h",
    fixability: Fixability::Unsafe,
    says: "6002h is {range}, but 6001h ({units}) times {turns:revolution|revolutions} is {all}",
    help: "write `{DefaultValue={all}}`{fix}, or a number that divides it",
    check: Check::Device(check),
    ..Rule::of("W0952")
};

fn check(description: &Description, findings: &mut Vec<Finding>) {
    let Some(encoder) = Encoder::of(description) else {
        return;
    };
    let turns = encoder.value(0x6502).map_or(1, |turns| turns.value.max(1));
    let (Some(units), Some(range)) = (encoder.value(0x6001), encoder.value(0x6002)) else {
        return;
    };
    let all = u128::from(units.value) * u128::from(turns);
    let own = u128::from(range.value);
    // A smaller range is correct if it divides the whole one.
    let divides = own < all && all.is_multiple_of(own);
    if units.value == 0 || range.value == 0 || all == own || divides {
        return;
    }
    let fix = match u32::try_from(all) {
        Ok(all) => Fix::unsafe_fix().replace(range.span, format!("{all}")),
        Err(_) => Fix::unsafe_fix(),
    };
    let finding = W0952.at(range.span).about(Address::new(0x6002, 0));
    let finding = finding
        .fact("range", range.value)
        .fact("units", units.value);
    let finding = finding
        .fact("turns", turns)
        .fact("all", format!("{all}"))
        .fix(fix);
    findings.push(finding.related(units.span, "6001h is set here"));
}
