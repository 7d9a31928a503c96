//! 07: edits of a macro call or a variant. One file a rule.

catalogue! {
    e0701 E0701
    e0702 E0702
    e0703 E0703
    e0704 E0704
    e0705 E0705
    e0706 E0706
    e0707 E0707
    e0708 E0708
    e0709 E0709
    e0710 E0710
}
