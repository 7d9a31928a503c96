//! Types that a file defines for itself, as CanFestival writes them.
//!
//! A DataType of 0040h or more refers to an object of the same file, whose sub-index 1
//! holds the type, and 2 and 3 the limits. The value is read as if it had this type and these limits itself.

use alloc::borrow::Cow;
use alloc::collections::BTreeMap;

use crate::log::Log;
use crate::read::object::Sections;
use crate::rules::values::reader::i0425_own_data_type;
use crate::scan::number::{self, number};
use crate::scan::section::{Text, TextSection};
use crate::span::Spanned;
use od_model::{Address, DataType};

/// Types of manufacturers and profiles (CiA 301, object dictionary structure).
const OWN: core::ops::RangeInclusive<u16> = 0x0040..=0x025F;

/// A type of the file: its number and the limits, as written.
struct OwnType<'a> {
    data_type: Text<'a>,
    low: Option<Text<'a>>,
    high: Option<Text<'a>>,
}

/// Replaces references to the types.
pub(crate) fn resolve<'a>(objects: &mut BTreeMap<u16, Sections<'a>>, log: &mut Log) {
    let own: BTreeMap<u16, OwnType<'a>> = objects
        .range(OWN)
        .filter_map(|(index, sections)| Some((*index, own_type(sections)?)))
        .collect();
    if own.is_empty() {
        return;
    }
    for (index, sections) in objects.iter_mut() {
        let whole = sections.own.iter_mut().map(|section| (0, section));
        let members = sections
            .members
            .iter_mut()
            .map(|(sub, section)| (*sub, section));
        for (sub, section) in whole.chain(members) {
            let at = section
                .pairs
                .iter()
                .position(|(key, _)| key.eq_ignore_ascii_case("DataType"));
            let Some(at) = at else { continue };
            let given = section.pairs[at].1.clone();
            let code = number(number::before_comment(&given)).and_then(|n| u16::try_from(n).ok());
            let Some(found) = code.and_then(|code| own.get(&code)) else {
                continue;
            };
            let finding = i0425_own_data_type(&given, &found.data_type);
            log.push(finding.about(Address::new(*index, sub)));
            section.pairs[at].1.value = found.data_type.value.clone();
            add(section, "LowLimit", &found.low);
            add(section, "HighLimit", &found.high);
        }
    }
}

/// A limit of the type, if the value has none of its own.
fn add<'a>(section: &mut TextSection<'a>, key: &'static str, limit: &Option<Text<'a>>) {
    let has_one = section.get(key).is_some_and(|own| !own.is_empty());
    if let Some(limit) = limit
        && !has_one
    {
        section
            .pairs
            .retain(|(own, _)| !own.eq_ignore_ascii_case(key));
        let key = Spanned::new(Cow::Borrowed(key), limit.span);
        section.pairs.push((key, limit.clone()));
    }
}

fn own_type<'a>(sections: &Sections<'a>) -> Option<OwnType<'a>> {
    let value = |sub: u8| {
        let member = sections.members.get(&sub)?;
        let pairs = member.pairs.iter();
        let mut found = pairs.filter(|(key, _)| key.eq_ignore_ascii_case("DefaultValue"));
        let (_, value) = found.next()?;
        (!value.is_empty()).then(|| value.clone())
    };
    let data_type = value(1)?;
    let code = number(&data_type).and_then(|n| u16::try_from(n).ok())?;
    DataType::from_code(code)?;
    Some(OwnType {
        data_type,
        low: value(2),
        high: value(3),
    })
}

#[cfg(test)]
mod tests {
    use alloc::vec::Vec;

    use super::*;
    use crate::description::Value;

    #[test]
    fn a_reference_to_a_type_of_the_file_is_replaced() {
        let parsed = crate::parse(
            "[A0]\nParameterName=INTEGER8[-10-20]\nObjectType=0x6\nSubNumber=4\n\
             [A0sub1]\nParameterName=Type\nDataType=5\nDefaultValue=0x2\n\
             [A0sub2]\nParameterName=Minimum\nDataType=2\nDefaultValue=-10\n\
             [A0sub3]\nParameterName=Maximum\nDataType=2\nDefaultValue=20\n\
             [2000]\nParameterName=a\nDataType=0x00A0\nAccessType=rw\nHighLimit=5\n\
             [2001]\nParameterName=a\nDataType=0x00A1\nAccessType=rw\n",
        );
        let entry = parsed.description.entry(Address::new(0x2000, 0)).unwrap();
        assert_eq!(entry.data_type.map(|t| t.value), Some(DataType::Integer8));
        assert_eq!(entry.low.as_deref(), Some(&Value::Signed(-10)));
        assert_eq!(entry.high.as_deref(), Some(&Value::Signed(5)));
        let codes: Vec<_> = parsed.findings.iter().map(|d| d.code()).collect();
        assert!(codes.contains(&"I0425") && codes.contains(&"E0402"));
    }
}
