//! Questions about the bytes of a later frame.

use std::prelude::v1::*;
use std::vec;

use crate::grammar::pattern::Pattern;
use crate::grammar::problem::Problem;
use crate::logs::candump;

/// A question, its answer, and the explanation.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Quiz {
    /// The question, as Markdown.
    pub question: String,
    /// The frame; bytes that do not matter are gaps.
    pub answer: Pattern,
    /// Text that is shown with the answer, as Markdown.
    pub reveal: String,
    /// Line number of the answer.
    pub line: u32,
}

/// Result of comparing an answer.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Judgement {
    /// All correct.
    pub right: bool,
    /// The CAN-ID is wrong.
    pub wrong_identifier: bool,
    /// The number of bytes is wrong.
    pub wrong_length: bool,
    /// Numbers of the wrong bytes, counted from 0.
    pub wrong_bytes: Vec<usize>,
}

impl Quiz {
    /// Like [`judge`], with the answer of this question.
    ///
    /// # Errors
    /// The text is not a frame.
    pub fn judge(&self, given: &str) -> Result<Judgement, Problem> {
        judge(&self.answer, given)
    }
}

/// Compares a prediction: `585#43 00 10 00`, or only its bytes.
///
/// # Errors
/// The text is neither.
pub fn judge(answer: &Pattern, given: &str) -> Result<Judgement, Problem> {
    let given = given.trim();
    let whole = if given.contains('#') {
        given.to_uppercase()
    } else {
        std::format!("{}#{given}", answer.id())
    };
    let frame = candump::parse_frame(&whole)?;
    let mut judgement = Judgement {
        right: answer.matches(&frame),
        wrong_identifier: answer.id() != frame.id(),
        wrong_length: false,
        wrong_bytes: vec![],
    };
    if let Some(bytes) = answer.bytes() {
        judgement.wrong_length = if answer.is_open() {
            frame.data().len() < bytes.len()
        } else {
            frame.data().len() != bytes.len()
        };
        let wrong = |(at, byte): (usize, &Option<u8>)| {
            let given = frame.data().get(at)?;
            byte.filter(|byte| byte != given).map(|_| at)
        };
        judgement.wrong_bytes = bytes.iter().enumerate().filter_map(wrong).collect();
    }
    Ok(judgement)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_answer_is_compared_byte_by_byte() {
        let judge = |given| {
            judge(
                &Pattern::parse("585#43 17 .. 00").expect("a pattern"),
                given,
            )
        };
        let right = judge("43 17 99 00").expect("bytes");
        assert!(right.right && right.wrong_bytes.is_empty());
        let wrong = judge("586#44 17 99").expect("a frame");
        assert!(!wrong.right && wrong.wrong_identifier && wrong.wrong_length);
        assert_eq!(wrong.wrong_bytes, [0]);
        assert!(judge("what").is_err() && judge("585#4").is_err());
    }
}
