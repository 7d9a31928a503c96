//! Lessons on a bus: their steps, and the progress of a learner.

use od_runtime::Instant;
use od_sim::lesson::{self, Problem};
use od_sim::script::{Bare, Pattern};
use wasm_bindgen::prelude::*;

use crate::bus::Bus;
use crate::crossing::{Crosses, Maybe, record};

record! {
    /// An error in the text of a lesson.
    LessonProblem {
        /// Counted from 1.
        line: u32,
        column: usize,
        message: String,
        /// The correction.
        help: String,
    }

    /// A lesson; texts are Markdown.
    Lesson {
        title: String,
        /// Summary in a sentence; may be empty.
        summary: String,
        /// `en`, `de` …
        language: String,
        /// 1 for beginners, 2, 3.
        level: u8,
        minutes: u16,
        intro: String,
        steps: Vec<LessonStep>,
    }

    LessonStep {
        title: String,
        text: String,
        /// Each hint tells more than the one before.
        hints: Vec<String>,
        /// Explanation, shown after the checkpoint is reached.
        happened: String,
        quiz: Option<LessonQuiz>,
        /// Lines for `Bus.runScript`.
        solution: String,
    }

    /// A question: predict a frame, then see it.
    LessonQuiz {
        question: String,
        /// For `judgeAnswer`, and to show; `..` and `*` are bytes that do not matter.
        answer: String,
        reveal: String,
    }

    LessonResult {
        lesson: Option<Lesson>,
        problems: Vec<LessonProblem>,
    }

    /// A condition of the current step.
    LessonRequirement {
        holds: bool,
        /// The condition in words, with its current state.
        text: String,
        /// It held when the step began, and has held since.
        already: Maybe<bool>,
        /// It held since the step began, but no longer holds.
        lost: Maybe<bool>,
    }

    LessonState {
        /// The current step, counted from 0; the number of steps when all are done.
        step: usize,
        done: bool,
        /// Virtual microseconds at which each checkpoint was reached.
        reached: Vec<f64>,
        requirements: Vec<LessonRequirement>,
        /// All conditions held before the learner acted in this step, and it waits for an action.
        idle: bool,
    }

    /// Result for an answer, by its parts.
    Judgement {
        right: bool,
        "wrongIdentifier" wrong_identifier: bool,
        "wrongLength" wrong_length: bool,
        /// Counted from 0.
        "wrongBytes" wrong_bytes: Vec<usize>,
    }
}

#[wasm_bindgen]
impl Bus {
    /// Starts a lesson: its set-up replaces everything on the bus, and time continues.
    /// From now on `advance` returns early when a checkpoint is reached.
    ///
    /// # Errors
    /// The errors of the text, or of its set-up.
    #[wasm_bindgen(js_name = startLesson)]
    pub fn start_lesson(&mut self, text: &str) -> Result<(), JsError> {
        let started = self
            .journal
            .rig
            .start_lesson(text, &mut Bare(od_devices::DEVICES));
        started.map(|_| ()).map_err(|all| error(all.first()))
    }

    /// The lesson in the journal; `null` if there is none.
    #[wasm_bindgen(js_name = takenLesson, unchecked_return_type = "Lesson | null")]
    pub fn taken_lesson(&self) -> JsValue {
        self.journal.lesson().map(content).value()
    }

    /// Returns the progress of the lesson; `null` if none runs.
    #[wasm_bindgen(unchecked_return_type = "LessonState | null")]
    pub fn lesson(&mut self) -> JsValue {
        let Some((progress, bus)) = self.journal.rig.lesson() else {
            return JsValue::NULL;
        };
        let requirements = progress.requirements(bus);
        let requirement = |one: lesson::Requirement| LessonRequirement {
            holds: one.holds,
            text: one.text,
            already: Maybe(one.already.then_some(true)),
            lost: Maybe(one.lost.then_some(true)),
        };
        let reached = progress.reached().iter();
        let micros = |at: &Instant| at.as_micros() as f64;
        let state = LessonState {
            step: progress.step(),
            done: progress.is_done(),
            reached: reached.map(micros).collect(),
            idle: progress.is_idle() && requirements.iter().all(|one| one.holds),
            requirements: requirements.into_iter().map(requirement).collect(),
        };
        state.value()
    }

    /// The steps whose checkpoints were reached since the last call, counted from 0.
    #[wasm_bindgen(js_name = lessonEvents)]
    pub fn lesson_events(&mut self) -> Vec<u32> {
        let Some((progress, _)) = self.journal.rig.lesson() else {
            return Vec::new();
        };
        std::iter::from_fn(|| progress.poll().map(|step| step as u32)).collect()
    }

    /// Goes to a step as if the steps before it had just been done; also to start it again.
    #[wasm_bindgen(js_name = beginStep)]
    pub fn begin_step(&mut self, step: usize) {
        if let Some((progress, bus)) = self.journal.rig.lesson() {
            progress.begin(step, bus);
        }
    }

    /// Ends the lesson; the devices stay on the bus.
    #[wasm_bindgen(js_name = endLesson)]
    pub fn end_lesson(&mut self) {
        self.journal.rig.end_lesson();
    }

    /// Plays script lines, such as the solution of a step; time passes as the lines say.
    /// Lines act on the first device, until `use` selects another one.
    ///
    /// # Errors
    /// The line that cannot be parsed or fails; the effect of earlier lines stays.
    #[wasm_bindgen(js_name = runScript)]
    pub fn run_script(&mut self, text: &str) -> Result<(), JsError> {
        let result = self
            .journal
            .rig
            .run_script(text, &mut Bare(od_devices::DEVICES));
        Ok(result?)
    }
}

/// Parses a lesson; returns it, or all its errors.
#[wasm_bindgen(js_name = parseLesson, unchecked_return_type = "LessonResult")]
pub fn parse_lesson(text: &str) -> JsValue {
    let (lesson, problems) = match lesson::Lesson::parse(text) {
        Ok(lesson) => (Some(content(&lesson)), Vec::new()),
        Err(problems) => (None, problems),
    };
    let problem = |one: Problem| LessonProblem {
        line: one.line,
        column: one.column,
        message: one.message,
        help: one.help,
    };
    let problems = problems.into_iter().map(problem).collect();
    LessonResult { lesson, problems }.value()
}

/// Returns the text of a lesson with the prose of a translation, which has the headings of the original and no set-up, no
/// solution and no facts (LESSONS.md).
///
/// # Errors
/// The places of the translation that do not fit the original, one line each.
#[wasm_bindgen(js_name = translateLesson)]
pub fn translate_lesson(original: &str, translation: &str) -> Result<String, JsError> {
    lesson::translate(original, translation).map_err(|problems| {
        let lines: Vec<_> = problems.iter().map(ToString::to_string).collect();
        JsError::new(&lines.join("\n"))
    })
}

/// Judges an answer to a question: a frame such as `585#43 00 10 00`, or only its bytes.
/// `answer` is that of the question.
///
/// # Errors
/// The text is not a frame.
#[wasm_bindgen(js_name = judgeAnswer, unchecked_return_type = "Judgement")]
pub fn judge_answer(answer: &str, given: &str) -> Result<JsValue, JsError> {
    let answer = Pattern::parse(answer).map_err(|found| JsError::new(&found.to_string()))?;
    let judgement = od_sim::lesson::judge(&answer, given).map_err(|found| error(Some(&found)))?;
    let judgement = Judgement {
        right: judgement.right,
        wrong_identifier: judgement.wrong_identifier,
        wrong_length: judgement.wrong_length,
        wrong_bytes: judgement.wrong_bytes,
    };
    Ok(judgement.value())
}

fn content(lesson: &lesson::Lesson) -> Lesson {
    let quiz = |quiz: &lesson::Quiz| LessonQuiz {
        question: quiz.question.clone(),
        answer: quiz.answer.to_string(),
        reveal: quiz.reveal.clone(),
    };
    let step = |step: &lesson::Step| LessonStep {
        title: step.title.clone(),
        text: step.text.clone(),
        hints: step.hints.clone(),
        happened: step.happened.clone(),
        quiz: step.quiz.as_ref().map(quiz),
        solution: step.solution.text.clone(),
    };
    Lesson {
        title: lesson.title.clone(),
        summary: lesson.summary.clone(),
        language: lesson.language.clone(),
        level: lesson.level,
        minutes: lesson.minutes,
        intro: lesson.intro.clone(),
        steps: lesson.steps.iter().map(step).collect(),
    }
}

fn error(problem: Option<&Problem>) -> JsError {
    JsError::new(&problem.map(ToString::to_string).unwrap_or_default())
}
