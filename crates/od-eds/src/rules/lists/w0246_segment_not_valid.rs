use alloc::format;
use alloc::vec::Vec;

use crate::description::Description;
use crate::finding::{Check, Finding, Fixability, Form, Rule};
use crate::fix::Fix;
use crate::scan::number::number;
use od_model::{Access, DataType};

pub(crate) static W0246: Rule = Rule {
    title: "segment of [DynamicChannels] is not valid",
    why: "A programmable device cannot place its variables. Network variables are at A000h to AFFFh.",
    source: "CiA 306-1, DynamicChannels; CiA 302, network variables",
    says: "{field} `{given}` is not a range of A000h to AFFFh",
    help: "write {right}{fix}",
    also: &[TYPE, DIRECTION, MEETS, COUNT, BEYOND],
    fixability: Fixability::Unsafe,
    check: Check::Device(check),
    ..Rule::of("W0246")
};

/// Sentence for a type.
const TYPE: Form = Form {
    says: "{field} `{given}` is not a data type",
    help: "write the code of a data type, such as `0x0007` (UNSIGNED32)",
};

/// Sentence for a direction.
const DIRECTION: Form = Form {
    says: "{field} `{given}` is not a valid direction",
    help: "write `ro` for outputs of the program, `rww` or `rwr` for inputs",
};

/// Sentence for two segments that share indices.
const MEETS: Form = Form {
    says: "{field} `{given}` shares indices with segment {other}",
    help: "write a range that no other segment has",
};

/// Sentence for a section without a number of segments.
const COUNT: Form = Form {
    says: "[DynamicChannels] lacks `NrOfSeg`",
    help: "add `NrOfSeg=` and the number of segments",
};

/// Sentence for a segment that the number of segments does not count.
const BEYOND: Form = Form {
    says: "{field} belongs to a segment beyond NrOfSeg, which is {count}",
    help: "write the number of segments to NrOfSeg, or remove the line",
};

/// `0xA080-0xA0BF`
fn range(text: &str) -> Option<(i128, i128)> {
    let (first, last) = text.split_once('-')?;
    let (first, last) = (number(first.trim())?, number(last.trim())?);
    (0xA000 <= first && first <= last && last <= 0xAFFF).then_some((first, last))
}

fn check(description: &Description, findings: &mut Vec<Finding>) {
    let Some(channels) = description.section("DynamicChannels") else {
        return;
    };
    let Some(count) = channels.get("NrOfSeg") else {
        findings.push(W0246.at(channels.name.span).form(&COUNT));
        return;
    };
    let count = number(count).unwrap_or(0).clamp(0, 255);
    let beyond = channels.pairs.iter().find(|(key, _)| {
        let word = key.trim_end_matches(|c: char| c.is_ascii_digit());
        let known = ["Type", "Dir", "Range", "PPOffset"];
        let is_known = known.iter().any(|known| word.eq_ignore_ascii_case(known));
        let segment = key.get(word.len()..).filter(|_| is_known).and_then(number);
        segment.is_some_and(|segment| segment > count)
    });
    if let Some((key, _)) = beyond {
        let finding = W0246.at(key.span).form(&BEYOND).fact("field", key.as_str());
        findings.push(finding.fact("count", count));
    }
    let mut ranges: Vec<(i128, (i128, i128))> = Vec::new();
    for segment in 1..=count {
        let field = |word| {
            let name = format!("{word}{segment}");
            let given = channels.get(&name).filter(|given| !given.is_empty())?;
            Some((W0246.given(given).fact("field", name), given))
        };
        if let Some((finding, given)) = field("Type") {
            let code = number(given).and_then(|code| u16::try_from(code).ok());
            if code.and_then(DataType::from_code).is_none() {
                findings.push(finding.form(&TYPE));
            }
        }
        if let Some((finding, given)) = field("Dir") {
            let is = |access: &Access| given.eq_ignore_ascii_case(access.name());
            if !Access::ALL.iter().any(is) {
                findings.push(finding.form(&DIRECTION));
            }
        }
        if let Some((finding, given)) = field("Range") {
            let Some(own) = range(given) else {
                let turned = given.split_once('-').map(|(last, first)| {
                    let (last, first) = (last.trim(), first.trim());
                    format!("{first}-{last}")
                });
                findings.push(match turned.filter(|right| range(right).is_some()) {
                    Some(right) => {
                        let fix = Fix::unsafe_fix().replace(given.span, right.as_str());
                        finding.fact("right", format!("`{right}`")).fix(fix)
                    }
                    None => finding.fact(
                        "right",
                        "the first and the last index, such as `0xA080-0xA0BF`",
                    ),
                });
                continue;
            };
            let meets =
                |(_, (first, last)): &&(i128, (i128, i128))| own.0 <= *last && *first <= own.1;
            if let Some((other, _)) = ranges.iter().find(meets) {
                findings.push(finding.form(&MEETS).fact("other", *other));
            }
            ranges.push((segment, own));
        }
    }
}
