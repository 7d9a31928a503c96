//! 07: edits of a macro call or a variant. One file a rule.

catalogue! {
    e0701 E0701 (example)
    e0702 E0702 (example)
    e0703 E0703 (example)
    e0704 E0704 (example)
    e0705 E0705 (example)
    e0706 E0706 (example)
    e0707 E0707 (example)
    e0708 E0708 (example)
    e0709 E0709 (example)
    e0710 E0710 (example)
}

pub(crate) mod e0701;
pub(crate) mod e0702;
pub(crate) mod e0703;
pub(crate) mod e0704;
pub(crate) mod e0705;
pub(crate) mod e0706;
pub(crate) mod e0707;
pub(crate) mod e0708;
pub(crate) mod e0709;
pub(crate) mod e0710;
