use alloc::vec::Vec;

use crate::fact::Fact;
use crate::finding::{Check, Finding, Form, Rule, Severity};
use crate::rules::profile::shared::device;
use crate::subject::Object;

pub(crate) static W0912: Rule = Rule {
    title: "parameters of channels that the device lacks",
    why: "A master that sets the parameter of a channel finds no channel for it.",
    source: "CiA 401 and CiA 404, object overview",
    says: "{object} sets channels of {channels}, which is missing",
    help: "add {missing}, or remove {object}",
    also: &[MORE],
    check: Check::Object(check),
    ..Rule::of("W0912")
};

/// Sentence for more parameters than channels.
const MORE: Form = Form {
    says: "{object} has sub-index {sub}, but {channels} ends at {last}",
    help: "remove the sub-object, or add the channel",
};

/// The objects of which one has the channels of a parameter object of a measuring device (CiA 404).
const fn measuring(index: u16) -> &'static [u16] {
    const INPUTS: &[u16] = &[
        0x6130, 0x7130, 0x8130, 0x9130, 0x6100, 0x7100, 0x8100, 0x9100,
    ];
    const OUTPUTS: &[u16] = &[
        0x6300, 0x7300, 0x8300, 0x9300, 0x6330, 0x7330, 0x8330, 0x9330,
    ];
    match (index, index & 0xFFF) {
        (0x6000..=0x9FFF, 0x120..=0x124 | 0x133..=0x136 | 0x148..=0x149) => INPUTS,
        (0x6110..=0x6114 | 0x6125..=0x6127 | 0x6131..=0x6132 | 0x6150 | 0x61A0..=0x61A1, _) => {
            INPUTS
        }
        (0x6000..=0x9FFF, 0x320..=0x321 | 0x341) => OUTPUTS,
        (0x6301..=0x6302 | 0x6310 | 0x6340, _) => OUTPUTS,
        _ => &[],
    }
}

/// The objects of which one has the channels of a parameter object of an I/O module (CiA 401).
const fn channels(index: u16) -> &'static [u16] {
    match index {
        0x6002 | 0x6003 | 0x6006..=0x6008 => &[0x6000],
        0x6102 | 0x6103 | 0x6106..=0x6108 => &[0x6100],
        0x6122 | 0x6123 | 0x6126..=0x6128 => &[0x6120],
        0x6202 | 0x6206..=0x6208 => &[0x6200],
        0x6302 | 0x6306..=0x6308 => &[0x6300],
        0x6322 | 0x6326..=0x6328 => &[0x6320],
        0x6421..=0x6428 => &[0x6401, 0x6400, 0x6402, 0x6403, 0x6404],
        0x6443 | 0x6444 => &[0x6411, 0x6410, 0x6412, 0x6413, 0x6414],
        _ => &[],
    }
}

fn check(object: &Object<'_>, findings: &mut Vec<Finding>) {
    let description = object.description;
    let is_a = |profile| device(description, profile).is_some();
    let of = match (channels(object.index), measuring(object.index)) {
        (of @ [_, ..], _) if is_a(401) => of,
        (_, of @ [_, ..]) if is_a(404) => of,
        _ => return,
    };
    let Some(first) = of.first() else {
        return;
    };
    let present = of
        .iter()
        .filter_map(|index| Some((index, description.objects.get(index)?)));
    let last = present.map(|(index, channels)| {
        let last = channels.entries.range(..255).next_back();
        (last.map_or(0, |(sub, _)| *sub), index)
    });
    let named = |finding: Finding, channels: u16| {
        let finding = finding.fact("object", Fact::Index(object.index));
        finding.fact("channels", Fact::Index(channels))
    };
    match last.max() {
        None => {
            let finding = named(W0912.on(object, object.span), *first);
            findings.push(finding.fact("missing", Fact::Section(*first, None)));
        }
        Some((last, channels)) => {
            let more = object
                .entries()
                .find(|entry| (last + 1..255).contains(&entry.address.sub));
            // The channels of such a module are those of its extension modules.
            if let Some(entry) = more.filter(|_| last > 0) {
                let finding = named(W0912.on(&entry, entry.span), *channels).form(&MORE);
                let finding = finding.fact("sub", entry.address.sub);
                // A parameter of a channel that does not exist is never set.
                findings.push(finding.fact("last", last).severity_of(Severity::Info));
            }
        }
    }
}
