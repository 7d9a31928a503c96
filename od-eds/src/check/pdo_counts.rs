//! [DeviceInfo] counts the PDOs that there are.
//!
//! Guarantees nothing but agreement. Assumes that a communication parameter is a
//! PDO, and that the reader made those that CompactPDO stands for. Source: CiA 306-1, DeviceInfo.

use alloc::format;
use alloc::vec::Vec;

use crate::description::Description;
use crate::finding::Finding;
use crate::fix::Fix;
use crate::rules;
use crate::scan::number::number;

pub(super) fn check(description: &Description, findings: &mut Vec<Finding>) {
    let Some(info) = description.section("DeviceInfo") else {
        return;
    };
    for (key, range, what) in [
        ("NrOfRxPDO", 0x1400..=0x15FF, "1400h–15FFh"),
        ("NrOfTxPDO", 0x1800..=0x19FF, "1800h–19FFh"),
    ] {
        let Some(given) = info.get(key) else { continue };
        let count = description.objects.range(range).count();
        match number(given) {
            Some(number) if number != count as i128 => findings.push(
                rules::W0608
                    .told(
                        given.span,
                        format!("{key} is {number}, but there are {count} objects {what}"),
                    )
                    .with_help(format!("write `{key}={count}`"))
                    .fix(Fix::safe().replace(given.span, format!("{count}"))),
            ),
            _ => {}
        }
    }
}
