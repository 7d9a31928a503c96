//! Workflow commands of GitHub Actions: an annotation at the line of each finding.

use od_eds::{Eds, Finding, Sentence, Severity, say};

use super::checked::{Checked, end_column};
use crate::source::Part;

pub(super) fn lines(checked: &Checked, remarks: bool) -> Vec<String> {
    let wanted = |finding: &&Finding| remarks || finding.severity() > Severity::Info;
    let of = |part: Part<'_>| {
        let findings = part.findings.iter().filter(wanted);
        let lines =
            findings.map(|finding| line(part.path, part.document.text(), &say(finding, &Eds)));
        lines.collect::<Vec<_>>()
    };
    checked.parts().into_iter().flat_map(of).collect()
}

fn line(path: &str, text: &str, finding: &Sentence) -> String {
    let command = match finding.severity {
        Severity::Error => "error",
        Severity::Warning => "warning",
        Severity::Info => "notice",
    };
    let mut line = format!("::{command} file={}", property(path));
    if let Some(span) = finding.span {
        let end = end_column(text, span);
        line.push_str(&format!(
            ",line={},endLine={},col={},endColumn={end}",
            span.line, span.line, span.column
        ));
    }
    let mut message = finding.with_object();
    if !finding.help.is_empty() {
        message = format!("{message}\nhelp: {}", finding.help);
    }
    format!(
        "{line},title={}::{}",
        property(finding.code),
        escaped(&message)
    )
}

fn escaped(text: &str) -> String {
    text.replace('%', "%25")
        .replace('\r', "%0D")
        .replace('\n', "%0A")
}

fn property(text: &str) -> String {
    escaped(text).replace(':', "%3A").replace(',', "%2C")
}

#[cfg(test)]
mod tests {
    use od_eds::Span;
    use od_model::Address;

    use super::*;

    #[test]
    fn nothing_breaks_out_of_a_command() {
        let finding = Sentence {
            code: "W0109",
            severity: Severity::Warning,
            message: "100 %\n::error::x".into(),
            span: Some(Span {
                start: 0,
                end: 3,
                line: 4,
                column: 2,
            }),
            address: Some(Address::new(0x2000, 1)),
            labels: Vec::new(),
            help: "write, or not".into(),
            fix: None,
        };
        assert_eq!(
            line("a,b:c.eds", "µx", &finding),
            "::warning file=a%2Cb%3Ac.eds,line=4,endLine=4,col=2,endColumn=4,title=W0109::\
             object 2000h:01: 100 %25%0A::error::x%0Ahelp: write, or not"
        );
    }
}
