//! Every lesson: its solutions solve it, and no step is done before its own.

use std::fs;
use std::path::{Path, PathBuf};

use od_devices::sim::lesson::{Lesson, Progress, begin, solve};
use od_devices::sim::script::Bare;

fn lessons() -> Vec<(PathBuf, String)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../lessons");
    let mut files: Vec<_> = fs::read_dir(folder)
        .expect("the folder of lessons")
        .map(|entry| entry.expect("an entry").path())
        .filter(|path| {
            path.extension().is_some_and(|end| end == "md") && !path.ends_with("README.md")
        })
        .collect();
    files.sort();
    let read = |path: PathBuf| {
        let text = fs::read_to_string(&path).expect("a readable lesson");
        (path, text)
    };
    files.into_iter().map(read).collect()
}

fn parse(path: &Path, text: &str) -> Lesson {
    Lesson::parse(text).unwrap_or_else(|problems| panic!("{}: {problems:?}", path.display()))
}

#[test]
fn there_are_at_least_twelve() {
    assert!(lessons().len() >= 12);
}

#[test]
fn every_solution_passes_and_every_start_fails() {
    for (path, text) in lessons() {
        let lesson = parse(&path, &text);
        if let Err(stuck) = solve(&lesson, &mut Bare) {
            panic!("{}: {stuck:#?}", path.display());
        }
    }
}

#[test]
fn doing_nothing_does_no_step() {
    for (path, text) in lessons() {
        let lesson = parse(&path, &text);
        let mut bench = begin(&lesson, &mut Bare).expect("a bench");
        let mut progress = Progress::new(&lesson, &bench.bus);
        let until = bench.bus.now().plus_micros(10_000_000);
        while bench.bus.advance_until_sent(until) {
            while let Some(sent) = bench.bus.poll() {
                progress.frame(sent.at, true, &sent.frame);
            }
            while let Some(one) = bench.bus.line.poll() {
                progress.disturbed(one.at);
            }
            assert!(!progress.look(&mut bench.bus), "{}", path.display());
        }
        assert!(!progress.look(&mut bench.bus), "{}", path.display());
    }
}

#[test]
fn every_step_explains_itself() {
    for (path, text) in lessons() {
        for step in parse(&path, &text).steps {
            let name = format!("{}: {}", path.display(), step.title);
            assert!(!step.text.is_empty(), "{name} has no task");
            assert!(
                !step.happened.is_empty(),
                "{name} does not tell what happened"
            );
            assert!(!step.solution.trim().is_empty(), "{name} has no solution");
            assert!(
                step.checks.iter().all(|check| check.words.is_some()),
                "{name}: a check without words"
            );
        }
    }
}

#[test]
fn mistakes_name_their_line() {
    for (text, line, word) in [
        (
            "---\ntitle: x\n---\n## a\n```check\nseen 701#00\n```\n",
            1,
            "bench",
        ),
        (
            "---\ntitle: x\n---\n```start\ndevise gxmm\n```\n## a\n```check\nstate off\n```\n",
            5,
            "devise",
        ),
        (
            "---\ntitle: x\n---\n```start\ndevice gxmm\n```\n## a\n```check\nstate on\n```\n",
            9,
            "state",
        ),
        (
            "---\ntitle: x\n---\n```start\ndevice gxmm\n```\n## a\n```check\nvalue 6004h\n```\n",
            9,
            "comparison",
        ),
        (
            "---\ntitle: x\n---\n```start\ndevice gxmm\n```\n## a\n```check\nseen 7#0\n",
            8,
            "closed",
        ),
        (
            "```start\ndevice gxmm\n```\n## a\n```check\nstate off\n```\n",
            1,
            "title",
        ),
        (
            "---\ntitle: x\n---\n```start\ndevice gxmm\n```\n## a\ntext\n",
            1,
            "nothing to check",
        ),
    ] {
        let problems = Lesson::parse(text).expect_err(text);
        assert!(
            problems
                .iter()
                .any(|one| one.line == line && one.message.contains(word)),
            "{text}: {problems:?}"
        );
    }
}

#[test]
fn a_missing_device_is_no_answer() {
    let text = "---\ntitle: x\n---\n```start\ndevice gxmm\n```\n## a\n```check\ndevice 3 state off\n```\n\
                ```solution\nnmt start\n```\n";
    let stuck =
        solve(&parse(Path::new("x"), text), &mut Bare).expect_err("there is no third device");
    assert_eq!(stuck.lines[0].missing, "there is no such device");
}
