//! Rules about keys outside the object sections that the reader reports.

use alloc::format;
use alloc::string::String;
use alloc::vec::Vec;

use crate::finding::{
    Finding, Fixability, Form, Rule,
    Severity::{Error, Info, Warning},
};
use crate::fix::Fix;
use crate::scan::forms::{Form as Wanted, date, day, time};
use crate::scan::section::Text;
use crate::span::Span;

pub(crate) static W0609: Rule = Rule {
    buildable: true,
    title: "value outside the object sections is not valid",
    why: "A tool cannot use the value. odkit keeps it as text and treats it as missing. A flag is 0 or 1, and each number has a range.",
    source: "CiA 306-1, FileInfo, DeviceInfo, DummyUsage, DeviceComissioning",
    fixability: Fixability::Unsafe,
    says: "{name} `{given}` in [{section}] is not valid",
    help: "write `0` or `1`",
    also: &[W0609_NUMBER, W0609_LONG, W0609_HEX, W0609_VERSION],
    ..Rule::of("W0609")
};

const W0609_NUMBER: Form = Form {
    help: "write a number from 0 to {most}",
    ..Form::OWN
};
const W0609_LONG: Form = Form {
    help: "write a number such as `0x1A` with at most 32 bits",
    ..Form::OWN
};
const W0609_HEX: Form = Form {
    help: "write `{meant}`{fix}",
    ..Form::OWN
};
const W0609_VERSION: Form = Form {
    says: "{name} `{given}` in [{section}] is not a version of CiA 306",
    help: "write `4.0`, `4.1` or `4.2`",
};

pub(crate) fn w0609_key_value_not_valid(
    section: &str,
    key: &str,
    given: &Text<'_>,
    wanted: Wanted,
) -> Finding {
    let finding = W0609.at(given.span);
    let finding = match wanted {
        Wanted::Number(u32::MAX) => finding.form(&W0609_LONG),
        Wanted::Number(most) => finding.form(&W0609_NUMBER).fact("most", most),
        Wanted::Version => finding.form(&W0609_VERSION),
        _ => finding,
    };
    let finding = match hexadecimal(given).filter(|_| matches!(wanted, Wanted::Number(_))) {
        Some(meant) => {
            let fix = Fix::unsafe_fix().replace(given.span, meant.as_str());
            finding.form(&W0609_HEX).fact("meant", meant).fix(fix)
        }
        None => finding,
    };
    // A number or a flag of the device, which no tool can use. Dates and versions of the file are
    // only read by people; many files have a FileVersion such as `1.0`, or `08`.
    let is_number = matches!(wanted, Wanted::Flag | Wanted::Number(_));
    let is_read = section.eq_ignore_ascii_case("DeviceInfo")
        || section.eq_ignore_ascii_case("DeviceComissioning") && is_number
        || section.eq_ignore_ascii_case("DeviceCommissioning") && is_number
        || key.eq_ignore_ascii_case("NodeID")
        || wanted == Wanted::Flag;
    let is_of_file = ["FileVersion", "FileRevision"]
        .iter()
        .any(|own| key.eq_ignore_ascii_case(own));
    let finding = if is_read {
        finding.severity_of(Error)
    } else if is_of_file && is_version(given) {
        finding.severity_of(Info)
    } else {
        finding
    };
    finding
        .fact("section", section)
        .fact("name", key)
        .fact("given", &*given.value)
}

/// Returns whether this is a version with points, such as `1.0` or `2.1.3`, or a number of one byte.
fn is_version(text: &str) -> bool {
    let mut parts = text.split('.');
    let is_number = |part: &str| !part.is_empty() && part.bytes().all(|b| b.is_ascii_digit());
    parts.all(is_number) && (text.contains('.') || text.parse::<u8>().is_ok())
}

/// The number that is probably meant by hexadecimal digits without `0x`: `0xDEF` for `DEF`. `None` for
/// digits of a decimal number.
fn hexadecimal(text: &str) -> Option<String> {
    let digits = text.strip_suffix(['h', 'H']).unwrap_or(text);
    let is_hex = matches!(digits.len(), 1..=8) && digits.bytes().all(|b| b.is_ascii_hexdigit());
    let is_decimal = text.bytes().all(|b| b.is_ascii_digit());
    (is_hex && !is_decimal).then(|| format!("0x{}", digits.to_ascii_uppercase()))
}

pub(crate) static I0610: Rule = Rule {
    title: "date or time is not as CiA 306 specifies",
    why: "Some editors drop the value; odkit keeps it. CiA 306 specifies `MM-DD-YYYY` and `hh:mmAM`.",
    source: "CiA 306-1, FileInfo",
    says: "{name} `{given}` is not as CiA 306 specifies",
    fixability: Fixability::Unsafe,
    help: "write {right}{fix}",
    ..Rule::of("I0610")
};

pub(crate) fn i0610_date_or_time(key: &str, given: &Text<'_>, wanted: Wanted) -> Finding {
    let finding = I0610.given(given).fact("name", key);
    let finding = if is_possible(given) {
        finding
    } else {
        finding.severity_of(Warning)
    };
    let (right, wanted) = match wanted {
        Wanted::Time => (
            right_time(given),
            "hour, minute, and AM or PM, such as `09:30AM`",
        ),
        _ => (
            right_date(given),
            "month, day and year, such as `07-14-2026`",
        ),
    };
    match right {
        Some(right) => {
            let fix = Fix::unsafe_fix().replace(given.span, right.as_str());
            finding.fact("right", format!("`{right}`")).fix(fix)
        }
        None => finding.fact("right", wanted),
    }
}

/// A date as CiA 306 specifies, if the text can only be read as this day: the year is first, or points are between day and
/// month, or only one of the two can be the month.
fn right_date(text: &str) -> Option<String> {
    let is_day = |text: &String| day(text).is_some();
    let iso = text.replace(['/', '.'], "-");
    if iso.find('-') == Some(4) {
        return Some(date(&iso)).filter(is_day);
    }
    let parts: Vec<&str> = iso.split('-').collect();
    let [one, other, year] = parts[..] else {
        return None;
    };
    let [first, turned] = [(one, other), (other, one)]
        .map(|(month, day)| Some(format!("{month:0>2}-{day:0>2}-{year}")).filter(is_day));
    match (first, turned) {
        (_, Some(turned)) if text.contains('.') => Some(turned),
        (Some(only), None) | (None, Some(only)) => Some(only),
        _ => None,
    }
}

/// A time as CiA 306 specifies, of one with hours from 0 to 23.
fn right_time(text: &str) -> Option<String> {
    let upper = text.to_ascii_uppercase();
    let plain = upper.trim_end_matches(['A', 'P', 'M', ' ']);
    let right = time(plain);
    (right != plain).then_some(right)
}

/// Returns whether a time has fewer than 60 minutes, and whether a date is a day of the calendar with month and day in either
/// order.
fn is_possible(text: &str) -> bool {
    let number = |part: Option<&str>| part.and_then(|part| part.get(..2)?.parse::<u8>().ok());
    let (mut time, mut date) = (text.split(':'), text.split('-'));
    if time.next().is_some_and(|hour| hour.len() <= 2)
        && let Some(minute) = number(time.next())
    {
        return minute < 60;
    }
    match (number(date.next()), number(date.next()), date.next()) {
        (Some(one), Some(other), Some(year)) if year.len() == 4 => {
            // A program that knows no date writes the year 0001.
            let year = year.max("1000");
            let is_day = |month: u8, of: u8| day(&format!("{month}-{of}-{year}")).is_some();
            is_day(one, other) || is_day(other, one)
        }
        _ => true,
    }
}

pub(crate) static I0611: Rule = Rule {
    title: "DeviceCommissioning is spelled with two m",
    why: "Many tools know only the spelling of the standard, `DeviceComissioning`. odkit reads both.",
    source: "CiA 306-1, DCF",
    fixability: Fixability::Either,
    says: "CiA 306 spells `DeviceCommissioning` with one m",
    help: "write `[DeviceComissioning]`{fix}",
    ..Rule::of("I0611")
};

/// The finding about the header. A tool that now ignores the section may stop at an invalid value
/// in it.
pub(crate) fn i0611_commissioning_spelling(header: Span, is_valid: bool) -> Finding {
    let fix = if is_valid {
        Fix::safe()
    } else {
        Fix::unsafe_fix()
    };
    I0611
        .at(header)
        .fix(fix.replace(header, "[DeviceComissioning]"))
}

pub(crate) static W0658: Rule = Rule {
    title: "DCF or XDC without the node ID of its device",
    why: "A master that configures by the DCF has no node ID and no bit rate for the device.",
    source: "CiA 306-1, DeviceComissioning; CiA 311, deviceCommissioning",
    says: "section [DeviceComissioning] is missing, and this file is a DCF",
    help: "add a section [DeviceComissioning] with `NodeID=` and `Baudrate=`",
    also: &[W0658_XDC],
    ..Rule::of("W0658")
};

/// Sentence for an XDC.
const W0658_XDC: Form = Form {
    says: "element deviceCommissioning is missing, and this file is an XDC",
    help: "add `<deviceCommissioning nodeID=\"1\" actualBaudRate=\"250 Kbps\"/>` with the values of the device to NetworkManagement",
};

/// The finding about a DCF, or an XDC if the file `is_xml`, without the node ID of its device.
pub(crate) fn w0658_commissioning_missing(is_xml: bool) -> Finding {
    let form = if is_xml { &W0658_XDC } else { &Form::OWN };
    W0658.finding().form(form)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_day_of_the_calendar_in_either_order_is_possible() {
        for text in [
            "02-29-2024",
            "29-02-2024",
            "01-01-0001",
            "17:30PM",
            "tomorrow",
        ] {
            assert!(is_possible(text), "{text}");
        }
        for text in ["02-30-2026", "02-29-2026", "13-13-2026", "09:75AM"] {
            assert!(!is_possible(text), "{text}");
        }
    }

    #[test]
    fn a_version_has_points_or_one_byte() {
        for text in ["1.0", "2.10.3", "08", "255"] {
            assert!(is_version(text), "{text}");
        }
        for text in ["256", "1.", "-", "1.a"] {
            assert!(!is_version(text), "{text}");
        }
    }
}
