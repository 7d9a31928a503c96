//! A description as a C header with the constants that the firmware of a master needs.

use alloc::collections::BTreeSet;
use alloc::string::String;
use alloc::vec::Vec;
use alloc::{format, vec};
use core::fmt::Write;

use crate::description::tables::fitting;
use crate::description::{Description, EntryDescription, Value};
use od_model::{DataType, Kind, Visible};

/// Returns the header's text.
///
/// `name` prefixes every macro: `GXMM_POSITION_VALUE_INDEX`. `source` is named in its first line.
pub fn write(description: &Description, name: &str, source: &str) -> String {
    let prefix = macro_name(name);
    let mut out = String::new();
    // Writing to a String cannot fail, here and below.
    let _ = writeln!(
        out,
        "/* Object dictionary of {}.\n * Made by `odkit convert`. NODE_ID has to be defined where a default hangs on it. */\n\
         #ifndef {prefix}_OD_H\n#define {prefix}_OD_H",
        comment(source)
    );
    for ((&index, object), (stem, stems)) in description.objects.iter().zip(stems(description)) {
        let title = object.name.value.as_str();
        let _ = writeln!(
            out,
            "\n/* {:04X}h {}, {} */\n#define {prefix}_{stem}_INDEX 0x{:04X}u",
            index,
            comment(title),
            object.code.name(),
            index
        );
        for ((&sub, entry), stem) in object.entries.iter().zip(&stems) {
            one(&mut out, sub, entry, &prefix, stem);
        }
    }
    let _ = writeln!(out, "\n#endif /* {prefix}_OD_H */");
    out
}

/// Returns the text of a header with a macro for each value that expands to index and sub-index as two arguments:
/// `OD_POSITION_VALUE 0x6004u, 0x00u`. For the firmware of the device itself (`od-capi`).
pub fn addresses(description: &Description, name: &str, source: &str) -> String {
    let prefix = macro_name(name);
    let mut out = String::new();
    let _ = writeln!(
        out,
        "/* Index and sub-index of the values of {}. */\n\
         #ifndef {prefix}_OBJECTS_H\n#define {prefix}_OBJECTS_H\n",
        comment(source)
    );
    for ((&index, object), (_, stems)) in description.objects.iter().zip(stems(description)) {
        for ((&sub, entry), stem) in object.entries.iter().zip(&stems) {
            let data_type = entry.data_type.map(|data_type| data_type.value);
            let (name, access) = (
                data_type.map_or("unknown type", DataType::name),
                entry.access.name(),
            );
            let _ = writeln!(
                out,
                "#define {prefix}_{stem} 0x{index:04X}u, 0x{sub:02X}u /* {name}, {access} */"
            );
        }
    }
    let _ = writeln!(out, "\n#endif /* {prefix}_OBJECTS_H */");
    out
}

/// The names of objects and of their values, in the order of the description.
fn stems(description: &Description) -> impl Iterator<Item = (String, Vec<String>)> {
    let mut names = BTreeSet::new();
    description.objects.iter().map(move |(&index, object)| {
        let title = macro_name(&object.name.value);
        let stem = unique(&mut names, title, index, None);
        let entries = object.entries.iter().map(|(&sub, entry)| {
            if object.code.has_members() {
                let member = macro_name(&entry.name);
                unique(&mut names, format!("{stem}_{member}"), index, Some(sub))
            } else {
                stem.clone()
            }
        });
        let entries = entries.collect();
        (stem, entries)
    })
}

fn one(out: &mut String, sub: u8, entry: &EntryDescription, prefix: &str, stem: &str) {
    let data_type = entry.data_type.map(|data_type| data_type.value);
    let mut facts = vec![
        data_type.map_or("unknown type", DataType::name),
        entry.access.name(),
    ];
    let mappable = *entry.mappable;
    let [tpdo, rpdo] = [entry.access.maps_to_tpdo(), entry.access.maps_to_rpdo()];
    match (mappable && tpdo, mappable && rpdo) {
        (true, true) => facts.push("TPDO, RPDO"),
        (true, false) => facts.push("TPDO"),
        (false, true) => facts.push("RPDO"),
        (false, false) => {}
    }
    let facts = facts.join(", ");
    let _ = writeln!(
        out,
        "#define {prefix}_{stem}_SUB 0x{sub:02X}u /* {facts} */"
    );
    let Some(data_type) = data_type else { return };
    if let Some(bits) = data_type.bits() {
        let _ = writeln!(out, "#define {prefix}_{stem}_BITS {bits}u");
    }
    for (what, value) in [
        (
            "DEFAULT",
            fitting(&entry.parameter, data_type).or(fitting(&entry.default, data_type)),
        ),
        ("MIN", fitting(&entry.low, data_type)),
        ("MAX", fitting(&entry.high, data_type)),
    ] {
        if let Some(text) = value.and_then(|value| constant(data_type, value)) {
            let _ = writeln!(out, "#define {prefix}_{stem}_{what} {text}");
        }
    }
}

/// A C constant; a default that depends on the node ID is a macro with an argument.
fn constant(data_type: DataType, value: &Value) -> Option<String> {
    let wide = data_type.bits().is_some_and(|bits| bits > 32);
    let (unsigned, signed) = if wide { ("ull", "ll") } else { ("u", "") };
    let is_signed = data_type.kind() == Kind::Signed;
    Some(match *value {
        Value::Bytes(_) => return None,
        Value::Unsigned(value) if is_signed => format!("({value}{signed})"),
        Value::Unsigned(value) => format!("0x{value:X}{unsigned}"),
        // It fits an unsigned type, so it is not negative.
        Value::Signed(value) if !is_signed => format!("0x{value:X}{unsigned}"),
        // C has no literal for the smallest number of a type.
        Value::Signed(i64::MIN) => "(-9223372036854775807ll - 1ll)".into(),
        Value::Signed(value @ -0x8000_0000) => format!("({}{signed} - 1{signed})", value + 1),
        Value::Signed(value) => format!("({value}{signed})"),
        Value::Real(value) if value.is_finite() => format!("({value:?})"),
        Value::Real(_) => return None,
        Value::NodeId(offset) => format!("(0x{offset:X}u + (NODE_ID))"),
        Value::Text(ref text) => format!("\"{}\"", c_string(text)),
    })
}

fn c_string(text: &str) -> String {
    let mut out = String::new();
    for byte in text.bytes() {
        match byte {
            b'"' | b'\\' => {
                out.push('\\');
                out.push(char::from(byte));
            }
            // Octal escapes end after three digits; a hex escape would continue. `?` might
            // begin a trigraph.
            b' '..=b'~' if byte != b'?' => out.push(char::from(byte)),
            _ => {
                let _ = write!(out, "\\{byte:03o}");
            }
        }
    }
    out
}

/// The text as one line of a C comment.
pub(super) fn comment(text: &str) -> String {
    Visible(text)
        .line()
        .replace("*/", "* /")
        .replace("/*", "/ *")
}

/// `Position value (raw)` is `POSITION_VALUE_RAW`.
fn macro_name(text: &str) -> String {
    let mut name = String::new();
    for character in text.chars() {
        if character.is_ascii_alphanumeric() {
            name.push(character.to_ascii_uppercase());
        } else if !name.is_empty() && !name.ends_with('_') {
            name.push('_');
        }
    }
    let name = name.trim_end_matches('_');
    match name.chars().next() {
        None => "X".into(),
        Some(first) if first.is_ascii_digit() => format!("X{name}"),
        Some(_) => name.into(),
    }
}

/// Appends the address to a name that exists already.
fn unique(names: &mut BTreeSet<String>, name: String, index: u16, sub: Option<u8>) -> String {
    if names.insert(name.clone()) {
        return name;
    }
    let name = match sub {
        Some(sub) => format!("{name}_{index:04X}_{sub:02X}"),
        None => format!("{name}_{index:04X}"),
    };
    names.insert(name.clone());
    name
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_and_texts_are_valid_in_c() {
        assert_eq!(macro_name("Position value (raw)"), "POSITION_VALUE_RAW");
        assert_eq!(macro_name("1st mapped object"), "X1ST_MAPPED_OBJECT");
        assert_eq!(macro_name("§°"), "X");
        assert_eq!(c_string("a\"b\\c\n?7"), "a\\\"b\\\\c\\012\\0777");
        assert_eq!(comment("x */ int y; /*"), "x * / int y; / *");
        let mut names = BTreeSet::new();
        assert_eq!(unique(&mut names, "A".into(), 0x2000, None), "A");
        assert_eq!(unique(&mut names, "A".into(), 0x2001, None), "A_2001");
        assert_eq!(unique(&mut names, "A".into(), 0x2001, Some(3)), "A_2001_03");
    }

    #[test]
    fn an_address_expands_to_two_arguments() {
        let eds = "[1017]\nParameterName=Producer heartbeat time\nDataType=6\nAccessType=rw\n\
                   [1018]\nParameterName=Identity\nObjectType=9\nSubNumber=2\n\
                   [1018sub0]\nParameterName=Last\nDataType=5\nAccessType=const\n\
                   [1018sub1]\nParameterName=Vendor-ID\nDataType=7\nAccessType=ro\n";
        let text = addresses(&crate::parse(eds).description, "OD", "x.eds");
        for line in [
            "#define OD_PRODUCER_HEARTBEAT_TIME 0x1017u, 0x00u /* UNSIGNED16, rw */\n",
            "#define OD_IDENTITY_VENDOR_ID 0x1018u, 0x01u /* UNSIGNED32, ro */\n",
        ] {
            assert!(text.contains(line), "{text}");
        }
    }
}
