//! Frames over several lines: a line that a terminal or a mail broke, or one field in each line.

use std::prelude::v1::*;

/// The lines of a log in which each frame is in one line. The lines that were joined to the one before are empty, so the numbers
/// of the others stay.
///
/// | form | example |
/// |---|---|
/// | a broken line | `can0  601   [8]  40 00 10`, then `00 00 00 00 00` |
/// | a field in each line | `ID = 0x601`, then `Length = 8`, then `Data = 40 00 10 00 00 00 00 00` |
pub(super) fn joined(lines: Vec<&str>) -> Vec<String> {
    let mut all: Vec<String> = Vec::with_capacity(lines.len());
    // The line that the next one may continue.
    let mut open = None;
    for line in lines {
        let words = || line.split_whitespace();
        let last = open.and_then(|at: usize| all.get_mut(at));
        let may_follow = last.filter(|last| {
            let is_rest = words().next().is_some() && words().all(is_byte) && words().count() < 8;
            is_rest && last.split_whitespace().next_back().is_some_and(is_byte)
                || is_field(line) && !is_id(line) && is_id(last) && last.len() < LONGEST
        });
        if let Some(last) = may_follow {
            last.push(' ');
            last.push_str(line.trim());
            all.push(String::new());
        } else {
            open = (!line.trim().is_empty()).then_some(all.len());
            all.push(line.into());
        }
    }
    all
}

/// A frame in fields is not longer.
const LONGEST: usize = 400;

fn is_byte(word: &str) -> bool {
    word.len() == 2 && word.bytes().all(|digit| digit.is_ascii_hexdigit())
}

/// A field: a name of letters, perhaps with an index, `=` or `:`, and a value.
fn is_field(line: &str) -> bool {
    let Some((name, value)) = line.trim().split_once(['=', ':']) else {
        return false;
    };
    let is_name = |c: char| c.is_ascii_alphanumeric() || " []_-".contains(c);
    let begins = name.starts_with(|c: char| c.is_ascii_alphabetic());
    begins && name.len() <= 20 && name.chars().all(is_name) && !value.trim().is_empty()
}

/// Returns whether a line begins with a field that is a CAN-ID, and has no other field of it.
fn is_id(line: &str) -> bool {
    let name = line.trim().split(['=', ':']).next().unwrap_or_default();
    let mut words = name.split([' ', '-', '_']);
    is_field(line)
        && words.any(|word| matches!(&*word.to_ascii_lowercase(), "id" | "cobid" | "canid"))
}

#[cfg(test)]
mod tests {
    use crate::logs::{What, read};
    use std::format;
    use std::prelude::v1::*;

    fn told(text: &str) -> Vec<String> {
        let log = read(text.as_bytes()).expect("a log");
        let frames = log.records.iter().map(|record| match record.what {
            What::Frame(frame) => format!("{frame}"),
            What::Error(_) => "error".into(),
        });
        let problems = log.skipped.iter().map(|problem| format!("{problem}"));
        frames.chain(problems).collect()
    }

    #[test]
    fn a_line_that_was_broken_is_one_frame() {
        let text = "  can0  601   [8]  40 00 10\n  00 00 00 00 00\n  can0  581   [8]  43 00 10 00 92 01\n02 00\n  can0  701   [1]  05\n  can0 zzz\n";
        let read = ["601#4000100000000000", "581#4300100092010200", "701#05"];
        assert_eq!(told(text)[..3], read);
        assert!(told(text)[3].starts_with("line 6: "));
    }

    #[test]
    fn fields_in_lines_of_their_own_are_one_frame() {
        let text = "Request\nSTD ID = 0x606\nRTR = NO\nLength = 4\nData[0] = 0x40\nData[1] = 0x05\nData[2] = 0x10\nData[3] = 0x00\n\n\
            Response\nID: 586\nDLC: 8\nData: 43 05 10 00 80 00 00 00\n";
        assert_eq!(told(text)[..2], ["606#40051000", "586#4305100080000000"]);
    }
}
