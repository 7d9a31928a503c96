//! Does the base have what an edit names? If not: what is near it?

use alloc::format;
use alloc::string::{String, ToString};
use alloc::vec::Vec;

use super::{Target, finding};
use crate::description::{Description, ObjectDescription};
use crate::finding::Finding;
use crate::rules;
use crate::span::Spanned;

/// The finding that `target` is not in `description`; `None` if it is.
pub fn missing(description: &Description, target: &Spanned<Target>) -> Option<Finding> {
    let Target { index, sub } = target.value;
    let Some(object) = description.objects.get(&index) else {
        return Some(
            finding(
                &rules::E0701,
                target.span,
                target.value,
                format!("there is no object {index:04X}h"),
            )
            .with_help(near_index(description, target.value)),
        );
    };
    let sub = sub?;
    if !object.code.has_members() {
        return Some(
            finding(
                &rules::E0704,
                target.span,
                target.value,
                format!("{index:04X}h is a {}: it has no members", *object.code),
            )
            .with_help(format!("its one value is `0x{index:04X}`")),
        );
    }
    if object.entries.contains_key(&sub) {
        return None;
    }
    Some(
        finding(
            &rules::E0701,
            target.span,
            target.value,
            format!("there is no {}", target.address()),
        )
        .with_help(format!("{index:04X}h has {}", subs(object))),
    )
}

fn near_index(description: &Description, target: Target) -> String {
    let digits = |index: u16| [index >> 12, index >> 8 & 15, index >> 4 & 15, index & 15];
    let near = description.objects.iter().filter(|(index, object)| {
        let same = digits(**index)
            .iter()
            .zip(digits(target.index))
            .filter(|(a, b)| **a == *b)
            .count();
        same == 3
            && target
                .sub
                .is_none_or(|sub| object.entries.contains_key(&sub) && object.code.has_members())
    });
    // Of several that differ in one digit, the numerically nearest.
    let near = near.min_by_key(|(index, _)| index.abs_diff(target.index));
    match near {
        Some((index, object)) => {
            let meant = Target {
                index: *index,
                ..target
            };
            format!("did you mean `{meant}`, \"{}\"?", *object.name)
        }
        None if description.objects.is_empty() => "there are no objects yet".into(),
        None => "`odkit dump` lists the objects of a file".into(),
    }
}

/// "sub-indices 0–4, 6": what there is, in runs.
fn subs(object: &ObjectDescription) -> String {
    let mut runs: Vec<(u8, u8)> = Vec::new();
    for &sub in object.entries.keys() {
        match runs.last_mut() {
            Some((_, last)) if last.checked_add(1) == Some(sub) => *last = sub,
            _ => runs.push((sub, sub)),
        }
    }
    let runs: Vec<String> = runs
        .iter()
        .map(|(first, last)| match first == last {
            true => format!("sub{first:X}"),
            false => format!("sub{first:X}–sub{last:X}"),
        })
        .collect();
    match runs.is_empty() {
        true => "no members".to_string(),
        false => runs.join(", "),
    }
}
