//! The lessons of the playground: each is checked, and the links between them.

use std::fs;
use std::path::{Path, PathBuf};

use od_sim::lesson::{Lesson, prove};
use od_sim::script::Bare;

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../playground/lessons")
}

/// Name and text of each lesson, by name.
fn lessons() -> Vec<(String, String)> {
    let files = fs::read_dir(folder()).expect("the folder of the lessons is there");
    let mut all: Vec<_> = files
        .map(|file| file.expect("its entries can be read").path())
        .filter(|path| path.extension().is_some_and(|kind| kind == "md"))
        .map(|path| {
            let name = path.file_name().and_then(|name| name.to_str());
            let name = name.expect("names of lessons are UTF-8").to_owned();
            let text = fs::read_to_string(&path).expect("a lesson can be read");
            (name, text)
        })
        .collect();
    all.sort();
    all
}

fn read(name: &str, text: &str) -> Lesson {
    Lesson::parse(text).unwrap_or_else(|problems| {
        let problems: Vec<_> = problems.iter().map(|one| format!("{name}:{one}")).collect();
        panic!("{}", problems.join("\n"))
    })
}

#[test]
fn every_solution_passes_and_no_step_passes_without_it() {
    let mut found = Vec::new();
    for (name, text) in lessons() {
        let lesson = read(&name, &text);
        let problems = prove(&lesson, &mut Bare(od_devices::DEVICES));
        found.extend(problems.iter().map(|one| format!("{name}:{one}")));
    }
    assert!(found.is_empty(), "{}", found.join("\n"));
}

#[test]
fn every_lesson_has_hints() {
    for (name, text) in lessons() {
        let lesson = read(&name, &text);
        for step in &lesson.steps {
            let (line, hints) = (step.line, step.hints.len());
            assert!(
                hints >= 2,
                "{name}:{line}: hints come in tiers, here {hints}"
            );
        }
        assert!(
            !lesson.summary.is_empty(),
            "{name}: the list shows a summary"
        );
        let why = lesson.intro.trim().split("\n\n").next().unwrap_or_default();
        assert_eq!(
            why.split(['.', '?'])
                .filter(|one| !one.trim().is_empty())
                .count(),
            2,
            "{name}: two sentences say why it matters, what it is about follows"
        );
    }
}

#[test]
fn every_link_leads_to_a_file() {
    for (name, text) in lessons() {
        for (line, file) in read(&name, &text).files() {
            assert!(
                folder().join(file).is_file(),
                "{name}:{line}: {file} does not exist"
            );
        }
    }
}

/// The text before an answer does not contain it, and a wrong answer is explained by its parts.
#[test]
fn no_question_contains_its_answer() {
    let plain = |text: &str| text.replace([' ', '`'], "").to_uppercase();
    for (name, text) in lessons() {
        for step in read(&name, &text).steps {
            let Some(quiz) = step.quiz else { continue };
            let answer = plain(&quiz.answer.to_string());
            let seen = plain(&format!("{} {} {}", step.title, step.text, quiz.question));
            assert!(
                !seen.contains(answer.trim_end_matches('*')),
                "{name}:{}: {answer} is shown beside its question",
                quiz.line
            );
        }
    }
}
