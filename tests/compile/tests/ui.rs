//! What does not compile, and what rustc says then: the words in `ui/*.stderr`.
//!
//! One mistake a file; the file's first line says which. After a change of words,
//! `TRYBUILD=overwrite cargo test -p od-tests-compile --test ui` writes them anew: read them
//! as somebody who made that mistake before you commit them. What compiles is in `ui/pass`.

#[test]
fn mistakes_are_told_in_words_that_help() {
    trybuild::TestCases::new().compile_fail("ui/*.rs");
}
