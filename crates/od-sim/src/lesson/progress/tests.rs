use std::format;

use super::*;
use crate::lesson::{Lesson, Watched};
use crate::script::{Bare, Script, run_on};

/// The bench of a lesson whose only step has this checkpoint.
#[track_caller]
fn begin(checkpoint: &str) -> (Bench, Progress) {
    let text = format!(
        "+++\ntitle = \"Start\"\nlevel = 1\nminutes = 5\n+++\n\
         ```set-up\ndevice gxmm node 5\n```\n\
         ## Start it\nSend the frame.\n```checkpoint\n{checkpoint}\n```\n\
         ### Hint\nTwo bytes.\n### What just happened\nIt runs.\n\
         ```solution\nnmt start\n```\n"
    );
    let lesson = Lesson::parse(&text).expect(checkpoint);
    let bench = lesson.set_up(&mut Bare(od_devices::DEVICES));
    let mut bench = bench.expect("its device is built in");
    let progress = Progress::new(lesson, &mut bench);
    (bench, progress)
}

#[track_caller]
fn play(lines: &str, bench: &mut Bench, progress: &mut Progress) {
    let script = Script::parse(lines).expect(lines);
    let mut host = Bare(od_devices::DEVICES);
    let mut watched = Watched {
        host: &mut host,
        progress,
    };
    run_on(&script, bench, &mut watched).expect(lines);
}

/// Plays lines on the bench of a lesson with this checkpoint, and returns whether they reach it.
#[track_caller]
fn reaches(checkpoint: &str, lines: &str) -> bool {
    let (mut bench, mut progress) = begin(checkpoint);
    play(lines, &mut bench, &mut progress);
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
            "sdo write 1017h = 100\nwait 290ms",
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
        // It holds at the start, and waits for an action.
        (
            "value 1008h = \"GXMM\"",
            "wait 1s\nexpect node-id = 5\nskip",
            false,
        ),
        ("value 1008h = \"GXMM\"", "sync", true),
        ("value 1008h = \"GXMM\"", "random sync", true),
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
        (
            "disturbed 16 times\ntec = 128\ncontroller error-passive",
            "sdo write 1017h = 100\nline unplug\nwait 500ms",
            true,
        ),
        ("disturbed\nsent sync", "sync", false),
        ("quiet 705#* for 1s\nsent sync", "wait 2s\nsync", true),
        (
            "quiet 705#* for 1s\nsent sync",
            "nmt reset\nwait 900ms\nsync",
            false,
        ),
    ] {
        assert_eq!(reaches(checkpoint, lines), holds, "{checkpoint}\n{lines}");
    }
}

#[test]
fn a_response_takes_its_time_unless_the_set_up_says_line_ideal() {
    let checkpoint = "sent 605#40 17 10*\nthen came 585#4B 17 10* within 200us";
    assert!(!reaches(checkpoint, "sdo read 1017h"));
    assert!(reaches(checkpoint, "line ideal\nsdo read 1017h"));
    let (bench, _) = begin(checkpoint);
    assert!(bench.bus.line.is_real());
}

#[test]
fn missing_conditions_are_described_in_words() {
    let (mut bench, mut progress) = begin(
        "sent 000#01 05\ncame 705#05 3 times\nvalue 1017h = 100\nled green on -- see the LED",
    );
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
    play(
        "sdo write 1017h = 100\nnmt start\nwait 200ms",
        &mut bench,
        &mut progress,
    );
    let said = said(&mut progress, &mut bench);
    assert!(said[0].starts_with('1') && said[2].starts_with('1') && said[3].starts_with('1'));
    assert!(said[1].ends_with("3 times (2 of 3 so far)"), "{}", said[1]);
}

#[test]
fn a_lesson_in_german_says_in_german_how_a_condition_stands() {
    let (mut bench, mut progress) = begin(
        "led green on -- A\nled red on -- B\nled green off -- C\nbroken position-error -- D\nmaster 5 started -- E\n\
         state stopped -- F\nvalue 1017h = 100 -- G",
    );
    progress.lesson.language = "de".into();
    let all = progress.requirements(&mut bench.bus);
    let said: Vec<_> = all.iter().map(|one| one.text.as_str()).collect();
    assert_eq!(
        said,
        [
            "A (jetzt blinkend)",
            "B (jetzt aus)",
            "C (jetzt blinkend)",
            "D (jetzt nicht aktiv)",
            "E (jetzt noch nicht gebootet)",
            "F (jetzt Pre-operational)",
            "G (jetzt 0)",
        ]
    );
    assert_eq!(
        german("failed, error status D"),
        "aufgegeben, Fehlerstatus D"
    );
}

#[test]
fn a_condition_that_is_met_when_a_step_begins_counts_after_a_change() {
    let (mut bench, mut progress) =
        begin("value 1017h = 0\nled red off\nnot came abort\nsent sync");
    let already = |bench: &mut Bench, progress: &mut Progress| {
        let all = progress.requirements(&mut bench.bus);
        let one = |one: &Requirement| (one.holds, one.already);
        all.iter().map(one).collect::<Vec<_>>()
    };
    let (open, so, done) = ((false, false), (true, true), (true, false));
    assert_eq!(already(&mut bench, &mut progress), [so, so, so, open]);
    play("sdo write 1017h = 100", &mut bench, &mut progress);
    assert_eq!(already(&mut bench, &mut progress), [open, so, so, open]);
    play("sdo write 1017h = 0", &mut bench, &mut progress);
    assert_eq!(already(&mut bench, &mut progress), [done, so, so, open]);
}

#[test]
fn a_step_that_an_earlier_action_met_waits_for_an_action_of_its_own() {
    let (mut bench, mut progress) = begin("came 705#7F 3 times every 100ms");
    play("sdo write 1017h = 100", &mut bench, &mut progress);
    progress.begin(0, &mut bench.bus);
    play("wait 2s", &mut bench, &mut progress);
    assert!(progress.is_idle() && !progress.is_done());
    play("sdo write 1017h = 100", &mut bench, &mut progress);
    assert!(progress.is_done());
}

#[test]
fn a_condition_that_no_longer_holds_is_lost() {
    let (mut bench, mut progress) = begin("came abort\nvalue 6001h = 8192");
    let lost = |bench: &mut Bench, progress: &mut Progress| {
        let all = progress.requirements(&mut bench.bus);
        all.iter().map(|one| one.lost).collect::<Vec<_>>()
    };
    play("wait 1ms", &mut bench, &mut progress);
    assert_eq!(lost(&mut bench, &mut progress), [false, false]);
    play("sdo write 6001h = 1000", &mut bench, &mut progress);
    assert_eq!(lost(&mut bench, &mut progress), [false, true]);
    play("sdo write 6001h = 8192", &mut bench, &mut progress);
    assert_eq!(lost(&mut bench, &mut progress), [false, false]);
}
