//! Places in a project of dcfgen, found line by line: a text that is half typed is not YAML.

use std::ops::Range;

use od_eds::network::keys::{Keys, OF_MASTER, OF_OPTIONS, OF_PDO, OF_SLAVE};

/// A key and its value in a line.
pub(crate) struct Pair {
    pub(crate) key: Range<usize>,
    pub(crate) value: Range<usize>,
}

/// The line of a byte: its range, without a comment and the line end.
fn line(text: &str, offset: usize) -> Range<usize> {
    let start = text[..offset].rfind('\n').map_or(0, |at| at + 1);
    let rest = &text[start..];
    let end = rest.find(['\n', '\r', '#']).unwrap_or(rest.len());
    start..start + end
}

const fn is_of_word(c: char) -> bool {
    c.is_ascii_alphanumeric() || matches!(c, '_' | '-' | '.')
}

/// The keys of the line of a byte, each with the text up to the next key, comma or brace.
fn pairs(text: &str, offset: usize) -> Vec<Pair> {
    let line = line(text, offset);
    let part = &text[line.clone()];
    let mut found = Vec::new();
    for (colon, _) in part.match_indices(':') {
        let behind = &part[colon + 1..];
        let before = &part[..colon];
        let name = before.trim_end_matches(is_of_word).len()..colon;
        if name.is_empty() || !(behind.is_empty() || behind.starts_with(' ')) {
            continue;
        }
        let blanks = behind.len() - behind.trim_start().len();
        let rest = &behind[blanks..];
        let length = rest.find([',', '}', ']']).unwrap_or(rest.len());
        let start = line.start + colon + 1 + blanks;
        let value = rest[..length].trim_end();
        found.push(Pair {
            key: line.start + name.start..line.start + name.end,
            value: start..start + value.len(),
        });
    }
    found
}

/// The key or the value at a byte; of a value, the last key before it.
pub(crate) fn at(text: &str, offset: usize) -> Option<Pair> {
    let mut pairs = pairs(text, offset).into_iter().rev();
    pairs.find(|pair| pair.key.start <= offset && offset <= pair.value.end.max(pair.key.end))
}

/// The keys at the beginning of a line, with their indents, above a byte, the nearest first.
fn above(text: &str, offset: usize) -> impl Iterator<Item = (usize, &str)> {
    let lines = text[..offset].lines().rev();
    lines.filter_map(|line| {
        let own = line.trim_start_matches([' ', '\u{FEFF}']);
        let (key, _) = own.split_once(':')?;
        let is_key = !key.is_empty() && key.chars().all(is_of_word);
        is_key.then(|| (line.len() - own.len(), key))
    })
}

/// The keys that a mapping at a byte may have, below keys with a smaller indent.
pub(crate) fn keys(text: &str, offset: usize) -> Keys {
    let start = line(text, offset).start;
    let own = &text[start..offset];
    let mut indent = own.len() - own.trim_start_matches(' ').len();
    let mut keys = OF_SLAVE;
    for (other, key) in above(text, start) {
        if other >= indent {
            continue;
        }
        indent = other;
        keys = match key {
            "master" if other == 0 => return OF_MASTER,
            "options" if other == 0 => return OF_OPTIONS,
            "tpdo" | "rpdo" => return OF_PDO,
            _ => keys,
        };
    }
    if indent == 0 && own.trim_start_matches(' ').len() == own.len() {
        &[]
    } else {
        keys
    }
}

/// The meaning of a key at a byte.
pub(crate) fn meaning(text: &str, key: &Range<usize>) -> Option<&'static str> {
    let name = text.get(key.clone())?;
    let start = line(text, key.start).start;
    let mut lines = above(text, line(text, key.start).end);
    let section = lines.find(|(indent, _)| *indent == 0);
    let section = section.filter(|_| key.start != start);
    let tables: &[Keys] = match section {
        Some((_, "master")) => &[OF_MASTER],
        Some((_, "options")) => &[OF_OPTIONS],
        Some(_) => &[OF_SLAVE, OF_PDO],
        None => &[],
    };
    let mut all = tables.iter().copied().flatten();
    all.find(|(own, _)| *own == name).map(|(_, says)| *says)
}

/// The name of a file at a byte, and its place.
pub(crate) fn file(text: &str, offset: usize) -> Option<&str> {
    let pair = at(text, offset)?;
    let value = text.get(pair.value.clone())?.trim_matches(['"', '\'']);
    let is_file = text.get(pair.key)? == "dcf" && !value.is_empty();
    is_file.then_some(value)
}

/// The sections of a project: their names, and their whole text; nodes below `nodes` are sections of their own.
pub(crate) fn sections(text: &str) -> Vec<(Range<usize>, Range<usize>)> {
    let mut found: Vec<(Range<usize>, Range<usize>)> = Vec::new();
    let mut start = 0;
    // The indent of the nodes below `nodes`.
    let mut nodes = None;
    for line in text.split_inclusive('\n') {
        let own = line.trim_start_matches([' ', '\u{FEFF}']);
        let indent = line.len() - own.len();
        let name = own.split_once(':').map_or("", |(name, _)| name);
        let is_key = !name.is_empty() && name.chars().all(is_of_word);
        let is_top = indent == 0 || line.starts_with('\u{FEFF}');
        if is_key && (is_top || nodes.is_some_and(|own| own == usize::MAX || own == indent)) {
            nodes = match (is_top, name) {
                (true, "nodes") => Some(usize::MAX),
                (true, _) => None,
                (false, _) => Some(indent),
            };
            let at = start + indent;
            found.push((at..at + name.len(), at..at));
        }
        if !own.trim_end().is_empty()
            && let Some((_, whole)) = found.last_mut()
        {
            whole.end = start + line.trim_end().len();
        }
        start += line.len();
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "master: {node_id: 1, baudrate: 500}\nnodes:\n  left: # first\n    dcf: \"a/l.eds\"\n    \
        tpdo:\n      1:\n        transmission: 1\n        \n  right: {dcf: r.eds, node_id: 5}\n";

    fn place(mark: &str) -> usize {
        let (before, behind) = mark.split_once('|').expect("a mark");
        let found = TEXT.find(&format!("{before}{behind}"));
        found.expect("the text") + before.len()
    }

    #[test]
    fn a_key_has_the_meaning_of_its_section() {
        for (mark, part) in [
            ("{node|_id: 1", "of the master"),
            ("node_id|: 5", "1 to 127"),
            ("baudrate: |500", "kbit/s"),
            ("transmission: 1|", "0 to 255"),
        ] {
            let found = at(TEXT, place(mark)).and_then(|pair| meaning(TEXT, &pair.key));
            assert!(found.is_some_and(|says| says.contains(part)), "{mark}");
        }
        assert!(at(TEXT, place("# fi|rst")).is_none());
        assert!(at(TEXT, place("no|des:")).is_some_and(|pair| meaning(TEXT, &pair.key).is_none()));
    }

    #[test]
    fn a_file_and_the_sections_are_found() {
        assert_eq!(file(TEXT, place("a/l|.eds")), Some("a/l.eds"));
        assert_eq!(file(TEXT, place("r.eds|,")), Some("r.eds"));
        assert_eq!(file(TEXT, place("node_id: 5|")), None);
        let names = sections(TEXT).into_iter().map(|(name, _)| &TEXT[name]);
        assert_eq!(
            names.collect::<Vec<_>>(),
            ["master", "nodes", "left", "right"]
        );
    }

    #[test]
    fn a_mapping_has_the_keys_of_its_place() {
        let first = |mark: &str| keys(TEXT, place(mark)).first().map(|(name, _)| *name);
        assert_eq!(first("        |\n  right"), Some("enabled"));
        assert_eq!(first("    |dcf"), Some("dcf"));
        assert_eq!(first("|master"), None);
    }
}
