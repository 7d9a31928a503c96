//! The words of a line, with their columns. The grammar and the logs use it.

/// The rest of a line, read word by word.
#[derive(Clone, Copy)]
pub(crate) struct Cursor<'t> {
    /// The rest, without blanks at its start.
    pub(crate) text: &'t str,
    /// Its column in characters, counted from 1.
    pub(crate) column: usize,
}

impl<'t> Cursor<'t> {
    pub(crate) fn new(text: &'t str) -> Self {
        let mut cursor = Self { text, column: 1 };
        cursor.skip(0);
        cursor
    }

    /// Passes a number of bytes, and the blanks after them.
    pub(crate) fn skip(&mut self, bytes: usize) {
        let rest = self.text[bytes..].trim_start();
        let passed = &self.text[..self.text.len() - rest.len()];
        self.column += passed.chars().count();
        self.text = rest;
    }

    /// The next word; empty at the end of the line.
    pub(crate) fn peek(&self) -> &'t str {
        self.text.split_whitespace().next().unwrap_or("")
    }

    /// Takes the next word.
    pub(crate) fn next(&mut self) -> &'t str {
        let word = self.peek();
        self.skip(word.len());
        word
    }
}
