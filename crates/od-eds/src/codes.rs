//! All codes of findings: those of the rules, and those of the tools.

use crate::finding::Rule;
use crate::rules::RULES;
#[cfg(feature = "tools")]
use crate::tools;

/// The rule with this code, ignoring case.
pub fn rule(code: &str) -> Option<&'static Rule> {
    all().find(|r| r.code.eq_ignore_ascii_case(code))
}

/// Every rule of odkit, and with feature `tools` those of the tools that read device files, too.
pub fn all() -> impl Iterator<Item = &'static Rule> {
    let rules = RULES.iter().copied();
    #[cfg(feature = "tools")]
    let rules = rules.chain(tools::rules());
    rules
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_code_is_found_in_any_case() {
        assert_eq!(rule("e0412").map(|r| r.code), Some("E0412"));
        #[cfg(feature = "tools")]
        assert_eq!(rule("t0112").map(|r| r.code), Some("T0112"));
        assert_eq!(rule("E9999"), None);
    }
}
