//! A page for each rule, from the output of `odkit explain`.

use crate::console::{ask_in, cargo};
use crate::error::{Error, Result};
use crate::packages::CLI;
use crate::release::dist::Dist;
use crate::repo::program;

/// Code and page of each rule of the catalogue.
pub(super) fn pages(dist: &Dist<'_>) -> Result<Vec<(String, String)>> {
    let (repo, console) = (dist.repo, dist.console);
    let mut build = cargo(&repo.root, &["build", "--package", CLI.0, "--bin", CLI.1]);
    console.run("odkit, for the texts of its rules", &mut build)?;
    let odkit = repo.target.join("debug").join(program(CLI.1));
    let silent = || Error::Failed(String::from("`odkit explain` did not explain its rules"));
    let list = ask_in(&repo.root, &odkit, &["explain", "--list"]).ok_or_else(silent)?;
    let codes: Vec<&str> = list
        .lines()
        .filter_map(|line| line.split_whitespace().next())
        .collect();
    let texts = ask_in(&repo.root, &odkit, &[&["explain"], &codes[..]].concat());
    let pages = split(&texts.ok_or_else(silent)?);
    if pages.len() == codes.len() && !pages.is_empty() {
        Ok(pages)
    } else {
        Err(silent())
    }
}

/// The explanations of several rules as one Markdown page each.
fn split(texts: &str) -> Vec<(String, String)> {
    let mut pages: Vec<(String, String)> = Vec::new();
    let mut was_list = false;
    for line in texts.lines() {
        if let Some((code, severity, title)) = heading(line) {
            let text = format!("# {code}: {title}\n\nSeverity: {severity}\n");
            pages.push((String::from(code), text));
            was_list = false;
            continue;
        }
        let Some((_, page)) = pages.last_mut() else {
            continue;
        };
        let label = ["Fix:", "Source:", "Allow:"].iter().find_map(|label| {
            let value = line.strip_prefix(label)?;
            Some(format!("- {label} {}\n", value.trim()))
        });
        match label {
            Some(item) => page.push_str(&item),
            // A block of code begins after an empty line.
            None if ["Before:", "After:"].contains(&line) => page.push_str(&format!("{line}\n\n")),
            // Continuation of a list item.
            None if was_list && !line.is_empty() => page.push_str(&format!("  {}\n", line.trim())),
            None => page.push_str(&format!("{line}\n")),
        }
        was_list = (was_list || line.starts_with("Fix:")) && !line.is_empty();
    }
    pages
}

/// Code, severity and title of `E0412 (error): DefaultValue is not valid`.
fn heading(line: &str) -> Option<(&str, &str, &str)> {
    let (code, rest) = line.split_once(" (")?;
    let (severity, title) = rest.split_once("): ")?;
    let is_code = code.len() == 5 && code[1..].bytes().all(|byte| byte.is_ascii_digit());
    is_code.then_some((code, severity, title))
}

/// Adds a link to the rule's page to a table row that begins with a code.
pub(super) fn linked(text: &str, codes: &[(String, String)]) -> String {
    let mut out = String::with_capacity(text.len());
    for line in text.split_inclusive('\n') {
        let code = line
            .strip_prefix("| ")
            .and_then(|rest| rest.split_once(' '));
        match code.filter(|(code, _)| codes.iter().any(|(known, _)| known == code)) {
            Some((code, rest)) => out.push_str(&format!("| [{code}](../rules/{code}.md) {rest}")),
            None => out.push_str(line),
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::{linked, split};

    const TEXTS: &str = "E0412 (error): a value\n\nA tool cannot\nuse it.\n\nBefore:\n    [2000]\n\nFix:    none\n\
                         Source: CiA\n        301\n\nW0101 (warning): a line\n\nWhy.\n";

    #[test]
    fn each_explanation_is_a_page() {
        let pages = split(TEXTS);
        assert_eq!(pages.len(), 2);
        let text = "# E0412: a value\n\nSeverity: error\n\nA tool cannot\nuse it.\n\nBefore:\n\n    [2000]\n\n\
                    - Fix: none\n- Source: CiA\n  301\n\n";
        assert_eq!(pages[0], (String::from("E0412"), String::from(text)));
        assert_eq!(pages[1].1, "# W0101: a line\n\nSeverity: warning\n\nWhy.\n");
        let table = linked(
            "| E0412 | error |\n| code | what |\n| E9999 | no |\n",
            &pages,
        );
        assert_eq!(
            table,
            "| [E0412](../rules/E0412.md) | error |\n| code | what |\n| E9999 | no |\n"
        );
    }
}
