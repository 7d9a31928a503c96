//! A call of `object_dictionary!`: its file and its statements.

use std::ops::Range;

use od_eds::patch::{Action, Target};

use crate::macros::scan::{Kind, Token, tokens};

#[derive(Clone, Debug, Default)]
pub(crate) struct Call {
    /// The bytes between its braces.
    pub(crate) body: Range<usize>,
    /// The path after `eds =`, without its quotes, and that of the overlay.
    pub(crate) eds: Option<Range<usize>>,
    pub(crate) overlay: Option<Range<usize>>,
    pub(crate) statements: Vec<Statement>,
    /// Whether the call has `warnings = off;`.
    pub(crate) is_quiet: bool,
}

/// `add`, `modify`, `remove` or `rename`.
#[derive(Clone, Debug)]
pub(crate) struct Statement {
    /// `None` for `rename`.
    pub(crate) action: Option<Action>,
    /// `None` while it is incomplete.
    pub(crate) target: Option<(Target, Range<usize>)>,
    /// The tokens between the braces.
    pub(crate) fields: Vec<Token>,
    /// The braces, if it has some.
    pub(crate) braces: Option<Range<usize>>,
    /// Index of its variant.
    pub(crate) variant: Option<usize>,
}

pub(crate) fn all(source: &str) -> Vec<Call> {
    // Most sources contain no call.
    if !source.contains("object_dictionary") {
        return Vec::new();
    }
    let tokens = tokens(source);
    let mut calls = Vec::new();
    let mut at = 0;
    while at + 2 < tokens.len() {
        let own = &tokens[at..];
        let is_call = is(source, &own[0], "object_dictionary")
            && own[1].kind == Kind::Sign(b'!')
            && matches!(own[2].kind, Kind::Sign(b'{' | b'(' | b'['));
        if !is_call {
            at += 1;
            continue;
        }
        let end = closed(tokens.get(at + 2..).unwrap_or_default());
        let inside = tokens.get(at + 3..at + 2 + end).unwrap_or_default();
        let stop = tokens
            .get(at + 2 + end)
            .map_or(source.len(), |token| token.bytes.start);
        calls.push(call(source, inside, own[2].bytes.end..stop));
        at += end + 2;
    }
    calls
}

fn is(source: &str, token: &Token, word: &str) -> bool {
    token.kind == Kind::Word && source.get(token.bytes.clone()) == Some(word)
}

/// Index of the token that closes the bracket which the first token opens.
fn closed(tokens: &[Token]) -> usize {
    let mut depth = 0usize;
    for (at, token) in tokens.iter().enumerate() {
        match token.kind {
            Kind::Sign(b'{' | b'(' | b'[') => depth += 1,
            Kind::Sign(b'}' | b')' | b']') => depth = depth.saturating_sub(1),
            _ => {}
        }
        if depth == 0 {
            return at;
        }
    }
    tokens.len()
}

fn call(source: &str, tokens: &[Token], body: Range<usize>) -> Call {
    let mut call = Call {
        body,
        ..Call::default()
    };
    let kind = |at: usize| tokens.get(at).map(|token| token.kind);
    let mut variants = 0;
    // End of the open variant, by token.
    let mut open: Option<(usize, usize)> = None;
    let mut at = 0;
    while let Some(token) = tokens.get(at) {
        if open.is_some_and(|(_, end)| at >= end) {
            open = None;
        }
        let word = match token.kind {
            Kind::Word => source.get(token.bytes.clone()).unwrap_or_default(),
            _ => "",
        };
        let text = |at: usize| {
            let token = tokens.get(at).filter(|token| token.kind == Kind::Text);
            token.map(|token| token.bytes.clone())
        };
        match word {
            "eds" if kind(at + 1) == Some(Kind::Sign(b'=')) => {
                call.eds = call.eds.or(text(at + 2));
                if kind(at + 3) == Some(Kind::Sign(b'+')) {
                    call.overlay = call.overlay.or(text(at + 4));
                }
                at += 2;
            }
            "warnings" if tokens.get(at + 2).is_some_and(|off| is(source, off, "off")) => {
                call.is_quiet = true;
                at += 2;
            }
            "variant" => {
                let brace = (at + 1..at + 4).find(|at| kind(*at) == Some(Kind::Sign(b'{')));
                if let Some(brace) = brace {
                    open = Some((variants, brace + closed(&tokens[brace..])));
                    variants += 1;
                    at = brace;
                }
            }
            "add" | "modify" | "remove" | "rename" => {
                let (statement, next) = statement(source, tokens, at, word);
                call.statements.push(Statement {
                    variant: open.map(|(number, _)| number),
                    ..statement
                });
                at = next;
                continue;
            }
            _ => {}
        }
        at += 1;
    }
    call
}

/// The statement with this first token, and the token after it.
fn statement(source: &str, tokens: &[Token], at: usize, word: &str) -> (Statement, usize) {
    let number = tokens
        .get(at + 1)
        .filter(|token| token.kind == Kind::Number);
    let target = number.and_then(|token| {
        let text = source.get(token.bytes.clone())?;
        Some((text.parse().ok()?, token.bytes.clone()))
    });
    let mut next = at + 1 + usize::from(number.is_some());
    let mut fields = Vec::new();
    let mut braces = None;
    let is_brace = |at: usize| tokens.get(at).map(|token| token.kind) == Some(Kind::Sign(b'{'));
    if is_brace(next) {
        let own = tokens.get(next..).unwrap_or_default();
        let end = closed(own);
        fields = own.get(1..end).unwrap_or_default().to_vec();
        let start = own.first().map_or(0, |token| token.bytes.end);
        let stop = own.get(end).map_or(source.len(), |token| token.bytes.start);
        braces = Some(start..stop);
        next += end + 1;
    } else if word == "rename" || word == "remove" {
        let sign = |token: &Token| token.kind == Kind::Sign(b';');
        let rest = tokens.get(next..).unwrap_or_default();
        let end = rest.iter().take(4).position(sign);
        next += end.map_or(0, |end| end + 1);
    }
    let statement = Statement {
        action: match word {
            "add" => Some(Action::Add),
            "modify" => Some(Action::Modify),
            "remove" => Some(Action::Remove),
            _ => None,
        },
        target,
        fields,
        braces,
        variant: None,
    };
    (statement, next)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn calls_and_their_statements() {
        let source = r#"
            // object_dictionary! { mod no {} }
            odkit::object_dictionary! {
                /// A device.
                pub mod a {
                    eds = "a.eds" + "b.overlay";
                    modify 0x1018sub2 { default = 5 }
                    rename 0x6004 = POSITION;
                    variant x { remove 0x2000; modify }
                    add
                }
            }
            object_dictionary!(mod b { add 0x2000 { name = "é"; type = u8 } });
            object_dictionary! { mod open { remove 0x"#;
        let calls = all(source);
        assert_eq!(calls.len(), 3);
        let text = |bytes: &Option<Range<usize>>| bytes.clone().map(|bytes| &source[bytes]);
        assert_eq!(text(&calls[0].eds), Some("a.eds"));
        assert_eq!(text(&calls[0].overlay), Some("b.overlay"));
        let said: Vec<_> = calls[0]
            .statements
            .iter()
            .map(|own| {
                let target = own.target.as_ref().map(|(target, _)| target.to_string());
                (own.action, target, own.variant)
            })
            .collect();
        let some = |text: &str| Some(text.to_owned());
        assert_eq!(
            said,
            [
                (Some(Action::Modify), some("0x1018sub2"), None),
                (None, some("0x6004"), None),
                (Some(Action::Remove), some("0x2000"), Some(0)),
                (Some(Action::Modify), None, Some(0)),
                (Some(Action::Add), None, None),
            ]
        );
        assert_eq!(calls[1].statements[0].fields.len(), 7);
        assert_eq!(calls[2].statements[0].target, None);
    }
}
