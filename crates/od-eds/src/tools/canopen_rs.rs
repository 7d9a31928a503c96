//! canopen-rs, whose reader is the crate `canopen-host`.
//!
//! It uses only the node ID of `[DeviceComissioning]`, ignores unknown lines, and rejects unknown access
//! types and values.

use alloc::collections::BTreeMap;
use alloc::string::String;

use crate::fact::Key;
use crate::finding::{Fixability, Form, Rule};
use crate::scan::lines::{Line, lines_by_newline};
use crate::span::Span;
use crate::tools::shared::ENCODING;
use crate::tools::tool::{Differences, Input, REJECTS, Read, ReadEntry, Reading, Tool};

const SOURCE: &str = "canopen-host 0.6.1 of crates.io, src/eds.rs";

pub(crate) static TOOL: Tool = Tool {
    name: "canopen-rs",
    version: "0.6.1",
    source: SOURCE,
    tried: true,
    rules: &[
        &NOT_TEXT,
        &ACCESS,
        &VALUE,
        &DIFFERENCES.drops,
        &DIFFERENCES.value,
        &DIFFERENCES.field,
    ],
    read,
    value: Some(|key, text, data_type| match key {
        Key::LowLimit | Key::HighLimit => None,
        // Without a node ID in the file, `$NODEID` is 0.
        _ if text.contains('$') => None,
        _ => value(text.trim(), data_type, 0),
    }),
    differences: Some(&DIFFERENCES),
};

static DIFFERENCES: Differences = Differences::new(["T0411", "T0412", "T0413", "T0414"], SOURCE);

static NOT_TEXT: Rule = Rule {
    code: "T0401",
    source: SOURCE,
    title: "a file that is not UTF-8",
    also: &[],
    ..ENCODING
};

static ACCESS: Rule = Rule {
    code: "T0402",
    title: "an access type that CiA 306 does not know",
    source: SOURCE,
    says: "{tool} rejects the file: it does not know the access type `{value}`",
    help: "write `ro`, `wo`, `rw`, `rwr`, `rww` or `const`",
    example: "AccessType=r0",
    ..REJECTS
};

static VALUE: Rule = Rule {
    code: "T0403",
    title: "a type or a value that the tool cannot read",
    source: SOURCE,
    says: "{tool} rejects the file: it cannot read `{key}={value}`",
    help: "write a number such as `0x10`",
    also: &[Form {
        help: "write a number such as `1.5`",
        ..Form::OWN
    }],
    fixability: Fixability::None,
    example: "DefaultValue=0x10 ; sixteen",
    ..REJECTS
};

/// A sum of numbers and `$NODEID`.
fn sum(text: &str, node_id: i128) -> Option<i128> {
    let mut sum: i128 = 0;
    for term in text
        .split('+')
        .map(str::trim)
        .filter(|term| !term.is_empty())
    {
        let hex = term.strip_prefix("0x").or_else(|| term.strip_prefix("0X"));
        let number = match hex {
            _ if term.eq_ignore_ascii_case("$nodeid") => node_id,
            Some(digits) => i128::from_str_radix(digits, 16).ok()?,
            None => term.parse().ok()?,
        };
        sum = sum.saturating_add(number);
    }
    Some(sum)
}

/// Reads a value as the tool does.
fn value(text: &str, data_type: i128, node_id: i128) -> Option<Read> {
    let number = || sum(text, node_id);
    // It uses the low bits only.
    Some(match data_type {
        0x8 if text.is_empty() => Read::Real(0.0),
        0x8 => Read::Real(f64::from(text.parse::<f32>().ok()?)),
        0x11 if text.is_empty() => Read::Real(0.0),
        0x11 => Read::Real(text.parse().ok()?),
        0x9 => Read::Text(String::from_utf8_lossy(cut(text)).into_owned()),
        0xA | 0xF => Read::Bytes(cut(text).into()),
        0x1 => Read::Number(i128::from(number()? != 0)),
        0x2 => Read::Number((number()? as i8).into()),
        0x3 => Read::Number((number()? as i16).into()),
        0x4 => Read::Number((number()? as i32).into()),
        0x15 => Read::Number((number()? as i64).into()),
        0x5 => Read::Number((number()? as u8).into()),
        0x6 => Read::Number((number()? as u16).into()),
        0x7 => Read::Number((number()? as u32).into()),
        _ => Read::Number((number()? as u64).into()),
    })
}

/// The bytes that fit into its strings.
fn cut(text: &str) -> &[u8] {
    &text.as_bytes()[..text.len().min(32)]
}

type Fields<'a> = BTreeMap<String, (&'a str, Span)>;

fn sections<'a>(text: &'a str, has_mark: bool) -> BTreeMap<String, Fields<'a>> {
    let mut sections: BTreeMap<String, Fields<'a>> = BTreeMap::new();
    let mut current: Option<String> = None;
    for line in lines_by_newline(text) {
        let Line { text, number, .. } = line;
        let trimmed = text.trim();
        // After a byte order mark it does not know the first line.
        if trimmed.is_empty() || trimmed.starts_with(';') || has_mark && number == 1 {
            continue;
        }
        let header = trimmed
            .strip_prefix('[')
            .and_then(|name| name.strip_suffix(']'));
        if let Some(name) = header {
            let name = name.trim().to_ascii_lowercase();
            sections.entry(name.clone()).or_default();
            current = Some(name);
        } else if let Some(name) = &current
            && let Some((key, value)) = trimmed.split_once('=')
            && let Some(fields) = sections.get_mut(name)
        {
            let value = value.trim();
            fields.insert(key.trim().to_ascii_lowercase(), (value, line.span(value)));
        }
    }
    sections
}

/// Index and sub-index of a section's name.
fn address(name: &str) -> Option<(u32, u32)> {
    let (index, sub) = name.split_once("sub").unwrap_or((name, "0"));
    let index = u16::from_str_radix(index, 16).ok()?;
    Some((index.into(), u8::from_str_radix(sub, 16).ok()?.into()))
}

fn read(input: &Input<'_>) -> Reading {
    let mut reading = Reading::default();
    let Some(text) = input.text else {
        reading.push(NOT_TEXT.at(Span::default()));
        return reading;
    };
    let sections = sections(text, input.has_mark);
    let node = sections.get("devicecomissioning");
    let node = node.or_else(|| sections.get("devicecommissioning"));
    let node = node.and_then(|node| sum(node.get("nodeid")?.0, 0));
    let node = node.filter(|node| (0..=255).contains(node));
    let node_id = node.unwrap_or(0);
    reading.node_id = node;
    for (name, fields) in &sections {
        let Some(address) = address(name) else {
            continue;
        };
        let Some((data_type, at)) = fields.get("datatype") else {
            continue;
        };
        let Some(code) = sum(data_type, node_id) else {
            let finding = VALUE.at(*at).key(Key::DataType);
            reading.push(finding.fact("value", *data_type));
            continue;
        };
        if !matches!(code, 1..=0xA | 0xF | 0x11 | 0x15 | 0x1B) {
            continue;
        }
        let access = fields
            .get("accesstype")
            .map(|(word, at)| (word.to_ascii_lowercase(), at));
        if let Some((word, at)) = &access
            && !matches!(&**word, "ro" | "wo" | "rw" | "rwr" | "rww" | "const")
        {
            reading.push(ACCESS.at(**at).fact("value", &**word));
        }
        let parameter = fields.get("parametervalue");
        let (text, at) = parameter
            .or_else(|| fields.get("defaultvalue"))
            .copied()
            .unwrap_or_default();
        let read = value(text, code, node_id);
        let is_parameter = parameter.is_some_and(|(text, _)| !text.is_empty());
        if read.is_none() {
            let key = if is_parameter {
                Key::ParameterValue
            } else {
                Key::DefaultValue
            };
            let finding = VALUE.at(at).key(key).fact("value", text);
            let finding = if matches!(code, 8 | 0x11) {
                finding.form(&VALUE.also[0])
            } else {
                finding
            };
            reading.push(finding);
        }
        let mapping = fields.get("pdomapping");
        let mut entry = ReadEntry {
            name: Some(
                fields
                    .get("parametername")
                    .map_or("", |(name, _)| name)
                    .into(),
            ),
            data_type: Some(code),
            // It has no `rwr` and `rww`.
            access: access.map_or(Some("ro".into()), |(word, _)| {
                Some(word).filter(|word| !matches!(&**word, "rwr" | "rww"))
            }),
            mappable: Some(mapping.is_some_and(|(flag, _)| *flag != "0")),
            ..ReadEntry::default()
        };
        if is_parameter {
            entry.parameter = Some(read)
        } else {
            entry.default = Some(read)
        }
        reading.entries.insert(address, entry);
    }
    reading
}
