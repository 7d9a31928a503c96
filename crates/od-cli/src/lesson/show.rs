//! `odkit lesson show`: the text of a lesson.

use std::path::PathBuf;

use od_sim::lesson::{Lesson, Step};

use super::builtin::Language;
use super::file::File;
use crate::failure::Failure;
use crate::{output, report};

#[derive(clap::Args)]
pub(super) struct Args {
    /// The lesson
    file: PathBuf,
    /// Language of the lesson's text, if it is translated
    #[arg(long, value_enum, value_name = "CODE", default_value_t)]
    lang: Language,
    /// Show only this step, counted from 1
    #[arg(long, value_name = "N")]
    step: Option<usize>,
    /// Number of hints to show for each step
    #[arg(long, value_name = "N", default_value_t = 0)]
    hints: usize,
    /// Show the solution and the explanation too
    #[arg(long)]
    solution: bool,
}

pub(super) fn run(args: &Args) -> Result<(), Failure> {
    let lesson = File::read(&args.file, args.lang)?.usable()?;
    let steps = lesson.steps.len();
    if args.step.is_some_and(|step| step == 0 || step > steps) {
        let step = args.step.unwrap_or_default();
        return Err(Failure::Usage(format!(
            "step {step} does not exist; the lesson has steps 1 to {steps}"
        )));
    }
    output::print(&text(&lesson, args))
}

fn text(lesson: &Lesson, args: &Args) -> String {
    let mut text = String::new();
    if args.step.is_none() {
        let steps = report::plural(lesson.steps.len(), "step");
        let (level, minutes) = (lesson.level, lesson.minutes);
        text.push_str(&format!(
            "# {}\n\nLevel {level}, {minutes} minutes, {steps}.\n\n{}\n",
            lesson.title, lesson.intro
        ));
        text.push_str(&block("On the bench:", &lesson.set_up.text));
    }
    let wanted = |number: usize| args.step.is_none_or(|step| step == number);
    for (number, step) in (1..)
        .zip(&lesson.steps)
        .filter(|(number, _)| wanted(*number))
    {
        text.push_str(&step_text(number, step, args));
    }
    text
}

fn step_text(number: usize, step: &Step, args: &Args) -> String {
    let mut text = format!("\n## {number}. {}\n\n{}\n", step.title, step.text);
    if let Some(quiz) = &step.quiz {
        text.push_str(&format!("\n**Predict:** {}\n", quiz.question));
        if args.solution {
            text.push_str(&format!("\nAnswer: `{}`. {}\n", quiz.answer, quiz.reveal));
        }
    }
    for (number, hint) in (1..).zip(step.hints.iter().take(args.hints)) {
        text.push_str(&format!("\nHint {number}: {hint}\n"));
    }
    if args.solution {
        text.push_str(&block("Solution:", &step.solution.text));
        text.push_str(&format!("\nWhat just happened: {}\n", step.happened));
    }
    text
}

fn block(title: &str, lines: &str) -> String {
    let lines: Vec<_> = lines.lines().map(|line| format!("    {line}")).collect();
    format!("\n{title}\n\n{}\n", lines.join("\n"))
}
