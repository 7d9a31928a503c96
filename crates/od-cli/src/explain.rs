//! `odkit explain`: the meaning of a rule, with an example and its fix, or of an abort code or an EMCY error code.

use od_eds::check::{Fixability, Rule, all, pair, rule};
use od_eds::tools::tool_of;
use od_sim::diagnose::wrapped;

use crate::failure::Failure;
use crate::output;

mod codes;
mod example;

/// Explain a rule by its code: why it matters, with an example before and after; or an SDO abort code, or an EMCY error code
#[derive(clap::Args)]
pub(crate) struct Args {
    /// Codes: of a rule, such as `E0412`, of an SDO abort, such as `0x06070010`, or of an EMCY message, such as `8130h`; or the
    /// name of a rule of `odkit diagnose`
    #[arg(required_unless_present = "list", value_name = "CODE")]
    codes: Vec<String>,
    /// List all rules
    #[arg(long, conflicts_with = "codes")]
    list: bool,
}

pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    if args.list {
        return output::print(&all().map(row).collect::<String>());
    }
    let page = |code: &&String| {
        let page = rule(code).map(text).or_else(|| codes::page(code));
        let page = page.or_else(|| diagnosis(code));
        page.ok_or_else(|| unknown(code))
    };
    // `emcy 8130`: the number says what it is.
    let is_kind = |code: &&String| ["emcy", "sdo", "abort"].contains(&&*code.to_lowercase());
    let codes = args
        .codes
        .iter()
        .filter(|code| !is_kind(code) || args.codes.len() == 1);
    let codes: Vec<&String> = codes.collect();
    let pages: Result<Vec<String>, Failure> = codes.iter().map(page).collect();
    output::print(&pages?.join("\n"))
}

/// A line of the list.
fn row(rule: &Rule) -> String {
    let (code, severity) = (rule.code, rule.severity.name());
    let fix = rule.fixability.name();
    format!("{code}  {severity:<7}  {fix:<14}  {}\n", rule.title)
}

/// A rule of `odkit diagnose`, by the name that its reports in JSON have.
fn diagnosis(name: &str) -> Option<String> {
    let mut all = od_sim::diagnose::rules();
    let (name, title) = all.find(|(known, _)| *known == name)?;
    Some(format!(
        "{name} (rule of `odkit diagnose`): {title}\n\ndocs/how-to/diagnose-a-log.md lists what it finds, and the causes.\n"
    ))
}

fn unknown(code: &str) -> Failure {
    let is_rule = matches!(code.as_bytes(), [letter, digits @ ..]
        if letter.is_ascii_alphabetic() && digits.len() == 4 && digits.iter().all(u8::is_ascii_digit));
    if !is_rule {
        return Failure::Usage(format!(
            "`{code}` is not a code of a rule (E0412), of an SDO abort (0x06070010) or of an EMCY message (8130h); \
             `odkit explain --list` lists all rules"
        ));
    }
    // The digits identify a rule; only the letter may be wrong.
    let digits = code.trim_start_matches(|c: char| c.is_ascii_alphabetic());
    let near = all().find(|rule| &rule.code[1..] == digits);
    Failure::Usage(match near {
        Some(near) => format!("rule `{code}` does not exist; did you mean {}?", near.code),
        None => format!("rule `{code}` does not exist; `odkit explain --list` lists all rules"),
    })
}

fn text(rule: &Rule) -> String {
    let mut text = format!(
        "{} ({}): {}\n\n{}\n",
        rule.code,
        rule.severity.name(),
        rule.title,
        wrapped(rule.why, 90)
    );
    let (before, after) = pair(rule.code).map(example::lines).unwrap_or_default();
    for (title, lines) in [("Before:", &before), ("After:", &after)] {
        if !lines.is_empty() {
            text.push_str(&format!("\n{title}\n{lines}"));
        }
    }
    if !rule.example.is_empty() {
        text.push_str(&format!("\nExample:\n    {}\n", rule.example));
    }
    let fix = match rule.fixability {
        Fixability::None => "none; correct the file yourself",
        Fixability::Safe => "`odkit check --fix`",
        Fixability::Unsafe => "`odkit check --unsafe-fixes`; review the result",
        Fixability::Either => "`odkit check --fix`, or `--unsafe-fixes` if content is lost",
    };
    text.push_str(&format!("\nFix:    {fix}\nSource: {}\n", rule.source));
    let tool = tool_of(rule.code);
    if let Some(tool) = tool {
        let tried = if tool.tried {
            "held against the tool itself"
        } else {
            "not tried"
        };
        text.push_str(&format!(
            "Tool:   {} {} ({tried}); `odkit check --for {}`\n",
            tool.name, tool.version, tool.name
        ));
    }
    if tool.is_some() || !matches!(&rule.code[1..3], "07" | "08" | "11" | "12") {
        text.push_str(&format!(
            "Allow:  `;odkit-allow={} reason` in the file, or `--allow {}`\n",
            rule.code, rule.code
        ));
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_rule_has_a_page() {
        for rule in all() {
            let page = text(rule);
            assert!(
                page.starts_with(rule.code) && page.contains(rule.source),
                "{page}"
            );
            // Our words are wrapped; examples are lines of files and keep their length.
            let own = page.lines().filter(|line| !line.starts_with("    "));
            assert!(
                own.clone().all(|line| line.chars().count() <= 130),
                "{page}"
            );
            assert!(own.count() > 4, "{page}");
            assert!(page.lines().any(|line| line.starts_with("    ")), "{page}");
        }
    }
}
