//! 06: mandatory and standard objects, identity, `[DeviceInfo]`. One file a rule.

catalogue! {
    e0601 E0601
    e0602 E0602
    e0603 E0603
    e0604 E0604
    e0605 E0605
    e0606 E0606
    w0607 W0607
    w0608 W0608
    w0609 W0609
    i0610 I0610
    i0611 I0611
}
