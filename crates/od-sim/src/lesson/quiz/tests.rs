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
