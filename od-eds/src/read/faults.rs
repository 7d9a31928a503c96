//! Findings about lines that are not plain INI.

use alloc::format;

use crate::finding::Finding;
use crate::fix::Fix;
use crate::rules;
use crate::scan::lines::Fault;
use crate::span::Span;

/// The finding of a fault.
pub(crate) fn finding(fault: &Fault<'_>) -> Finding {
    match *fault {
        Fault::NoPair(line) => rules::W0101
            .told(
                line.span,
                format!("`{}` is no section, no `key=value` and no comment", *line),
            )
            .with_help("the line is ignored; begin it with `;` to make it a comment")
            .fix(comment(line.span)),
        Fault::NoKey(line) => rules::W0102
            .told(line.span, format!("`{}` has no key before the `=`", *line))
            .with_help("the line is ignored; remove it, or name the key")
            .fix(comment(line.span)),
        Fault::Open { line, name } => rules::W0103
            .told(
                line,
                format!("the section `{}` has no closing bracket", *name),
            )
            .with_help(format!("write `[{}]`", *name))
            .fix(Fix::safe().replace(name.span, format!("{}]", *name))),
        Fault::Behind { name, text } => rules::W0104
            .told(
                text.span,
                format!("`{}` stands behind the section `[{name}]`", *text),
            )
            .with_help("give a comment a line of its own that begins with `;`")
            .fix(Fix::safe().replace(
                text.span,
                format!("\n;{}", text.trim_start_matches([';', '#'])),
            )),
        Fault::NoName(line) => rules::W0110
            .told(line, "the section has no name")
            .with_help("write the name between the brackets"),
        Fault::NoSection { line, key } => rules::W0105
            .told(line, format!("`{key}` stands before the first section"))
            .with_help("write the section's name above it, for example `[FileInfo]`"),
        Fault::Colon { at, key, value } => rules::W0108
            .told(at, format!("`{key}` is separated from its value by `:`"))
            .with_help(format!("write `{key}={value}`"))
            .fix(Fix::safe().replace(at, "=")),
    }
}

/// Makes a comment of a line.
fn comment(line: Span) -> Fix {
    let start = Span {
        end: line.start,
        ..line
    };
    Fix::safe().replace(start, ";")
}
