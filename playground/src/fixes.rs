//! The fix of a finding.

use crate::crossing::record;

record! {
    /// Edits of the text that was checked; all of them together, or none.
    Fix {
        /// A safe fix: the meaning of the text does not change.
        safe: bool,
        edits: Vec<TextEdit>,
    }

    /// `text` replaces what is from `start` to before `end`, as in `String.slice`.
    TextEdit {
        start: u32,
        end: u32,
        text: String,
    }
}
