//! Modules, channels and extensions are as many as they are said to be.
//!
//! Guarantees that a configuration tool which counts finds all of them. Assumes that sections
//! which describe no object were kept. Source: CiA 306-1, SupportedModules and DynamicChannels.

use alloc::format;
use alloc::vec::Vec;

use crate::description::{Description, Section};
use crate::finding::Finding;
use crate::fix::Fix;
use crate::rules;
use crate::scan::number::number;

pub(super) fn check(description: &Description, findings: &mut Vec<Finding>) {
    if let Some(modules) = description.section("SupportedModules") {
        let count = modules.get("NrOfEntries").and_then(|count| number(count));
        for module in 1..=count.unwrap_or(0).clamp(0, 255) {
            let name = format!("M{module}ModuleInfo");
            if description.section(&name).is_none() {
                findings.push(
                    rules::W0243
                        .told(
                            modules.name.span,
                            format!("there is no section [{name}] for module {module}"),
                        )
                        .with_help(format!("write a section [{name}], or count fewer modules")),
                );
            }
        }
    }
    for section in &description.sections {
        if is_counted_list(&section.name) {
            counted(section, findings);
        }
    }
    if let Some(channels) = description.section("DynamicChannels") {
        segments(channels, findings);
    }
}

/// `[M1FixedObjects]`, `[M1SubExtends]`
fn is_counted_list(name: &str) -> bool {
    let Some(rest) = name.strip_prefix(['M', 'm']) else {
        return false;
    };
    let word = rest.trim_start_matches(|c: char| c.is_ascii_digit());
    word.len() < rest.len()
        && ["FixedObjects", "SubExtends"]
            .iter()
            .any(|known| word.eq_ignore_ascii_case(known))
}

fn counted(section: &Section, findings: &mut Vec<Finding>) {
    let entries = section.pairs.iter();
    let count = entries.filter(|(key, _)| number(key).is_some()).count();
    let Some(given) = section.get("NrOfEntries") else {
        return;
    };
    if number(given) != Some(count as i128) {
        findings.push(
            rules::W0244
                .told(
                    given.span,
                    format!(
                        "NrOfEntries is {}, but the list has {count} entries",
                        given.value
                    ),
                )
                .with_help(format!("write `NrOfEntries={count}`"))
                .fix(Fix::safe().replace(given.span, format!("{count}"))),
        );
    }
}

fn segments(channels: &Section, findings: &mut Vec<Finding>) {
    let Some(given) = channels.get("NrOfSeg") else {
        return;
    };
    let Some(count) = number(given) else { return };
    for segment in 1..=count.clamp(0, 255) {
        for key in ["Type", "Dir", "Range"] {
            let key = format!("{key}{segment}");
            if channels.get(&key).is_none() {
                findings.push(
                    rules::W0245
                        .told(
                            given.span,
                            format!("there is no {key} for segment {segment}"),
                        )
                        .with_help(format!("write `{key}=`, or count fewer segments")),
                );
            }
        }
    }
}
