//! Proof that a lesson works: no step is done at the start, its solutions complete it, and every line
//! of them is needed.

use std::prelude::v1::*;
use std::{format, vec};

use super::content::{Block, Lesson, stopped};
use super::progress::Progress;
use super::watch::{Watched, pass};
use crate::grammar::problem::Problem;
use crate::script::{Bench, Host, Recorder, Script, run_on};

/// Time without any action, in microseconds; no checkpoint may be reached in it.
const IDLE: u64 = 20_000_000;

const NEEDS_ACTION: &str = "add a condition that needs an action";

/// Proves a lesson; `host` makes the devices of its benches.
///
/// Returns problems in order of the lines. There are none if the lesson meets all of this:
///
/// - the set-up and the solutions can be carried out, and the checkpoints can be reached;
/// - no checkpoint holds at the start, nor after a while without any action, nor
///   when the steps before it are done;
/// - each step's solution reaches its checkpoint and no other;
/// - without any one line of the solutions the lesson does not come to its end;
/// - the frame of a question comes during its step;
/// - the facts of its texts hold: each `facts` block can be carried out when its step is done;
/// - all of this with each device that can take the place of the first one;
/// - all objects in the text exist in a device, and the title and the hints exist.
pub fn prove(lesson: &Lesson, host: &mut dyn Host) -> Vec<Problem> {
    let mut problems = prove_one(lesson, host, true);
    for name in &lesson.also {
        let on_it = lesson.with_device(name);
        problems.extend(
            prove_one(&on_it, host, false)
                .into_iter()
                .map(|mut problem| {
                    problem.message = format!("with device {name}: {}", problem.message);
                    problem
                }),
        );
    }
    problems
}

/// Only the device of the set-up is examined without an action and without each line of the solutions.
fn prove_one(lesson: &Lesson, host: &mut dyn Host, is_first: bool) -> Vec<Problem> {
    let mut problems = match lesson.set_up(host) {
        Ok(mut bench) => {
            let progress = Progress::new(lesson.clone(), &mut bench);
            let wrong = progress.impossible(&mut bench.bus).into_iter();
            let mut problems: Vec<_> = wrong
                .map(|(line, why)| Problem::new(line, why, "correct the condition or the set-up"))
                .collect();
            problems.extend(lesson.unknown_objects(bench.bus.devices()));
            problems
        }
        Err(problem) => return vec![problem],
    };
    if problems.is_empty() {
        let solutions: Vec<_> = lesson
            .steps
            .iter()
            .map(|step| step.solution.clone())
            .collect();
        if is_first {
            nothing_by_itself(lesson, host, &mut problems);
        }
        solved(lesson, host, &solutions, is_first, &mut problems);
        if problems.is_empty() && is_first {
            every_line_is_needed(lesson, host, &solutions, &mut problems);
        }
    }
    problems.sort_by_key(|problem| problem.line);
    problems
}

/// The bench after the set-up and some solutions.
fn played(
    lesson: &Lesson,
    host: &mut dyn Host,
    solutions: &[Block],
) -> Result<(Bench, Progress), Problem> {
    let mut bench = lesson.set_up(host)?;
    let mut progress = Progress::new(lesson.clone(), &mut bench);
    for solution in solutions {
        play(solution, &mut bench, host, &mut progress)?;
    }
    Ok((bench, progress))
}

/// Plays each step without the others, on the bench after the set-up.
fn nothing_by_itself(lesson: &Lesson, host: &mut dyn Host, problems: &mut Vec<Problem>) {
    for (number, step) in lesson.steps.iter().enumerate() {
        let Ok((mut bench, mut progress)) = played(lesson, host, &[]) else {
            return;
        };
        progress.begin(number, &mut bench.bus);
        progress.look(&mut bench.bus);
        let at_once = progress.is_idle();
        pass(&mut bench.bus, &mut progress, IDLE);
        if progress.is_idle() {
            let when = if at_once {
                "at the start"
            } else {
                "after a pause"
            };
            let message = format!("the checkpoint of `{}` holds {when}", step.title);
            problems.push(Problem::new(step.line, message, NEEDS_ACTION));
        }
    }
}

/// Plays the solutions in order.
fn solved(
    lesson: &Lesson,
    host: &mut dyn Host,
    solutions: &[Block],
    is_first: bool,
    problems: &mut Vec<Problem>,
) {
    let Ok((mut bench, mut progress)) = played(lesson, host, &[]) else {
        return;
    };
    for (number, (step, solution)) in lesson.steps.iter().zip(solutions).enumerate() {
        let mut frames = Vec::new();
        let record = |_, _, frame| frames.push(frame);
        let mut recorder = Recorder { host, record };
        if let Err(problem) = play(solution, &mut bench, &mut recorder, &mut progress) {
            return problems.push(problem);
        }
        if progress.step() <= number {
            let missing = progress.requirements(&mut bench.bus);
            let missing = missing.iter().filter(|one| !one.holds);
            let words: Vec<_> = missing.map(|one| one.text.as_str()).collect();
            let message = format!(
                "the solution of `{}` does not reach its checkpoint; not met: {}",
                step.title,
                words.join("; ")
            );
            let help = "correct the solution or the checkpoint";
            return problems.push(Problem::new(solution.line, message, help));
        }
        if progress.step() > number + 1 {
            let message = format!(
                "the solution of `{}` also completes the next step",
                step.title
            );
            let help = "let the checkpoint ask for something new";
            return problems.push(Problem::new(solution.line, message, help));
        }
        if let Some(quiz) = &step.quiz
            && quiz.answer.is_open()
        {
            let message = format!("the answer {} leaves the length open", quiz.answer);
            let help = "write `..` for each byte that does not matter";
            problems.push(Problem::new(quiz.line, message, help));
        }
        if let Some(quiz) = &step.quiz
            && !frames.iter().any(|frame| quiz.answer.matches(frame))
        {
            let message = format!("the answer {} does not occur in this step", quiz.answer);
            let help = "correct the answer or the solution";
            problems.push(Problem::new(quiz.line, message, help));
        }
        for facts in &step.facts {
            let mut copy = bench.clone();
            let script = facts.script().map_err(|mut all| all.remove(0));
            let run = script
                .and_then(|script| run_on(&script, &mut copy, host).map_err(|stop| stopped(&stop)));
            if let Err(mut problem) = run {
                problem.help = "correct the text, or the facts below it".into();
                problems.push(problem);
            }
        }
        if is_first && let Err(found) = waits(lesson, host, solutions, number + 1) {
            problems.push(found);
        }
    }
}

/// Checks that waiting does not complete the next step.
fn waits(
    lesson: &Lesson,
    host: &mut dyn Host,
    solutions: &[Block],
    done: usize,
) -> Result<(), Problem> {
    let (mut bench, mut progress) = played(lesson, host, &solutions[..done])?;
    pass(&mut bench.bus, &mut progress, IDLE);
    match lesson.steps.get(done) {
        Some(step) if progress.is_idle() => {
            let message = format!("the checkpoint of `{}` holds after a pause", step.title);
            Err(Problem::new(step.line, message, NEEDS_ACTION))
        }
        _ => Ok(()),
    }
}

/// Plays the solutions without one line, for each line.
fn every_line_is_needed(
    lesson: &Lesson,
    host: &mut dyn Host,
    solutions: &[Block],
    problems: &mut Vec<Problem>,
) {
    for (number, solution) in solutions.iter().enumerate() {
        let Ok(script) = solution.script() else {
            return;
        };
        for statement in script.statements() {
            let line = statement.line;
            let place = (line - solution.line) as usize;
            let mut text: Vec<_> = solution.text.lines().collect();
            let Some(left_out) = text.get_mut(place) else {
                continue;
            };
            let shown = core::mem::take(left_out).trim();
            let mut shorter = solutions.to_vec();
            shorter[number].text = text.join("\n");
            if played(lesson, host, &shorter).is_ok_and(|(_, progress)| progress.is_done()) {
                let message = format!("the lesson is also done without `{shown}`");
                let help = "let the checkpoint ask for its effect, or remove the line";
                problems.push(Problem::new(line, message, help));
            }
        }
    }
}

/// Plays a block while a lesson watches.
fn play(
    block: &Block,
    bench: &mut Bench,
    host: &mut dyn Host,
    progress: &mut Progress,
) -> Result<(), Problem> {
    let script: Script = block.script().map_err(|mut all| all.remove(0))?;
    let mut watched = Watched { host, progress };
    run_on(&script, bench, &mut watched)
        .map(|_| ())
        .map_err(|stop| stopped(&stop))
}
