//! Calls that do not compile, and the messages of rustc for them: the words in `ui/*.stderr`.
//!
//! One mistake per file; the file's first line describes it. After a change of messages,
//! `TRYBUILD=overwrite cargo test -p od-tests-compile --test ui` writes them again: read them
//! like somebody who made that mistake before you commit them. Calls that compile are in `ui/pass`.

#[test]
fn mistakes_are_told_in_words_that_help() {
    trybuild::TestCases::new().compile_fail("ui/*.rs");
}
