//! `odkit lesson`: lists, shows, runs and checks lessons; exit codes.

use crate::support::{file, odkit, repository};

fn lesson(name: &str) -> String {
    repository(&format!("playground/lessons/{name}.md"))
}

#[test]
fn lessons_are_listed_run_and_checked() {
    let folder = repository("playground/lessons");
    let list = odkit(&["lesson", "list", &folder], "");
    assert_eq!(list.code, 0, "{}", list.err);
    assert!(list.out.lines().count() >= 12, "{}", list.out);
    assert!(
        list.out
            .contains("level 1, 10 min, 5 steps  Boot-up and heartbeat")
    );
    let builtin = odkit(&["lesson", "list"], "");
    assert_eq!(builtin.out.lines().count(), list.out.lines().count());
    assert!(
        builtin.out.starts_with("boot-up-and-heartbeat  level 1"),
        "{}",
        builtin.out
    );
    let by_name = odkit(&["lesson", "run", "nmt", "--solution"], "");
    assert_eq!(by_name.code, 0, "{}", by_name.err);
    // A test of all crates proves each lesson.
    let few = [lesson("01-boot-up-and-heartbeat"), lesson("02-nmt")];
    let check = odkit(&["lesson", "check", &few[0], &few[1]], "");
    assert_eq!(check.code, 0, "{}", check.err);
    assert!(
        check.err.ends_with("2 lessons, no mistakes\n"),
        "{}",
        check.err
    );
}

#[test]
fn a_lesson_is_shown_without_its_solution() {
    let path = lesson("01-boot-up-and-heartbeat");
    let plain = odkit(&["lesson", "show", &path], "");
    assert_eq!(plain.code, 0, "{}", plain.err);
    assert!(
        plain
            .out
            .starts_with("# Boot-up and heartbeat\n\nLevel 1, 10 minutes, 5 steps.")
    );
    assert!(plain.out.contains("Which frame is it?"));
    assert!(!plain.out.contains("Hint") && !plain.out.contains("sdo write"));
    let all = odkit(
        &[
            "lesson",
            "show",
            &path,
            "--step",
            "2",
            "--hints",
            "1",
            "--solution",
        ],
        "",
    );
    assert!(
        all.out.contains("Hint 1: ") && !all.out.contains("Hint 2: "),
        "{}",
        all.out
    );
    assert!(all.out.contains("    sdo write 1017h = 500\n"));
    let beyond = odkit(&["lesson", "show", &path, "--step", "6"], "");
    assert_eq!((beyond.code, beyond.out.as_str()), (2, ""));
}

#[test]
fn a_lesson_run_reports_open_conditions() {
    let path = lesson("01-boot-up-and-heartbeat");
    let lines = "power on\nsdo write 1017h = 500\nhello\nwait 600ms\n";
    let taken = odkit(&["lesson", "run", &path, "--hints", "2"], lines);
    assert_eq!(taken.code, 1);
    let expected = "(0.001100) can0 705#00\n\
                    # step 1 is done at 0.001100 s: Power the encoder and find its first frame\n\
                    (0.006020) can0 585#6017100000000000\n\
                    (0.504580) can0 705#7F\n\
                    # step 2 of 5 is open: Configure a heartbeat of 500 ms\n\
                    #   holds    1017h is written over the bus\n\
                    #   holds    1017h is 500\n\
                    #   missing  three heartbeats come, half a second apart (1 of 3 so far)\n\
                    # hint 1 of 3: ";
    assert!(taken.out.starts_with(expected), "{}", taken.out);
    assert!(taken.out.contains("# hint 2 of 3: ") && !taken.out.contains("# hint 3"));
    assert!(
        taken
            .err
            .starts_with("-:3:1: `hello` is not a verb or a frame"),
        "{}",
        taken.err
    );
    let echoed = odkit(&["lesson", "run", &path, "--echo"], "power on\n605#40\n");
    assert!(echoed.out.contains("can0 605#40\n"), "{}", echoed.out);
}

#[test]
fn a_solution_does_every_step_and_a_failing_line_is_reported() {
    for name in ["02-nmt", "10-lss", "14-find-terminator"] {
        let solved = odkit(&["lesson", "run", &lesson(name), "--solution"], "");
        assert_eq!(solved.code, 0, "{}{}", solved.out, solved.err);
        assert!(
            solved.out.contains("# the lesson is done: "),
            "{}",
            solved.out
        );
    }
    let lines = "sdo read 5555h\nsdo write 1000h = 1 aborts 06010002h\n";
    let taken = odkit(&["lesson", "run", &lesson("04-aborts")], lines);
    assert_eq!(taken.code, 1);
    assert!(
        taken.err.starts_with("odkit: -: line 1 at "),
        "{}",
        taken.err
    );
    assert!(taken.out.contains("# step 1 is done"), "{}", taken.out);
}

#[test]
fn mistakes_have_a_line_and_a_help() {
    let bad = file(
        "bad-lesson.md",
        "+++\ntitle = \"Bad\"\nlevel = 1\nminutes = 5\n+++\n```set-up\ndevice gxmm\n```\n\
         ## Step\nDo 1019h, see [more](gone.md).\n```checkpoint\nsent nmt start\n```\n### Hint\nNo.\n\
         ### What just happened\nThis.\n```solution\nnmt start\nsync\n```\n",
    );
    let bad = bad.display().to_string();
    let check = odkit(&["lesson", "check", &bad], "");
    assert_eq!(check.code, 1);
    assert!(
        check
            .err
            .contains(":10:1: no device of the set-up has object 1019h:00; "),
        "{}",
        check.err
    );
    assert!(
        check
            .err
            .contains(":10:1: the linked file gone.md does not exist; "),
        "{}",
        check.err
    );
    let form = file("no-lesson.md", "## Step\n```checkpoint\ncame 7\n```\n");
    let form = form.display().to_string();
    let check = odkit(&["lesson", "check", &form], "");
    assert_eq!(check.code, 1);
    assert!(
        check.err.contains(":3:6: `7` is not a frame; "),
        "{}",
        check.err
    );
    for command in ["run", "show"] {
        let refused = odkit(&["lesson", command, &form], "");
        assert_eq!(refused.code, 2);
        assert!(refused.err.contains("see LESSONS.md"), "{}", refused.err);
    }
    let gone = odkit(&["lesson", "check", "gone.md"], "");
    assert_eq!((gone.code, gone.out.as_str()), (2, ""));
    assert!(
        gone.err.contains("gone.md: it does not exist"),
        "{}",
        gone.err
    );
}

#[test]
fn a_lesson_is_shown_in_german_where_it_is_translated() {
    let list = odkit(&["lesson", "list", "--lang", "de"], "");
    assert_eq!(list.code, 0, "{}", list.err);
    assert!(
        list.out.contains("5 steps  Boot-up und Heartbeat\n"),
        "{}",
        list.out
    );
    let show = |name: &str| {
        odkit(
            &[
                "lesson", "show", name, "--step", "1", "--hints", "2", "--lang", "de",
            ],
            "",
        )
    };
    let text = show("nmt").out;
    assert!(
        text.contains("## 1. Starte Knoten 5\n") && text.contains("Hint 2: Sende `000#01 05`"),
        "{text}"
    );
    // The translation is a file beside the lesson. If there is none, a message says so.
    assert_eq!(show(&lesson("02-nmt")).out, text);
    let run = odkit(
        &["lesson", "run", "boot-up-and-heartbeat", "--lang", "de"],
        "power on\n",
    );
    assert!(
        run.out
            .contains("#   missing  1017h Producer heartbeat time ist 500 (jetzt 0)\n"),
        "{}",
        run.out
    );
    let own = file(
        "own-lesson.md",
        &std::fs::read_to_string(lesson("02-nmt")).expect("a lesson"),
    );
    let own = show(&own.display().to_string());
    assert!(own.out.contains("## 1. Start node 5\n"), "{}", own.out);
    assert!(own.err.contains("no translation in `de`"), "{}", own.err);
}

#[test]
fn a_translation_that_does_not_fit_its_lesson_is_a_mistake() {
    let path = file(
        "fits.md",
        &std::fs::read_to_string(lesson("02-nmt")).expect("a lesson"),
    );
    let german = std::fs::read_to_string(lesson("de/02-nmt")).expect("its translation");
    let folder = path.parent().expect("a folder").join("de");
    std::fs::create_dir_all(&folder).expect("a folder");
    let check = |german: &str| {
        std::fs::write(folder.join("fits.md"), german).expect("it can be written");
        odkit(&["lesson", "check", &path.display().to_string()], "")
    };
    assert_eq!(check(&german).code, 0);
    let bad = check(&german.replacen("### Hint\n", "### Predict\n", 1));
    assert_eq!(bad.code, 1, "{}", bad.err);
    assert!(
        bad.err.contains("de/fits.md:") && bad.err.contains("is where the original has"),
        "{}",
        bad.err
    );
    // A translation alone is one message, which names its original.
    let alone = |place: &std::path::Path| {
        let done = odkit(&["lesson", "check", &place.display().to_string()], "");
        assert_eq!(
            (done.code, done.err.lines().count()),
            (1, 2),
            "{}",
            done.err
        );
        done.err
    };
    let translation = folder.join("fits.md");
    std::fs::write(&translation, &german).expect("it can be written");
    let of = format!("this is the translation of {}", path.display());
    assert!(alone(&translation).contains(&of));
    std::fs::remove_file(&path).expect("it can be removed");
    let gone = alone(&translation);
    assert!(
        gone.contains(&format!("its original {} does not exist", path.display())),
        "{gone}"
    );
}

/// The first code is written by the page in playground/web/src/lessons/kept.test.ts.
const CODES: &str = "From Ann:
> odkit-progress/1 learner=Ann%20%C3%9C. nmt=5/5@2026-11-22
> sdo=2/6@2026-11-23 sum=1AD6B914
odkit-progress/1 learner=Bob sdo=6/6@2026-11-24 sum=CE8B1035 Regards
";

#[test]
fn codes_of_learners_become_a_table_and_a_truncated_one_is_reported() {
    let list = odkit(&["lesson", "list"], "").out;
    let lessons = list.lines().count();
    let table = odkit(&["lesson", "progress", "-"], &CODES.replace("> ", ""));
    assert_eq!(table.code, 0, "{}", table.err);
    assert_eq!(
        table.out,
        format!(
            "learner  lessons  steps      2      3\n\
             Ann Ü.         1      7   done    2/6\n\
             Bob            1      6      -   done\n\
             \n2 learners, {lessons} lessons come with odkit\n  2  nmt\n  3  sdo\n"
        )
    );
    // The page did two of these steps; the final test is not a lesson.
    let shown =
        "odkit-progress/1 learner=Eva nmt=5/5~2@2026-11-22 final-test=12/12@2026-11-26 sum=";
    let sum = shown
        .trim_end_matches(" sum=")
        .bytes()
        .fold(0x811C_9DC5_u32, |hash, byte| {
            (hash ^ u32::from(byte)).wrapping_mul(0x0100_0193)
        });
    let table = odkit(&["lesson", "progress", "-"], &format!("{shown}{sum:08X}\n"));
    assert_eq!(table.code, 0, "{}", table.err);
    assert!(
        table
            .out
            .contains("Eva            1      5  done~2   done\n")
            && table.out.contains("  ~  steps that the page did")
            && table
                .out
                .ends_with(&format!(" {}  final-test\n", lessons + 1)),
        "{}",
        table.out
    );
    let cut = odkit(
        &["lesson", "progress", "-"],
        &CODES.replace("sdo=2/6", "sdo=6/6"),
    );
    assert_eq!(cut.code, 1);
    assert!(cut.err.contains("a code is cut or changed"), "{}", cut.err);
    assert!(cut.out.contains("Bob"), "{}", cut.out);
    let none = odkit(&["lesson", "progress", "-"], "Dear trainer,\n");
    assert_eq!((none.code, none.out.as_str()), (1, ""));
    assert!(none.err.contains("contains no code"), "{}", none.err);
    let missing = odkit(&["lesson", "progress", "nosuch.txt"], "");
    assert_eq!(missing.code, 2);
}

#[test]
fn a_fault_case_is_shown_probed_and_marked() {
    let list = odkit(&["lesson", "case"], "");
    assert_eq!(
        (list.code, list.out.lines().count()),
        (0, 20),
        "{}",
        list.err
    );
    let shown = odkit(&["lesson", "case", "dead-end", "--lang", "de"], "");
    assert!(
        shown.out.starts_with("# Die Knoten 4 und 6 sind tot\n"),
        "{}",
        shown.out
    );
    let case = |rest: &[&str]| {
        odkit(
            &[&["lesson", "case", "dead-end", "--seed", "7"], rest].concat(),
            "",
        )
    };
    // Trace, resistance and supply voltage prove one of the four causes: named, it is the one with exit code 0.
    let all = [
        "--probe", "1", "--probe", "2", "--probe", "3", "--probe", "4",
    ];
    let marks: Vec<_> = ["1", "2", "3", "4"]
        .map(|cause| case(&[&all[..], &["--cause", cause]].concat()))
        .into();
    let right: Vec<_> = marks.iter().filter(|mark| mark.code == 0).collect();
    assert_eq!(right.len(), 1);
    assert!(
        right[0].out.contains("\nRight: ")
            && right[0]
                .out
                .contains("Your probes prove it (4); 1 probe can.")
    );
    assert_eq!(
        marks
            .iter()
            .filter(|mark| mark.out.contains("Not right. The cause is: "))
            .count(),
        3
    );
    let guess = case(&["--cause", "1"]);
    assert!(
        guess.code == 1
            && guess
                .out
                .contains("Your probes do not prove it: 4 causes fit them."),
        "{}",
        guess.out
    );
    for (wrong, why) in [
        (
            &["--probe", "9"][..],
            "probe 9 does not exist; the case has probes 1 to 6",
        ),
        (
            &["--cause", "0"],
            "cause 0 does not exist; the case has causes 1 to 4",
        ),
    ] {
        let failed = case(wrong);
        assert!(
            failed.code == 2 && failed.err.contains(why),
            "{}",
            failed.err
        );
    }
    assert_eq!(odkit(&["lesson", "case", "no-such"], "").code, 2);
}
