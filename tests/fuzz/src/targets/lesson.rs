//! Lessons: every text is read, or refused with line numbers; a valid lesson sets up a bench,
//! asks questions, and judges any answer.

use od_sim::lesson::{Lesson, Progress, pass, translate};

use super::script::{Bounded, WORDS as LINES, is_short};
use crate::files::files;
use crate::target::Target;

pub(super) const TARGET: Target = Target {
    name: "lesson",
    run,
    seeds: || files("playground/lessons", &[".md"], 16_384),
    words: &[
        "+++\n",
        "title = \"x\"\n",
        "level = 4\n",
        "minutes = 0\n",
        "absent = \"2FFFh\"\n",
        "language = \"\"\n",
        "## Step\n",
        "### Predict\n",
        "### Hint\n",
        "### What just happened\n",
        "```set-up\n",
        "```checkpoint\n",
        "```solution\n",
        "```answer\n",
        "```\n",
        "````\n",
        "sent 601#40* -- you ask\n",
        "then came 581#43*\n",
        "came 701#05 3 times within 1s\n",
        "no 181#* for 500ms\n",
        "value 6004h = 5\n",
        "state operational\n",
        "of right\n",
        "device gxmm\n",
        "nmt start\n",
        "wait 100ms\n",
        "power on\n",
        "[a](b)",
        "`6004h`",
        "6004h:01",
        "--",
        "ä",
    ],
    is_text: true,
    longest: 16_384,
    ..Target::PLAIN
};

const NMT: &str = include_str!("../../../../playground/lessons/02-nmt.md");

fn run(input: &[u8]) {
    let text = String::from_utf8_lossy(input);
    let lines = text.lines().count() as u32 + 1;
    // As the translation of a lesson, and of itself.
    for original in [NMT, &text] {
        for problem in translate(original, &text).err().into_iter().flatten() {
            assert!((1..=lines).contains(&problem.line), "{problem}");
        }
    }
    let lesson = match Lesson::parse(&text) {
        Ok(lesson) => lesson,
        Err(problems) => {
            assert!(!problems.is_empty(), "refused without a reason");
            for problem in problems {
                assert!((1..=lines).contains(&problem.line), "{problem}");
            }
            return;
        }
    };
    for (line, target) in lesson.files() {
        assert!((1..=lines).contains(&line), "{target} in line {line}");
    }
    for step in &lesson.steps {
        let Some(quiz) = &step.quiz else { continue };
        for given in ["", "601#40", "7", "05 00", LINES[0], &quiz.question] {
            if let Err(problem) = quiz.judge(given) {
                assert!(!problem.message.is_empty());
            }
        }
    }
    if !is_short(&text) {
        return;
    }
    let mut bench = match lesson.set_up(&mut Bounded(0)) {
        Ok(bench) => bench,
        Err(problem) => {
            assert!((1..=lines).contains(&problem.line), "{problem}");
            return;
        }
    };
    let steps = lesson.steps.len();
    let mut progress = Progress::new(lesson, &mut bench);
    for device in 0..bench.bus.devices().len() {
        bench.bus.set_power(device, true);
    }
    pass(&mut bench.bus, &mut progress, 1_000_000);
    while let Some(step) = progress.poll() {
        assert!(step < steps, "step {step} of {steps}");
    }
    for wanted in progress.requirements(&mut bench.bus) {
        assert!(!wanted.text.is_empty(), "a requirement without words");
    }
}
