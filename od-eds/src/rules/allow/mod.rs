//! 08: findings that a file allows. One file per rule.

catalogue! {
    w0801 W0801
    w0802 W0802
    i0803 I0803
}

pub(crate) mod i0803;
pub(crate) mod w0801;
pub(crate) mod w0802;
