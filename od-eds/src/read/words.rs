//! Words where CiA 306 has numbers, and other words than its own.

use alloc::format;
use alloc::string::String;

use crate::fix::Fix;
use crate::read::entry::Reader;
use crate::rules;
use crate::scan::number::before_comment;
use crate::scan::placed::Text;
use od_model::{Access, DataType, ObjectCode};

/// A data type by its name: `UNSIGNED8`.
pub(crate) fn data_type(reader: &mut Reader<'_>, given: &Text<'_>) -> Option<DataType> {
    let word = before_comment(given);
    let data_type = DataType::ALL.into_iter().find(|t| same(word, t.name()))?;
    report(
        reader,
        "DataType",
        given,
        &format!("0x{:04X}", data_type.code()),
    );
    Some(data_type)
}

/// An object code by its name: `VAR`.
pub(crate) fn object_code(reader: &mut Reader<'_>, given: &Text<'_>) -> Option<ObjectCode> {
    let word = before_comment(given);
    let code = (0..=9)
        .filter_map(ObjectCode::from_code)
        .find(|code| same(word, code.name()))?;
    report(reader, "ObjectType", given, &format!("0x{:X}", code.code()));
    Some(code)
}

/// An access in other words than those of CiA 306.
pub(crate) fn access(reader: &mut Reader<'_>, given: &Text<'_>, word: &str) -> Option<Access> {
    let known: &[(&str, Access)] = &[
        ("r", Access::Ro),
        ("read", Access::Ro),
        ("readonly", Access::Ro),
        ("w", Access::Wo),
        ("write", Access::Wo),
        ("writeonly", Access::Wo),
        ("wr", Access::Rw),
        ("r/w", Access::Rw),
        ("w/r", Access::Rw),
        ("readwrite", Access::Rw),
        ("constant", Access::Const),
        ("co", Access::Const),
    ];
    let found = known.iter().find(|(known, _)| same(word, known))?.1;
    report(reader, "AccessType", given, found.name());
    Some(found)
}

/// PDOMapping as a word.
pub(crate) fn mappable(reader: &mut Reader<'_>, given: &Text<'_>) -> Option<bool> {
    let word = before_comment(given);
    let known = [
        ("no", false),
        ("false", false),
        ("yes", true),
        ("true", true),
        ("optional", true),
    ];
    let found = known.iter().find(|(known, _)| same(word, known))?.1;
    report(reader, "PDOMapping", given, if found { "1" } else { "0" });
    Some(found)
}

/// The same letters and digits, whatever stands between them?
fn same(a: &str, b: &str) -> bool {
    let letters = |text: &str| -> String {
        text.chars()
            .filter(|c| !matches!(c, ' ' | '_' | '-'))
            .map(|c| c.to_ascii_lowercase())
            .collect()
    };
    !a.is_empty() && letters(a) == letters(b)
}

fn report(reader: &mut Reader<'_>, key: &str, given: &Text<'_>, right: &str) {
    reader.report(
        rules::W0424
            .told(
                given.span,
                format!("`{}` is read as `{right}`", given.value),
            )
            .with_help(format!("write `{key}={right}`"))
            .fix(Fix::safe().replace(given.span, right)),
    );
}
