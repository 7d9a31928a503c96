//! 07: edits of a macro call or a variant. One file a rule.

catalogue! {
    e0701 E0701 (edit)
    e0702 E0702 (edit)
    e0703 E0703 (edit)
    e0704 E0704 (edit)
    e0705 E0705 (edit)
    e0706 E0706 (edit)
    e0707 E0707 (edit)
    e0708 E0708 (edit)
    e0709 E0709 (edit)
    e0710 E0710 (edit)
}
