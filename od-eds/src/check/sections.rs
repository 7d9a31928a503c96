//! The sections about file and device are there, and say what CiA 306 lets them say.
//!
//! Guarantees that a tool which reads `[FileInfo]`, `[DeviceInfo]`, `[DummyUsage]` and
//! `[Comments]` finds what it looks for. Assumes that the reader named values that are none.
//! Source: CiA 306-1, FileInfo, DeviceInfo, DummyUsage, Comments.

use alloc::format;
use alloc::string::String;
use alloc::vec::Vec;

use crate::description::{Description, Section};
use crate::finding::Finding;
use crate::fix::Fix;
use crate::rules;
use crate::scan::number::number;
use crate::span::{Span, Spanned};

pub(super) fn check(description: &Description, findings: &mut Vec<Finding>) {
    if description.objects.is_empty() {
        return;
    }
    for name in ["FileInfo", "DeviceInfo"] {
        if description.section(name).is_none() {
            findings.push(
                rules::I0240
                    .told(Span::default(), format!("there is no section [{name}]"))
                    .with_help(format!("write a section [{name}]")),
            );
        }
    }
    if let Some(info) = description.section("DeviceInfo") {
        device_info(info, findings);
    }
    if let Some(usage) = description.section("DummyUsage") {
        dummies(usage, findings);
    }
    if let Some(section) = description.section("Comments") {
        comments(section, findings);
    }
}

fn device_info(info: &Section, findings: &mut Vec<Finding>) {
    let rates: Vec<&Spanned<String>> = info
        .pairs
        .iter()
        .filter(|(key, _)| {
            let prefix = key.get(.."BaudRate_".len());
            prefix.is_some_and(|prefix| prefix.eq_ignore_ascii_case("BaudRate_"))
        })
        .map(|(_, value)| value)
        .collect();
    if let Some(first) = rates.first()
        && rates.iter().all(|rate| number(rate) == Some(0))
    {
        findings.push(
            rules::W0637
                .told(first.span, "the device supports no bit rate at all")
                .with_help(
                    "write 1 for each bit rate that it supports, for example `BaudRate_125=1`",
                ),
        );
    }
}

fn dummies(usage: &Section, findings: &mut Vec<Finding>) {
    let missing: Vec<String> = (1..=7)
        .map(|index| format!("Dummy{index:04X}"))
        .filter(|key| usage.get(key).is_none())
        .collect();
    if !missing.is_empty() {
        let lines: Vec<String> = missing.iter().map(|key| format!("{key}=0")).collect();
        findings.push(
            rules::I0251
                .told(
                    usage.name.span,
                    format!("[DummyUsage] does not say {}", missing.join(", ")),
                )
                .with_help("write 0, which is taken now, or 1 for each")
                .fix(Fix::safe().below(usage.name.span, lines.join("\n"))),
        );
    }
}

fn comments(section: &Section, findings: &mut Vec<Finding>) {
    let lines = section
        .pairs
        .iter()
        .filter(|(key, _)| {
            let digits = key
                .get(.."Line".len())
                .filter(|word| word.eq_ignore_ascii_case("Line"));
            digits.is_some() && key["Line".len()..].parse::<u32>().is_ok()
        })
        .count();
    let given = section.get("Lines");
    if given.is_some_and(|given| number(given) != Some(lines as i128))
        || given.is_none() && lines > 0
    {
        let (span, fix) = match given {
            Some(given) => (
                given.span,
                Fix::safe().replace(given.span, format!("{lines}")),
            ),
            None => {
                let span = section.name.span;
                (span, Fix::safe().below(span, format!("Lines={lines}")))
            }
        };
        findings.push(
            rules::W0241
                .told(
                    span,
                    format!("[Comments] has {lines} lines, but Lines says otherwise"),
                )
                .with_help(format!("write `Lines={lines}`"))
                .fix(fix),
        );
    }
}
