use crate::fact::Fact;
use crate::finding::{Finding, Rule, Severity::Warning};
use od_model::Address;

pub(crate) static RULE: Rule = Rule {
    code: "W1109",
    severity: Warning,
    title: "CANopenNode does not start without the object",
    why: "CO_CANopenInit returns CO_ERROR_ILLEGAL_ARGUMENT: EMCY needs 1001h and the NMT slave needs 1017h, whatever CO_driver_target.h says.",
    source: "CANopenNode 4, CANopen.c: CO_CANopenInit; 301/CO_NMT_Heartbeat.c: CO_NMT_init",
    example: "a file without [1017]",
    says: "CANopenNode does not start without {object}",
    help: "add {section}; a 1017h of 0 sends no heartbeat",
    ..Rule::NEW
};

/// The finding about an object that no node of CANopenNode can do without.
pub(crate) fn finding(missing: u16) -> Finding {
    let finding = RULE.finding().about(Address::new(missing, 0));
    let finding = finding.fact("object", Fact::Index(missing));
    finding.fact("section", Fact::Section(missing, None))
}
