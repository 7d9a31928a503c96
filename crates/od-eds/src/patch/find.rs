//! Checks that the base has the target of an edit, and otherwise looks for a similar one.

use alloc::format;
use alloc::string::String;
use alloc::vec::Vec;

use crate::description::{Description, ObjectDescription};
use crate::finding::Finding;
use crate::patch::target::Target;
use crate::rules::edits::{
    e0701_first, e0701_near, e0701_object_missing, e0701_sub_index,
    e0704_object_without_sub_objects,
};
use crate::span::Spanned;

/// The finding that `target` is missing in `description`; `None` if it exists.
pub fn missing(description: &Description, target: &Spanned<Target>) -> Option<Finding> {
    let Some(object) = description.objects.get(&target.index) else {
        return Some(match near_index(description, target.value) {
            Some((meant, name)) => e0701_near(target, meant, name),
            None if description.objects.is_empty() => e0701_first(target),
            None => e0701_object_missing(target),
        });
    };
    let sub = target.sub?;
    if !object.code.has_members() {
        return Some(e0704_object_without_sub_objects(target, *object.code));
    }
    let missing = !object.entries.contains_key(&sub);
    missing.then(|| e0701_sub_index(target, &subs(object)))
}

/// The object whose index differs in one digit or has one digit more, with its name.
fn near_index(description: &Description, target: Target) -> Option<(Target, &str)> {
    let digits = |index: u16| [index >> 12, index >> 8 & 15, index >> 4 & 15, index & 15];
    // `0x200` for 2000h: 2000h without one of its digits is the given number.
    let has_lost_one = |index: u16| {
        let all = digits(index);
        let without = |lost: usize| {
            let kept = (0..4).filter(|at| *at != lost);
            kept.fold(0, |number, at| number << 4 | all[at])
        };
        target.index < 0x1000 && (0..4).any(|lost| without(lost) == target.index)
    };
    let near = description.objects.iter().filter(|(index, object)| {
        let same = digits(**index)
            .iter()
            .zip(digits(target.index))
            .filter(|(a, b)| **a == *b)
            .count();
        (same == 3 || has_lost_one(**index))
            && target
                .sub
                .is_none_or(|sub| object.entries.contains_key(&sub) && object.code.has_members())
    });
    // Of several candidates, the numerically nearest.
    let (index, object) = near.min_by_key(|(index, _)| index.abs_diff(target.index))?;
    let meant = Target {
        index: *index,
        ..target
    };
    Some((meant, &object.name))
}

/// "sub0–sub4, sub6": the sub-indices of an object as ranges.
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
        .map(|(first, last)| {
            if first == last {
                format!("sub{first:X}")
            } else {
                format!("sub{first:X}–sub{last:X}")
            }
        })
        .collect();
    runs.join(", ")
}
