//! Differences between the objects of a device and the object overview of its profile. CiA 406 has
//! its own rules, the other profiles share theirs.

use alloc::format;
use alloc::vec::Vec;

use od_model::Access;

use crate::fact::{Fact, Key};
use crate::finding::{
    Check, Finding, Fixability, Rule,
    Severity::{Error, Warning},
};
use crate::fix::Fix;
use crate::rules::profile::shared::in_profile;
use crate::subject::Object;

/// Profiles of which all objects are known; the rules about encoders are about CiA 406.
const OTHERS: [u16; 3] = [401, 402, 404];
const ENCODER: [u16; 1] = [406];

/// Source of the rules about them.
const OVERVIEWS: &str = "CiA 401, CiA 402 and CiA 404, object overview";
const ENCODER_OVERVIEW: &str = "CiA 406, object overview";

/// Words of the rules about object code and type.
const TYPES: Rule = Rule {
    severity: Error,
    buildable: true,
    fixability: Fixability::Unsafe,
    says: "{object} is {given}, but CiA {profile} specifies {right}",
    help: "write `{key={right}}`{fix}",
    ..Rule::NEW
};

/// Words of the rules about access.
const ACCESS: Rule = Rule {
    fixability: Fixability::Unsafe,
    says: "{AccessType} of {object} is `{given}`, but CiA {profile} specifies `{right}`",
    help: "write `{AccessType={right}}`{fix}",
    ..Rule::NEW
};

pub(crate) static W0905: Rule = Rule {
    code: "W0905",
    title: "profile object has another object code or type",
    why: "A master that knows the object from the device profile reads and writes it with another length.",
    source: OVERVIEWS,
    check: Check::Object(|object, findings| types(&W0905, &OTHERS, object, findings)),
    ..TYPES
};

pub(crate) static W0950: Rule = Rule {
    code: "W0950",
    title: "encoder object has another object code or type",
    why: "A master that knows the object from CiA 406 reads and writes it with another length.",
    source: ENCODER_OVERVIEW,
    check: Check::Object(|object, findings| types(&W0950, &ENCODER, object, findings)),
    ..TYPES
};

pub(crate) static W0906: Rule = Rule {
    code: "W0906",
    severity: Warning,
    title: "profile object is writable",
    why: "A master can change a value that only the device sets.",
    source: OVERVIEWS,
    check: Check::Object(|object, findings| access(&W0906, &OTHERS, false, object, findings)),
    ..ACCESS
};

pub(crate) static W0951: Rule = Rule {
    code: "W0951",
    severity: Warning,
    title: "encoder object is writable",
    why: "A master can change a value that only the device sets.",
    source: ENCODER_OVERVIEW,
    check: Check::Object(|object, findings| access(&W0951, &ENCODER, false, object, findings)),
    ..ACCESS
};

pub(crate) static E0907: Rule = Rule {
    code: "E0907",
    severity: Error,
    buildable: true,
    title: "access to a profile object is missing",
    why: "A master that reads or writes the object as the profile specifies gets an abort.",
    source: OVERVIEWS,
    check: Check::Object(|object, findings| access(&E0907, &OTHERS, true, object, findings)),
    ..ACCESS
};

pub(crate) static E0961: Rule = Rule {
    code: "E0961",
    severity: Error,
    buildable: true,
    title: "access to an encoder object is missing",
    why: "A master that reads or writes the object as the profile specifies gets an abort.",
    source: ENCODER_OVERVIEW,
    check: Check::Object(|object, findings| access(&E0961, &ENCODER, true, object, findings)),
    ..ACCESS
};

/// Reports code and types of an object of one of these profiles.
fn types(rule: &'static Rule, profiles: &[u16], object: &Object<'_>, findings: &mut Vec<Finding>) {
    let standard = in_profile(object).filter(|(profile, _)| profiles.contains(profile));
    let Some((profile, standard)) = standard else {
        return;
    };
    let code = standard.code;
    if object.code.has_members() != code.has_members() {
        let finding = rule.on(object, object.code.span).key(Key::ObjectType);
        let finding = finding
            .fact("object", Fact::Index(object.index))
            .fact("right", code);
        let finding = finding.fact("profile", u32::from(profile));
        findings.push(finding.fact("given", *object.code));
        return;
    }
    let subs = u8::from(code.has_members())..=254;
    for entry in object
        .entries()
        .filter(|entry| subs.contains(&entry.address.sub))
    {
        let mut types = standard.types(entry.address.sub);
        let right = standard.types(entry.address.sub).next();
        let given = entry
            .data_type
            .filter(|given| !types.any(|own| own == **given));
        if let (Some(given), Some(right)) = (given, right) {
            let fix = Fix::unsafe_fix().replace(given.span, format!("0x{:04X}", right.code()));
            let finding = rule.on(&entry, given.span).key(Key::DataType);
            let finding = finding.fact("object", entry.shown());
            let finding = finding
                .fact("right", right)
                .fact("profile", u32::from(profile));
            findings.push(finding.fact("given", *given).fix(fix));
        }
    }
}

/// Reports the access of the values of an object of one of these profiles: of those that cannot be
/// read or written as the profile specifies if `stops`, else of those that can be written besides.
fn access(
    rule: &'static Rule,
    profiles: &[u16],
    stops: bool,
    object: &Object<'_>,
    findings: &mut Vec<Finding>,
) {
    let standard = in_profile(object).filter(|(profile, standard)| {
        let alike = object.code.has_members() == standard.code.has_members();
        profiles.contains(profile) && alike
    });
    let Some((profile, standard)) = standard else {
        return;
    };
    let Some(writable) = standard.writable else {
        return;
    };
    let subs = u8::from(standard.code.has_members())..=254;
    for entry in object
        .entries()
        .filter(|entry| subs.contains(&entry.address.sub))
    {
        let own = *entry.access;
        let is_wrong = if stops {
            writable && !own.writable() || !writable && own == Access::Wo
        } else {
            !writable && own.writable() && own != Access::Wo
        };
        if is_wrong {
            let right = if writable { Access::Rw } else { Access::Ro };
            let finding = rule
                .on(&entry, entry.access.span)
                .fact("object", entry.shown());
            let finding = finding.fact("profile", u32::from(profile));
            let finding = finding.fact("given", *entry.access).fact("right", right);
            let fix = Fix::unsafe_fix().replace(entry.access.span, right.name());
            findings.push(finding.fix(fix));
        }
    }
}
