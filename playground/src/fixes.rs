//! The fix of a finding.

use crate::crossing::record;

record! {
    /// Edits of the checked text; all of them are applied, or none.
    Fix {
        /// A safe fix: the meaning of the text does not change.
        safe: bool,
        edits: Vec<TextEdit>,
    }

    /// `text` replaces the range from `start` to before `end`, as in `String.slice`.
    TextEdit {
        start: u32,
        end: u32,
        text: String,
    }
}
