//! Limits of an XML text, far above those of any device file: what the parser would spend much time and memory on.

use crate::scan::lines::LONGEST;

/// Maximum number of attributes of an element. Those of CiA 311 have 12, and the parser compares each attribute with
/// all others.
const OF_ELEMENT: usize = 1_000;
/// Maximum number of elements of a text. Large device files have 10,000.
const ELEMENTS: usize = 200_000;
/// Maximum number of attributes of a text.
const ATTRIBUTES: usize = 1_000_000;
/// Maximum number of elements inside each other.
const DEPTH: usize = 100;

/// A limit that a text exceeds.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) struct Large {
    /// Byte where the element or the value begins.
    pub(super) at: usize,
    pub(super) part: &'static str,
    pub(super) most: usize,
    pub(super) of: &'static str,
}

/// The first limit that a text exceeds. It need not be well-formed.
pub(super) fn exceeded(text: &str) -> Option<Large> {
    let large = |at, part, most, of| Some(Large { at, part, most, of });
    let (mut elements, mut attributes, mut depth) = (0, 0, 0_usize);
    let mut at = 0;
    while let Some(found) = find(text, at, "<") {
        if found - at > LONGEST {
            return large(at, "text", LONGEST, "bytes");
        }
        at = found;
        let rest = &text[at..];
        // Markup in which quotation marks are text.
        let other = [("<!--", "-->"), ("<![CDATA[", "]]>"), ("<?", "?>")];
        if let Some((_, end)) = other.iter().find(|(start, _)| rest.starts_with(start)) {
            at = find(text, at, end)? + end.len();
            continue;
        }
        let tag = tag(text, at);
        if tag.longest > LONGEST {
            return large(at, "value of an attribute", LONGEST, "bytes");
        }
        if tag.attributes > OF_ELEMENT {
            return large(at, "element", OF_ELEMENT, "attributes");
        }
        attributes += tag.attributes;
        if attributes > ATTRIBUTES {
            return large(at, "file", ATTRIBUTES, "attributes");
        }
        let bytes = text.as_bytes();
        if bytes.get(at + 1) == Some(&b'/') {
            depth = depth.saturating_sub(1);
        } else {
            elements += 1;
            let is_empty = bytes.get(tag.end.saturating_sub(2)) == Some(&b'/');
            let is_declaration = bytes.get(at + 1) == Some(&b'!');
            depth += usize::from(!is_empty && !is_declaration);
        }
        if elements > ELEMENTS {
            return large(at, "file", ELEMENTS, "elements");
        }
        if depth > DEPTH {
            return large(at, "file", DEPTH, "elements inside each other");
        }
        at = tag.end;
    }
    (text.len() - at.min(text.len()) > LONGEST).then_some(Large {
        at,
        part: "text",
        most: LONGEST,
        of: "bytes",
    })
}

/// The place of `what` from a byte on.
fn find(text: &str, from: usize, what: &str) -> Option<usize> {
    text.get(from..)?.find(what).map(|at| from + at)
}

/// A tag of an element.
struct Tag {
    /// The byte after it.
    end: usize,
    attributes: usize,
    /// Bytes of its longest value.
    longest: usize,
}

/// The tag that begins at a byte; up to the end of the text if it has no end.
fn tag(text: &str, start: usize) -> Tag {
    let mut tag = Tag {
        end: text.len(),
        attributes: 0,
        longest: 0,
    };
    let mut at = start;
    while let Some(found) = text[at..].find(['>', '"', '\'']) {
        at += found;
        let mark = &text[at..=at];
        if mark == ">" {
            tag.end = at + 1;
            break;
        }
        let Some(end) = find(text, at + 1, mark) else {
            tag.longest = tag.longest.max(text.len() - at);
            break;
        };
        tag.attributes += 1;
        tag.longest = tag.longest.max(end - at - 1);
        at = end + 1;
    }
    tag
}

#[cfg(test)]
mod tests {
    use alloc::format;
    use alloc::string::String;

    use super::*;

    fn part(text: &str) -> Option<(usize, &'static str)> {
        exceeded(text).map(|large| (large.at, large.of))
    }

    fn attributes(count: usize, sign: &str) -> String {
        let all = (0..count).map(|n| format!(" a{n}{sign}'1'"));
        format!("<!-- it's -->\n<b/><a{}/>", all.collect::<String>())
    }

    #[test]
    fn each_limit_has_its_place() {
        for sign in ["=", " = ", "=\n"] {
            assert_eq!(part(&attributes(OF_ELEMENT, sign)), None);
            let found = part(&attributes(OF_ELEMENT + 1, sign));
            assert_eq!(found, Some((18, "attributes")), "{sign}");
        }
        assert_eq!(part(&"<a b='1'/>".repeat(ELEMENTS)), None);
        let found = part(&"<a/>".repeat(ELEMENTS + 1));
        assert_eq!(found, Some((4 * ELEMENTS, "elements")));
        assert_eq!(part(&"<a></a>".repeat(DEPTH + 1)), None);
        let found = part(&"<a>".repeat(DEPTH + 1));
        assert_eq!(found, Some((3 * DEPTH, "elements inside each other")));
        let long = "x".repeat(LONGEST + 1);
        assert_eq!(part(&format!("<a b='{long}'/>")), Some((0, "bytes")));
        assert_eq!(part(&format!("<a>{long}</a>")), Some((3, "bytes")));
        assert_eq!(part(&format!("<a>{long}")), Some((3, "bytes")));
        assert_eq!(part(&format!("<!--{long}--><a/>")), None);
    }

    #[test]
    fn a_text_that_is_not_well_formed_has_an_end() {
        for text in [
            "<",
            "<a",
            "<a b='",
            "<!--",
            "<?",
            "<![CDATA[",
            "a",
            "",
            "<a b=\"é'>",
            "</a>",
        ] {
            assert_eq!(part(text), None, "{text}");
        }
    }
}
