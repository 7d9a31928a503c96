use crate::fact::Fact;
use crate::finding::{Finding, Rule, Severity::Info};

pub(crate) static RULE: Rule = Rule {
    code: "I1107",
    severity: Info,
    title: "CANopenNode needs an object that is missing",
    why: "OD.c compiles, but CANopen.c does not, or its init functions fail, unless the services of these objects are off in CO_driver_target.h: heartbeat consumer (1016h), SYNC producer (1006h), EMCY (1003h, 1014h).",
    source: "CANopenNode 4, CANopen.c and 301/CO_config.h",
    example: "a file without [1016]",
    says: "CANopenNode needs {objects} unless their services are off",
    help: "add the objects, or set CO_CONFIG_EM, CO_CONFIG_HB_CONS or CO_CONFIG_SYNC in CO_driver_target.h",
    ..Rule::NEW
};

/// The finding about missing objects.
pub(crate) fn finding(missing: impl Iterator<Item = u16>) -> Finding {
    let missing = missing.map(Fact::Index).collect();
    RULE.finding().fact("objects", Fact::List(missing))
}
