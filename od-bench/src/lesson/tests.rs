use std::format;
use std::string::ToString;

use super::*;
use crate::grammar::pattern::Pattern;
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
        "`{from}` stands in the lesson"
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
fn a_good_lesson_has_nothing_to_mend() {
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
fn mistakes_of_the_form_say_where_and_what_to_do() {
    check("title =", "titel =", "1:1: the lesson has no title");
    check("level = 1", "level = 9", "1:1: the lesson has no level");
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
        "18:1: `within` needs something",
    );
    check(
        "state operational",
        "state off\nthen came 705#05",
        "19:1: `then` needs a frame before",
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
        "18:21: the words behind `--` are missing",
    );
    check("### Hint", "### Tip", "27:1: there is no part `Tip`");
    check(
        "### What just happened\nIt runs.\n",
        "",
        "12:1: the step `Start it` has no explanation",
    );
    check(
        "```answer\n000#01 05\n",
        "```answer\n000#zz\n",
        "24:5: `zz` is no byte",
    );
    check("nmt start\n```", "nmt start", "33:1: this block has no end");
    check(
        "```solution",
        "```solution\nnmt explode",
        "34:5: NMT command `explode` does not exist",
    );
}

#[test]
fn what_does_not_work_is_found() {
    check(
        "device gxmm",
        "device gxxx",
        "9:1: `device gxxx node 5` does not work",
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
        "6:1: no device of the set-up has 1019h:00",
    );
    check(
        "nmt start\n",
        "nmt stop\n",
        "34:1: the solution of `Start it` does not reach",
    );
    check(
        "nmt start\n",
        "sync\nnmt start\n",
        "34:1: the lesson is done without `sync`, too",
    );
    check(
        "sent nmt start 5\nstate operational",
        "state pre-operational",
        "12:1: the checkpoint of `Start it` holds at the start",
    );
    check(
        "sent nmt start 5\nstate operational",
        "quiet 705#* for 2s",
        "12:1: the checkpoint of `Start it` holds by waiting alone",
    );
    check(
        "000#01 05\n```",
        "000#01 06\n```",
        "24:1: the answer 000#0106 does not come",
    );
}

/// Plays lines on the bench of a lesson with this checkpoint, and answers whether they reach it.
#[track_caller]
fn reaches(checkpoint: &str, lines: &str) -> bool {
    let text = GOOD.replacen("sent nmt start 5\nstate operational", checkpoint, 1);
    let lesson = Lesson::parse(&text).expect(checkpoint);
    let mut bench = lesson
        .set_up(&mut Bare(od_devices::DEVICES))
        .expect("its device is built in");
    let mut progress = Progress::new(lesson, &mut bench);
    let script = Script::parse(lines).expect(lines);
    let mut host = Bare(od_devices::DEVICES);
    let mut watched = Watched {
        host: &mut host,
        progress: &mut progress,
    };
    run_on(&script, &mut bench, &mut watched).expect(lines);
    progress.is_done()
}

#[test]
fn conditions_hold_when_they_should() {
    for (checkpoint, lines, holds) in [
        (
            "came 705#7F 3 times every 100ms",
            "sdo write 1017h = 100\nwait 300ms",
            true,
        ),
        (
            "came 705#7F 3 times every 100ms",
            "sdo write 1017h = 200\nwait 3s",
            false,
        ),
        (
            "came 705#7F 3 times every 90ms to 250ms",
            "sdo write 1017h = 200\nwait 3s",
            true,
        ),
        (
            "came 705#7F 3 times",
            "sdo write 1017h = 100\nwait 299ms",
            false,
        ),
        ("came read 1017h", "sdo read 1017h", true),
        ("came read 1017h", "sdo write 1017h = 5", false),
        (
            "came write 1017h or came read 1018h:01",
            "sdo read 1018h:01",
            true,
        ),
        (
            "came abort 06020000h",
            "sdo read 2FF0h aborts 06020000h",
            true,
        ),
        ("came abort", "sdo read 1017h", false),
        ("came emcy FF00h", "fault battery-low on", true),
        ("came boot-up", "nmt reset", true),
        ("came boot-up of 2", "nmt reset", false),
        ("seen 080#", "sync", true),
        ("came 080#", "sync", false),
        ("sent sync 2 times", "sync 2 times every 5ms", true),
        ("sent sync\nthen sent nmt start", "sync\nnmt start", true),
        ("sent sync\nthen sent nmt start", "nmt start\nsync", false),
        (
            "sent sync\nthen sent nmt start within 5ms",
            "sync\nwait 6ms\nnmt start",
            false,
        ),
        (
            "sent sync\nthen sent nmt start within 5ms",
            "sync\nwait 6ms\nsync\nnmt start",
            true,
        ),
        (
            "sent sync\nnot came abort",
            "sync\nsdo read 2FF0h aborts 06020000h",
            true,
        ),
        (
            "sent sync\nsent nmt stop\nnot sent 605#*",
            "sync\nsdo read 1017h\nnmt stop",
            false,
        ),
        (
            "sent sync\nsent nmt stop\nnot sent 605#*",
            "sdo read 1017h\nsync\nnmt stop",
            true,
        ),
        ("value 1017h in 400..600", "sdo write 1017h = 500", true),
        ("value 1017h > 500", "sdo write 1017h = 500", false),
        ("value 1017h >= 500", "sdo write 1017h = 500", true),
        ("value 1008h = \"GXMM\"", "", false),
        ("saved 1017h = 500", "sdo write 1017h = 500", false),
        (
            "saved 1017h = 500",
            "sdo write 1017h = 500\nsdo write 1010h:01 = \"save\"",
            true,
        ),
        ("turned >= 0.5", "shaft turn -0.5", true),
        ("turned >= 0.5", "shaft rpm 60\nwait 400ms", false),
        ("rpm in 59..61", "shaft rpm 60", true),
        ("not state pre-operational", "nmt start", true),
        ("state operational for 1s", "nmt start\nwait 999ms", false),
        (
            "state operational for 1s",
            "nmt start\nwait 400ms\nwait 600ms",
            true,
        ),
        ("led red on", "fault position-error on", true),
        ("broken battery-low", "fault battery-low on", true),
        ("node-id = 9", "switch node 9\npower cycle", true),
        ("bitrate = 50\nsent sync", "sync", true),
        ("quiet 705#* for 1s\nsent sync", "wait 2s\nsync", true),
        (
            "quiet 705#* for 1s\nsent sync",
            "nmt reset\nwait 900ms\nsync",
            false,
        ),
    ] {
        // What holds already at the start is not what these are about.
        let lines = format!("{lines}\nwait 0ms");
        let expected = holds || checkpoint.starts_with("value 1008h");
        assert_eq!(
            reaches(checkpoint, &lines),
            expected,
            "{checkpoint}\n{lines}"
        );
    }
}

#[test]
fn what_is_missing_is_said_in_words() {
    let lesson = Lesson::parse(&GOOD.replacen(
        "sent nmt start 5\nstate operational",
        "sent 000#01 05\ncame 705#05 3 times\nvalue 1017h = 100\nled green on -- see the LED",
        1,
    ));
    let lesson = lesson.expect("a good lesson");
    let mut bench = lesson
        .set_up(&mut Bare(od_devices::DEVICES))
        .expect("its device is built in");
    let mut progress = Progress::new(lesson, &mut bench);
    let said = |progress: &mut Progress, bench: &mut Bench| {
        let all = progress.requirements(&mut bench.bus);
        let line = |one: &Requirement| format!("{} {}", u8::from(one.holds), one.text);
        all.iter().map(line).collect::<Vec<_>>()
    };
    assert_eq!(
        said(&mut progress, &mut bench),
        [
            "0 you send `000#0105` (NMT node 5: start)",
            "0 a device sends `705#05` (NMT EC node 5: Operational), 3 times",
            "0 1017h Producer heartbeat time is 100 (it is 0)",
            "0 see the LED (it is flashing)",
        ]
    );
    let script = "sdo write 1017h = 100\nnmt start\nwait 200ms";
    let mut watched = Watched {
        host: &mut Bare(od_devices::DEVICES),
        progress: &mut progress,
    };
    let script = Script::parse(script).expect("a script");
    run_on(&script, &mut bench, &mut watched).expect("it runs");
    let said = said(&mut progress, &mut bench);
    assert!(said[0].starts_with('1') && said[2].starts_with('1') && said[3].starts_with('1'));
    assert!(said[1].ends_with("3 times (2 of 3 so far)"), "{}", said[1]);
}

#[test]
fn an_answer_is_judged_byte_by_byte() {
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

#[test]
fn no_text_panics_or_takes_long() {
    let pieces: Vec<_> = GOOD.split_inclusive('\n').collect();
    let mut state = 1u32;
    for _ in 0..2000 {
        let mut text = String::new();
        for _ in 0..state % 40 {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            let piece = pieces[(state >> 16) as usize % pieces.len()];
            text.push_str(&piece[..piece.len() - (state as usize >> 8) % piece.len()]);
        }
        state = state.wrapping_mul(1_664_525).wrapping_add(1);
        let _ = Lesson::parse(&text);
    }
    assert!(Lesson::parse(&"x\n".repeat(200_000)).is_err());
}
