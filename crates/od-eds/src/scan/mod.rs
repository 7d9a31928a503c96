//! Parts that every reader uses: lines, sections, names, numbers and encodings of a text, with
//! their places.

pub(crate) mod encoding;
pub(crate) mod forms;
pub(crate) mod lines;
pub(crate) mod names;
pub(crate) mod number;
pub(crate) mod section;

/// Position of the first of two ASCII characters.
///
/// `find` with an array uses iterators. Without optimisation, as in a macro and in tests, this took
/// two fifths of the time for a file.
pub(crate) fn either(text: &str, either: [u8; 2]) -> Option<usize> {
    let bytes = text.as_bytes();
    let mut at = 0;
    while at < bytes.len() {
        if bytes[at] == either[0] || bytes[at] == either[1] {
            return Some(at);
        }
        at += 1;
    }
    None
}
