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
