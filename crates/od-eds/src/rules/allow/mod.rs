//! 08: findings that a file allows. One file per rule.

catalogue! {
    w0801_allow_without_rule W0801
    w0802_allow_without_reason W0802
    i0803_allow_without_finding I0803
}

pub(crate) mod i0803_allow_without_finding;
pub(crate) mod w0801_allow_without_rule;
pub(crate) mod w0802_allow_without_reason;
