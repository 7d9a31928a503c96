use crate::finding::{Finding, Rule, Severity::Warning};

pub(crate) static RULE: Rule = Rule {
    code: "W0658",
    severity: Warning,
    title: "DCF without [DeviceComissioning]",
    why: "A master that configures by the DCF has no node ID and no bit rate for the device.",
    source: "CiA 306-1, DeviceComissioning",
    says: "section [DeviceComissioning] is missing, and this file is a DCF",
    help: "add a section [DeviceComissioning] with `NodeID=` and `Baudrate=`",
    ..Rule::NEW
};

/// The finding about a DCF of no node.
pub(crate) fn finding() -> Finding {
    RULE.finding()
}
