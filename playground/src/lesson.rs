//! Lessons on a bus: what there is to do, and how far somebody is.

use od_bench::lesson::{Lesson, Problem, Quiz};
use od_bench::script::{Bare, Pattern};
use od_runtime::Instant;
use wasm_bindgen::prelude::*;

use crate::bus::Bus;
use crate::record::{Record, list};

#[wasm_bindgen]
impl Bus {
    /// Begins a lesson: its set-up takes the place of all that is on the bus, and time goes on.
    /// From then on `advance` returns early when a checkpoint is reached.
    ///
    /// # Errors
    /// The problems of the text, or of its set-up.
    #[wasm_bindgen(js_name = startLesson)]
    pub fn start_lesson(&mut self, text: &str) -> Result<(), JsError> {
        let started = self
            .journal
            .rig
            .start_lesson(text, &mut Bare(od_devices::DEVICES));
        started.map(|_| ()).map_err(|all| error(all.first()))
    }

    /// The lesson of the journal; `null` where none is taken.
    #[wasm_bindgen(js_name = takenLesson, unchecked_return_type = "Lesson | null")]
    pub fn taken_lesson(&self) -> JsValue {
        self.journal.lesson().map_or(JsValue::NULL, record)
    }

    /// Returns the progress of the lesson; `null` if none runs.
    #[wasm_bindgen(unchecked_return_type = "LessonState | null")]
    pub fn lesson(&mut self) -> JsValue {
        let Some((progress, bus)) = self.journal.rig.lesson() else {
            return JsValue::NULL;
        };
        let requirements = progress.requirements(bus);
        let requirement = |one: &od_bench::lesson::Requirement| {
            let record = Record::new()
                .with("holds", one.holds)
                .with("text", one.text.as_str());
            match one.lost {
                true => record.with("lost", true).done(),
                false => record.done(),
            }
        };
        let reached = progress.reached().iter();
        let micros = |at: &Instant| JsValue::from_f64(at.as_micros() as f64);
        Record::new()
            .with("step", progress.step())
            .with("done", progress.is_done())
            .with("reached", list(reached.map(micros)))
            .with("requirements", list(requirements.iter().map(requirement)))
            .done()
    }

    /// The steps whose checkpoints were reached since the last call, counted from 0.
    #[wasm_bindgen(js_name = lessonEvents)]
    pub fn lesson_events(&mut self) -> Vec<u32> {
        let Some((progress, _)) = self.journal.rig.lesson() else {
            return Vec::new();
        };
        std::iter::from_fn(|| progress.poll().map(|step| step as u32)).collect()
    }

    /// Goes to a step, as if those before it had just been done; also to begin it again.
    #[wasm_bindgen(js_name = beginStep)]
    pub fn begin_step(&mut self, step: usize) {
        if let Some((progress, bus)) = self.journal.rig.lesson() {
            progress.begin(step, bus);
        }
    }

    /// Ends the lesson; what is on the bus stays.
    #[wasm_bindgen(js_name = endLesson)]
    pub fn end_lesson(&mut self) {
        self.journal.rig.end_lesson();
    }

    /// Plays lines of a script, such as the solution of a step; time passes where it says so.
    /// The first device is the one that lines are about, until `use` names another one.
    ///
    /// # Errors
    /// Which line cannot be read, or does not work; what the lines before it did stays done.
    #[wasm_bindgen(js_name = runScript)]
    pub fn run_script(&mut self, text: &str) -> Result<(), JsError> {
        let result = self
            .journal
            .rig
            .run_script(text, &mut Bare(od_devices::DEVICES));
        result.map_err(|why| JsError::new(&why))
    }
}

/// Reads a lesson: what it says, or everything that is wrong with it.
#[wasm_bindgen(js_name = parseLesson, unchecked_return_type = "LessonResult")]
pub fn parse_lesson(text: &str) -> JsValue {
    let (lesson, problems) = match Lesson::parse(text) {
        Ok(lesson) => (record(&lesson), Vec::new()),
        Err(problems) => (JsValue::NULL, problems),
    };
    Record::new()
        .with("lesson", lesson)
        .with("problems", list(problems.iter().map(problem)))
        .done()
}

/// Looks at an answer to a question: a frame such as `585#43 00 10 00`, or its bytes alone.
/// `answer` is what the question has.
///
/// # Errors
/// It is no frame.
#[wasm_bindgen(js_name = judgeAnswer, unchecked_return_type = "Judgement")]
pub fn judge_answer(answer: &str, given: &str) -> Result<JsValue, JsError> {
    let answer = Pattern::parse(answer).map_err(|found| JsError::new(&found.to_string()))?;
    let judgement = od_bench::lesson::judge(&answer, given).map_err(|found| error(Some(&found)))?;
    let wrong = judgement.wrong_bytes.iter();
    Ok(Record::new()
        .with("right", judgement.right)
        .with("wrongIdentifier", judgement.wrong_identifier)
        .with("wrongLength", judgement.wrong_length)
        .with(
            "wrongBytes",
            list(wrong.map(|at| JsValue::from_f64(*at as f64))),
        )
        .done())
}

fn record(lesson: &Lesson) -> JsValue {
    let texts = |texts: &[String]| list(texts.iter().map(|text| JsValue::from_str(text)));
    let quiz = |quiz: &Quiz| {
        Record::new()
            .with("question", quiz.question.as_str())
            .with("answer", quiz.answer.to_string())
            .with("reveal", quiz.reveal.as_str())
            .done()
    };
    let steps = lesson.steps.iter().map(|step| {
        Record::new()
            .with("title", step.title.as_str())
            .with("text", step.text.as_str())
            .with("hints", texts(&step.hints))
            .with("happened", step.happened.as_str())
            .with("quiz", step.quiz.as_ref().map_or(JsValue::NULL, quiz))
            .with("solution", step.solution.text.as_str())
            .done()
    });
    Record::new()
        .with("title", lesson.title.as_str())
        .with("summary", lesson.summary.as_str())
        .with("language", lesson.language.as_str())
        .with("level", lesson.level)
        .with("minutes", lesson.minutes)
        .with("intro", lesson.intro.as_str())
        .with("steps", list(steps))
        .done()
}

fn problem(problem: &Problem) -> JsValue {
    Record::new()
        .with("line", problem.line)
        .with("column", problem.column as f64)
        .with("message", problem.message.as_str())
        .with("help", problem.help.as_str())
        .done()
}

fn error(problem: Option<&Problem>) -> JsError {
    JsError::new(&problem.map(ToString::to_string).unwrap_or_default())
}
