//! 11: targets of `odkit convert` that cannot express all of a description. A warning is what a
//! master sees of the target; of a remark it sees nothing. One rule per file.

catalogue! {
    w1101 W1101 (example)
    w1102 W1102 (example)
    w1103 W1103 (example)
    w1104 W1104 (example)
    w1105 W1105 (example)
    i1106 I1106 (example)
    i1107 I1107 (example)
    i1108 I1108 (example)
    w1109 W1109 (example)
    w1110 W1110 (example)
    w1111 W1111 (example)
    w1112 W1112 (example)
    w1113 W1113 (example)
}

pub(crate) mod i1106;
pub(crate) mod i1107;
pub(crate) mod i1108;
pub(crate) mod w1101;
pub(crate) mod w1102;
pub(crate) mod w1103;
pub(crate) mod w1104;
pub(crate) mod w1105;
pub(crate) mod w1109;
pub(crate) mod w1110;
pub(crate) mod w1111;
pub(crate) mod w1112;
pub(crate) mod w1113;
