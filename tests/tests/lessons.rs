//! The lessons of the playground: each is checked, and the links between them.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::thread;

use od_sim::faults::sight::Language;
use od_sim::faults::{Case, Collection, Trial};
use od_sim::lesson::{Lesson, prove, translate};
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

/// An abort code in the text of a lesson is one that its device sends, unless the sentence says that others send it.
#[test]
fn an_abort_code_in_a_text_is_shown_in_the_lesson() {
    let mut found = Vec::new();
    for (name, text) in lessons() {
        let (mut prose, mut blocks) = (String::new(), String::new());
        for (number, part) in text.split("```").enumerate() {
            let place = if number % 2 == 0 {
                &mut prose
            } else {
                &mut blocks
            };
            place.push_str(part);
        }
        for sentence in prose.split(['.', ';']) {
            let words = sentence.split(|one: char| !one.is_ascii_alphanumeric());
            let codes = words.filter_map(|word| word.strip_suffix('h'));
            for code in codes.filter(|code| code.len() == 8 && code.starts_with(['0'])) {
                let Ok(value) = u32::from_str_radix(code, 16) else {
                    continue;
                };
                if !matches!(value >> 24, 5 | 6 | 8) {
                    continue;
                }
                let bytes = value
                    .to_le_bytes()
                    .map(|byte| format!("{byte:02X}"))
                    .join(" ");
                let is_shown = blocks.contains(&format!("{code}h")) || blocks.contains(&bytes);
                if !is_shown && !sentence.to_lowercase().contains("other") {
                    found.push(format!("{name}: {code}h"));
                }
            }
        }
    }
    assert!(
        found.is_empty(),
        "abort codes that the lesson does not show; add `facts` with `aborts`, or say that other devices send it: {found:?}"
    );
}

/// Lessons without a German text in `playground/lessons/de`; a new lesson is translated, or listed here until it is.
const NOT_IN_GERMAN: [&str; 0] = [];

#[test]
fn every_lesson_is_in_german_except_those_that_are_listed() {
    let german = folder().join("de");
    let names: Vec<_> = lessons().into_iter().map(|(name, _)| name).collect();
    let missing: Vec<_> = names
        .iter()
        .filter(|name| !german.join(name).is_file())
        .collect();
    assert_eq!(
        missing,
        NOT_IN_GERMAN.iter().collect::<Vec<_>>(),
        "lessons without a text in playground/lessons/de, and NOT_IN_GERMAN: write the German text, or list the lesson"
    );
    for file in fs::read_dir(german).expect("the translations are there") {
        let name = file.expect("an entry").file_name();
        let name = name.to_str().expect("names of lessons are UTF-8");
        assert!(names.iter().any(|one| one == name), "{name} has no lesson");
    }
}

/// The words of a text that are numbers, frames or names of the field: those with a digit, and code.
fn facts(text: &str) -> BTreeSet<String> {
    let mut facts = BTreeSet::new();
    for (number, part) in text.split('`').enumerate() {
        if number % 2 == 1 {
            facts.insert(part.split_whitespace().collect::<Vec<_>>().join(" "));
        } else {
            let words = part.split(|one: char| !one.is_alphanumeric());
            let words = words.filter(|word| word.contains(|one: char| one.is_ascii_digit()));
            facts.extend(words.map(String::from));
        }
    }
    facts
}

/// A translation says the same numbers, objects and frames as its lesson, part by part.
#[test]
fn a_translation_has_the_facts_of_its_lesson() {
    let mut found = Vec::new();
    for (name, text) in lessons() {
        let file = folder().join("de").join(&name);
        let Ok(german) = fs::read_to_string(file) else {
            continue;
        };
        let composed = translate(&text, &german).unwrap_or_else(|problems| {
            let problems: Vec<_> = problems
                .iter()
                .map(|one| format!("de/{name}:{one}"))
                .collect();
            panic!("{}", problems.join("\n"))
        });
        let (lesson, german) = (read(&name, &text), read(&format!("de/{name}"), &composed));
        assert_eq!(german.language, "de", "de/{name}");
        let mut compare = |place: &str, original: &str, translated: &str| {
            let (original, translated) = (facts(original), facts(translated));
            let lacks: Vec<_> = original.difference(&translated).collect();
            let adds: Vec<_> = translated.difference(&original).collect();
            if !lacks.is_empty() || !adds.is_empty() {
                found.push(format!(
                    "de/{name}, {place}: lacks {lacks:?}, adds {adds:?}"
                ));
            }
        };
        compare("intro", &lesson.intro, &german.intro);
        for (one, other) in lesson.steps.iter().zip(&german.steps) {
            compare(&other.title, &one.title, &other.title);
            compare(&other.title, &one.text, &other.text);
            compare(&other.title, &one.happened, &other.happened);
            for (hint, translated) in one.hints.iter().zip(&other.hints) {
                compare(&other.title, hint, translated);
            }
            if let (Some(quiz), Some(translated)) = (&one.quiz, &other.quiz) {
                compare(&other.title, &quiz.question, &translated.question);
                compare(&other.title, &quiz.reveal, &translated.reveal);
            }
        }
    }
    assert!(found.is_empty(), "{}", found.join("\n"));
}

/// Questions of the final test: lesson, number of the step whose answer they have, text.
fn questions(language: &str) -> Vec<(String, usize, String)> {
    let path = folder().join(format!("../questions/{language}.md"));
    let text = fs::read_to_string(path).expect("the questions are there");
    let question = |part: &str| {
        let (head, text) = part.split_once('\n').expect("a text");
        let (lesson, step) = head.split_once(' ').expect("a lesson and a step");
        let step = step.parse().expect("the number of a step");
        (lesson.to_owned(), step, text.trim().to_owned())
    };
    text.split("\n## ").skip(1).map(question).collect()
}

#[test]
fn each_question_of_the_final_test_has_its_answer_in_a_lesson_and_not_in_its_text() {
    let lessons = lessons();
    let german = questions("de");
    let plain = |text: &str| text.replace([' ', '`'], "").to_uppercase();
    for (number, (name, step, question)) in questions("en").into_iter().enumerate() {
        let (file, text) = lessons
            .iter()
            .find(|(file, _)| file.get(3..) == Some(&format!("{name}.md")))
            .unwrap_or_else(|| panic!("{name} is not a lesson"));
        let lesson = read(file, text);
        let quiz = lesson.steps[step - 1].quiz.as_ref();
        let quiz = quiz.unwrap_or_else(|| panic!("step {step} of {name} has no question"));
        let answer = plain(&quiz.answer.to_string());
        assert!(
            !plain(&question).contains(answer.trim_end_matches('*')),
            "{name} {step}"
        );
        let (same, number, translated) = &german[number];
        assert_eq!(
            (same, *number),
            (&name, step),
            "de.md has the order of en.md"
        );
        assert_eq!(facts(translated), facts(&question), "{name} {step}");
    }
}

/// The fault cases in English, and their German words.
fn fault_cases() -> (String, String) {
    let file = |language: &str| {
        let path = folder().join(format!("../cases/{language}.md"));
        fs::read_to_string(path).expect("the cases are there")
    };
    (file("en"), file("de"))
}

/// With each cause the symptom shows, and the probes separate it from each other cause. Each case has another seed.
#[test]
fn every_fault_case_can_be_decided_for_each_cause() {
    let (text, _) = fault_cases();
    let collection = Collection::parse(&text).unwrap_or_else(|problems| panic!("{problems:#?}"));
    assert_eq!(collection.cases.len(), 20);
    let cases: Vec<_> = (0..).zip(&collection.cases).collect();
    let prove = |(seed, case): &(u64, &Case)| {
        let trial = Trial::new(&collection, &case.name, *seed).expect("the case exists");
        trial.prove(&mut Bare(od_devices::DEVICES))
    };
    // Each case plays some hundred seconds of the bus.
    let found: Vec<String> = thread::scope(|scope| {
        let parts = cases.chunks(5);
        let parts =
            parts.map(|part| scope.spawn(|| part.iter().flat_map(prove).collect::<Vec<_>>()));
        let parts: Vec<_> = parts.collect();
        let found = parts
            .into_iter()
            .map(|part| part.join().expect("no proof panics"));
        found.flatten().collect()
    });
    for case in &collection.cases {
        for cause in &case.causes {
            let title = &collection.causes[*cause].title;
            assert!(
                !case.story.contains(title.as_str()),
                "{} tells its cause",
                case.name
            );
        }
    }
    for cause in 0..collection.causes.len() {
        let is_used = collection
            .cases
            .iter()
            .any(|case| case.causes.contains(&cause));
        assert!(is_used, "no case has {}", collection.causes[cause].name);
    }
    assert!(found.is_empty(), "{}", found.join("\n"));
}

/// Each seed is one cause, again and again; all causes are drawn, and a mark says what the probes told.
#[test]
fn a_fault_case_is_marked_by_its_probes() {
    let (text, _) = fault_cases();
    let collection = Collection::parse(&text).expect("the cases have no mistakes");
    let trial = |seed| Trial::new(&collection, "dead-end", seed).expect("the case exists");
    let drawn: Vec<usize> = (0..40).map(|seed| trial(seed).cause()).collect();
    let again: Vec<usize> = (0..40).map(|seed| trial(seed).cause()).collect();
    assert_eq!(drawn, again);
    assert_eq!(drawn.iter().collect::<BTreeSet<_>>().len(), 4, "{drawn:?}");

    let host = &mut Bare(od_devices::DEVICES);
    let seed = drawn
        .iter()
        .position(|cause| *cause == 1)
        .expect("no power") as u64;
    let trial = trial(seed);
    // The probe of the supply voltage is the third of the case.
    let reading = trial.probe(2, host).expect("the bench can be made");
    let english: Vec<_> = reading
        .sights
        .iter()
        .map(|one| one.words(Language::English))
        .collect();
    assert_eq!(english, ["node 4: 0 V"]);
    let mark = trial.judge(&[2], 1, host).expect("the benches can be made");
    assert!(mark.is_right && mark.is_proven);
    assert_eq!((mark.fewest, mark.used[0].left.as_slice()), (1, &[1][..]));
    // The resistance is right with three causes: it proves none of them, and a guess is not a proof.
    let mark = trial.judge(&[1], 1, host).expect("the benches can be made");
    assert!(mark.is_right && !mark.is_proven);
    assert_eq!(mark.used[0].fit, [1, 2, 3]);
    let mark = trial
        .judge(&[1, 2], 0, host)
        .expect("the benches can be made");
    assert!(!mark.is_right && mark.is_proven);
    let unmade = trial.judge(&[], 0, host).expect("the benches can be made");
    assert!(!unmade.is_proven && unmade.used.is_empty());
    assert!(trial.probe(9, host).is_err());
}

#[test]
fn fault_cases_are_in_german_with_their_facts() {
    let (text, translation) = fault_cases();
    let english = Collection::parse(&text).expect("the cases have no mistakes");
    let german = english.clone().translate(&translation);
    let german = german.unwrap_or_else(|problems| panic!("{problems:#?}"));
    for (one, other) in english.causes.iter().zip(&german.causes) {
        assert_eq!(facts(&one.title), facts(&other.title), "{}", one.name);
        assert_eq!(facts(&one.proof), facts(&other.proof), "{}", one.name);
    }
    for (one, other) in english.cases.iter().zip(&german.cases) {
        assert_eq!(facts(&one.title), facts(&other.title), "{}", one.name);
        assert_eq!(facts(&one.story), facts(&other.story), "{}", one.name);
    }
    for (wrong, why) in [
        (
            translation.replacen("## flood:", "## food:", 1),
            "`flood` is not translated",
        ),
        (
            format!("{translation}\n## more: Mehr\n"),
            "`more` does not exist, or has blocks",
        ),
    ] {
        let problems = english.clone().translate(&wrong).expect_err(why);
        assert!(
            problems.iter().any(|one| one.message == why),
            "{problems:?}"
        );
    }
    for (from, to, why) in [
        (
            "read suspect 1000h\n```\n\n```causes",
            "look suspect\n```\n\n```causes",
            "`look suspect` is not a probe",
        ),
        (
            "```causes\nno-power\n",
            "```causes\nno-light\n",
            "cause `no-light` does not exist",
        ),
        (
            "bench encoders",
            "bench elsewhere",
            "bench `elsewhere` does not exist",
        ),
        (
            "## flood: ",
            "## flood ",
            "the heading is not `## name: title` below `# Benches`, `# Causes` or `# Cases`",
        ),
        ("line terminators 1", "line terminator", "7"),
    ] {
        let problems = Collection::parse(&text.replacen(from, to, 1)).expect_err(why);
        assert!(
            problems.iter().any(|one| one.message == why || why == "7"),
            "{problems:?}"
        );
    }
}
