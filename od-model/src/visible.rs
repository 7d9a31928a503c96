//! Foreign text, escaped so that it cannot change a terminal, a table or a page.

use alloc::borrow::Cow;
use alloc::format;
use alloc::string::String;
use core::fmt::{self, Write};

/// A text of a device, a file or another program. Its forms escape characters that a reader would
/// not see: control characters (ESC, BEL, C1, line ends), marks that change the direction of the
/// text, and characters without a width become `\n` or `\u{1b}`.
///
/// ```
/// use od_model::Visible;
///
/// assert_eq!(Visible("red\u{1b}[31m").to_string(), "red\\u{1b}[31m");
/// ```
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Visible<'t>(pub &'t str);

impl<'t> Visible<'t> {
    /// Returns the text as one line.
    pub fn line(self) -> Cow<'t, str> {
        self.escaped(is_hidden)
    }

    /// Returns the text with its line ends and tabs.
    pub fn lines(self) -> Cow<'t, str> {
        let Self(text) = self;
        if !text.contains(|c| is_hidden(c) && !matches!(c, '\n' | '\t')) {
            return Cow::Borrowed(text);
        }
        let mut out = String::with_capacity(text.len() + 16);
        for line in text.split_inclusive('\n') {
            let (line, end) = match line.strip_suffix("\r\n") {
                Some(line) => (line, "\r\n"),
                None => (line, ""),
            };
            out.push_str(&Visible(line).escaped(|c| is_hidden(c) && !matches!(c, '\n' | '\t')));
            out.push_str(end);
        }
        Cow::Owned(out)
    }

    /// Returns the text as one line of Markdown that shows it unchanged, in a heading or a cell of
    /// a table.
    pub fn markdown(self) -> String {
        let mut out = String::with_capacity(self.0.len());
        for c in self.line().chars() {
            match c {
                '&' => out.push_str("&amp;"),
                '<' => out.push_str("&lt;"),
                '>' => out.push_str("&gt;"),
                '*' | '_' | '[' | ']' | '`' | '\\' | '|' => out.extend(['\\', c]),
                c => out.push(c),
            }
        }
        out
    }

    /// Returns the text as a cell of a CSV file (RFC 4180). A text that a spreadsheet would read as
    /// a formula gets an apostrophe in front.
    pub fn csv(self) -> String {
        let line = self.line();
        let is_formula = line.starts_with(['=', '+', '-', '@']) && line.parse::<f64>().is_err();
        let cell = if is_formula {
            format!("'{line}")
        } else {
            line.into_owned()
        };
        if cell.contains([',', '"']) {
            format!("\"{}\"", cell.replace('"', "\"\""))
        } else {
            cell
        }
    }

    /// Returns a JSON text in which every hidden character is escaped in the way of JSON; a parser
    /// gets the same strings.
    pub fn json(self) -> Cow<'t, str> {
        let Self(text) = self;
        let is_raw = |c: char| is_hidden(c) && !matches!(c, '\n' | '\r' | '\t');
        if !text.contains(is_raw) {
            return Cow::Borrowed(text);
        }
        let mut out = String::with_capacity(text.len() + 16);
        for c in text.chars() {
            if is_raw(c) {
                c.encode_utf16(&mut [0; 2]).iter().for_each(|unit| {
                    // Writing to a `String` does not fail.
                    let _ = write!(out, "\\u{unit:04x}");
                })
            } else {
                out.push(c)
            }
        }
        Cow::Owned(out)
    }

    fn escaped(self, is_escaped: impl Fn(char) -> bool) -> Cow<'t, str> {
        let Self(text) = self;
        if !text.contains(&is_escaped) {
            return Cow::Borrowed(text);
        }
        let mut out = String::with_capacity(text.len() + 16);
        for c in text.chars() {
            match c {
                c if !is_escaped(c) => out.push(c),
                '\n' | '\r' | '\t' => out.extend(c.escape_default()),
                c => out.extend(c.escape_unicode()),
            }
        }
        Cow::Owned(out)
    }
}

impl fmt::Display for Visible<'_> {
    /// The text as one line.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(&self.line())
    }
}

/// Returns whether a character is a control character, a line end, a mark of direction, or has no width.
pub fn is_hidden(c: char) -> bool {
    // Unicode 16: Cc, Zl, Zp, the bidirectional formatting characters (UAX 9), and the rest of Cf that no
    // script needs inside words.
    c.is_control()
        || matches!(c,
            '\u{AD}' | '\u{61C}' | '\u{180E}' | '\u{200B}' | '\u{200E}' | '\u{200F}'
            | '\u{2028}'..='\u{202E}' | '\u{2060}'..='\u{206F}' | '\u{FEFF}'
            | '\u{FFF9}'..='\u{FFFB}' | '\u{E0000}'..='\u{E007F}')
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hidden_characters_are_shown_as_escapes() {
        for (text, line, lines) in [
            ("Größe 5 µm", "Größe 5 µm", "Größe 5 µm"),
            ("\x1b[31m\x07", "\\u{1b}[31m\\u{7}", "\\u{1b}[31m\\u{7}"),
            ("\u{9b}2J\x7f", "\\u{9b}2J\\u{7f}", "\\u{9b}2J\\u{7f}"),
            ("a\nb\tc", "a\\nb\\tc", "a\nb\tc"),
            ("a\r\nb\rc\x1b", "a\\r\\nb\\rc\\u{1b}", "a\r\nb\\rc\\u{1b}"),
            (
                "a\u{202e}b\u{2028}",
                "a\\u{202e}b\\u{2028}",
                "a\\u{202e}b\\u{2028}",
            ),
        ] {
            assert_eq!(Visible(text).line(), line);
            assert_eq!(Visible(text).lines(), lines);
        }
        assert_eq!(format!("{:<4}|", Visible("a")), "a   |");
    }

    #[test]
    fn markdown_shows_the_text() {
        let text = "<script>|`x`*\n&";
        assert_eq!(
            Visible(text).markdown(),
            "&lt;script&gt;\\|\\`x\\`\\*\\\\n&amp;"
        );
    }

    #[test]
    fn a_cell_is_not_a_formula() {
        for (text, cell) in [
            ("=HYPERLINK(\"x\")", "\"'=HYPERLINK(\"\"x\"\")\""),
            ("+cmd", "'+cmd"),
            ("@SUM(A1)", "'@SUM(A1)"),
            ("-5", "-5"),
            ("-1.5e3", "-1.5e3"),
            ("-5+A1", "'-5+A1"),
            ("\t=1", "\\t=1"),
            ("a,b", "\"a,b\""),
            ("plain", "plain"),
        ] {
            assert_eq!(Visible(text).csv(), cell);
        }
    }

    #[test]
    fn json_keeps_its_meaning() {
        let text = "{\"a\": \"\u{9b}\u{e0001}ü\",\n\"b\": 1}";
        assert_eq!(
            Visible(text).json(),
            "{\"a\": \"\\u009b\\udb40\\udc01ü\",\n\"b\": 1}"
        );
    }
}
