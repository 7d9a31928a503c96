//! A case: one of the built-in table, or a script with a head of comments.

use od_sim::script::Script;
use std::path::Path;
use std::sync::OnceLock;

use super::check::{self, BuiltIn, Check, Test};
use super::play::placed;
use crate::error::Error;

/// One step of a case.
#[derive(Clone, Debug)]
pub(crate) enum Step {
    /// `check NAME`: a step that is written in Rust.
    Check(Check),
    /// Lines of a script, from this line of the file on, with `$` not yet replaced.
    Script(u32, String),
}

/// One case of the conformance test.
#[derive(Clone, Debug)]
pub struct Case {
    /// Its name; for a script that of its file without `.script`.
    pub id: String,
    /// `SDO`, `NMT` …
    pub group: String,
    /// Standard and clause, or number of the case of the official test.
    pub clause: String,
    /// The requirement, in one sentence.
    pub title: String,
    /// Conditions that the EDS has to meet.
    pub(crate) applies: Vec<String>,
    /// The built-in devices that it tests; empty: any device.
    pub(crate) devices: Vec<String>,
    /// Permissions that the case needs: `reset`, `store`, `motion`, `power`.
    pub(crate) needs: Vec<String>,
    pub(crate) steps: Vec<Step>,
}

const NEEDS: [&str; 4] = ["reset", "store", "motion", "power"];

/// The parts of a comma-separated list.
fn list(text: &str) -> Vec<String> {
    let parts = text.split(',').map(|part| part.trim().to_owned());
    parts.filter(|part| !part.is_empty()).collect()
}

impl Case {
    fn new(id: &str, group: &str) -> Self {
        Self {
            id: id.into(),
            group: group.into(),
            clause: String::new(),
            title: String::new(),
            applies: Vec::new(),
            devices: Vec::new(),
            needs: Vec::new(),
            steps: Vec::new(),
        }
    }

    /// A case of the built-in table.
    fn built_in(group: &str, case: &BuiltIn) -> Result<Self, Error> {
        let check = match case.test {
            Test::Script(text) => return Self::parse(case.id, text),
            Test::Check(check) => check,
        };
        let (clause, title) = case.rule.split_once(": ").unwrap_or(("", case.rule));
        Ok(Self {
            clause: clause.into(),
            title: title.into(),
            applies: list(case.applies),
            needs: list(case.needs),
            steps: vec![Step::Check(check)],
            ..Self::new(case.id, group)
        })
    }

    /// Reads a script; `id` is the name of its file.
    ///
    /// # Errors
    /// The first line that cannot be read.
    pub fn parse(id: &str, text: &str) -> Result<Self, Error> {
        let mut case = Self::new(id, id.split('-').next().unwrap_or(id));
        let mut in_head = true;
        for (number, line) in (1..).zip(text.lines()) {
            let wrong = |message: String| Error::Case {
                id: id.into(),
                line: number,
                message,
            };
            match line.strip_prefix('#') {
                Some(comment) if in_head => case.head(comment.trim()).map_err(wrong)?,
                _ => {
                    in_head = false;
                    case.step(number, line).map_err(wrong)?;
                }
            }
        }
        for step in &case.steps {
            let Step::Script(first_line, text) = step else {
                continue;
            };
            // The node ID does not matter here: the lines are read again when the node under test
            // is known.
            let script = Script::parse_at(&placed(text, 1), *first_line);
            if let Some(problem) = script.err().and_then(|all| all.into_iter().next()) {
                let message = format!("{}; {}", problem.message, problem.help);
                let (id, line) = (id.into(), problem.line);
                return Err(Error::Case { id, line, message });
            }
        }
        Ok(case)
    }

    fn head(&mut self, line: &str) -> Result<(), String> {
        match line.split_once(": ") {
            Some(("Group", group)) => self.group = group.into(),
            Some(("Applies", all)) => self.applies = list(all),
            Some(("Devices", all)) => {
                self.devices = all.split_whitespace().map(str::to_owned).collect();
            }
            Some(("Needs", all)) => {
                self.needs = list(all);
                if let Some(other) = self.needs.iter().find(|one| !NEEDS.contains(&one.as_str())) {
                    return Err(format!(
                        "`{other}` is not valid; write reset, store, motion or power"
                    ));
                }
            }
            Some((source, rule)) if self.title.is_empty() => {
                self.clause = source.into();
                self.title = rule.into();
            }
            _ if line.is_empty() => {}
            _ if self.title.is_empty() => {
                return Err("begin with `# CiA 301 7.2.4: what is right`".into());
            }
            _ => {
                self.title.push(' ');
                self.title.push_str(line);
            }
        }
        Ok(())
    }

    fn step(&mut self, number: u32, line: &str) -> Result<(), String> {
        if let Some(name) = line.strip_prefix("check ") {
            let name = name.split(" #").next().unwrap_or(name).trim();
            let found = check::find(name);
            let found = found.ok_or_else(|| format!("check `{name}` does not exist"))?;
            self.steps.push(Step::Check(found));
            return Ok(());
        }
        match self.steps.last_mut() {
            Some(Step::Script(_, text)) => {
                text.push('\n');
                text.push_str(line);
            }
            _ if line.trim().is_empty() => {}
            _ => self.steps.push(Step::Script(number, line.into())),
        }
        Ok(())
    }

    /// Returns whether a pattern with `*` and `?` matches the name of this case or of its group; case is ignored.
    pub fn is_named_by(&self, pattern: &str) -> bool {
        let pattern = pattern.to_ascii_lowercase();
        let names = [&self.id, &self.group];
        names
            .iter()
            .any(|name| is_like(pattern.as_bytes(), name.to_ascii_lowercase().as_bytes()))
    }
}

fn is_like(pattern: &[u8], text: &[u8]) -> bool {
    match (pattern.split_first(), text.split_first()) {
        (None, None) => true,
        (Some((b'*', rest)), _) => (0..=text.len()).any(|skipped| is_like(rest, &text[skipped..])),
        (Some((b'?', rest)), Some((_, text))) => is_like(rest, text),
        (Some((wanted, rest)), Some((byte, text))) => wanted == byte && is_like(rest, text),
        _ => false,
    }
}

/// Reads all cases of a folder, by name.
///
/// # Errors
/// The folder or a file cannot be read.
pub fn in_folder(folder: &Path) -> Result<Vec<Case>, Error> {
    let fail =
        |path: &Path, error: std::io::Error| Error::Usage(format!("{}: {error}", path.display()));
    let mut found = Vec::new();
    let entries = std::fs::read_dir(folder).map_err(|error| fail(folder, error))?;
    for entry in entries {
        let path = entry.map_err(|error| fail(folder, error))?.path();
        let Some(name) = path.file_name().and_then(|name| name.to_str()) else {
            continue;
        };
        let Some(id) = name.strip_suffix(".script") else {
            continue;
        };
        let text = std::fs::read_to_string(&path).map_err(|error| fail(&path, error))?;
        found.push(Case::parse(id, &text)?);
    }
    found.sort_by(|a, b| a.id.cmp(&b.id));
    Ok(found)
}

/// The built-in cases, in the order in which they are run.
pub fn built_in() -> &'static [Case] {
    static CASES: OnceLock<Vec<Case>> = OnceLock::new();
    CASES.get_or_init(|| {
        let all = check::GROUPS.iter().flat_map(|(group, cases)| {
            // A test reads the scripts, so that none of them has an error.
            let read = cases.iter().map(|case| Case::built_in(group, case));
            read.filter_map(Result::ok)
        });
        all.collect()
    })
}
