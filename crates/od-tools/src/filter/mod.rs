//! The filter language of the playground's console: `node:5 sdo`, `185:7FF`, `position`, `!hb`,
//! `(emcy or nmt) tx`. Terms without an operator between them are combined by and; `or` and parentheses group them.

mod term;
mod tokens;

use self::term::{Term, term};
use self::tokens::{Token, mistake, tokens};
use crate::error::Error;

pub use self::term::FilteredFrame;

/// A filter for frames; an empty filter accepts all.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct Filter(Option<Rule>);

#[derive(Clone, PartialEq, Debug)]
enum Rule {
    All(Vec<Rule>),
    Any(Vec<Rule>),
    Not(Box<Rule>),
    Term(Term),
}

impl Filter {
    /// Reads a filter.
    ///
    /// # Errors
    /// The first mistake.
    pub fn parse(text: &str) -> Result<Self, Error> {
        let mut parser = Parser {
            tokens: &tokens(text)?,
            length: text.len(),
        };
        if parser.tokens.is_empty() {
            return Ok(Self(None));
        }
        let rule = parser.any()?;
        match parser.tokens.first() {
            Some(rest) => Err(mistake(rest.at, "`)` has no `(` before it")),
            None => Ok(Self(Some(rule))),
        }
    }

    /// Returns whether the filter accepts a frame.
    pub fn passes(&self, seen: &FilteredFrame<'_>) -> bool {
        self.0.as_ref().is_none_or(|rule| rule.passes(seen))
    }
}

impl Rule {
    fn passes(&self, seen: &FilteredFrame<'_>) -> bool {
        match self {
            Self::All(rules) => rules.iter().all(|rule| rule.passes(seen)),
            Self::Any(rules) => rules.iter().any(|rule| rule.passes(seen)),
            Self::Not(rule) => !rule.passes(seen),
            Self::Term(term) => term.passes(seen),
        }
    }
}

struct Parser<'t> {
    tokens: &'t [Token<'t>],
    length: usize,
}

impl<'t> Parser<'t> {
    fn peek(&self) -> Option<String> {
        self.tokens
            .first()
            .map(|token| token.text.to_ascii_lowercase())
    }

    fn next(&mut self) -> Option<&'t Token<'t>> {
        let (first, rest) = self.tokens.split_first()?;
        self.tokens = rest;
        Some(first)
    }

    fn any(&mut self) -> Result<Rule, Error> {
        let mut rules = vec![self.all()?];
        while matches!(self.peek().as_deref(), Some("or" | "|")) {
            self.next();
            rules.push(self.all()?);
        }
        Ok(match rules.len() {
            1 => rules.remove(0),
            _ => Rule::Any(rules),
        })
    }

    fn all(&mut self) -> Result<Rule, Error> {
        let mut rules = Vec::new();
        while let Some(next) = self.peek() {
            match next.as_str() {
                "or" | "|" | ")" => break,
                "and" => {
                    self.next();
                }
                _ => {}
            }
            rules.push(self.one()?);
        }
        match rules.len() {
            0 => Err(self.missing()),
            1 => Ok(rules.remove(0)),
            _ => Ok(Rule::All(rules)),
        }
    }

    fn missing(&self) -> Error {
        let at = self.tokens.first().map_or(self.length, |token| token.at);
        mistake(at, "a term is missing here")
    }

    fn one(&mut self) -> Result<Rule, Error> {
        let Some(token) = self.next() else {
            return Err(self.missing());
        };
        match token.text.to_ascii_lowercase().as_str() {
            "!" | "-" | "not" => Ok(Rule::Not(Box::new(self.one()?))),
            "(" => {
                let inner = self.any()?;
                match self.next() {
                    Some(close) if close.text == ")" => Ok(inner),
                    _ => Err(mistake(token.at, "`(` is not closed")),
                }
            }
            ")" => Err(mistake(token.at, "`)` has no `(` before it")),
            _ => term(token.text, token.at).map(|(term, is_not)| {
                if is_not {
                    Rule::Not(Box::new(Rule::Term(term)))
                } else {
                    Rule::Term(term)
                }
            }),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn passes(text: &str, frame: &str, words: &str) -> bool {
        let frame = od_sim::logs::candump::parse_frame(frame).expect(frame);
        let filter = Filter::parse(text).unwrap_or_else(|why| panic!("{text}: {why}"));
        let sent = false;
        filter.passes(&FilteredFrame {
            frame: &frame,
            sent,
            words,
        })
    }

    /// The cases of the page's own filter (`playground/web/src/trace/filter.test.ts`).
    #[test]
    fn services_nodes_and_identifiers() {
        for (text, answer, pdo, heartbeat) in [
            ("", true, true, true),
            ("sdo", true, false, false),
            ("node:5", true, false, true),
            ("node:5 sdo", true, false, false),
            ("181", false, true, false),
            ("id:0x181", false, true, false),
            ("canopen.cob_id == 0x181", false, true, false),
            ("canopen.cob_id!=181", true, false, true),
            ("180:780", false, true, false),
            ("185:7FF", false, false, false),
            ("180-5FF", true, true, false),
            ("!hb", true, true, false),
            ("-hb -sdo", false, true, false),
            ("not (sdo or hb)", false, true, false),
            ("pdo | node:5 hb", false, true, true),
            ("6004", true, false, false),
            ("object:6004:00", true, false, false),
            ("object:6004:01", false, false, false),
            ("data:43..60", true, false, false),
            ("data:\"01 02\"", false, true, false),
            ("pdo1", false, true, false),
            ("len:4", false, true, false),
            ("rx !tx", true, true, true),
            ("abort", false, false, false),
        ] {
            for (frame, expected) in [
                ("585#4304600001020304", answer),
                ("181#01020304", pdo),
                ("705#05", heartbeat),
            ] {
                assert_eq!(passes(text, frame, ""), expected, "{text}: {frame}");
            }
        }
    }

    #[test]
    fn words() {
        let said = "TPDO1 Position value = 5";
        assert!(passes("position", "181#01020304", said));
        assert!(!passes("!position", "181#01020304", said));
        assert!(passes("\"position value\" pdo", "181#01020304", said));
        assert!(passes("text:position", "181#01020304", said));
        assert!(!passes("position", "705#05", "Operational"));
    }

    #[test]
    fn mistakes_say_where() {
        for (text, at, what) in [
            ("node:200", 5, "1 to 127"),
            ("node:", 5, "missing"),
            ("nod:5", 0, "not a field"),
            ("sdo (pdo", 4, "not closed"),
            ("sdo)", 3, "no `(`"),
            ("sdo or", 6, "missing"),
            ("\"posi", 0, "not closed"),
            ("id:zz", 3, "hexadecimal"),
            ("data:4", 5, "two hexadecimal"),
            ("5FF-180", 0, "before it begins"),
            ("!", 1, "missing"),
        ] {
            let wrong = Filter::parse(text).expect_err(text);
            let Error::Filter {
                at: place,
                what: why,
            } = &wrong
            else {
                panic!("{text}: {wrong:?}");
            };
            assert!(*place == at && why.contains(what), "{text}: {wrong:?}");
        }
    }
}
