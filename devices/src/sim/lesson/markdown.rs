//! From Markdown to a lesson. Only what a lesson needs is looked at; the rest stays text.

use std::prelude::v1::*;
use std::{format, mem};

use super::{Check, Lesson, Problem, Step};
use crate::sim::script::Script;

/// Blocks between fences that mean something.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Block {
    Start,
    Check,
    Solution,
    /// Any other: part of the text.
    Other,
}

/// What a quoted paragraph is.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Quote {
    Hint,
    Happened,
}

#[derive(Default)]
struct Reader {
    lesson: Lesson,
    problems: Vec<Problem>,
    step: Option<Step>,
    quote: Option<Quote>,
}

pub(super) fn parse(text: &str) -> Result<Lesson, Vec<Problem>> {
    let mut reader = Reader::default();
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let mut lines = (1u32..).zip(text.lines()).peekable();
    if lines.peek().is_some_and(|(_, line)| line.trim() == "---") {
        lines.next();
        for (number, line) in lines.by_ref() {
            if line.trim() == "---" {
                break;
            }
            reader.front_matter(number, line);
        }
    }
    let mut block: Option<(Block, u32, String)> = None;
    for (number, line) in lines {
        let fence = line.trim_start().strip_prefix("```");
        match (&mut block, fence) {
            (None, Some(name)) => {
                let kind = match name.trim() {
                    "start" => Block::Start,
                    "check" => Block::Check,
                    "solution" => Block::Solution,
                    _ => Block::Other,
                };
                reader.quote = None;
                if kind == Block::Other {
                    reader.text(line);
                }
                block = Some((kind, number, String::new()));
            }
            (Some((kind, first, _)), Some(_)) => {
                let (kind, first) = (*kind, *first);
                let body = block.take().map(|(_, _, body)| body).unwrap_or_default();
                match kind {
                    Block::Other => reader.text(line),
                    _ => reader.block(kind, first, body),
                }
            }
            (Some((Block::Other, ..)), None) => reader.text(line),
            (Some((.., body)), None) => {
                body.push_str(line);
                body.push('\n');
            }
            (None, None) => reader.line(line),
        }
    }
    if let Some((_, first, _)) = block {
        reader.problem(
            first,
            "this block is not closed",
            "write ``` on a line behind it",
        );
    }
    reader.finish()
}

impl Reader {
    fn problem(&mut self, line: u32, message: impl Into<String>, help: &str) {
        self.problems.push(Problem {
            line,
            column: 1,
            message: message.into(),
            help: help.into(),
        });
    }

    fn front_matter(&mut self, number: u32, line: &str) {
        let Some((key, value)) = line.split_once(':') else {
            if !line.trim().is_empty() {
                self.problem(number, "this is no `key: value`", "write `title: …`");
            }
            return;
        };
        let value = value.trim().trim_matches('"');
        match key.trim() {
            "title" => self.lesson.title = value.into(),
            "summary" => self.lesson.summary = value.into(),
            "minutes" => match value.parse() {
                Ok(minutes) => self.lesson.minutes = minutes,
                Err(_) => self.problem(number, format!("`{value}` is no number"), "write minutes"),
            },
            // A trainer's own keys stay his.
            _ => {}
        }
    }

    fn line(&mut self, line: &str) {
        if let Some(title) = line.strip_prefix("## ") {
            self.close_step();
            self.step = Some(Step {
                title: title.trim().into(),
                ..Step::default()
            });
            return;
        }
        let Some(quoted) = line.strip_prefix('>') else {
            self.quote = None;
            self.text(line);
            return;
        };
        let quoted = quoted.trim();
        for (name, quote) in [
            ("Hint:", Quote::Hint),
            ("What just happened:", Quote::Happened),
        ] {
            if let (Some(rest), Some(step)) = (quoted.strip_prefix(name), &mut self.step) {
                self.quote = Some(quote);
                match quote {
                    Quote::Hint => step.hints.push(rest.trim().into()),
                    Quote::Happened => step.happened = rest.trim().into(),
                }
                return;
            }
        }
        let open = match (self.quote, &mut self.step) {
            (Some(Quote::Hint), Some(step)) => step.hints.last_mut(),
            (Some(Quote::Happened), Some(step)) => Some(&mut step.happened),
            _ => None,
        };
        match open {
            Some(text) => {
                text.push(if quoted.is_empty() { '\n' } else { ' ' });
                text.push_str(quoted);
            }
            None => self.text(line),
        }
    }

    fn text(&mut self, line: &str) {
        let to = match &mut self.step {
            Some(step) => &mut step.text,
            None => &mut self.lesson.intro,
        };
        // The lesson's own heading is its title.
        if let Some(title) = line.strip_prefix("# ")
            && to.trim().is_empty()
        {
            if self.lesson.title.is_empty() {
                self.lesson.title = title.trim().into();
            }
            return;
        }
        to.push_str(line);
        to.push('\n');
    }

    fn block(&mut self, kind: Block, first: u32, body: String) {
        match (kind, &mut self.step) {
            (Block::Start, None) => {
                self.script(first, &body);
                self.lesson.start = body;
            }
            (Block::Start, Some(_)) => {
                self.problem(
                    first,
                    "the bench is set up once",
                    "put `start` before the first ##",
                );
            }
            (Block::Check | Block::Solution, None) => {
                self.problem(first, "this belongs to no step", "a step begins with `## `");
            }
            (Block::Check, Some(step)) => {
                let mut problems = Vec::new();
                for (number, line) in (first + 1..).zip(body.lines()) {
                    match Check::parse(line) {
                        Ok(Some(check)) => step.checks.push(check),
                        Ok(None) => {}
                        Err((message, help)) => problems.push((number, message, help)),
                    }
                }
                for (number, message, help) in problems {
                    self.problem(number, message, &help);
                }
            }
            (Block::Solution, Some(step)) => {
                step.solution = body.clone();
                self.script(first, &body);
            }
            (Block::Other, _) => {}
        }
    }

    /// A script inside a lesson is read at once, so that its mistakes show with the lesson's lines.
    fn script(&mut self, first: u32, body: &str) {
        if let Err(problems) = Script::parse(body) {
            self.problems
                .extend(problems.into_iter().map(|problem| Problem {
                    line: problem.line + first,
                    ..problem
                }));
        }
    }

    fn close_step(&mut self) {
        self.quote = None;
        if let Some(mut step) = self.step.take() {
            step.text = mem::take(&mut step.text).trim().into();
            self.lesson.steps.push(step);
        }
    }

    fn finish(mut self) -> Result<Lesson, Vec<Problem>> {
        self.close_step();
        self.lesson.intro = mem::take(&mut self.lesson.intro).trim().into();
        if self.lesson.title.is_empty() {
            self.problem(
                1,
                "the lesson has no title",
                "write `title: …` between two lines of ---",
            );
        }
        if self.lesson.start.trim().is_empty() {
            self.problem(
                1,
                "the lesson sets up no bench",
                "write a block ```start with `device gxmm`",
            );
        }
        if self.lesson.steps.is_empty() {
            self.problem(1, "the lesson has no step", "a step begins with `## `");
        }
        let empty = |step: &&Step| step.checks.is_empty();
        if let Some(step) = self.lesson.steps.iter().find(empty) {
            let message = format!("the step “{}” has nothing to check", step.title);
            self.problem(1, message, "write a block ```check");
        }
        if self.problems.is_empty() {
            Ok(self.lesson)
        } else {
            self.problems.sort_by_key(|problem| problem.line);
            Err(self.problems)
        }
    }
}
