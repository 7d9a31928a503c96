use alloc::format;
use alloc::string::String;
use alloc::vec::Vec;

use crate::description::Description;
use crate::finding::{Check, Finding, Fixability, Form, Rule};
use crate::fix::Fix;
use crate::rules::standard::shared::commissioning;
use crate::scan::number::number;
use crate::span::Spanned;

pub(crate) static W0638: Rule = Rule {
    title: "bit rate in use is not valid",
    why: "A configuration tool cannot set the bit rate of a DCF, and the device cannot start with that of an XDD. CiA 301 defines the bit rates, and [DeviceInfo] gives those of the device.",
    source: "CiA 306-1, DeviceComissioning; CiA 311, baudRate",
    fixability: Fixability::Unsafe,
    says: "Baudrate `{given}` is not valid",
    help: "write 10, 20, 50, 125, 250, 500, 800 or 1000 (kbit/s){fix}",
    also: &[LACKS, DEFAULT],
    check: Check::Device(check),
    ..Rule::of("W0638")
};

/// Sentence for a bit rate that the device does not support.
const LACKS: Form = Form {
    says: "Baudrate is {given}, but BaudRate_{given} in [DeviceInfo] is 0",
    help: "write a bit rate that the device supports{fix}",
};

/// Sentence for the default bit rate of an XDD.
const DEFAULT: Form = Form {
    says: "default bit rate `{given}` is not one of the supported bit rates",
    help: "write a bit rate that has a supportedBaudRate, or add one for it",
};

#[cfg_attr(not(feature = "xdd"), allow(dead_code))]
/// The finding about the default bit rate of an XDD that the device does not support.
pub(crate) fn w0638_default_not_supported(given: &Spanned<String>) -> Finding {
    W0638.given(given).form(&DEFAULT)
}

fn check(description: &Description, findings: &mut Vec<Finding>) {
    let given = commissioning(description).and_then(|section| section.get("Baudrate"));
    let Some((given, rate)) = given.and_then(|given| Some((given, number(given)?))) else {
        return;
    };
    // The reader reports a value that is not a number of 16 bits.
    if !(0..=0xFFFF).contains(&rate) {
        return;
    }
    let finding = W0638.at(given.span).fact("given", given.as_str());
    let nearest = supported(description)
        .into_iter()
        .min_by_key(|own| own.abs_diff(rate));
    let finding = match nearest {
        Some(own) => finding.fix(Fix::unsafe_fix().replace(given.span, format!("{own}"))),
        None => finding,
    };
    if !matches!(rate, 10 | 20 | 50 | 100 | 125 | 250 | 500 | 800 | 1000) {
        findings.push(finding);
        return;
    }
    let info = description.section("DeviceInfo");
    let own = info.and_then(|info| info.get(&format!("BaudRate_{rate}")));
    if own.is_some_and(|own| number(own) == Some(0)) {
        findings.push(finding.form(&LACKS));
    }
}

/// The bit rates in kbit/s that [DeviceInfo] gives; all of CiA 301 if it gives none.
fn supported(description: &Description) -> Vec<i128> {
    const RATES: [i128; 8] = [10, 20, 50, 125, 250, 500, 800, 1000];
    let info = description.section("DeviceInfo");
    let has = |rate: &i128| {
        let own = info.and_then(|info| info.get(&format!("BaudRate_{rate}")));
        own.and_then(|own| number(own)) == Some(1)
    };
    let own: Vec<i128> = RATES.into_iter().filter(has).collect();
    if own.is_empty() { RATES.into() } else { own }
}
