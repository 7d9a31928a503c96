//! Comparison of the values that a tool reads with those that odkit reads.

use alloc::format;
use alloc::string::{String, ToString};
use alloc::vec::Vec;

use od_model::{Address, DataType};

use crate::description::{Description, EntryDescription, Value};
use crate::fact::Key;
use crate::finding::{Finding, Rule};
use crate::fix::Fix;
use crate::read::values;
use crate::span::{Span, Spanned};
use crate::tools::shared::NODE_ID;
use crate::tools::tool::{
    DROPPED, DROPPED_WRITE, Differences, READS_WRITE, Read, ReadEntry, Reading, Tool,
};

/// A description as one tool reads it.
pub(crate) struct Compare<'a> {
    /// The text of the file.
    pub(crate) text: &'a str,
    /// The tools for which a fix must be right.
    pub(crate) tools: &'a [&'static Tool],
    pub(crate) rules: &'static Differences,
    /// The node ID of the tool.
    pub(crate) node_id: i128,
    pub(crate) found: Vec<Finding>,
}

impl Compare<'_> {
    pub(crate) fn all(&mut self, description: &Description, reading: &Reading) {
        if reading.entries.is_empty() && !description.objects.is_empty() {
            let first = description.objects.values().next();
            let span = first.map_or(Span::default(), |object| object.span);
            let drops = &self.rules.drops;
            self.found.push(drops.at(span).form(&drops.also[0]));
            return;
        }
        for (address, own) in description.entries() {
            let (index, sub) = (u32::from(address.index), u32::from(address.sub));
            match reading.entries.get(&(index, sub)) {
                Some(read) => self.entry(address, own, read, reading.on_demand.contains(&index)),
                None if reading.on_demand.contains(&index) => {}
                None => {
                    let finding = self.rules.drops.at(own.span).about(address);
                    self.found.push(finding);
                }
            }
        }
    }

    fn entry(&mut self, address: Address, own: &EntryDescription, read: &ReadEntry, is_made: bool) {
        let data_type = own.data_type.map(|it| it.value);
        if let Some(name) = read
            .name
            .as_ref()
            .filter(|name| **name != *own.name && !is_made)
        {
            self.field(
                address,
                Key::ParameterName,
                own.name.span,
                name,
                &own.name,
                None,
            );
        }
        if let (Some(read), Some(own)) = (read.data_type, &own.data_type)
            && read != i128::from(own.code())
        {
            let (found, text) = (name_of(read), format!("0x{:04X}", own.code()));
            self.field(
                address,
                Key::DataType,
                own.span,
                &found,
                own.name(),
                Some(text),
            );
        }
        if let Some(word) = read.access.as_deref()
            && word != own.access.name()
            && !(is_made && address.sub == 0)
        {
            let (name, span) = (own.access.name(), own.access.span);
            self.field(
                address,
                Key::AccessType,
                span,
                word,
                name,
                Some(name.into()),
            );
        }
        if let Some(flag) = read.mappable.filter(|flag| *flag != *own.mappable) {
            let digit = |flag: bool| if flag { "1" } else { "0" };
            let (is, text) = (digit(*own.mappable), digit(*own.mappable).to_string());
            let span = own.mappable.span;
            self.field(address, Key::PdoMapping, span, digit(flag), is, Some(text));
        }
        if is_made && address.sub == 0 {
            return;
        }
        let values = &self.rules.value;
        let limits = &self.rules.limit;
        for (rule, key, read, own) in [
            (values, Key::DefaultValue, &read.default, &own.default),
            (values, Key::ParameterValue, &read.parameter, &own.parameter),
            (limits, Key::LowLimit, &read.low, &own.low),
            (limits, Key::HighLimit, &read.high, &own.high),
        ] {
            if let (Some(read), Some(own)) = (read, own) {
                self.value(rule, address, key, own, data_type, read.as_ref());
            }
        }
    }

    fn value(
        &mut self,
        rule: &'static Rule,
        address: Address,
        key: Key,
        own: &Spanned<Value>,
        data_type: Option<DataType>,
        read: Option<&Read>,
    ) {
        if read.is_some_and(|read| same(own, data_type, read, self.node_id)) {
            return;
        }
        let code = data_type.map_or(0, |it| i128::from(it.code()));
        let suits = |text: &String| {
            let known = self.tools.iter().filter_map(|tool| tool.value);
            let mut read = known.map(|value| value(key, text, code));
            read.all(|read| read.is_some_and(|read| same(own, data_type, &read, NODE_ID)))
        };
        let text = candidates(own, data_type).into_iter().find(suits);
        let finding = rule.at(own.span).about(address).key(key);
        let finding = match read {
            Some(read) => finding.fact("read", shown(read)),
            None => finding.form(&DROPPED),
        };
        let own_text = format!("`{}`", values::text(own, data_type));
        self.fixed(
            finding.fact("own", own_text),
            key,
            own.span,
            text,
            read.is_none(),
        );
    }

    fn field(
        &mut self,
        address: Address,
        key: Key,
        span: Span,
        read: &str,
        own: &str,
        text: Option<String>,
    ) {
        let finding = self.rules.field.at(span).about(address).key(key);
        let finding = finding.fact("read", format!("`{read}`"));
        self.fixed(
            finding.fact("own", format!("`{own}`")),
            key,
            span,
            text,
            false,
        );
    }

    /// Adds the fix that writes `text`, with the key in the spelling of the standard.
    fn fixed(&mut self, finding: Finding, key: Key, span: Span, text: Option<String>, drops: bool) {
        let edit = text.and_then(|text| {
            let written = self.text.get(span.start as usize..span.end as usize)?;
            let (at, name) = key_before(self.text, span)?;
            let fix = if name.eq_ignore_ascii_case(key.name()) && name != key.name() {
                Fix::safe().replace(at, key.name())
            } else {
                Fix::safe()
            };
            let fix = if written == text {
                fix
            } else {
                fix.replace(span, text.clone())
            };
            let changes = !fix.edits.is_empty() && span.line != 0;
            changes.then(|| (fix, format!("{}={text}", key.name())))
        });
        let finding = match edit {
            Some((fix, text)) => {
                let form = if drops { &DROPPED_WRITE } else { &READS_WRITE };
                finding.form(form).fact("text", text).fix(fix)
            }
            None => finding,
        };
        self.found.push(finding);
    }
}

/// The key of a value, and its place.
fn key_before(text: &str, value: Span) -> Option<(Span, &str)> {
    let before = text.get(..value.start as usize)?;
    let start = before.rfind(['\n', '\r']).map_or(0, |at| at + 1);
    let line = &before[start..];
    let key = line.split(['=', ':']).next().unwrap_or(line).trim();
    let start = start + (line.len() - line.trim_start().len());
    let span = Span {
        start: start as u32,
        end: (start + key.len()) as u32,
        line: value.line,
        column: 1,
    };
    Some((span, key))
}

/// Returns whether the values are the same.
fn same(own: &Value, data_type: Option<DataType>, read: &Read, node_id: i128) -> bool {
    match (own, read) {
        (Value::Real(own), Read::Real(read)) => {
            own == read
                || (own - read).abs() <= 1e-6 * own.abs().max(read.abs())
                || own.is_nan() && read.is_nan()
        }
        (Value::Real(own), Read::Number(read)) => *own == *read as f64,
        (Value::Bytes(own), Read::Bytes(read)) => own == read,
        (own, Read::Text(read)) => values::text(own, data_type) == *read,
        (own, Read::Number(read)) => own.integer(node_id as u8) == Some(*read),
        _ => false,
    }
}

/// Texts for the value, the usual one first.
fn candidates(own: &Value, data_type: Option<DataType>) -> Vec<String> {
    let usual = values::text(own, data_type);
    match own {
        Value::Text(_) => Vec::new(),
        Value::Real(real) => {
            let bits = match data_type {
                Some(DataType::Real32) => format!("0x{:08X}", (*real as f32).to_bits()),
                _ => format!("0x{:016X}", real.to_bits()),
            };
            alloc::vec![usual, bits]
        }
        own => match own.integer(0).filter(|_| !matches!(own, Value::NodeId(_))) {
            Some(number @ 0..) => alloc::vec![usual, number.to_string(), format!("0x{number:X}")],
            Some(number) => alloc::vec![usual, number.to_string()],
            None => alloc::vec![usual],
        },
    }
}

fn shown(read: &Read) -> String {
    match read {
        Read::Number(number) => format!("`{number}`"),
        Read::Real(real) => format!("`{real:?}`"),
        Read::Text(text) => format!("`{text}`"),
        Read::Bytes(bytes) => {
            let digits: String = bytes.iter().map(|byte| format!("{byte:02X}")).collect();
            format!("`{digits}`")
        }
    }
}

fn name_of(data_type: i128) -> String {
    let known = u16::try_from(data_type).ok().and_then(DataType::from_code);
    known.map_or_else(
        || format!("{data_type:#X}"),
        |known| known.name().to_string(),
    )
}
