//! Lessons in another language: the prose of a translation, with the blocks of the original.

use std::format;
use std::prelude::v1::*;

use super::content::BLOCKS;
use crate::grammar::problem::Problem;

/// Keys of the front matter that a translation has; the others are those of the original.
const KEYS: [&str; 3] = ["title", "summary", "language"];

/// Returns the text of a lesson with the headings and the prose of `translation` and the blocks of `original`.
///
/// A translation has the same headings as its original in the same order: the titles of steps are translated, `### Hint` and
/// the other parts keep their names. It has no set-up, no solution, no facts. Its `checkpoint` blocks have one line for each
/// condition of the original, which is the text that the learner sees; an empty `answer` block separates a question from the
/// text that is shown with its answer.
///
/// # Errors
/// All places of the translation that do not fit the original.
pub fn translate(original: &str, translation: &str) -> Result<String, Vec<Problem>> {
    let (front, sections) = split(original);
    let (words, translated) = split(translation);
    let mut text = Composed::default();
    text.front(&front, &words);
    for (number, own) in translated.iter().enumerate() {
        let kind = own.kind();
        match sections.get(number) {
            Some(of) if of.kind() == kind => text.section(of, own),
            of => {
                let there = of.map_or("nothing", Section::kind).trim();
                let message = format!("`{}` is where the original has `{there}`", own.heading);
                let help = "write the headings of the original, in its order";
                text.problem(own.line, message, help);
                return Err(text.problems);
            }
        }
    }
    if let Some(next) = sections.get(translated.len()) {
        let line = 1 + translation.lines().count() as u32;
        let message = format!("the translation ends before `{}`", next.heading);
        text.problem(line, message, "translate the whole lesson");
    }
    if text.problems.is_empty() {
        Ok(text.text)
    } else {
        Err(text.problems)
    }
}

/// Returns whether a text is a translation, which needs its original to be a lesson. It names its language, its front matter has
/// only keys of translations, and it has no set-up and no solution.
pub fn is_translation(text: &str) -> bool {
    let (front, sections) = split(text);
    let keys: Vec<&str> = (front.iter())
        .filter_map(|(_, line)| line.split_once('='))
        .map(|(key, _)| key.trim())
        .collect();
    let has = |name: &str| {
        let mut blocks = sections.iter().flat_map(Section::blocks);
        blocks.any(|block| block.name == name)
    };
    keys.contains(&"language")
        && keys.iter().all(|key| KEYS.contains(key))
        && !has("set-up")
        && !has("solution")
}

/// A heading and the parts below it; the first section of a lesson has no heading.
struct Section<'t> {
    line: u32,
    heading: &'t str,
    parts: Vec<Part<'t>>,
}

enum Part<'t> {
    /// A line of prose.
    Prose(&'t str),
    Block(Block<'t>),
}

/// A block that is not part of the prose.
struct Block<'t> {
    line: u32,
    ticks: &'t str,
    name: &'t str,
    lines: Vec<&'t str>,
}

impl Section<'_> {
    /// The heading without the title of a step, which is translated.
    fn kind(&self) -> &str {
        if self.heading.starts_with("## ") {
            "##"
        } else {
            self.heading.trim_end()
        }
    }

    fn blocks(&self) -> impl Iterator<Item = &Block<'_>> {
        self.parts.iter().filter_map(|part| match part {
            Part::Block(block) => Some(block),
            Part::Prose(_) => None,
        })
    }
}

/// The lines of the front matter with their numbers, and the sections.
fn split(text: &str) -> (Vec<(u32, &str)>, Vec<Section<'_>>) {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let mut lines = (1..).zip(text.lines()).peekable();
    while lines.next_if(|(_, line)| line.trim().is_empty()).is_some() {}
    let mut front = Vec::new();
    if lines.next_if(|(_, line)| line.trim() == "+++").is_some() {
        front.extend(lines.by_ref().take_while(|(_, line)| line.trim() != "+++"));
    }
    let mut section = Section {
        line: 1,
        heading: "",
        parts: Vec::new(),
    };
    let mut sections = Vec::new();
    while let Some((number, line)) = lines.next() {
        let trimmed = line.trim();
        let ticks = &trimmed[..trimmed.len() - trimmed.trim_start_matches('`').len()];
        if ticks.len() >= 3 {
            let is_end = |line: &str| {
                let line = line.trim();
                line.len() >= ticks.len() && line.bytes().all(|byte| byte == b'`')
            };
            let name = trimmed[ticks.len()..].trim();
            let inner: Vec<_> = lines
                .by_ref()
                .map(|(_, line)| line)
                .take_while(|line| !is_end(line))
                .collect();
            if BLOCKS.contains(&name) || name.starts_with("eds ") {
                section.parts.push(Part::Block(Block {
                    line: number,
                    ticks,
                    name,
                    lines: inner,
                }));
            } else {
                section.parts.push(Part::Prose(line));
                section.parts.extend(inner.into_iter().map(Part::Prose));
                section.parts.push(Part::Prose(ticks));
            }
        } else if line.starts_with("## ") || line.starts_with("### ") {
            sections.push(section);
            section = Section {
                line: number,
                heading: line,
                parts: Vec::new(),
            };
        } else {
            section.parts.push(Part::Prose(line));
        }
    }
    sections.push(section);
    (front, sections)
}

/// The lesson that is made, with the problems of its translation.
#[derive(Default)]
struct Composed {
    text: String,
    problems: Vec<Problem>,
}

impl Composed {
    fn problem(&mut self, line: u32, message: impl Into<String>, help: &str) {
        self.problems.push(Problem::new(line, message, help));
    }

    fn line(&mut self, line: &str) {
        self.text.push_str(line);
        self.text.push('\n');
    }

    fn front(&mut self, original: &[(u32, &str)], words: &[(u32, &str)]) {
        let key = |line: &str| {
            line.split_once('=')
                .map(|(key, _)| String::from(key.trim()))
        };
        let translated = |line: &str| key(line).is_some_and(|key| KEYS.contains(&key.as_str()));
        self.line("+++");
        for (number, line) in words {
            if translated(line) {
                self.line(line);
            } else if !line.trim().is_empty() {
                let help = "a translation has title, summary and language";
                self.problem(
                    *number,
                    format!("`{}` is not translated", line.trim()),
                    help,
                );
            }
        }
        for wanted in KEYS {
            // A lesson may have no summary; its language is that of the translation.
            let is_there = |lines: &[(u32, &str)]| {
                lines
                    .iter()
                    .any(|(_, line)| key(line).as_deref() == Some(wanted))
            };
            if !is_there(words) && (is_there(original) || wanted == "language") {
                let help = "write title, summary and language between lines `+++`";
                self.problem(1, format!("the translation has no {wanted}"), help);
            }
        }
        for (_, line) in original.iter().filter(|(_, line)| !translated(line)) {
            self.line(line);
        }
        self.line("+++");
    }

    fn section(&mut self, original: &Section<'_>, own: &Section<'_>) {
        if !own.heading.is_empty() {
            self.line(own.heading);
        }
        let mut placed = Vec::new();
        for part in &own.parts {
            match part {
                Part::Prose(line) => self.line(line),
                Part::Block(block) => {
                    let source = original.blocks().find(|one| one.name == block.name);
                    match (source, block.name) {
                        (Some(source), "checkpoint") => self.checkpoint(source, block),
                        (Some(source), "answer") if block.lines.is_empty() => self.block(source),
                        _ => {
                            let message =
                                format!("a translation has no `{}` block here", block.name);
                            let help = "remove it; the original has it. Only a checkpoint has lines, and an answer is empty";
                            self.problem(block.line, message, help);
                        }
                    }
                    if matches!(block.name, "checkpoint" | "answer") {
                        placed.push(block.name);
                    }
                }
            }
        }
        for block in original.blocks() {
            if placed.contains(&block.name) {
                continue;
            }
            if matches!(block.name, "checkpoint" | "answer") {
                let message = format!("the `{}` block of the original is missing", block.name);
                let help =
                    "add it: a checkpoint with a line for each condition, an answer without lines";
                self.problem(own.line, message, help);
            }
            self.line("");
            self.block(block);
        }
        self.line("");
    }

    fn block(&mut self, block: &Block<'_>) {
        self.line(&format!("{}{}", block.ticks, block.name));
        for line in &block.lines {
            self.line(line);
        }
        self.line(block.ticks);
    }

    /// The conditions of the original with the texts of the translation.
    fn checkpoint(&mut self, original: &Block<'_>, own: &Block<'_>) {
        let is_text = |line: &&&str| !line.trim().is_empty() && !line.trim().starts_with('#');
        let mut labels = own.lines.iter().filter(is_text);
        let (conditions, texts) = (
            original.lines.iter().filter(is_text).count(),
            labels.clone().count(),
        );
        if conditions != texts {
            let message = format!("the conditions are {conditions}, and the texts are {texts}");
            let help = "write one line for each condition of the original";
            return self.problem(own.line, message, help);
        }
        self.line(&format!("{}checkpoint", original.ticks));
        for line in &original.lines {
            match Some(line)
                .filter(|line| is_text(line))
                .and_then(|_| labels.next())
            {
                Some(label) => {
                    let (condition, _) = line.split_once(" -- ").unwrap_or((line, ""));
                    self.line(&format!("{} -- {}", condition.trim_end(), label.trim()));
                }
                None => self.line(line),
            }
        }
        self.line(original.ticks);
    }
}

#[cfg(test)]
mod tests {
    use std::format;
    use std::prelude::v1::*;

    use super::{is_translation, translate};

    const ORIGINAL: &str = "+++\ntitle = \"Boot-up\"\nlevel = 1\nminutes = 5\n+++\n\nAn intro.\n\n```set-up\n\
                            device gxmm node 5 off\n```\n\n## Power it\n\nDo it.\n\n```checkpoint\n# first\ncame 705#00 -- it comes\n\
                            value 1017h = 0\n```\n\n### Predict\n\nWhich?\n\n```answer\n705#00\n```\n\n700h + 5.\n\n### Hint\n\n\
                            The switch.\n\n### What just happened\n\nIt started.\n\n```solution\npower on\n```\n";
    const GERMAN: &str = "+++\ntitle = \"Booten\"\nlanguage = \"de\"\n+++\n\nDie Einleitung.\n\n## Einschalten\n\n\
                          Tu es.\n\n```text\n```\n\n```checkpoint\nsie kommt\n1017h ist 0\n```\n\n### Predict\n\nWelcher?\n\n```answer\n```\n\n\
                          700h + 5.\n\n### Hint\n\nDer Schalter.\n\n### What just happened\n\nEr ist gestartet.\n";

    #[test]
    fn a_translation_has_the_blocks_of_its_original() {
        let text = translate(ORIGINAL, GERMAN).expect("it fits");
        let lesson = crate::lesson::Lesson::parse(&text).expect("it is a lesson");
        assert!(is_translation(GERMAN) && !is_translation(&text) && !is_translation(ORIGINAL));
        let alone = crate::lesson::Lesson::parse(GERMAN).expect_err("its original is missing");
        let [problem] = &alone[..] else {
            panic!("{alone:?}");
        };
        assert_eq!(
            problem.message,
            "this is a translation without its original"
        );
        let step = &lesson.steps[0];
        assert_eq!((&*lesson.title, &*lesson.language), ("Booten", "de"));
        assert_eq!((lesson.level, lesson.minutes), (1, 5));
        assert_eq!(lesson.set_up.text, "device gxmm node 5 off");
        assert_eq!(
            (&*step.title, &*step.solution.text),
            ("Einschalten", "power on")
        );
        assert_eq!(step.hints, ["Der Schalter."]);
        let quiz = step.quiz.as_ref().expect("a question");
        assert_eq!((&*quiz.question, &*quiz.reveal), ("Welcher?", "700h + 5."));
        assert!(
            text.contains("came 705#00 -- sie kommt\nvalue 1017h = 0 -- 1017h ist 0\n"),
            "{text}"
        );
    }

    #[test]
    fn a_difference_from_the_original_is_reported_with_its_line() {
        let found = |german: &str| {
            let problems = translate(ORIGINAL, german).expect_err("it does not fit");
            let lines = problems
                .iter()
                .map(|one| format!("{}: {}", one.line, one.message));
            lines.collect::<Vec<_>>().join("\n")
        };
        let cases = [
            (
                "### Hint\n\nDer Schalter.\n\n",
                "",
                "29: `### What just happened` is where the original has `### Hint`",
            ),
            (
                "\n### What just happened\n\nEr ist gestartet.\n",
                "",
                "32: the translation ends before `### What just happened`",
            ),
            (
                "sie kommt\n",
                "",
                "15: the conditions are 2, and the texts are 1",
            ),
            (
                "```answer\n```\n",
                "",
                "20: the `answer` block of the original is missing",
            ),
            (
                "```answer\n",
                "```answer\n705#01\n",
                "24: a translation has no `answer` block here",
            ),
            (
                "Tu es.\n",
                "```solution\npower on\n```\n",
                "10: a translation has no `solution` block here",
            ),
            (
                "language = \"de\"\n",
                "minutes = 9\n",
                "3: `minutes = 9` is not translated\n1: the translation has no language",
            ),
        ];
        for (from, to, wanted) in cases {
            assert!(GERMAN.contains(from), "{from}");
            assert_eq!(found(&GERMAN.replacen(from, to, 1)), wanted, "{from}");
        }
    }
}
