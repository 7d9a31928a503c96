//! Findings that a file allows: `;odkit-allow=W0311 reason` in a comment of its own.
//!
//! Before the first section and in `[FileInfo]` such a comment applies to the whole file. In the section of an
//! object or a sub-object it applies to the findings there and to all findings about that object;
//! in any other section to the findings there. A reason is required, because the next reader of the
//! file has to judge it.

use alloc::format;
use alloc::vec::Vec;
use od_model::Refused;

use crate::codes::rule;
use crate::finding::{Finding, Rule, sort};
use crate::rules::allow::{
    i0803_allow_without_finding, w0801_allow_without_rule, w0802_allow_without_reason,
};
use crate::scan::{lines::lines, names::object_of};
use crate::span::Span;

/// The word that begins such a comment.
const WORD: &str = "odkit-allow";

/// One code that is allowed somewhere.
#[derive(Clone, Debug)]
struct Allow {
    code: &'static str,
    /// The code in the comment.
    span: Span,
    scope: Scope,
    used: bool,
}

/// The part of a file in which a code is allowed.
#[derive(Clone, Debug)]
enum Scope {
    File,
    /// From this line up to the line before that one, and all findings about this object.
    Section(u32, u32, Option<u16>),
}

/// All allowances of a text, and the findings about their comments.
#[derive(Clone, Debug, Default)]
pub struct Allows {
    allows: Vec<Allow>,
    findings: Vec<Finding>,
}

impl Allows {
    /// Reads the comments of a text.
    pub fn of(text: &str) -> Self {
        let mut allows = Self::default();
        // Most files have none, and searching for one character is fast.
        let is_word = |dash: usize| {
            let start = dash.checked_sub("odkit".len());
            let word = start.and_then(|start| text.as_bytes().get(start..start + WORD.len()));
            word.is_some_and(|word| word.eq_ignore_ascii_case(WORD.as_bytes()))
        };
        if !text.match_indices('-').any(|(at, _)| is_word(at)) {
            return allows;
        }
        let mut scope = Scope::File;
        let mut open = 0;
        for line in lines(text) {
            let trimmed = line.text.trim();
            if let Some(inside) = trimmed.strip_prefix('[') {
                allows.close(open, line.number);
                open = allows.allows.len();
                let name = inside.split(']').next().unwrap_or(inside).trim();
                scope = if name.eq_ignore_ascii_case("FileInfo") {
                    Scope::File
                } else {
                    let index = object_of(name);
                    Scope::Section(line.number, u32::MAX, index)
                };
            } else if let Some(body) = trimmed.strip_prefix([';', '#']) {
                let body = body.trim_start();
                let word = body.get(..WORD.len());
                if word.is_some_and(|word| word.eq_ignore_ascii_case(WORD)) {
                    let rest = body[WORD.len()..].trim_start();
                    let rest = rest.strip_prefix(['=', ':']).unwrap_or(rest).trim_start();
                    allows.comment(rest, |part| line.span(part), &scope);
                }
            }
        }
        allows
    }

    /// Ends the section of the newest entries, from number `open` on, before this line.
    fn close(&mut self, open: usize, number: u32) {
        for allow in &mut self.allows[open..] {
            if let Scope::Section(_, end, _) = &mut allow.scope {
                *end = number;
            }
        }
    }

    /// `W0311,W0302 reason`
    fn comment(&mut self, text: &str, span: impl Fn(&str) -> Span, scope: &Scope) {
        let (codes, reason) = match text.split_once(char::is_whitespace) {
            Some((codes, reason)) => (codes, reason.trim()),
            None => (text, ""),
        };
        if reason.is_empty() {
            self.findings
                .push(w0802_allow_without_reason(codes, span(text)));
            return;
        }
        for given in codes.split(',') {
            match known(given) {
                Some(rule) => self.allows.push(Allow {
                    code: rule.code,
                    span: span(given),
                    scope: scope.clone(),
                    used: false,
                }),
                None => self
                    .findings
                    .push(w0801_allow_without_rule(given, span(given))),
            }
        }
    }

    /// Removes allowed findings, and adds the findings about the comments themselves.
    pub fn apply(mut self, findings: &mut Vec<Finding>) {
        self.filter(findings);
        // The findings for other tools, if there are any, come later.
        let unused = self.allows.iter();
        let unused = unused.filter(|allow| !allow.used && !allow.code.starts_with('T'));
        let unused = unused.map(|allow| i0803_allow_without_finding(allow.code, allow.span));
        self.findings.extend(unused);
        if !self.findings.is_empty() {
            findings.append(&mut self.findings);
            sort(findings);
        }
    }

    /// Removes allowed findings.
    pub fn filter(&mut self, findings: &mut Vec<Finding>) {
        if !self.allows.is_empty() {
            findings.retain(|finding| !self.allowed(finding));
        }
    }

    fn allowed(&mut self, finding: &Finding) -> bool {
        let mut allowed = false;
        for allow in &mut self.allows {
            let here = match allow.scope {
                Scope::File => true,
                Scope::Section(start, end, index) => {
                    let about = finding.object.map(|address| address.index);
                    let at = finding.span().map(|span| span.line);
                    at.is_some_and(|line| (start..end).contains(&line))
                        || (index.is_some() && about == index)
                }
            };
            if here && allow.code == finding.rule.code {
                allow.used = true;
                allowed = true;
            }
        }
        allowed
    }
}

/// The rule of a code that can be allowed: all except those about edits and about allowing.
fn known(code: &str) -> Option<&'static Rule> {
    rule(code).filter(|rule| {
        rule.code.starts_with('T') || !matches!(&rule.code[1..3], "07" | "08" | "11" | "12")
    })
}

/// Reads an allowance of a command line: `E0310`, or `E0310:2000` for one object.
///
/// # Errors
///
/// A sentence that names what is wrong.
pub fn parse_allow(text: &str) -> Result<(&'static str, Option<u16>), Refused> {
    let (code, index) = match text.split_once(':') {
        Some((code, index)) => (code, Some(index)),
        None => (text, None),
    };
    let rule = known(code).ok_or_else(|| {
        format!("`{code}` is not the code of a finding; `odkit explain --list` lists them all")
    })?;
    let Some(index) = index else {
        return Ok((rule.code, None));
    };
    let digits = index
        .strip_prefix("0x")
        .or_else(|| index.strip_prefix("0X"))
        .unwrap_or(index);
    let digits = digits.strip_suffix(['h', 'H']).unwrap_or(digits);
    match u16::from_str_radix(digits, 16) {
        Ok(index) if !digits.starts_with('+') => Ok((rule.code, Some(index))),
        _ => Err(format!(
            "`{index}` is not an index; write four hexadecimal digits such as `2000`"
        )
        .into()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn codes(text: &str) -> Vec<&'static str> {
        let findings = crate::load::load(text).findings;
        findings
            .iter()
            .map(|finding| finding.rule.code)
            .filter(|code| {
                !code.starts_with("E06") && !matches!(*code, "W0203" | "W0216" | "I0240")
            })
            .collect()
    }

    const OBJECTS: &str = "[2000]\nParameterName=a\nDataType:5\nAccessType=ro\n\
                           [2001]\nParameterName=b\nDataType:5\nAccessType=ro\n";

    #[test]
    fn a_code_is_allowed_in_a_file_an_object_or_a_section() {
        assert_eq!(codes(OBJECTS), ["W0108", "W0108"]);
        let file = format!("; Odkit-Allow = w0108 an old editor\n{OBJECTS}");
        assert_eq!(codes(&file), [""; 0]);
        let info = format!("[FileInfo]\n#odkit-allow W0108,W0101 an old editor\nx\n{OBJECTS}");
        assert_eq!(codes(&info), [""; 0]);
        let object = OBJECTS.replace("ParameterName=b", ";odkit-allow=W0108 so\nParameterName=b");
        assert_eq!(codes(&object), ["W0108"]);
        let other = format!("[Tools]\n;odkit-allow=W0108 x\nItems:0\n{OBJECTS}");
        assert_eq!(codes(&other), ["W0108", "W0108"]);
    }

    #[test]
    fn a_wrong_allowance_is_reported() {
        let file = format!(";odkit-allow=W0108\n{OBJECTS}");
        assert_eq!(codes(&file), ["W0802", "W0108", "W0108"]);
        let file = format!(";odkit-allow=W99,E0701 x y\n{OBJECTS}");
        assert_eq!(codes(&file), ["W0801", "W0801", "W0108", "W0108"]);
        let file = format!(";odkit-allow=W0101 none here\n{OBJECTS}");
        assert_eq!(codes(&file), ["I0803", "W0108", "W0108"]);
        assert_eq!(
            codes(";odkit-allow=\n[2000]"),
            ["W0802", "W0315", "W0404", "E0401"]
        );
    }

    #[test]
    fn a_code_is_allowed_on_the_command_line() {
        assert_eq!(parse_allow("w0108"), Ok(("W0108", None)));
        assert_eq!(parse_allow("E0310:2000"), Ok(("E0310", Some(0x2000))));
        assert_eq!(parse_allow("E0310:0x20A0"), Ok(("E0310", Some(0x20A0))));
        for wrong in [
            "",
            "W99",
            "E0310:",
            "E0310:2000sub1",
            "E0310:12345",
            "W0801",
        ] {
            assert!(parse_allow(wrong).is_err(), "{wrong}");
        }
    }
}
