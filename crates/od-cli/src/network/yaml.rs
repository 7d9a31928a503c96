//! A YAML text as a tree, with the scalars of YAML 1.1, as PyYAML and therefore dcfgen read them.

use std::collections::BTreeMap;

use saphyr_parser::{Event, Parser, ScalarStyle};

/// Maximum number of values of a text, including those that aliases repeat.
const LIMIT: usize = 100_000;

/// A value.
#[derive(Clone, PartialEq, Debug)]
pub(super) enum Yaml {
    Null,
    Bool(bool),
    Integer(i128),
    Real(f64),
    Text(String),
    List(Vec<Yaml>),
    /// Keys and values in the order of the text.
    Map(Vec<(Yaml, Yaml)>),
}

impl Yaml {
    /// Reads the first document of a text.
    ///
    /// # Errors
    /// The text is not YAML, or too large; in words, with its line.
    pub(super) fn read(text: &str) -> Result<Self, String> {
        let mut tree = Tree::default();
        for event in Parser::new_from_str(text) {
            let (event, span) = event.map_err(|error| error.to_string())?;
            match tree.take(event) {
                Ok(Some(whole)) => return Ok(whole),
                Ok(None) => {}
                Err(why) => return Err(format!("line {}: {why}", span.start.line())),
            }
        }
        Ok(Self::Null)
    }

    /// The value of a key; `None` if it is missing.
    pub(super) fn get(&self, key: &str) -> Option<&Self> {
        self.entries()
            .iter()
            .find(|(own, _)| own.text() == key)
            .map(|(_, value)| value)
    }

    /// Keys and values; empty if this is not a mapping.
    pub(super) fn entries(&self) -> &[(Self, Self)] {
        match self {
            Self::Map(entries) => entries,
            _ => &[],
        }
    }

    /// Converted as by Python's `str`.
    pub(super) fn text(&self) -> String {
        match self {
            Self::Null => "None".into(),
            Self::Bool(true) => "True".into(),
            Self::Bool(false) => "False".into(),
            Self::Integer(number) => number.to_string(),
            Self::Real(number) => format!("{number:?}"),
            Self::Text(text) => text.clone(),
            Self::List(_) | Self::Map(_) => String::new(),
        }
    }

    /// Converted as by Python's `int`: a real without its fraction, a text of decimal digits.
    pub(super) fn integer(&self) -> Option<i128> {
        match self {
            Self::Bool(flag) => Some((*flag).into()),
            Self::Integer(number) => Some(*number),
            Self::Real(number) if number.is_finite() => Some(*number as i128),
            Self::Text(text) => text.trim().parse().ok(),
            _ => None,
        }
    }

    /// Converted as by Python's `float`.
    pub(super) fn real(&self) -> Option<f64> {
        match self {
            Self::Real(number) => Some(*number),
            Self::Text(text) => text.trim().parse().ok(),
            other => other.integer().map(|number| number as f64),
        }
    }

    /// Converted as by Python's `bool`: a text that is not empty is true.
    pub(super) fn is_true(&self) -> bool {
        match self {
            Self::Null => false,
            Self::Bool(flag) => *flag,
            Self::Integer(number) => *number != 0,
            Self::Real(number) => *number != 0.0,
            Self::Text(text) => !text.is_empty(),
            Self::List(list) => !list.is_empty(),
            Self::Map(entries) => !entries.is_empty(),
        }
    }

    fn size(&self) -> usize {
        1 + match self {
            Self::List(list) => list.iter().map(Self::size).sum(),
            Self::Map(entries) => entries
                .iter()
                .map(|(key, value)| key.size() + value.size())
                .sum(),
            _ => 0,
        }
    }
}

/// A list or mapping that is not complete yet.
struct Open {
    is_map: bool,
    anchor: usize,
    values: Vec<Yaml>,
}

#[derive(Default)]
struct Tree {
    open: Vec<Open>,
    anchors: BTreeMap<usize, Yaml>,
    size: usize,
}

impl Tree {
    /// Handles the next event; returns the whole value when it is complete.
    fn take(&mut self, event: Event<'_>) -> Result<Option<Yaml>, String> {
        let (anchor, value) = match event {
            Event::Scalar(text, style, anchor, tag) => {
                let is_plain = style == ScalarStyle::Plain && tag.is_none();
                let value = if is_plain {
                    scalar(&text)
                } else {
                    Yaml::Text(text.into_owned())
                };
                (anchor, value)
            }
            Event::Alias(anchor) => {
                let value = self.anchors.get(&anchor).cloned();
                (0, value.ok_or("an alias without its anchor")?)
            }
            Event::SequenceStart(anchor, _) | Event::MappingStart(anchor, _) => {
                let is_map = matches!(event, Event::MappingStart(..));
                let values = Vec::new();
                self.open.push(Open {
                    is_map,
                    anchor,
                    values,
                });
                return Ok(None);
            }
            Event::SequenceEnd | Event::MappingEnd => match self.open.pop() {
                Some(open) if open.is_map => (open.anchor, map(open.values)?),
                Some(open) => (open.anchor, Yaml::List(open.values)),
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
}

/// A mapping from alternating keys and values: the last of equal keys is used, and `<<` adds missing
/// entries of other mappings.
fn map(values: Vec<Yaml>) -> Result<Yaml, String> {
    let mut entries = Entries::default();
    let mut merged = Vec::new();
    let mut values = values.into_iter();
    while let (Some(key), Some(value)) = (values.next(), values.next()) {
        if key == Yaml::Text("<<".into()) {
            match value {
                Yaml::Map(others) => merged.extend(others),
                Yaml::List(lists) => {
                    merged.extend(lists.into_iter().flat_map(|list| list.entries().to_vec()));
                }
                _ => return Err("`<<` needs a mapping".into()),
            }
        } else {
            *entries.value(key) = value;
        }
    }
    // Merged entries come first, as in PyYAML.
    let own = std::mem::take(&mut entries);
    for (key, value) in merged {
        if !entries.has(&key) {
            *entries.value(key) = value;
        }
    }
    for (key, value) in own.all {
        *entries.value(key) = value;
    }
    Ok(Yaml::Map(entries.all))
}

/// The entries of a mapping, with the place of each key, so that a long mapping takes no longer for an entry.
#[derive(Default)]
struct Entries {
    all: Vec<(Yaml, Yaml)>,
    places: BTreeMap<String, usize>,
}

impl Entries {
    /// The text of a key by which it is found: equal keys have equal texts.
    fn name(key: &Yaml) -> String {
        format!("{key:?}")
    }

    fn has(&self, key: &Yaml) -> bool {
        self.places.contains_key(&Self::name(key))
    }

    /// The value of a key, which is added if it is new.
    fn value(&mut self, key: Yaml) -> &mut Yaml {
        let place = *self
            .places
            .entry(Self::name(&key))
            .or_insert(self.all.len());
        if place == self.all.len() {
            self.all.push((key, Yaml::Null));
        }
        &mut self.all[place].1
    }
}

/// A plain scalar by the rules of YAML 1.1.
fn scalar(text: &str) -> Yaml {
    match text {
        "" | "~" | "null" | "Null" | "NULL" => return Yaml::Null,
        "yes" | "Yes" | "YES" | "true" | "True" | "TRUE" | "on" | "On" | "ON" => {
            return Yaml::Bool(true);
        }
        "no" | "No" | "NO" | "false" | "False" | "FALSE" | "off" | "Off" | "OFF" => {
            return Yaml::Bool(false);
        }
        _ => {}
    }
    let number = number(text)
        .map(Yaml::Integer)
        .or_else(|| real(text).map(Yaml::Real));
    number.unwrap_or_else(|| Yaml::Text(text.into()))
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
            ("0x1F", Yaml::Integer(31)),
            ("-0x1F", Yaml::Integer(-31)),
            ("010", Yaml::Integer(8)),
            ("1_000", Yaml::Integer(1000)),
            ("1:30", Yaml::Integer(90)),
            ("0b11", Yaml::Integer(3)),
            ("089", Yaml::Text("089".into())),
            ("1.5", Yaml::Real(1.5)),
            ("1e3", Yaml::Text("1e3".into())),
            ("1.0e+3", Yaml::Real(1000.0)),
            ("yes", Yaml::Bool(true)),
            ("~", Yaml::Null),
            ("auto", Yaml::Text("auto".into())),
        ] {
            assert_eq!(scalar(text), expected, "{text}");
        }
    }

    #[test]
    fn aliases_and_merges_are_resolved() {
        let text = ".base: &base {a: 1, b: [1, 2]}\nx:\n  <<: *base\n  a: 3\n  a: 4\n";
        let whole = Yaml::read(text).expect("YAML");
        let x = whole.get("x").expect("x");
        assert_eq!(x.get("a"), Some(&Yaml::Integer(4)));
        assert_eq!(x.get("b").map(Yaml::size), Some(3));
        let mut bomb = String::from("a0: &a0 [1,1,1,1,1,1,1,1,1,1]\n");
        for level in 1..10 {
            let last = level - 1;
            let ten = vec![format!("*a{last}"); 10].join(",");
            bomb += &format!("a{level}: &a{level} [{ten}]\n");
        }
        assert!(Yaml::read(&bomb).is_err_and(|why| why.contains("100000")));
        assert!(Yaml::read("a: [1").is_err());
    }
}
