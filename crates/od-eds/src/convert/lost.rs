//! Findings about objects that another format cannot express.

use alloc::vec::Vec;

use crate::description::Description;
use crate::finding::Finding;
use crate::rules::values::e0401_data_type_missing;
use od_model::{Address, Kind};

/// The findings about objects, and about lines that are too many or too long, that were left out while a file was read; no format has them.
pub fn unread(findings: &[Finding]) -> Vec<Finding> {
    let lost = findings
        .iter()
        .filter(|finding| matches!(finding.code(), "E0113" | "E0114" | "E0119" | "E0353"));
    lost.cloned().collect()
}

/// The findings about all values without a usable type, which [`Tables`](crate::Tables) and all formats
/// made from it leave out; `findings` are those of the description. Each value has one finding.
pub fn untyped(description: &Description, findings: &[Finding]) -> Vec<Finding> {
    let is_lost = |address: Address| {
        let data_type = description.entry(address)?.data_type;
        Some(data_type.is_none_or(|data_type| data_type.kind() == Kind::Record))
    };
    let mut lost: Vec<Finding> = Vec::new();
    let about = findings
        .iter()
        .filter(|finding| matches!(finding.code(), "E0401" | "E0402" | "E0403"))
        .filter(|finding| finding.object.and_then(is_lost) == Some(true));
    lost.extend(about.cloned());
    let known: alloc::collections::BTreeSet<_> = lost.iter().map(|one| one.object).collect();
    // The description of a type needs no type itself, and has no finding.
    let others = description
        .entries()
        .filter(|(address, _)| is_lost(*address) == Some(true) && !known.contains(&Some(*address)));
    lost.extend(others.map(|(address, entry)| {
        e0401_data_type_missing::finding(description, address, entry.span)
    }));
    crate::finding::sort(&mut lost);
    lost
}
