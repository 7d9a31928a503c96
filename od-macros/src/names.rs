//! Rust identifiers out of the names in an EDS.
//!
//! They are part of the API of the module that the macro makes, so the rules are
//! few and do not depend on anything but the names:
//!
//! 1. Letters and digits stay, and all other characters separate words; a letter with
//!    an accent becomes ASCII. A capital letter in `camelCase` begins a word, too.
//! 2. VARs and members are `SHOUTY_SNAKE`, RECORDs and ARRAYs `snake_case` modules.
//! 3. A name that begins with a digit gets a leading `_`, a keyword a trailing `_`;
//!    an empty name becomes `OBJECT_2110` or `SUB_05`.
//! 4. Where names repeat, *each* of them ends with its index or sub-index:
//!    `RESERVED_2110`, `RESERVED_2111`; none keeps the bare name, which would
//!    change its meaning if the EDS got another object of this name.

use std::collections::{BTreeMap, BTreeSet};

/// The words of a name, in lower case.
fn words(name: &str) -> Vec<String> {
    let mut words = vec![String::new()];
    let letters: Vec<char> = name.chars().flat_map(ascii).collect();
    for (at, letter) in letters.iter().enumerate() {
        if !letter.is_ascii_alphanumeric() {
            words.push(String::new());
            continue;
        }
        if humps(&letters, at) {
            words.push(String::new());
        }
        if let Some(word) = words.last_mut() {
            word.push(letter.to_ascii_lowercase());
        }
    }
    words.retain(|word| !word.is_empty());
    words
}

/// Returns whether a new word begins here, as in `NodeId`, `TxPdo` and `PDOMapping`.
///
/// It does not in `kHz` and `PDOs`: a word has at least two letters.
fn humps(letters: &[char], at: usize) -> bool {
    let is = |at: Option<usize>, test: fn(&char) -> bool| {
        at.and_then(|at| letters.get(at)).is_some_and(test)
    };
    let upper: fn(&char) -> bool = char::is_ascii_uppercase;
    let lower: fn(&char) -> bool = char::is_ascii_lowercase;
    if !is(Some(at), upper) {
        return false;
    }
    if is(at.checked_sub(1), lower) {
        return is(at.checked_sub(2), char::is_ascii_alphanumeric);
    }
    is(at.checked_sub(1), upper) && is(Some(at + 1), lower) && is(Some(at + 2), lower)
}

fn ascii(c: char) -> Vec<char> {
    let text = match c {
        'ä' | 'æ' => "ae",
        'ö' | 'ø' | 'œ' => "oe",
        'ü' => "ue",
        'Ä' | 'Æ' => "Ae",
        'Ö' | 'Ø' => "Oe",
        'Ü' => "Ue",
        'ß' => "ss",
        'à'..='å' => "a",
        'è'..='ë' => "e",
        'ì'..='ï' => "i",
        'ò'..='õ' => "o",
        'ù'..='û' => "u",
        'ç' => "c",
        'ñ' => "n",
        'µ' | 'μ' => "u",
        '°' => " deg ",
        '%' => " percent ",
        // An apostrophe is part of a word.
        '\'' | '’' => "",
        other => return vec![other],
    };
    text.chars().collect()
}

fn finish(joined: String, index: u16, sub: Option<u8>) -> String {
    let joined = match (joined.is_empty(), sub) {
        (false, _) => joined,
        (true, None) => format!("OBJECT_{index:04X}"),
        (true, Some(sub)) => format!("SUB_{sub:02X}"),
    };
    if joined.starts_with(|c: char| c.is_ascii_digit()) {
        format!("_{joined}")
    } else {
        joined
    }
}

/// `Product code` → `PRODUCT_CODE`.
pub(crate) fn constant(name: &str, index: u16, sub: Option<u8>) -> String {
    finish(words(name).join("_"), index, sub).to_ascii_uppercase()
}

/// `Identity object` → `identity_object`.
pub(crate) fn module(name: &str, index: u16) -> String {
    let name = finish(words(name).join("_"), index, None).to_ascii_lowercase();
    if is_keyword(&name) { name + "_" } else { name }
}

/// Returns whether it is a keyword of Rust.
pub(crate) fn is_keyword(word: &str) -> bool {
    syn::parse_str::<syn::Ident>(word).is_err()
}

/// Returns the names by their keys; a name that is repeated or `taken` gets the suffix of its key.
pub(crate) fn distinct<K: Ord + Copy>(
    wanted: &[(K, String)],
    taken: &BTreeSet<String>,
    suffix: impl Fn(K) -> String,
) -> BTreeMap<K, String> {
    let mut count: BTreeMap<&str, usize> = BTreeMap::new();
    for (_, name) in wanted {
        *count.entry(name).or_default() += 1;
    }
    let mut used: BTreeSet<String> = wanted
        .iter()
        .map(|(_, name)| name.clone())
        .chain(taken.iter().cloned())
        .collect();
    let mut made = BTreeMap::new();
    for (key, name) in wanted {
        let mut name = name.clone();
        if count[name.as_str()] > 1 || taken.contains(&name) {
            name = format!("{name}_{}", suffix(*key));
            while !used.insert(name.clone()) {
                name.push('_');
            }
        }
        made.insert(*key, name);
    }
    made
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn constants() {
        for (name, expected) in [
            ("Device type", "DEVICE_TYPE"),
            ("COB-ID used by TPDO 1", "COB_ID_USED_BY_TPDO_1"),
            ("COB-ID_SYNC message", "COB_ID_SYNC_MESSAGE"),
            ("NodeID", "NODE_ID"),
            ("HighestSubIndexSupported", "HIGHEST_SUB_INDEX_SUPPORTED"),
            ("PDOMapping", "PDO_MAPPING"),
            ("number of PDOs", "NUMBER_OF_PDOS"),
            ("Frequency (kHz)", "FREQUENCY_KHZ"),
            ("TxPDO1", "TX_PDO1"),
            ("2nd position", "_2ND_POSITION"),
            ("Größe in %", "GROESSE_IN_PERCENT"),
            ("Manufacturer's name", "MANUFACTURERS_NAME"),
            ("  -- ", "OBJECT_2110"),
            ("型", "OBJECT_2110"),
        ] {
            assert_eq!(constant(name, 0x2110, None), expected, "{name}");
        }
        assert_eq!(constant("", 0x2110, Some(5)), "SUB_05");
    }

    #[test]
    fn modules() {
        assert_eq!(module("Identity object", 0x1018), "identity_object");
        assert_eq!(module("Type", 0x2110), "type_");
        assert_eq!(module("self", 0x2110), "self_");
        assert_eq!(module("1. TPDO", 0x1A00), "_1_tpdo");
        assert_eq!(module("", 0x1A00), "object_1a00");
    }

    #[test]
    fn each_of_equal_names_gets_its_suffix() {
        let wanted = [(5, "A"), (6, "A"), (7, "B"), (8, "A_6")].map(|(k, n)| (k, n.to_string()));
        let taken = BTreeSet::from(["B".to_string()]);
        let made = distinct(&wanted, &taken, |k| k.to_string());
        let made: Vec<_> = made.values().map(String::as_str).collect();
        assert_eq!(made, ["A_5", "A_6_", "B_7", "A_6"]);
    }
}
