use alloc::collections::BTreeMap;
use alloc::vec::Vec;

use crate::description::Description;
use crate::finding::{Check, Finding, Form, Rule, Severity::Error};
use crate::rules::pdo::cob_ids::{CobId, Service, cob_ids};

pub(crate) static RULE: Rule = Rule {
    code: "E0532",
    severity: Error,
    buildable: true,
    title: "two services have the same CAN-ID",
    why: "Two devices send with the same CAN-ID, which ends in bus errors, or a device takes the message of one service for that of the other.",
    source: "CiA 301, COB-ID and predefined connection set",
    says: "{object} has CAN-ID {id}, which is that of {other}",
    help: "write a CAN-ID that no other service has, or set bit 31 (`0x80000000`) if the service is not used",
    also: &[DEFAULT, SHARED],
    check: Check::Device(check),
    ..Rule::NEW
};

/// Sentence for the CAN-ID of a service by the predefined connection set.
const DEFAULT: Form = Form {
    says: "{object} has CAN-ID {id}, which {other} messages have by default",
    ..Form::OWN
};

/// Sentence for a COB-ID that all nodes must share.
const SHARED: Form = Form {
    says: "{object} has CAN-ID {id}, but all nodes share the CAN-ID of SYNC and TIME",
    help: "write the same number for all nodes: `0x80` for SYNC, `0x100` for TIME",
};

fn check(description: &Description, findings: &mut Vec<Finding>) {
    let sound =
        |cob_id: &CobId<'_>| !cob_id.extended && !cob_id.is_too_long() && !cob_id.is_restricted();
    let all: Vec<CobId<'_>> = cob_ids(description).filter(sound).collect();
    let mut used: BTreeMap<(bool, u32), Vec<&CobId<'_>>> = BTreeMap::new();
    for cob_id in &all {
        let same = used.entry((cob_id.formula, cob_id.identifier)).or_default();
        same.push(cob_id);
    }
    let about = |cob_id: &CobId<'_>| {
        let finding = cob_id.finding(&RULE).fact("object", cob_id.entry.shown());
        finding.fact("id", cob_id.shown())
    };
    for same in used.into_values() {
        // The one that is where it belongs keeps its CAN-ID.
        let mut same = same;
        same.sort_by_key(|cob_id| (!is_default(cob_id), cob_id.service, cob_id.entry.address));
        for (at, cob_id) in same.iter().enumerate().skip(1) {
            if let Some(other) = same[..at].iter().find(|other| collide(other, cob_id)) {
                let finding = about(cob_id).fact("other", other.entry.shown());
                findings.push(finding.related(other.span, "used here"));
            }
        }
    }
    let has = |service| all.iter().any(|cob_id| cob_id.service == service);
    for cob_id in &all {
        let shared = matches!(cob_id.service, Service::Sync | Service::Time);
        if cob_id.formula {
            findings.extend(shared.then(|| about(cob_id).form(&SHARED)));
            continue;
        }
        let by_default = match cob_id.identifier {
            0x80 if cob_id.service != Service::Sync && !has(Service::Sync) => "SYNC",
            0x100 if cob_id.service != Service::Time && !has(Service::Time) => "TIME",
            0x81..=0xFF if cob_id.service > Service::EmcyConsumer => "EMCY",
            0x181..=0x57F if cob_id.service < Service::Emcy => "PDO",
            _ => continue,
        };
        findings.push(about(cob_id).form(&DEFAULT).fact("other", by_default));
    }
}

/// Is it the COB-ID that the predefined connection set gives the service?
const fn is_default(cob_id: &CobId<'_>) -> bool {
    let index = cob_id.entry.address.index;
    let (formula, base) = match index {
        0x1005 => (false, 0x80),
        0x1012 => (false, 0x100),
        0x1014 => (true, 0x80),
        0x1400..=0x1403 => (true, 0x200 + (index as u32 & 3) * 0x100),
        0x1800..=0x1803 => (true, 0x180 + (index as u32 & 3) * 0x100),
        _ => return false,
    };
    cob_id.formula == formula && cob_id.identifier == base
}

/// Can these two not have one CAN-ID? Two PDOs have a rule of their own, and of two consumers each hears it.
fn collide(a: &CobId<'_>, b: &CobId<'_>) -> bool {
    let consumes = |cob_id: &CobId<'_>| cob_id.service == Service::EmcyConsumer;
    let pdos = a.service == Service::Pdo && b.service == Service::Pdo;
    // An entry of 1028h is the CAN-ID of another device's EMCY, and no device's SYNC or TIME.
    let shared = |cob_id: &CobId<'_>| matches!(cob_id.service, Service::Sync | Service::Time);
    !pdos && (!consumes(a) || shared(b)) && (!consumes(b) || shared(a))
}
