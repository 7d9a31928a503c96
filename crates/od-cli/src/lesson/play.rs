//! `odkit lesson run`: a lesson whose lines come from standard input.

use std::io::{self, BufRead};
use std::path::PathBuf;

use od_sim::lesson::{Progress, Watched};
use od_sim::script::{Bench, Reader, Script, run_on};

use super::builtin::Language;
use super::file::File;
use crate::failure::Failure;
use crate::output::{Output, error, note};
use crate::report;
use crate::terminal::Terminal;

#[derive(clap::Args)]
pub(super) struct Args {
    /// The lesson
    file: PathBuf,
    /// Language of the lesson's text, if it is translated
    #[arg(long, value_enum, value_name = "CODE", default_value_t)]
    lang: Language,
    /// Play the lesson's solution instead of standard input
    #[arg(long)]
    solution: bool,
    /// Number of hints to show for the step that is open at the end
    #[arg(long, value_name = "N", default_value_t = 1)]
    hints: usize,
    /// Also print the frames that the lines send
    #[arg(long)]
    echo: bool,
}

pub(super) fn run(args: &Args) -> Result<(), Failure> {
    let lesson = File::read(&args.file, args.lang)?.usable()?;
    let path = args.file.display();
    let mut host = Terminal::beside(&args.file, ("gxmm", None));
    let mut bench = lesson
        .set_up(&mut host)
        .map_err(|problem| Failure::Usage(format!("{path}:{problem}")))?;
    host.output = Some(Output::new());
    host.echo = args.echo;
    let solutions: Vec<_> = lesson
        .steps
        .iter()
        .map(|step| step.solution.clone())
        .collect();
    let mut take = Take {
        progress: Progress::new(lesson, &mut bench),
        bench,
        host,
    };
    if args.solution {
        for solution in solutions {
            // It was parsed with the lesson.
            if let Ok(script) = solution.script() {
                take.play(&script, &path.to_string());
            }
        }
    } else {
        let mut reader = Reader::default();
        for line in io::stdin().lock().lines() {
            match reader.read(&line?) {
                Ok(script) => take.play(&script, "-"),
                Err(problem) => note!("-:{problem}"),
            }
        }
    }
    take.end(args)
}

/// A lesson in progress.
struct Take {
    progress: Progress,
    bench: Bench,
    host: Terminal<'static>,
}

impl Take {
    /// Plays lines; a line that fails is reported, and the next one follows.
    fn play(&mut self, script: &Script, name: &str) {
        let mut watched = Watched {
            host: &mut self.host,
            progress: &mut self.progress,
        };
        let result = run_on(script, &mut self.bench, &mut watched);
        while let Some(step) = self.progress.poll() {
            let at = self.progress.reached().get(step).copied();
            let title = self.progress.lesson().steps[step].title.clone();
            let line = format!(
                "# step {} is done at {:?} s: {title}",
                step + 1,
                at.unwrap_or_default()
            );
            self.host.line(&line);
        }
        if let Err(stop) = result {
            error(&format!("{name}: {stop}"));
        }
    }

    /// Prints the open step and how to continue.
    fn end(mut self, args: &Args) -> Result<(), Failure> {
        let mut lines = Vec::new();
        let lesson = self.progress.lesson();
        let (done, steps) = (self.progress.step(), lesson.steps.len());
        if let Some(step) = lesson.steps.get(done).cloned() {
            lines.push(format!(
                "# step {} of {steps} is open: {}",
                done + 1,
                step.title
            ));
            for one in self.progress.requirements(&mut self.bench.bus) {
                let mark = match (one.holds, one.already) {
                    (true, true) => "already",
                    (true, false) => "holds  ",
                    (false, _) => "missing",
                };
                lines.push(format!("#   {mark}  {}", one.text));
            }
            if self.progress.is_idle() {
                lines.push(
                    "# this step waits for an action of its own; repeat what it asks for".into(),
                );
            }
            let hints = step.hints.len();
            for (number, hint) in (1..=hints).zip(&step.hints).take(args.hints) {
                lines.push(format!("# hint {number} of {hints}: {}", one_line(hint)));
            }
        } else {
            let count = report::plural(steps, "step");
            lines.push(format!(
                "# the lesson is done: {count}, {:?} s",
                self.bench.bus.now()
            ));
        }
        for line in lines {
            self.host.line(&line);
        }
        if let Some(mut output) = self.host.output.take() {
            output.flush()?;
        }
        if done < steps {
            Err(Failure::Reported(1))
        } else {
            Ok(())
        }
    }
}

fn one_line(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}
