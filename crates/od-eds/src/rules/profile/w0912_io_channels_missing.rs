use alloc::vec::Vec;

use crate::fact::Fact;
use crate::finding::{Check, Finding, Form, Rule, Severity};
use crate::rules::profile::shared::{device, in_profile};
use crate::subject::Object;

pub(crate) static W0912: Rule = Rule {
    title: "parameters of channels that the device lacks",
    why: "A master that sets the parameter of a channel finds no channel for it.",
    source: "CiA 401, CiA 404 and CiA 406, object overview",
    says: "{object} sets channels of {channels}, which is missing",
    help: "add {missing}, or remove {object}",
    also: &[MORE, FEWER],
    check: Check::Object(check),
    ..Rule::of("W0912")
};

/// Sentence for more parameters than channels.
const MORE: Form = Form {
    says: "{object} has sub-index {sub}, but {channels} ends at {last}",
    help: "remove the sub-object, or add the channel",
};

/// Sentence for fewer parameters than channels.
const FEWER: Form = Form {
    says: "{object} ends at sub-index {last}, but {channels} has channels up to {highest}",
    help: "add the sub-objects of the other channels, or remove the channels",
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

/// Objects of single inputs and outputs; the parameters of each have an index with the same last three bits.
const INPUT_BITS: [u16; 8] = [
    0x6020, 0x6021, 0x6022, 0x6023, 0x6024, 0x6025, 0x6026, 0x6027,
];
const OUTPUT_BITS: [u16; 8] = [
    0x6220, 0x6221, 0x6222, 0x6223, 0x6224, 0x6225, 0x6226, 0x6227,
];

/// The objects of which one has the channels of a parameter object of an I/O module (CiA 401).
fn channels(index: u16) -> &'static [u16] {
    let bit = usize::from(index & 7);
    match index {
        0x6002 | 0x6003 | 0x6006..=0x6008 => &[0x6000],
        0x6030..=0x603F | 0x6050..=0x6057 | 0x6060..=0x6067 | 0x6070..=0x6077 => {
            &INPUT_BITS[bit..=bit]
        }
        0x6102 | 0x6103 | 0x6106..=0x6108 => &[0x6100],
        0x6122 | 0x6123 | 0x6126..=0x6128 => &[0x6120],
        0x6202 | 0x6206..=0x6208 => &[0x6200],
        0x6240..=0x6247 | 0x6250..=0x6257 | 0x6260..=0x6267 | 0x6270..=0x6277 => {
            &OUTPUT_BITS[bit..=bit]
        }
        0x6302 | 0x6306..=0x6308 => &[0x6300],
        0x6322 | 0x6326..=0x6328 => &[0x6320],
        0x6421..=0x6432 => &[0x6401, 0x6400, 0x6402, 0x6403, 0x6404],
        0x6441..=0x6450 => &[0x6411, 0x6410, 0x6412, 0x6413, 0x6414],
        _ => &[],
    }
}

/// The object that has the channels of a parameter object of an encoder (CiA 406): cams, work areas, several sensors.
const fn encoder(index: u16) -> &'static [u16] {
    match index {
        0x6010 | 0x650C => &[0x6020],
        0x6301..=0x6337 => &[0x6300],
        0x6401 | 0x6402 => &[0x6400],
        _ => &[],
    }
}

/// Returns whether an object has a sub-index for each channel. The only other one has a bit for each: the sources of an
/// interrupt.
const fn has_each(index: u16) -> bool {
    index != 0x6422
}

fn check(object: &Object<'_>, findings: &mut Vec<Finding>) {
    let description = object.description;
    let is_a = |profile| device(description, profile).is_some();
    let lists = [
        (401, channels(object.index)),
        (404, measuring(object.index)),
        (406, encoder(object.index)),
    ];
    let own = lists
        .into_iter()
        .find(|(profile, of)| !of.is_empty() && is_a(*profile));
    // W0905 reports an object that has values where the profile has none, or the other way round.
    let is_like = in_profile(object)
        .is_none_or(|(_, right)| right.code.has_members() == object.code.has_members());
    let Some((profile, of @ [first, ..])) = own.filter(|_| is_like) else {
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
        // W0960 reports cams and work areas without their state.
        None if profile == 406 => {}
        None => {
            let finding = named(W0912.on(object, object.span), *first);
            findings.push(finding.fact("missing", Fact::Section(*first, None)));
        }
        Some((last, channels)) => {
            let more = object
                .entries()
                .find(|entry| (last + 1..255).contains(&entry.address.sub));
            let own = object.entries.range(1..255).next_back();
            let own = own.map_or(0, |(sub, _)| *sub);
            // The channels of a module without one are those of its extension modules.
            if let Some(entry) = more.filter(|_| last > 0) {
                let finding = named(W0912.on(&entry, entry.origin()), *channels).form(&MORE);
                let finding = finding.fact("sub", entry.address.sub);
                // A parameter of a channel that does not exist is never set.
                findings.push(finding.fact("last", last).severity_of(Severity::Info));
            } else if (1..last).contains(&own) && has_each(object.index) {
                let finding = named(W0912.on(object, object.span), *channels).form(&FEWER);
                let finding = finding.fact("last", own).fact("highest", last);
                // A channel needs no parameter of its own.
                findings.push(finding.severity_of(Severity::Info));
            }
        }
    }
}
