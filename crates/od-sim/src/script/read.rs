//! Reads a script. Lines are independent, so every mistake is found.

use std::prelude::v1::*;
use std::vec;

use crate::grammar::action::{Action, When};
use crate::grammar::line::line;
use crate::grammar::problem::Problem;
use crate::grammar::tokens::Tokens;

/// One line with its position in the text.
#[derive(Clone, PartialEq, Debug)]
pub struct Statement {
    /// Counted from 1.
    pub line: u32,
    /// The line without its comment.
    pub text: String,
    /// Time of the action.
    pub when: When,
    /// The action.
    pub action: Action,
}

impl Statement {
    /// The name in a `device` line: a built-in device, or a file.
    pub fn device(&self) -> Option<&str> {
        match &self.action {
            Action::Device(added) => added.name.as_deref(),
            _ => None,
        }
    }
}

/// The lines of a script.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct Script {
    pub(super) statements: Vec<Statement>,
}

impl Script {
    /// Reads a script.
    ///
    /// # Errors
    /// All mistakes, in order.
    pub fn parse(text: &str) -> Result<Self, Vec<Problem>> {
        Self::parse_at(text, 1)
    }

    /// Reads a script inside another text; its first line has this number.
    ///
    /// # Errors
    /// Like [`parse`](Self::parse).
    pub fn parse_at(text: &str, first_line: u32) -> Result<Self, Vec<Problem>> {
        let mut script = Self::default();
        let mut problems = vec![];
        let mut reader = Reader {
            origin: None,
            line: first_line.saturating_sub(1),
        };
        for text in text.lines() {
            match reader.statement(text) {
                Ok(statement) => script.statements.extend(statement),
                Err(problem) => problems.push(problem),
            }
        }
        if problems.is_empty() {
            Ok(script)
        } else {
            Err(problems)
        }
    }

    /// The lines that are not empty, for a program that plays them itself.
    pub fn statements(&self) -> &[Statement] {
        &self.statements
    }

    /// Number of `expect` lines, including SDO lines.
    pub fn expectations(&self) -> usize {
        let expects = |statement: &&Statement| {
            matches!(
                statement.action,
                Action::Expect(_) | Action::Read { .. } | Action::Write { .. }
            )
        };
        self.statements.iter().filter(expects).count()
    }
}

/// Reads a script line by line; each line is a script of its own.
#[derive(Clone, Debug, Default)]
pub struct Reader {
    /// Origin of the time stamps of a log.
    origin: Option<u64>,
    /// Number of lines so far.
    line: u32,
}

impl Reader {
    /// Reads one more line.
    ///
    /// # Errors
    /// The problem of the line.
    pub fn read(&mut self, text: &str) -> Result<Script, Problem> {
        let statements = self.statement(text)?.into_iter().collect();
        Ok(Script { statements })
    }

    /// Reads the next line; `None` if it is empty or only a comment.
    pub(super) fn statement(&mut self, text: &str) -> Result<Option<Statement>, Problem> {
        self.line = self.line.saturating_add(1);
        let tokens = Tokens::new(self.line, text.trim_start_matches('\u{feff}'));
        if tokens.is_empty() {
            return Ok(None);
        }
        let (when, action) = line(tokens, &mut self.origin)?;
        Ok(Some(Statement {
            line: self.line,
            text: tokens.rest().to_owned(),
            when,
            action,
        }))
    }
}
