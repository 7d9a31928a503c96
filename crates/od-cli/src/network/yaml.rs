//! A YAML text as a tree, with the scalars of YAML 1.1, as PyYAML and therefore dcfgen read them.

use std::collections::BTreeMap;

use od_eds::Span;
use saphyr_parser::{Event, Marker, Parser, ScalarStyle};

/// Maximum number of values of a text, including those that aliases repeat.
const LIMIT: usize = 100_000;

/// A value, and the place where it begins. That of an alias is the place of its anchor.
#[derive(Clone, Debug)]
pub(super) struct Yaml {
    value: Value,
    pub(super) span: Span,
}

#[derive(Clone, PartialEq, Debug)]
enum Value {
    Null,
    Bool(bool),
    Integer(i128),
    Real(f64),
    Text(String),
    List(Vec<Yaml>),
    /// Keys and values in the order of the text.
    Map(Vec<(Yaml, Yaml)>),
}

impl PartialEq for Yaml {
    fn eq(&self, other: &Self) -> bool {
        self.value == other.value
    }
}

impl Yaml {
    /// A mapping of these entries, in the place of this value.
    pub(super) fn with(&self, entries: Vec<(Self, Self)>) -> Self {
        Self {
            value: Value::Map(entries),
            span: self.span,
        }
    }

    /// Reads the first document of a text, and its keys that are given twice.
    ///
    /// # Errors
    /// A sentence and a place, if the text is not YAML or is too large.
    pub(super) fn read(text: &str) -> Result<(Self, Vec<Twice>), (String, Span)> {
        let mut tree = Tree::new(text);
        let mut places = Places::new(text);
        for event in Parser::new_from_str(text) {
            let (event, range) = event.map_err(|error| {
                let at = places.span(error.marker());
                (error.info().to_owned(), at)
            })?;
            let from = places.span(&range.start);
            let span = Span {
                // The parser puts the end of a block at the beginning of the next value, and that of a quoted text there, too.
                end: match event {
                    Event::Scalar(..) => {
                        let end = places.byte(range.end.index());
                        let scalar = &text[from.start as usize..end as usize];
                        from.start + quoted(scalar).map_or(scalar.len(), str::len) as u32
                    }
                    _ => from.end,
                },
                ..from
            };
            match tree.take(event, span) {
                Ok(Some(whole)) => return Ok((whole, tree.twice)),
                Ok(None) => {}
                Err(why) => return Err((why, span)),
            }
        }
        let nothing = Self {
            value: Value::Null,
            span: Span::default(),
        };
        Ok((nothing, Vec::new()))
    }

    /// The value of a key; `None` if it is missing.
    pub(super) fn get(&self, key: &str) -> Option<&Self> {
        self.entries()
            .iter()
            .find(|(own, _)| own.text() == key)
            .map(|(_, value)| value)
    }

    /// The values of a list; empty if this is not one.
    pub(super) fn list(&self) -> &[Self] {
        match &self.value {
            Value::List(list) => list,
            _ => &[],
        }
    }

    /// Keys and values; empty if this is not a mapping.
    pub(super) fn entries(&self) -> &[(Self, Self)] {
        match &self.value {
            Value::Map(entries) => entries,
            _ => &[],
        }
    }

    /// Converted as by Python's `str`.
    pub(super) fn text(&self) -> String {
        match &self.value {
            Value::Null => "None".into(),
            Value::Bool(true) => "True".into(),
            Value::Bool(false) => "False".into(),
            Value::Integer(number) => number.to_string(),
            Value::Real(number) => format!("{number:?}"),
            Value::Text(text) => text.clone(),
            Value::List(_) | Value::Map(_) => String::new(),
        }
    }

    /// Converted as by Python's `int`: a real without its fraction, a text of decimal digits.
    pub(super) fn integer(&self) -> Option<i128> {
        match &self.value {
            Value::Bool(flag) => Some((*flag).into()),
            Value::Integer(number) => Some(*number),
            Value::Real(number) if number.is_finite() => Some(*number as i128),
            Value::Text(text) => text.trim().parse().ok(),
            _ => None,
        }
    }

    /// Converted as by Python's `float`.
    pub(super) fn real(&self) -> Option<f64> {
        match &self.value {
            Value::Real(number) => Some(*number),
            Value::Text(text) => text.trim().parse().ok(),
            _ => self.integer().map(|number| number as f64),
        }
    }

    /// Returns whether the value is a text that is not empty.
    pub(super) fn is_words(&self) -> bool {
        matches!(&self.value, Value::Text(text) if !text.is_empty())
    }

    /// Converted as by Python's `bool`: a text that is not empty is true.
    pub(super) fn is_true(&self) -> bool {
        match &self.value {
            Value::Null => false,
            Value::Bool(flag) => *flag,
            Value::Integer(number) => *number != 0,
            Value::Real(number) => *number != 0.0,
            Value::Text(text) => !text.is_empty(),
            Value::List(list) => !list.is_empty(),
            Value::Map(entries) => !entries.is_empty(),
        }
    }

    fn size(&self) -> usize {
        1 + match &self.value {
            Value::List(list) => list.iter().map(Self::size).sum(),
            Value::Map(entries) => entries
                .iter()
                .map(|(key, value)| key.size() + value.size())
                .sum(),
            _ => 0,
        }
    }
}

/// The quotation at the beginning of a line, with its quotes; `None` if the line does not begin with one, or it has no end.
fn quoted(text: &str) -> Option<&str> {
    let quote = text
        .chars()
        .next()
        .filter(|quote| matches!(quote, '"' | '\''))?;
    let mut rest = text.char_indices().skip(1).peekable();
    while let Some((at, char)) = rest.next() {
        match (quote, char) {
            ('"', '\\') => drop(rest.next()),
            ('\'', '\'') if rest.peek().is_some_and(|(_, next)| *next == '\'') => drop(rest.next()),
            (quote, char) if quote == char => return text.get(..=at),
            _ => {}
        }
    }
    None
}

/// Converts places in characters into places in bytes. The places must come in the order of the text.
struct Places<'a> {
    text: &'a str,
    chars: usize,
    bytes: usize,
}

impl<'a> Places<'a> {
    const fn new(text: &'a str) -> Self {
        let (chars, bytes) = (0, 0);
        Self { text, chars, bytes }
    }

    /// The byte at which this character begins.
    fn byte(&mut self, char: usize) -> u32 {
        let rest = self.text[self.bytes..].chars();
        let passed = rest.take(char.saturating_sub(self.chars));
        self.bytes += passed.map(char::len_utf8).sum::<usize>();
        self.chars = self.chars.max(char);
        self.bytes as u32
    }

    /// The place at a mark of the parser, without a length.
    fn span(&mut self, at: &Marker) -> Span {
        let byte = self.byte(at.index());
        Span {
            start: byte,
            end: byte,
            line: at.line() as u32,
            column: at.col() as u32 + 1,
        }
    }
}

/// A list or mapping that is not complete yet.
struct Open {
    span: Span,
    is_map: bool,
    anchor: usize,
    values: Vec<Yaml>,
}

/// A key that its mapping has before.
pub(super) struct Twice {
    pub(super) key: Yaml,
    /// The place of the key that it has before, whose value is not used.
    pub(super) first: Span,
    /// Whether that key and its value are the only content of a line.
    pub(super) is_line: bool,
    /// Whether both have the same value.
    pub(super) is_same: bool,
}

struct Tree<'t> {
    text: &'t str,
    open: Vec<Open>,
    anchors: BTreeMap<usize, Yaml>,
    size: usize,
    twice: Vec<Twice>,
}

impl<'t> Tree<'t> {
    const fn new(text: &'t str) -> Self {
        Self {
            text,
            open: Vec::new(),
            anchors: BTreeMap::new(),
            size: 0,
            twice: Vec::new(),
        }
    }

    /// Handles the next event; returns the whole value when it is complete.
    fn take(&mut self, event: Event<'_>, span: Span) -> Result<Option<Yaml>, String> {
        let (anchor, value) = match event {
            Event::Scalar(text, style, anchor, tag) => {
                let is_plain = style == ScalarStyle::Plain && tag.is_none();
                let value = if is_plain {
                    scalar(&text)
                } else {
                    Value::Text(text.into_owned())
                };
                (anchor, Yaml { value, span })
            }
            Event::Alias(anchor) => {
                let value = self.anchors.get(&anchor).cloned();
                (0, value.ok_or("an alias without its anchor")?)
            }
            Event::SequenceStart(anchor, _) | Event::MappingStart(anchor, _) => {
                let is_map = matches!(event, Event::MappingStart(..));
                let values = Vec::new();
                self.open.push(Open {
                    span,
                    is_map,
                    anchor,
                    values,
                });
                return Ok(None);
            }
            Event::SequenceEnd | Event::MappingEnd => match self.open.pop() {
                Some(open) => {
                    let value = if open.is_map {
                        self.map(open.values)?
                    } else {
                        Value::List(open.values)
                    };
                    let span = open.span;
                    (open.anchor, Yaml { value, span })
                }
                None => return Ok(None),
            },
            _ => return Ok(None),
        };
        self.size += value.size();
        if self.size > LIMIT {
            return Err(format!("more than {LIMIT} values"));
        }
        if anchor > 0 {
            self.anchors.insert(anchor, value.clone());
        }
        match self.open.last_mut() {
            Some(open) => {
                open.values.push(value);
                Ok(None)
            }
            None => Ok(Some(value)),
        }
    }

    /// A mapping from alternating keys and values: the last of equal keys is used, and `<<` adds missing
    /// entries of other mappings.
    fn map(&mut self, values: Vec<Yaml>) -> Result<Value, String> {
        let mut entries = Entries::default();
        let mut merged = Vec::new();
        let mut values = values.into_iter();
        while let (Some(key), Some(value)) = (values.next(), values.next()) {
            if key.value == Value::Text("<<".into()) {
                match value.value {
                    Value::Map(others) => merged.extend(others),
                    Value::List(lists) => {
                        merged.extend(lists.into_iter().flat_map(|list| list.entries().to_vec()));
                    }
                    _ => return Err("`<<` needs a mapping".into()),
                }
            } else {
                if let Some((first, before)) = entries.get(&key) {
                    self.twice.push(Twice {
                        key: key.clone(),
                        first: first.span,
                        is_line: is_line(self.text, first, before),
                        is_same: *before == value,
                    });
                }
                entries.set(key, value);
            }
        }
        // Merged entries come first, as in PyYAML.
        let own = std::mem::take(&mut entries);
        for (key, value) in merged {
            if !entries.has(&key) {
                entries.set(key, value);
            }
        }
        for (key, value) in own.all {
            entries.set(key, value);
        }
        Ok(Value::Map(entries.all))
    }
}

/// Returns whether an entry with a scalar is the only content of its line.
fn is_line(text: &str, key: &Yaml, value: &Yaml) -> bool {
    let (from, to) = (key.span.end as usize, value.span.start as usize);
    let is_scalar = !matches!(value.value, Value::List(_) | Value::Map(_));
    let parts = || {
        let before = text[..key.span.start as usize].rsplit('\n').next()?;
        let after = text[value.span.end as usize..].split('\n').next()?;
        Some((before, text.get(from..to)?, after))
    };
    is_scalar
        && key.span.line == value.span.line
        && parts().is_some_and(|(before, between, after)| {
            let rest = after.trim_start();
            before.trim().is_empty()
                && between.trim() == ":"
                && (rest.is_empty() || rest.starts_with('#'))
        })
}

/// The entries of a mapping, and the place of each key: an entry is found in the same time in a long mapping.
#[derive(Default)]
struct Entries {
    all: Vec<(Yaml, Yaml)>,
    places: BTreeMap<String, usize>,
}

impl Entries {
    /// The text of a key by which it is found: equal keys have equal texts.
    fn name(key: &Yaml) -> String {
        format!("{:?}", key.value)
    }

    fn has(&self, key: &Yaml) -> bool {
        self.places.contains_key(&Self::name(key))
    }

    /// The entry of an equal key.
    fn get(&self, key: &Yaml) -> Option<&(Yaml, Yaml)> {
        self.all.get(*self.places.get(&Self::name(key))?)
    }

    /// Sets the entry of a key, which is added if it is new.
    fn set(&mut self, key: Yaml, value: Yaml) {
        let place = *self
            .places
            .entry(Self::name(&key))
            .or_insert(self.all.len());
        match self.all.get_mut(place) {
            Some(own) => *own = (key, value),
            None => self.all.push((key, value)),
        }
    }
}

/// A plain scalar by the rules of YAML 1.1.
fn scalar(text: &str) -> Value {
    match text {
        "" | "~" | "null" | "Null" | "NULL" => return Value::Null,
        "yes" | "Yes" | "YES" | "true" | "True" | "TRUE" | "on" | "On" | "ON" => {
            return Value::Bool(true);
        }
        "no" | "No" | "NO" | "false" | "False" | "FALSE" | "off" | "Off" | "OFF" => {
            return Value::Bool(false);
        }
        _ => {}
    }
    let number = number(text)
        .map(Value::Integer)
        .or_else(|| real(text).map(Value::Real));
    number.unwrap_or_else(|| Value::Text(text.into()))
}

fn number(text: &str) -> Option<i128> {
    let (sign, digits) = match text.as_bytes().first()? {
        b'-' => (-1, &text[1..]),
        b'+' => (1, &text[1..]),
        _ => (1, text),
    };
    if !digits.starts_with(|first: char| first.is_ascii_digit()) {
        return None;
    }
    let plain = digits.replace('_', "");
    let (radix, rest) = match plain.as_bytes() {
        [b'0', b'x', ..] => (16, &plain[2..]),
        [b'0', b'b', ..] => (2, &plain[2..]),
        [b'0', _, ..] => (8, &plain[1..]),
        _ => (10, plain.as_str()),
    };
    if radix == 10 && rest.contains(':') {
        // Hours, minutes, seconds.
        let parts = rest.split(':').map(|part| part.parse::<i128>().ok());
        let sum = parts.reduce(|sum, part| {
            sum?.checked_mul(60)?
                .checked_add(part.filter(|part| *part < 60)?)
        });
        return sum.flatten().map(|number| sign * number);
    }
    let is_number = rest.starts_with(|first: char| first.is_ascii_alphanumeric());
    let number = i128::from_str_radix(rest, radix).ok().filter(|_| is_number);
    number.map(|number| sign * number)
}

fn real(text: &str) -> Option<f64> {
    let lower = text.to_ascii_lowercase();
    match lower.trim_start_matches(['+', '-']) {
        ".inf" if lower.starts_with('-') => return Some(f64::NEG_INFINITY),
        ".inf" => return Some(f64::INFINITY),
        ".nan" => return Some(f64::NAN),
        // A real has a point, and its exponent has a sign.
        digits
            if !digits.contains('.')
                || !digits.starts_with(|c: char| c.is_ascii_digit() || c == '.') =>
        {
            return None;
        }
        _ => {}
    }
    let has_sign = lower
        .split_once('e')
        .is_none_or(|(_, exponent)| exponent.starts_with(['+', '-']));
    lower.replace('_', "").parse().ok().filter(|_| has_sign)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scalars_are_those_of_yaml_1_1() {
        for (text, expected) in [
            ("0x1F", Value::Integer(31)),
            ("-0x1F", Value::Integer(-31)),
            ("010", Value::Integer(8)),
            ("1_000", Value::Integer(1000)),
            ("1:30", Value::Integer(90)),
            ("0b11", Value::Integer(3)),
            ("089", Value::Text("089".into())),
            ("1.5", Value::Real(1.5)),
            ("1e3", Value::Text("1e3".into())),
            ("1.0e+3", Value::Real(1000.0)),
            ("yes", Value::Bool(true)),
            ("~", Value::Null),
            ("auto", Value::Text("auto".into())),
        ] {
            assert_eq!(scalar(text), expected, "{text}");
        }
    }

    #[test]
    fn aliases_and_merges_are_resolved() {
        let text = ".base: &base {a: 1, b: [1, 2]}\nx:\n  <<: *base\n  a: 3\n  a: 4\n";
        let (whole, _) = Yaml::read(text).expect("YAML");
        let x = whole.get("x").expect("x");
        assert_eq!(x.get("a").and_then(Yaml::integer), Some(4));
        assert_eq!(x.get("b").map(Yaml::size), Some(3));
        let mut bomb = String::from("a0: &a0 [1,1,1,1,1,1,1,1,1,1]\n");
        for level in 1..10 {
            let last = level - 1;
            let ten = vec![format!("*a{last}"); 10].join(",");
            bomb += &format!("a{level}: &a{level} [{ten}]\n");
        }
        assert!(Yaml::read(&bomb).is_err_and(|(why, _)| why.contains("100000")));
        assert!(Yaml::read("a: [1").is_err());
    }

    #[test]
    fn a_quoted_text_ends_with_its_quote() {
        for (text, expected) in [
            ("'it''s' # 'x'", Some("'it''s'")),
            ("\"a\\\"b\" # \"", Some("\"a\\\"b\"")),
            ("''", Some("''")),
            ("'open", None),
            ("plain", None),
        ] {
            assert_eq!(quoted(text), expected, "{text}");
        }
    }

    #[test]
    fn values_know_their_places() {
        let text = "# é\na: &x {b: ü, c: 5}\nd:\n  - *x\n  - 7\n";
        let (whole, _) = Yaml::read(text).expect("YAML");
        let place = |yaml: &Yaml| (yaml.span.line, yaml.span.column);
        let c = whole.get("a").and_then(|a| a.get("c")).expect("c");
        assert_eq!(place(c), (2, 17));
        assert_eq!(&text[c.span.start as usize..c.span.end as usize], "5");
        let list = whole.get("d").map_or(&[][..], Yaml::list);
        let lines: Vec<u32> = list.iter().map(|yaml| yaml.span.line).collect();
        assert_eq!(lines, [2, 5], "an alias is where its anchor is");
    }
}
