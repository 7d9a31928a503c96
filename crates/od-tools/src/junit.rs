//! JUnit XML, the report of a test run that build servers read.

use od_model::{Visible, is_hidden};

/// A test run.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Run {
    /// Name of the run.
    pub name: String,
    /// Place, time and equipment of the run: names and values.
    pub properties: Vec<(String, String)>,
    /// The groups of cases.
    pub suites: Vec<Suite>,
}

/// A group of cases.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Suite {
    /// Name of the group.
    pub name: String,
    /// Duration of the group, in microseconds.
    pub micros: u64,
    /// The cases.
    pub cases: Vec<Case>,
}

/// A test case.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Case {
    /// Name of the case.
    pub name: String,
    /// Duration of the case, in microseconds, if it was measured.
    pub micros: Option<u64>,
    /// Result of the case.
    pub outcome: Outcome,
    /// Lines that the case printed.
    pub output: Vec<String>,
}

/// Result of a case.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum Outcome {
    /// It passed.
    Passed,
    /// It failed.
    Failed {
        /// The reason in one line.
        message: String,
        /// Details, which may have several lines.
        text: String,
    },
    /// It did not run, for this reason.
    Skipped(String),
}

impl Run {
    /// Writes the run.
    pub fn render(&self) -> String {
        let micros = self.suites.iter().map(|suite| suite.micros).sum();
        let cases = self.suites.iter().flat_map(|suite| &suite.cases);
        let mut lines = vec![
            String::from(r#"<?xml version="1.0" encoding="UTF-8"?>"#),
            format!("<testsuites {}>", head(&self.name, micros, cases)),
        ];
        if !self.properties.is_empty() {
            lines.push("  <properties>".into());
            for (name, value) in &self.properties {
                let (name, value) = (escape(name), escape(value));
                lines.push(format!(r#"    <property name="{name}" value="{value}"/>"#));
            }
            lines.push("  </properties>".into());
        }
        for suite in &self.suites {
            let head = head(&suite.name, suite.micros, suite.cases.iter());
            lines.push(format!("  <testsuite {head}>"));
            let group = escape(&suite.name);
            for case in &suite.cases {
                case.render(&group, &mut lines);
            }
            lines.push("  </testsuite>".into());
        }
        lines.push("</testsuites>\n".into());
        lines.join("\n")
    }
}

impl Case {
    fn render(&self, group: &str, lines: &mut Vec<String>) {
        let name = escape(&self.name);
        let time = self.micros.map_or_else(String::new, |micros| {
            format!(r#" time="{}""#, seconds(micros))
        });
        lines.push(format!(
            r#"    <testcase name="{name}" classname="{group}"{time}>"#
        ));
        match &self.outcome {
            Outcome::Passed => {}
            Outcome::Failed { message, text } => {
                let (message, text) = (escape(message), escape(text));
                lines.push(format!(
                    r#"      <failure message="{message}">{text}</failure>"#
                ));
            }
            Outcome::Skipped(message) => {
                let message = escape(message);
                lines.push(format!(r#"      <skipped message="{message}"/>"#));
            }
        }
        if !self.output.is_empty() {
            let output = escape(&self.output.join("\n"));
            lines.push(format!("      <system-out>{output}</system-out>"));
        }
        lines.push("    </testcase>".into());
    }
}

/// The attributes of a run and of a group.
fn head<'c>(name: &str, micros: u64, cases: impl Iterator<Item = &'c Case>) -> String {
    let (mut tests, mut failures, mut skipped) = (0, 0, 0);
    for case in cases {
        tests += 1;
        match case.outcome {
            Outcome::Passed => {}
            Outcome::Failed { .. } => failures += 1,
            Outcome::Skipped(_) => skipped += 1,
        }
    }
    let (name, time) = (escape(name), seconds(micros));
    format!(
        r#"name="{name}" tests="{tests}" failures="{failures}" skipped="{skipped}" time="{time}""#
    )
}

fn seconds(micros: u64) -> String {
    format!("{}.{:06}", micros / 1_000_000, micros % 1_000_000)
}

/// Text for XML and HTML, also inside quotes; invisible characters are escaped.
pub(crate) fn escape(text: &str) -> String {
    let mut out = String::new();
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            '\n' | '\t' => out.push(c),
            c if is_hidden(c) => out.push_str(&Visible(c.encode_utf8(&mut [0; 4])).line()),
            c => out.push(c),
        }
    }
    out
}
