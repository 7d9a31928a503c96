//! 12: nodes of a network that do not fit together. One rule per file.

catalogue! {
    e1201 E1201 (example)
    e1202 E1202 (example)
    w1203 W1203 (example)
    e1204 E1204 (example)
    w1205 W1205 (example)
    w1206 W1206 (example)
}

pub(crate) mod e1201;
pub(crate) mod e1202;
pub(crate) mod e1204;
pub(crate) mod w1203;
pub(crate) mod w1205;
pub(crate) mod w1206;
