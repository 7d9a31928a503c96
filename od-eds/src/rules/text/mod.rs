//! 01: text and INI structure. One file a rule.

catalogue! {
    w0101 W0101
    w0102 W0102
    w0103 W0103
    w0104 W0104
    w0105 W0105
    w0106 W0106
    w0107 W0107
    w0108 W0108
    w0109 W0109
    w0110 W0110
    i0111 I0111
    w0112 W0112
    e0113 E0113 (xdd)
    e0114 E0114 (xdd)
    e0115 E0115 (xdd)
    w0116 W0116 (example)
    e0117 E0117
    e0118 E0118
}

pub(crate) mod e0113;
pub(crate) mod e0114;
pub(crate) mod e0115;
pub(crate) mod e0117;
pub(crate) mod e0118;
pub(crate) mod i0111;
pub(crate) mod w0101;
pub(crate) mod w0102;
pub(crate) mod w0103;
pub(crate) mod w0104;
pub(crate) mod w0105;
pub(crate) mod w0106;
pub(crate) mod w0107;
pub(crate) mod w0108;
pub(crate) mod w0109;
pub(crate) mod w0110;
pub(crate) mod w0112;
pub(crate) mod w0116;
