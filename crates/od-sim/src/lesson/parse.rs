//! Reads a lesson from Markdown: front matter, headings, and named blocks.

use std::format;
use std::prelude::v1::*;

use super::content::{BLOCKS, Block, Lesson, Step};
use super::quiz::Quiz;
use super::translation::is_translation;
use super::{checkpoint, front, links};
use crate::grammar::pattern::Pattern;
use crate::grammar::problem::Problem;
use crate::script::Script;

/// Longest lesson, in bytes; a longer text is refused.
const LONGEST: usize = 256 * 1024;

/// The part to which prose is added.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Part {
    Text,
    Hint,
    Happened,
    Question,
    Reveal,
}

/// An open fenced block.
struct Fence {
    line: u32,
    /// Number of backticks at its start.
    ticks: usize,
    /// One of [`BLOCKS`]; any other block is part of the text.
    name: String,
    lines: Vec<String>,
}

struct Reader {
    lesson: Lesson,
    problems: Vec<Problem>,
    part: Part,
    fence: Option<Fence>,
    /// Names of the blocks of the current step.
    seen: Vec<&'static str>,
}

impl Lesson {
    /// Reads a lesson.
    ///
    /// # Errors
    /// All problems, in the order of their lines.
    pub fn parse(text: &str) -> Result<Self, Vec<Problem>> {
        parse(text).map_err(|problems| {
            if !is_translation(text) {
                return problems;
            }
            let help = "open the original: it has the set-up, the conditions and the solutions";
            vec![Problem::new(
                1,
                "this is a translation without its original",
                help,
            )]
        })
    }
}

fn parse(text: &str) -> Result<Lesson, Vec<Problem>> {
    let mut reader = Reader {
        lesson: Lesson {
            language: "en".into(),
            ..Lesson::default()
        },
        problems: Vec::new(),
        part: Part::Text,
        fence: None,
        seen: Vec::new(),
    };
    if text.len() > LONGEST {
        reader.problem(
            1,
            "the lesson is longer than 256 KiB",
            "split it into two lessons",
        );
        return Err(reader.problems);
    }
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let (mut front, mut keys) = (None, Vec::new());
    for (number, line) in (1..).zip(text.lines()) {
        match front {
            None if line.trim() == "+++" => front = Some(true),
            None if line.trim().is_empty() => {}
            Some(true) if line.trim() == "+++" => front = Some(false),
            Some(true) => {
                keys.push(front::key(line));
                if let Err(problem) = front::line(&mut reader.lesson, number, line) {
                    reader.problems.push(problem);
                }
            }
            // Read the rest even without front matter.
            _ => {
                front = Some(false);
                reader.line(number, line);
            }
        }
    }
    reader.end(&keys)
}

impl Reader {
    fn problem(&mut self, line: u32, message: impl Into<String>, help: &str) {
        self.problems.push(Problem::new(line, message, help));
    }

    fn line(&mut self, number: u32, line: &str) {
        let trimmed = line.trim();
        let ticks = trimmed.len() - trimmed.trim_start_matches('`').len();
        if let Some(fence) = &mut self.fence {
            let closes = ticks >= fence.ticks && ticks == trimmed.len();
            if !closes {
                fence.lines.push(line.to_owned());
                return;
            }
            if let Some(fence) = self.fence.take() {
                self.block(fence);
            }
            return;
        }
        if ticks >= 3 {
            self.fence = Some(Fence {
                line: number + 1,
                ticks,
                name: trimmed[ticks..].trim().to_owned(),
                lines: Vec::new(),
            });
        } else if let Some(title) = line.strip_prefix("### ") {
            self.heading(number, title.trim());
        } else if let Some(title) = line.strip_prefix("## ") {
            self.end_step();
            self.lesson.steps.push(Step {
                line: number,
                title: title.trim().to_owned(),
                ..Step::default()
            });
            self.part = Part::Text;
            self.seen.clear();
        } else {
            links::collect(&mut self.lesson, number, line);
            self.prose(line);
        }
    }

    /// `### Hint` and the other headings of this level.
    fn heading(&mut self, number: u32, title: &str) {
        const HELP: &str = "write Hint, Predict or What just happened; for another heading use \
                            `####`";
        let Some(step) = self.lesson.steps.last_mut() else {
            return self.problem(
                number,
                "a part before the first step",
                "begin a step with `## `",
            );
        };
        self.part = match title {
            "Hint" => {
                step.hints.push(String::new());
                Part::Hint
            }
            "What just happened" => Part::Happened,
            "Predict" if step.quiz.is_some() => {
                return self.problem(
                    number,
                    "a step can have only one question",
                    "add another step",
                );
            }
            "Predict" => {
                step.quiz = Some(Quiz {
                    question: String::new(),
                    answer: Pattern::NOTHING,
                    reveal: String::new(),
                    line: 0,
                });
                Part::Question
            }
            _ => return self.problem(number, format!("part `{title}` does not exist"), HELP),
        };
    }

    /// Returns the text to which prose is added now.
    fn target(&mut self) -> &mut String {
        let Some(step) = self.lesson.steps.last_mut() else {
            return &mut self.lesson.intro;
        };
        match (self.part, &mut step.quiz, step.hints.last_mut()) {
            (Part::Hint, _, Some(hint)) => hint,
            (Part::Happened, ..) => &mut step.happened,
            (Part::Question, Some(quiz), _) => &mut quiz.question,
            (Part::Reveal, Some(quiz), _) => &mut quiz.reveal,
            _ => &mut step.text,
        }
    }

    fn prose(&mut self, line: &str) {
        let target = self.target();
        // Skip blank lines at the beginning.
        if !target.is_empty() || !line.trim().is_empty() {
            target.push_str(line.trim_end());
            target.push('\n');
        }
    }

    fn block(&mut self, fence: Fence) {
        if let Some(name) = fence.name.strip_prefix("eds ") {
            let line = fence.line - 1;
            if !self.lesson.steps.is_empty() {
                let help = "move it before the first `## `";
                return self.problem(line, "an `eds` block is inside a step", help);
            }
            let device = (name.trim().to_owned(), fence.lines.join("\n"));
            return self.lesson.eds.push(device);
        }
        let Some(name) = BLOCKS.into_iter().find(|name| *name == fence.name) else {
            let ticks = "`".repeat(fence.ticks);
            self.prose(&format!("{ticks}{}", fence.name));
            for line in &fence.lines {
                let target = self.target();
                target.push_str(line);
                target.push('\n');
            }
            return self.prose(&ticks);
        };
        let line = fence.line - 1;
        if name != "facts" && self.seen.contains(&name) {
            let message = format!("a second `{name}` block");
            return self.problem(line, message, "add its lines to the first block");
        }
        self.seen.push(name);
        let before_steps = self.lesson.steps.is_empty();
        if before_steps != (name == "set-up") {
            let (message, help) = match name {
                "set-up" => (
                    "the set-up is inside a step",
                    "move it before the first `## `",
                ),
                _ => ("a block before the first step", "begin a step with `## `"),
            };
            return self.problem(line, message, help);
        }
        let block = Block {
            line: fence.line,
            text: fence.lines.join("\n"),
        };
        match name {
            "checkpoint" => self.checkpoint(&fence),
            "answer" => self.answer(&fence),
            _ => {
                if let Err(problems) = Script::parse_at(&block.text, block.line) {
                    self.problems.extend(problems);
                }
                match self.lesson.steps.last_mut() {
                    Some(step) if name == "facts" => step.facts.push(block),
                    Some(step) => step.solution = block,
                    None => self.lesson.set_up = block,
                }
            }
        }
    }

    fn checkpoint(&mut self, fence: &Fence) {
        let Some(step) = self.lesson.steps.last_mut() else {
            return;
        };
        for (number, text) in (fence.line..).zip(&fence.lines) {
            match checkpoint::line(number, text, step.checkpoint.last()) {
                Ok(line) => step.checkpoint.extend(line),
                Err(problem) => self.problems.push(problem),
            }
        }
        if self.problems.is_empty() && step.checkpoint.is_empty() {
            let help = "write a condition, such as `came 701#00`";
            self.problem(fence.line, "the checkpoint is empty", help);
        }
    }

    fn answer(&mut self, fence: &Fence) {
        const HELP: &str = "write the frame in one line, such as `581#43 00 10 00 ..*`";
        let quiz = self
            .lesson
            .steps
            .last_mut()
            .and_then(|step| step.quiz.as_mut());
        let Some(quiz) = quiz else {
            let help = "move it below a heading `### Predict`";
            return self.problem(fence.line, "an answer without a question", help);
        };
        let mut lines = fence.lines.iter().filter(|line| !line.trim().is_empty());
        let (Some(line), None) = (lines.next(), lines.next()) else {
            return self.problem(fence.line, "an answer has exactly one frame", HELP);
        };
        match Pattern::parse(line) {
            Ok(answer) => {
                quiz.answer = answer;
                quiz.line = fence.line;
                self.part = Part::Reveal;
            }
            Err(error) => self.problems.push(Problem {
                line: fence.line,
                ..error
            }),
        }
    }

    /// Reports the missing parts of the step that ends.
    fn end_step(&mut self) {
        let Some(step) = self.lesson.steps.last() else {
            return;
        };
        let line = step.line;
        let quiz_open = step.quiz.as_ref().is_some_and(|quiz| quiz.line == 0);
        let lacks = [
            (step.title.is_empty(), "a title", "write it after `## `"),
            (
                step.text.trim().is_empty(),
                "a text",
                "write below the heading what to do",
            ),
            (
                !self.seen.contains(&"checkpoint"),
                "a checkpoint",
                "add a block that begins with three backticks and `checkpoint`",
            ),
            (
                !self.seen.contains(&"solution"),
                "a solution",
                "add a block that begins with three backticks and `solution`",
            ),
            (step.hints.is_empty(), "hints", "add a heading `### Hint`"),
            (
                step.hints.iter().any(|hint| hint.trim().is_empty()),
                "a text of a hint",
                "write it below `### Hint`",
            ),
            (
                step.happened.trim().is_empty(),
                "an explanation",
                "add a heading `### What just happened`",
            ),
            (
                quiz_open && !self.seen.contains(&"answer"),
                "an answer to its question",
                "add a block that begins with three backticks and `answer`",
            ),
        ];
        let title = step.title.clone();
        for (missing, what, help) in lacks {
            if missing {
                self.problem(
                    line,
                    format!(
                        "the step `{title}` has no {}",
                        what.trim_start_matches("a ").trim_start_matches("an ")
                    ),
                    help,
                );
            }
        }
    }

    fn end(mut self, keys: &[&str]) -> Result<Lesson, Vec<Problem>> {
        match self.fence.take() {
            Some(fence) => {
                let help = "close it with the same number of backticks";
                self.problem(fence.line - 1, "this block is not closed", help);
            }
            // The unclosed block contains these parts, so do not report them as missing.
            None => self.end_step(),
        }
        if let Some(problem) = front::missing(keys) {
            self.problems.push(problem);
        }
        if self.lesson.steps.is_empty() {
            self.problem(1, "the lesson has no step", "begin a step with `## `");
        }
        if self.lesson.set_up.line == 0 {
            let help = "add a block that begins with three backticks and `set-up`, with a line \
                        such as `device gxmm node 5`";
            self.problem(1, "the lesson has no set-up", help);
        }
        if self.problems.is_empty() {
            let trim = |text: &mut String| text.truncate(text.trim_end().len());
            trim(&mut self.lesson.intro);
            for step in &mut self.lesson.steps {
                trim(&mut step.text);
                trim(&mut step.happened);
                step.hints.iter_mut().for_each(trim);
                if let Some(quiz) = &mut step.quiz {
                    trim(&mut quiz.question);
                    trim(&mut quiz.reveal);
                }
            }
            return Ok(self.lesson);
        }
        self.problems.sort_by_key(|problem| problem.line);
        Err(self.problems)
    }
}
