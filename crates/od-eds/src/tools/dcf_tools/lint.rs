//! The checks of dcf-tools (`dcflint`), section by section.

use alloc::format;
use alloc::string::{String, ToString};

use super::rules::{LIST, MEMBERS, MISSING, UNKNOWN};
use crate::fix::Fix;
use crate::span::Span;
use crate::tools::configparser::{Ini, Pair, Section};
use crate::tools::python::int;
use crate::tools::tool::Reading;

/// The checks and their findings.
pub(super) struct Lint<'a> {
    pub(super) ini: &'a Ini<'a>,
    pub(super) reading: Reading,
}

/// The checks of all sections.
pub(super) fn lint<'a>(ini: &'a Ini<'a>, reading: Reading) -> Reading {
    let mut lint = Lint { ini, reading };
    for section in ini.all() {
        lint.section(section);
    }
    lint.reading
}

const FILE_INFO: &str = " filename fileversion filerevision edsversion description creationtime creationdate createdby \
    modificationtime modificationdate modifiedby lasteds ";
const NODE: &str = " nodeid nodename noderefd baudrate netnumber networkname netrefd canopenmanager lss_serialnumber ";
const DEVICE_INFO: &str = " vendorname vendornumber productname productnumber revisionnumber ordercode baudrate_10 \
    baudrate_20 baudrate_50 baudrate_125 baudrate_250 baudrate_500 baudrate_800 baudrate_1000 simplebootupmaster \
    simplebootupslave granularity dynamicchannelssupported groupmessaging nrofrxpdo nroftxpdo lss_supported compactpdo ";
const OBJECT: &str = " subnumber parametername objecttype datatype accesstype lowlimit highlimit defaultvalue pdomapping \
    objflags compactsubobj parametervalue uploadfile downloadfile denotation paramrefd ";

fn is_one_of(words: &str, word: &str) -> bool {
    !word.contains(' ') && words.contains(&format!(" {} ", word.to_lowercase()))
}

/// The index in a section's name, and the rest of the name.
fn object_name(name: &str) -> Option<(u32, &str)> {
    let (index, rest) = name.split_at_checked(4)?;
    let is_hex = |text: &str| text.bytes().all(|byte| byte.is_ascii_hexdigit());
    let is_sub = rest.get(..3).is_some_and(|word| {
        word.eq_ignore_ascii_case("sub") && rest.len() > 3 && is_hex(&rest[3..])
    });
    let known =
        rest.is_empty() || rest.eq_ignore_ascii_case("name") || rest.eq_ignore_ascii_case("value");
    (is_hex(index) && (known || is_sub))
        .then(|| (u32::from_str_radix(index, 16).unwrap_or(0), rest))
}

impl<'a> Lint<'a> {
    fn section(&mut self, section: &'a Section<'a>) {
        let keys = match section.name.to_lowercase().as_str() {
            "fileinfo" => FILE_INFO,
            "devicecomissioning" => NODE,
            "deviceinfo" => DEVICE_INFO,
            "comments" => return,
            "dummyusage" => return self.dummies(section),
            "mandatoryobjects" | "optionalobjects" | "manufacturerobjects" => {
                return self.list(section);
            }
            _ => match object_name(&section.name) {
                Some((index, "")) => return self.object(section, index),
                Some((index, rest)) if rest[..1].eq_ignore_ascii_case("s") => {
                    return self.member(section, index, &rest[3..]);
                }
                Some((index, rest)) => {
                    return self.compact(section, index, rest.eq_ignore_ascii_case("value"));
                }
                None => {
                    let finding = UNKNOWN.at(section.header).form(&UNKNOWN.also[0]);
                    return self.reading.push(finding.fact("section", &*section.name));
                }
            },
        };
        for pair in section
            .pairs
            .iter()
            .filter(|pair| !is_one_of(keys, &pair.key))
        {
            self.unknown(section, pair);
        }
    }

    fn unknown(&mut self, section: &Section<'_>, pair: &Pair<'_>) {
        let finding = UNKNOWN.at(pair.at).fact("section", &*section.name);
        let fix = Fix::unsafe_fix().comment_out(pair.at);
        self.reading.push(finding.fact("name", &*pair.key).fix(fix));
    }

    fn dummies(&mut self, section: &'a Section<'a>) {
        for pair in &section.pairs {
            let digits = pair
                .key
                .get(5..)
                .filter(|_| pair.key[..5].eq_ignore_ascii_case("dummy"));
            let digits = digits
                .filter(|it| it.len() == 4 && it.bytes().all(|byte| byte.is_ascii_hexdigit()));
            if digits.is_none() {
                self.unknown(section, pair);
            } else if int(&pair.value, 2).is_none() {
                self.not_a_number(pair, None);
            }
        }
    }

    /// The pair of a key with a value.
    pub(super) fn given(&self, section: &'a Section<'a>, key: &str) -> Option<&'a Pair<'a>> {
        let pair = self.ini.get(section, key);
        pair.filter(|pair| !pair.value.is_empty())
    }

    /// The number of a key; 0 if it has no value.
    pub(super) fn number(&mut self, section: &'a Section<'a>, key: &str) -> i128 {
        let Some(pair) = self.given(section, key) else {
            return 0;
        };
        let read = int(&pair.value, 0);
        if read.is_none() {
            self.not_a_number(pair, None);
        }
        read.unwrap_or(0)
    }

    /// Reports a key that is missing.
    pub(super) fn missing(&mut self, section: &Section<'_>, key: &str) {
        let finding = MISSING.at(section.header).fact("section", &*section.name);
        self.reading.push(finding.fact("name", key));
    }

    fn list(&mut self, section: &'a Section<'a>) {
        let what = |span: Span, what: String| {
            LIST.at(span)
                .fact("section", &*section.name)
                .fact("what", what)
        };
        let mut count = None;
        let mut has_count = false;
        for pair in &section.pairs {
            if pair.key.eq_ignore_ascii_case("SupportedObjects") {
                has_count = true;
                count = int(&pair.value, 10);
                if count.is_none() {
                    self.not_a_number(pair, None);
                }
            } else if int(&pair.key, 10).is_none() {
                self.unknown(section, pair);
            }
        }
        let Some(count) = count else {
            if !has_count {
                self.missing(section, "SupportedObjects");
            }
            return;
        };
        let others = section.pairs.len() as i128 - 1;
        if count < others {
            let text = format!("more than {count} entries");
            self.reading.push(what(section.header, text));
        }
        let kind = section.name.to_lowercase();
        for number in 1..=count {
            let Some(pair) = self.ini.get(section, &number.to_string()) else {
                self.missing(section, &number.to_string());
                break;
            };
            let Some(index) = int(&pair.value, 0) else {
                self.not_a_number(pair, None);
                continue;
            };
            if self.ini.section(&format!("{index:04X}")).is_none() {
                self.reading.push(what(
                    pair.span,
                    format!("object {index:04X}h without a section"),
                ));
            }
            let misplaced = match kind.as_str() {
                _ if index < 0x1000 => true,
                "mandatoryobjects" => !matches!(index, 0x1000 | 0x1001 | 0x1018),
                "optionalobjects" => (0x2000..0x6000).contains(&index),
                _ => !(0x2000..0x6000).contains(&index),
            };
            if misplaced {
                self.reading
                    .push(what(pair.span, format!("misplaced object {index:04X}h")));
            }
        }
    }

    /// Checks keys, access type and name, for objects and sub-objects.
    fn keys(&mut self, section: &'a Section<'a>) {
        for pair in &section.pairs {
            let word = pair.value.to_lowercase();
            let is_access = pair.key.eq_ignore_ascii_case("AccessType");
            if !is_one_of(OBJECT, &pair.key) {
                self.unknown(section, pair);
            } else if is_access && !matches!(&*word, "ro" | "wo" | "rw" | "rwr" | "rww" | "const") {
                let finding = UNKNOWN.at(pair.span).form(&UNKNOWN.also[1]);
                let finding = finding.fact("name", &*pair.key);
                self.reading.push(finding.fact("value", &*pair.value));
            }
        }
        if self.ini.get(section, "ParameterName").is_none() {
            self.missing(section, "ParameterName");
        }
    }

    fn members(&mut self, section: &Section<'_>, at: Span, what: impl Into<String>) {
        let finding = MEMBERS.at(at).fact("section", &*section.name);
        self.reading.push(finding.fact("what", what.into()));
    }

    fn object(&mut self, section: &'a Section<'a>, index: u32) {
        self.keys(section);
        let at = |pair: Option<&Pair<'_>>| pair.map_or(section.header, |pair| pair.span);
        let code = match self.given(section, "ObjectType") {
            Some(_) => self.number(section, "ObjectType"),
            None => 7,
        };
        if matches!(code, 5 | 7) && self.given(section, "DataType").is_none() {
            self.missing(section, "DataType");
        }
        let count = self.number(section, "SubNumber");
        let compact = self.number(section, "CompactSubObj");
        let is_many = matches!(code, 8 | 9);
        match self.given(section, "AccessType") {
            Some(pair) if (is_many || code == 6) && compact == 0 => {
                self.members(
                    section,
                    pair.span,
                    "AccessType of an object with sub-objects",
                );
            }
            None if code != 2 && compact != 0 => self.missing(section, "AccessType"),
            _ => {}
        }
        let own = at(self.given(
            section,
            if count != 0 {
                "SubNumber"
            } else {
                "CompactSubObj"
            },
        ));
        if count != 0 && compact != 0 {
            self.members(section, own, "SubNumber beside CompactSubObj");
        } else if (count != 0 || compact != 0) && !is_many {
            self.members(
                section,
                own,
                "sub-objects of an object that is not an ARRAY or RECORD",
            );
        }
        if count != 0 && compact == 0 {
            let mut found = 0;
            for sub in 0..255 {
                let name = format!("{index:04X}sub{sub:X}");
                let Some(member) = self.ini.section(&name) else {
                    continue;
                };
                found += 1;
                let data_type = self
                    .given(member, "DataType")
                    .and_then(|pair| int(&pair.value, 0));
                if sub == 0 && data_type != Some(5) {
                    self.members(member, member.header, "a sub-index 0 that is not UNSIGNED8");
                }
            }
            if found != count {
                self.members(
                    section,
                    own,
                    format!("SubNumber {count} with {found} sub-objects"),
                );
            }
        }
        if count == 0 {
            self.value_section(section);
        }
    }

    fn member(&mut self, section: &'a Section<'a>, index: u32, sub: &str) {
        if self.ini.section(&format!("{index:04X}")).is_none() {
            let name = format!("{index:04X}");
            let finding = MISSING.at(section.header).form(&MISSING.also[0]);
            self.reading.push(finding.fact("section", name));
        }
        if u32::from_str_radix(sub, 16).is_ok_and(|sub| sub <= 254) {
            self.keys(section);
            self.value_section(section);
            if self.given(section, "AccessType").is_none()
                && self.ini.get(section, "AccessType").is_none()
            {
                self.missing(section, "AccessType");
            }
        } else {
            self.members(section, section.header, "a sub-index beyond FEh");
        }
    }

    /// `[2000Name]` and `[2000Value]`
    fn compact(&mut self, section: &'a Section<'a>, index: u32, has_values: bool) {
        let before = self.reading.findings.len();
        let name = format!("{index:04X}");
        let mut compact = 0;
        let object = self.ini.section(&name);
        match object {
            Some(object) if self.given(object, "CompactSubObj").is_some() => {
                compact = self.number(object, "CompactSubObj");
                self.check_limits(object);
            }
            Some(_) => self.members(
                section,
                section.header,
                "names or values without CompactSubObj",
            ),
            None => {
                let finding = MISSING.at(section.header).form(&MISSING.also[0]);
                self.reading.push(finding.fact("section", name));
            }
        }
        let mut count = None;
        let mut has_count = false;
        for pair in &section.pairs {
            if pair.key.eq_ignore_ascii_case("NrOfEntries") {
                has_count = true;
                count = int(&pair.value, 10);
                if count.is_none() {
                    self.not_a_number(pair, None);
                }
            } else {
                match int(&pair.key, 10) {
                    Some(sub) if sub > compact => {
                        self.members(section, pair.at, "a sub-index beyond CompactSubObj")
                    }
                    Some(_) => {}
                    None => self.unknown(section, pair),
                }
            }
        }
        let Some(count) = count else {
            if !has_count {
                self.missing(section, "NrOfEntries");
            }
            return;
        };
        let others = section.pairs.len() as i128 - 1;
        if count != others {
            self.members(
                section,
                section.header,
                format!("NrOfEntries {count} with {others} entries"),
            );
        }
        if has_values
            && before == self.reading.findings.len()
            && let Some(object) = object
        {
            let values = section.pairs.iter();
            for pair in values.filter(|pair| !pair.key.eq_ignore_ascii_case("NrOfEntries")) {
                self.check_value(object, pair);
            }
        }
    }
}
