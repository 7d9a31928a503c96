//! Quick fixes: the fixes of findings, all safe ones at once, and comments that allow a finding.

use std::ops::Range;

use od_eds::fix::{self, Applicability};
use od_eds::{Document, Finding};

use crate::features::diagnostics;
use crate::file::{self, File, Kind, Seen};
use crate::layout::bytes;
use crate::types::{CodeAction, TextEdit, WorkspaceEdit};

/// The kind that applies all safe fixes; an editor can request it on every save.
pub(crate) const FIX_ALL: &str = "source.fixAll.odkit";
const QUICK_FIX: &str = "quickfix";

/// The actions for the lines of a range. `all` makes the edit of "fix all" now, or when the client requests
/// it `later`.
pub(crate) fn of(
    file: &File,
    seen: &Seen,
    all: &dyn Fn() -> WorkspaceEdit,
    within: &Range<usize>,
    only: Option<&[String]>,
    later: bool,
) -> Vec<CodeAction> {
    let wants = |kind: &str| {
        let is_below = |own: &String| {
            let rest = kind.strip_prefix(own.as_str());
            rest.is_some_and(|rest| rest.is_empty() || rest.starts_with('.'))
        };
        only.is_none_or(|only| only.iter().any(is_below))
    };
    let mut actions = Vec::new();
    if wants(QUICK_FIX) {
        let lines = file.text.line_at(within.start)..=file.text.line_at(within.end);
        let here = seen.findings.iter().filter(|finding| {
            let start = finding.span().map_or(0, |span| bytes(span).start);
            lines.contains(&file.text.line_at(start))
        });
        let here: Vec<&Finding> = here.collect();
        actions.extend(here.iter().filter_map(|finding| fixed(file, seen, finding)));
        actions.extend(
            here.iter()
                .filter_map(|finding| allowed(file, seen, finding)),
        );
    }
    let is_safe = |finding: &Finding| {
        let fix = finding.fix.as_ref();
        fix.is_some_and(|fix| fix.applicability == Applicability::Safe)
    };
    if wants(FIX_ALL) && seen.findings.iter().any(is_safe) {
        let now = (!later).then(all);
        // A fix that would break the fix of another finding is left out.
        if now.as_ref().is_none_or(|edit| !edit.changes.is_empty()) {
            actions.push(CodeAction {
                title: "Apply all safe fixes of odkit".into(),
                kind: FIX_ALL,
                diagnostics: Vec::new(),
                is_preferred: false,
                edit: now,
                data: later.then(|| file.uri.clone()),
            });
        }
    }
    actions
}

/// The edit that applies all safe fixes; `find` returns the findings of a text.
pub(crate) fn fix_all(file: &File, find: &dyn Fn(&Document) -> Vec<Finding>) -> WorkspaceEdit {
    let edits = match file.kind {
        Kind::Eds | Kind::Xdd | Kind::NodeList | Kind::Project => {
            let done = fix::fix(&file.document(), Applicability::Safe, find);
            file::edits(file, &format!("{}{}", file.mark(), done.document.text()))
        }
        Kind::Overlay | Kind::Rust => Vec::new(),
    };
    WorkspaceEdit::of(&file.uri, edits)
}

fn fixed(file: &File, seen: &Seen, finding: &Finding) -> Option<CodeAction> {
    let fix = finding.fix.as_ref()?;
    let edits = fix
        .text_edits(file.str())?
        .into_iter()
        .map(|edit| TextEdit {
            range: file.text.range(edit.start as usize..edit.end as usize),
            new_text: edit.text,
        });
    let diagnostic = diagnostics::one(file, &seen.description, finding);
    let is_safe = fix.applicability == Applicability::Safe;
    let help = od_eds::say(finding, &od_eds::Eds).help;
    let how = if is_safe { "Fix" } else { "Unsafe fix of" };
    let title = if help.is_empty() {
        format!("{how} {}: {}", finding.code(), finding.rule.title)
    } else {
        format!("{how} {}: {help}", finding.code())
    };
    Some(CodeAction {
        title,
        kind: QUICK_FIX,
        diagnostics: vec![diagnostic],
        is_preferred: is_safe,
        edit: Some(WorkspaceEdit::of(&file.uri, edits.collect())),
        data: None,
    })
}

/// The action that adds a comment which allows the finding.
fn allowed(file: &File, seen: &Seen, finding: &Finding) -> Option<CodeAction> {
    let code = finding.code();
    if file.kind != Kind::Eds || matches!(&code[1..3], "07" | "08") {
        return None;
    }
    let span = finding.span()?;
    let section = seen.layout.section_at(span.start as usize)?;
    // After the header, in the line below it.
    let line = file.text.line_at(section.header.start);
    let end = file.text.line(line).end;
    let line_end = match file.str().get(end..) {
        Some(rest) if rest.starts_with("\r\n") => "\r\n",
        Some(rest) if rest.starts_with('\r') => "\r",
        _ => "\n",
    };
    let name = file.part(section.name.clone());
    let edit = TextEdit {
        range: file.text.range(end..end),
        new_text: format!("{line_end};odkit-allow={code} reason"),
    };
    Some(CodeAction {
        title: format!("Allow {code} in [{name}]; replace `reason`"),
        kind: QUICK_FIX,
        diagnostics: vec![diagnostics::one(file, &seen.description, finding)],
        is_preferred: false,
        edit: Some(WorkspaceEdit::of(&file.uri, vec![edit])),
        data: None,
    })
}
