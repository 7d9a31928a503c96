//! `odkit lesson`: the page's lessons without the page.

use std::fs;
use std::path::Path;

use od_devices::sim::lesson::{Lesson, Stuck, solve};
use od_devices::sim::script::Bare;

use crate::Failure;
use crate::output::{self, Output};

/// The lessons that come with odkit, in their order.
const LESSONS: &[(&str, &str)] = &[
    ("boot-up", include_str!("../../lessons/01-boot-up.md")),
    ("nmt", include_str!("../../lessons/02-nmt.md")),
    ("sdo", include_str!("../../lessons/03-sdo.md")),
    ("aborts", include_str!("../../lessons/04-aborts.md")),
    ("guarding", include_str!("../../lessons/05-guarding.md")),
    ("pdo-sync", include_str!("../../lessons/06-pdo-sync.md")),
    ("mapping", include_str!("../../lessons/07-mapping.md")),
    ("scaling", include_str!("../../lessons/08-scaling.md")),
    ("store", include_str!("../../lessons/09-store.md")),
    ("lss", include_str!("../../lessons/10-lss.md")),
    ("emcy", include_str!("../../lessons/11-emcy.md")),
    ("gear", include_str!("../../lessons/12-gear.md")),
    (
        "find-silent-node",
        include_str!("../../lessons/13-find-silent-node.md"),
    ),
    (
        "find-terminator",
        include_str!("../../lessons/14-find-terminator.md"),
    ),
    (
        "find-two-nodes",
        include_str!("../../lessons/15-find-two-nodes.md"),
    ),
];

/// Solve a lesson without the page, or list those that there are
///
/// Every step is done by its own solution, and none may be done before. Exit code 0: all
/// went well; 1: a step is stuck, and it is shown what is missing; 2: a lesson cannot be read.
#[derive(clap::Args)]
pub(crate) struct Args {
    /// Lessons: Markdown files, or names of those that come with odkit; none lists these
    lessons: Vec<String>,
}

pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    let mut output = Output::new();
    if args.lessons.is_empty() {
        for (name, text) in LESSONS {
            let lesson = parse(name, text)?;
            output.line(&format!("{name:<20} {}", lesson.title))?;
        }
        return Ok(());
    }
    let mut failed = false;
    for wanted in &args.lessons {
        let (name, text) = find(wanted)?;
        let lesson = parse(&name, &text)?;
        match solve(&lesson, &mut Bare) {
            Ok(()) => {
                let steps = lesson.steps.len();
                output.line(&format!("{name}: {steps} steps solved"))?;
            }
            Err(stuck) => {
                failed = true;
                output::error(&describe(&name, &lesson, &stuck));
            }
        }
    }
    if failed {
        return Err(Failure::Reported(1));
    }
    Ok(())
}

fn find(wanted: &str) -> Result<(String, String), Failure> {
    if let Some((name, text)) = LESSONS.iter().find(|(name, _)| *name == wanted) {
        return Ok(((*name).into(), (*text).into()));
    }
    match fs::read(Path::new(wanted)) {
        Ok(bytes) => Ok((wanted.into(), String::from_utf8_lossy(&bytes).into_owned())),
        Err(error) => Err(Failure::Usage(format!(
            "{wanted}: {error}; `odkit lesson` lists the lessons that come with odkit"
        ))),
    }
}

fn parse(name: &str, text: &str) -> Result<Lesson, Failure> {
    Lesson::parse(text).map_err(|problems| {
        let all: Vec<_> = problems
            .iter()
            .map(|problem| format!("{name}:{problem}"))
            .collect();
        Failure::Usage(all.join("\n"))
    })
}

fn describe(name: &str, lesson: &Lesson, stuck: &Stuck) -> String {
    let step = match stuck.step {
        Some(number) => {
            let title = lesson.steps.get(number).map_or("", |step| &step.title);
            format!("step {} “{title}”", number + 1)
        }
        None => String::from("its start"),
    };
    let mut text = format!("{name}: {step}: {}", stuck.why);
    for line in &stuck.lines {
        let mark = if line.done { "done   " } else { "missing" };
        text.push_str(&format!("\n  {mark}  {}", line.text));
        if !line.missing.is_empty() {
            text.push_str(&format!(" ({})", line.missing));
        }
    }
    text
}
