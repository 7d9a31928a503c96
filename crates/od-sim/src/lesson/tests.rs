use std::string::ToString;

use super::*;
use crate::script::Bare;

const GOOD: &str = "\
+++
title = \"Start\"
level = 1
minutes = 5
+++
See 1017h.

```set-up
device gxmm node 5
```

## Start it

Send the frame.

```checkpoint
sent nmt start 5
state operational
```

### Predict
Which?
```answer
000#01 05
```
So it is.
### Hint
Two bytes.
### Hint
`000#01 05`
### What just happened
It runs.
```solution
nmt start
```
";

#[track_caller]
fn check(from: &str, to: &str, expected: &str) {
    let text = GOOD.replacen(from, to, 1);
    assert!(
        text != GOOD || from.is_empty(),
        "the lesson contains `{from}`"
    );
    let problems = match Lesson::parse(&text) {
        Ok(lesson) => prove(&lesson, &mut Bare(od_devices::DEVICES)),
        Err(problems) => problems,
    };
    let shown: Vec<_> = problems.iter().map(ToString::to_string).collect();
    assert!(
        shown.join("\n").starts_with(expected),
        "{}",
        shown.join("\n")
    );
    assert_eq!(
        expected.is_empty(),
        problems.is_empty(),
        "{}",
        shown.join("\n")
    );
}

#[test]
fn a_good_lesson_has_no_problems() {
    check("", "", "");
    check("state operational", "state operational\nled green on", "");
    let lesson = Lesson::parse(GOOD).expect("a good lesson");
    assert_eq!((lesson.title.as_str(), lesson.level), ("Start", 1));
    let step = &lesson.steps[0];
    assert_eq!(step.hints, ["Two bytes.", "`000#01 05`"]);
    assert_eq!(
        (step.text.as_str(), step.happened.as_str()),
        ("Send the frame.", "It runs.")
    );
    assert_eq!(
        step.quiz.as_ref().map(|quiz| quiz.reveal.as_str()),
        Some("So it is.")
    );
}

#[test]
fn a_mistake_in_the_form_has_a_line_and_a_help() {
    check("title =", "titel =", "1:1: the lesson has no title");
    for (from, to, line) in [
        (
            "title = \"Start\"",
            "title = Start",
            "2:1: `title` is not a text",
        ),
        (
            "title = \"Start\"",
            "title = \"\"",
            "2:1: `title` is not a text",
        ),
        ("level = 1", "level = 9", "3:1: the level is not valid"),
        (
            "minutes = 5",
            "minutes = 0",
            "4:1: the minutes are not valid",
        ),
    ] {
        check(from, to, line);
        let problems = Lesson::parse(&GOOD.replacen(from, to, 1)).map_err(|all| all.len());
        assert_eq!(problems.err(), Some(1), "{to}");
    }
    check("+++\ntitle", "title", "1:1: the lesson has no title");
    check(
        "minutes = 5",
        "minutes: 5",
        "1:1: the lesson has no minutes",
    );
    check(
        "device gxmm node 5",
        "device gxmm node 500",
        "9:18: `500` is not valid",
    );
    check("```set-up", "```setup", "1:1: the lesson has no set-up");
    check("## Start it", "Start it", "1:1: the lesson has no step");
    check(
        "state operational",
        "state flying",
        "18:7: state `flying` does not exist",
    );
    check(
        "state operational",
        "stat operational",
        "18:1: `stat` is not a condition",
    );
    check(
        "state operational",
        "value = 5",
        "18:7: the object is missing",
    );
    check(
        "state operational",
        "came 705",
        "18:6: `705` is not a frame",
    );
    check(
        "state operational",
        "came 705#05 within 1s",
        "18:1: `within` needs a start",
    );
    check(
        "state operational",
        "state off\nthen came 705#05",
        "19:1: `then` needs a frame in this line",
    );
    check(
        "state operational",
        "not came 1F",
        "18:10: `1F` is not a frame",
    );
    check(
        "state operational",
        "quiet 705#*",
        "18:1: the duration is missing; write",
    );
    check(
        "state operational",
        "state operational --",
        "18:21: the text after `--` is missing",
    );
    check("### Hint", "### Tip", "27:1: part `Tip` does not exist");
    check(
        "### What just happened\nIt runs.\n",
        "",
        "12:1: the step `Start it` has no explanation",
    );
    check(
        "```answer\n000#01 05\n",
        "```answer\n000#zz\n",
        "24:5: `zz` is not a byte",
    );
    check(
        "nmt start\n```",
        "nmt start",
        "33:1: this block is not closed",
    );
    check(
        "```solution",
        "```solution\nnmt explode",
        "34:5: NMT command `explode` does not exist",
    );
}

#[test]
fn a_lesson_that_does_not_work_is_found() {
    check(
        "device gxmm",
        "device gxxx",
        "9:1: `device gxxx node 5` fails",
    );
    check(
        "state operational",
        "value 2FF0h = 1",
        "18:1: object 2FF0h does not exist",
    );
    check(
        "state operational",
        "value 1017h = 99999",
        "18:1: UNSIGNED16 goes from 0 to 65535",
    );
    check(
        "state operational",
        "state operational of left",
        "18:1: the set-up has no device `left`",
    );
    check(
        "state operational",
        "broken overspeed",
        "18:1: this device does not support the fault",
    );
    check(
        "state operational",
        "saved 6004h = 1",
        "18:1: 6004h:00 is not saved",
    );
    check(
        "1017h",
        "1019h",
        "6:1: no device of the set-up has object 1019h:00",
    );
    check(
        "nmt start\n",
        "nmt stop\n",
        "34:1: the solution of `Start it` does not reach",
    );
    check(
        "nmt start\n",
        "sync\nnmt start\n",
        "34:1: the lesson is also done without `sync`",
    );
    check(
        "sent nmt start 5\nstate operational",
        "state pre-operational",
        "12:1: the checkpoint of `Start it` holds at the start",
    );
    check(
        "sent nmt start 5\nstate operational",
        "quiet 705#* for 2s",
        "12:1: the checkpoint of `Start it` holds after a pause",
    );
    check(
        "000#01 05\n```",
        "000#01 06\n```",
        "24:1: the answer 000#0106 does not occur",
    );
}

#[test]
fn a_long_text_without_a_lesson_is_refused_at_once() {
    assert!(Lesson::parse(&"x\n".repeat(200_000)).is_err());
}
