use alloc::format;
use alloc::vec::Vec;

use crate::finding::{Check, Finding, Fixability, Rule, Severity::Error};
use crate::fix::Fix;
use crate::rules::pdo::shared::{is_communication, maps_rpdo};
use crate::span::Spanned;
use crate::standards::cia301::of;
use crate::subject::Entry;
use od_model::{Address, DataType};

pub(crate) static W0631: Rule = Rule {
    severity: Error,
    buildable: true,
    title: "standard object has another data type",
    why: "A master that knows the object from the standard reads and writes it with another length.",
    source: "CiA 301, chapter 7.5; CiA 302",
    fixability: Fixability::Unsafe,
    says: "{object} ({name}) is {given}, but {standard} specifies {right}",
    help: "write `{DataType={right}}`{fix}",
    check: Check::Entry(check),
    ..Rule::of("W0631")
};

/// Sub-index with the structure of its object: object code and data type (CiA 301, sub-index FFh).
const STRUCTURE: u8 = 0xFF;

fn check(entry: &Entry<'_>, findings: &mut Vec<Finding>) {
    let Address { index, sub } = entry.address;
    if sub == STRUCTURE && entry.object.code.has_members() {
        let right = DataType::Unsigned32;
        let given = entry.data_type.filter(|given| **given != right);
        findings.extend(
            given.map(|given| other(entry, given, right, ("structure of the object", "CiA 301"))),
        );
        return;
    }
    let own_rule = matches!(index, 0x1000 | 0x1001 | 0x1018)
        || is_communication(index) && sub <= 2
        || maps_rpdo(index).is_some();
    // The document says UNSIGNED32, the signature `conf`; each master.dcf of dcfgen has UNSIGNED8.
    let is_of_dcfgen = |given: DataType| index == 0x1F25 && given == DataType::Unsigned8;
    if let Some(standard) = of(index).filter(|found| found.is_like(*entry.object.code))
        && let Some(value) = standard.value(sub)
        && let Some(given) = entry.data_type.filter(|given| **given != value.data_type)
        && !own_rule
        && !is_of_dcfgen(*given)
        // The bytes on the bus are the same.
        && (*given, value.data_type) != (DataType::Domain, DataType::OctetString)
    {
        let words = (standard.name, standard.source());
        findings.push(other(entry, given, value.data_type, words));
    }
}

/// The finding about a value with this type, whose right one is in the standard under this name.
fn other(
    entry: &Entry<'_>,
    given: Spanned<DataType>,
    right: DataType,
    (name, standard): (&'static str, &'static str),
) -> Finding {
    let code = format!("0x{:04X}", right.code());
    let finding = W0631.on(entry, given.span).fact("object", entry.shown());
    let finding = finding.fact("name", name).fact("right", right);
    let finding = finding.fact("standard", standard).fact("given", *given);
    finding.fix(Fix::unsafe_fix().replace(given.span, code))
}
