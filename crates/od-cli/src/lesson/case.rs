//! `odkit lesson case`: a fault case with its probes and its mark.

use std::fmt::Write;

use od_sim::faults::sight::Language as Words;
use od_sim::faults::{Collection, Mark, Trial};
use od_sim::lesson::Problem;
use od_sim::script::Bare;

use super::builtin::Language;
use crate::failure::Failure;
use crate::{output, report};

const ENGLISH: &str = include_str!("../../cases/en.md");
const GERMAN: &str = include_str!("../../cases/de.md");

/// Take a fault case: a symptom, probes, and a mark for the cause that you name
///
/// Without a name: lists the cases. With a name: shows the symptom, the probes and the possible causes.
/// Exit code 0: no cause was named, or the probes prove it; 1: it is not right, or not proven.
#[derive(clap::Args)]
pub(super) struct Args {
    /// Name of the case
    name: Option<String>,
    /// Seed that draws the cause; the same seed is the same case, here and in the page
    #[arg(long, value_name = "N", default_value_t)]
    seed: u32,
    /// Make this probe, counted from 1; may be repeated
    #[arg(long, value_name = "N")]
    probe: Vec<usize>,
    /// Name this cause, counted from 1
    #[arg(long, value_name = "N")]
    cause: Option<usize>,
    /// Language of the texts of the case
    #[arg(long, value_enum, value_name = "CODE", default_value_t)]
    lang: Language,
}

pub(super) fn run(args: &Args) -> Result<(), Failure> {
    let own = |problems: Vec<Problem>| match problems.first() {
        Some(problem) => Failure::Usage(problem.to_string()),
        None => Failure::Usage(String::from("the cases cannot be read")),
    };
    let collection = Collection::parse(ENGLISH).map_err(own)?;
    let (collection, language) = match args.lang {
        Language::En => (collection, Words::English),
        Language::De => (collection.translate(GERMAN).map_err(own)?, Words::German),
    };
    let Some(name) = &args.name else {
        return output::print(&list(&collection));
    };
    let trial = Trial::new(&collection, name, args.seed.into()).ok_or_else(|| {
        Failure::Usage(format!(
            "case `{name}` does not exist; `odkit lesson case` lists all"
        ))
    })?;
    let (probes, causes) = (trial.case().probes.len(), trial.case().causes.len());
    let numbers = args.probe.iter().map(|number| ("probe", *number, probes));
    for (what, number, last) in numbers.chain(args.cause.map(|number| ("cause", number, causes))) {
        if !(1..=last).contains(&number) {
            let why = format!("{what} {number} does not exist; the case has {what}s 1 to {last}");
            return Err(Failure::Usage(why));
        }
    }
    let host = &mut Bare(od_devices::DEVICES);
    let failed = |problem: Problem| Failure::Usage(problem.to_string());
    let words = trial.probes(language, host).map_err(failed)?;
    let mut text = String::new();
    if args.probe.is_empty() && args.cause.is_none() {
        text = symptom(&trial, &words);
    }
    for number in &args.probe {
        let reading = trial.probe(number - 1, host).map_err(failed)?;
        let _ = writeln!(text, "{number}. {}", words[number - 1]);
        for sight in &reading.sights {
            let _ = writeln!(text, "   {}", sight.words(language));
        }
    }
    let Some(cause) = args.cause else {
        return output::print(&text);
    };
    let used: Vec<usize> = args.probe.iter().map(|number| number - 1).collect();
    let mark = trial.judge(&used, cause - 1, host).map_err(failed)?;
    text.push_str(&marked(&trial, &mark, &words));
    output::print(&text)?;
    if mark.is_right && mark.is_proven {
        Ok(())
    } else {
        Err(Failure::Reported(1))
    }
}

fn list(collection: &Collection) -> String {
    let width = collection
        .cases
        .iter()
        .map(|case| case.name.len())
        .max()
        .unwrap_or_default();
    let mut text = String::new();
    for case in &collection.cases {
        let _ = writeln!(text, "{:width$}  {}", case.name, case.title);
    }
    text
}

fn symptom(trial: &Trial<'_>, probes: &[String]) -> String {
    let case = trial.case();
    let mut text = format!("# {}\n\n{}\n\nProbes:\n\n", case.title, case.story);
    for (number, words) in (1..).zip(probes) {
        let _ = writeln!(text, "{number:>3}. {words}");
    }
    text.push_str("\nCauses:\n\n");
    for (number, cause) in (1..).zip(trial.causes()) {
        let _ = writeln!(text, "{number:>3}. {}", cause.title);
    }
    text
}

fn marked(trial: &Trial<'_>, mark: &Mark, probes: &[String]) -> String {
    let causes: Vec<_> = trial.causes().collect();
    let cause = causes[mark.cause];
    let mut text = String::from(if mark.is_right {
        "\nRight: "
    } else {
        "\nNot right. The cause is: "
    });
    let _ = writeln!(text, "{}\n", cause.title);
    let mut before = causes.len();
    for one in &mark.used {
        let left = one.left.len();
        let _ = writeln!(
            text,
            "probe {}: rules out {}, {left} left",
            one.probe + 1,
            before - left
        );
        before = left;
    }
    let fewest = report::plural(mark.fewest, "probe");
    let _ = if mark.is_proven {
        let used = mark.used.len();
        writeln!(text, "Your probes prove it ({used}); {fewest} can.")
    } else {
        writeln!(
            text,
            "Your probes do not prove it: {before} causes fit them. {fewest} can:"
        )
    };
    for probe in &mark.best {
        let _ = writeln!(text, "  {}. {}", probe + 1, probes[*probe]);
    }
    let _ = writeln!(text, "\n{}", cause.proof);
    text
}
