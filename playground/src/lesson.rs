//! Lessons on a bus: what there is to do, and how far somebody is.

use od_bench::lesson::{Lesson, Problem, Progress, Quiz, Watched};
use od_bench::script::{Bare, Bench, Host, Origin, Pattern, Script, run_on};
use od_runtime::{Frame, Instant, NodeId};
use wasm_bindgen::prelude::*;

use crate::record::{Record, list};
use crate::{Bus, motion, packed};

/// A lesson that is taken, and the names that its set-up gave the devices.
pub(crate) struct Taken {
    progress: Progress,
    /// Without its bus, which is the page's.
    names: Bench,
}

#[wasm_bindgen]
impl Bus {
    /// Begins a lesson: its set-up takes the place of all that is on the bus, and time goes on.
    /// From then on `advance` returns early when a checkpoint is reached.
    ///
    /// # Errors
    /// What is wrong with the text, or with its set-up.
    #[wasm_bindgen(js_name = startLesson)]
    pub fn start_lesson(&mut self, text: &str) -> Result<(), JsError> {
        let lesson = Lesson::parse(text).map_err(|all| error(all.first()))?;
        let mut bus = od_bench::Bus::new();
        bus.advance(self.bus.now());
        let mut bench = lesson
            .set_up_on(Bench::new(bus), &mut Bare(od_devices::DEVICES))
            .map_err(|problem| error(Some(&problem)))?;
        let progress = Progress::new(lesson, &mut bench);
        self.bus = std::mem::take(&mut bench.bus);
        self.clockwork = motion::Clockwork::default();
        self.batch.clear();
        self.taken = Some(Taken {
            progress,
            names: bench,
        });
        Ok(())
    }

    /// How far the lesson is; `null` where none is taken.
    #[wasm_bindgen(unchecked_return_type = "LessonState | null")]
    pub fn lesson(&mut self) -> JsValue {
        self.look();
        let Some(taken) = &mut self.taken else {
            return JsValue::NULL;
        };
        let progress = &mut taken.progress;
        let requirements = progress.requirements(&mut self.bus);
        let requirement = |one: &od_bench::lesson::Requirement| {
            Record::new()
                .with("holds", one.holds)
                .with("text", one.text.as_str())
                .done()
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
        let progress = self.taken.as_mut().map(|taken| &mut taken.progress);
        let news = |progress: &mut Progress| progress.poll().map(|step| step as u32);
        progress.map_or(Vec::new(), |progress| {
            std::iter::from_fn(|| news(progress)).collect()
        })
    }

    /// Goes to a step, as if those before it had just been done; also to begin it again.
    #[wasm_bindgen(js_name = beginStep)]
    pub fn begin_step(&mut self, step: usize) {
        if let Some(taken) = &mut self.taken {
            taken.progress.begin(step, &self.bus);
        }
    }

    /// Ends the lesson; what is on the bus stays.
    #[wasm_bindgen(js_name = endLesson)]
    pub fn end_lesson(&mut self) {
        self.taken = None;
    }

    /// Plays lines of a script, such as the solution of a step; time passes where it says so.
    /// The first device is the one that lines are about, until `use` names another one.
    ///
    /// # Errors
    /// Which line cannot be read, or does not work; what the lines before it did stays done.
    #[wasm_bindgen(js_name = runScript)]
    pub fn run_script(&mut self, text: &str) -> Result<(), JsError> {
        let script = Script::parse(text).map_err(|all| error(all.first()))?;
        let bus = std::mem::take(&mut self.bus);
        let mut recorder = Recorder {
            batch: &mut self.batch,
        };
        let (result, bus) = match &mut self.taken {
            Some(taken) => {
                taken.names.bus = bus;
                let mut watched = Watched {
                    host: &mut recorder,
                    progress: &mut taken.progress,
                };
                let result = run_on(&script, &mut taken.names, &mut watched);
                (result, std::mem::take(&mut taken.names.bus))
            }
            None => {
                let mut bench = Bench::new(bus);
                let result = run_on(&script, &mut bench, &mut recorder);
                (result, bench.bus)
            }
        };
        self.bus = bus;
        self.collect();
        result
            .map(|_| ())
            .map_err(|stop| JsError::new(&stop.to_string()))
    }
}

impl Bus {
    /// A frame came through, from outside or from a device.
    pub(crate) fn saw(&mut self, at: Instant, device: Option<usize>, frame: &Frame) {
        if let Some(taken) = &mut self.taken {
            let origin = device.map_or(Origin::Script, Origin::Device);
            taken.progress.frame(at, origin, frame);
            taken.progress.look(&mut self.bus);
        }
    }

    /// A frame was disturbed on the wire.
    pub(crate) fn lost(&mut self, at: Instant) {
        if let Some(taken) = &mut self.taken {
            taken.progress.disturbed(at);
        }
    }

    /// Something may have changed.
    pub(crate) fn look(&mut self) {
        if let Some(taken) = &mut self.taken {
            taken.progress.look(&mut self.bus);
        }
    }

    /// Checkpoints that were reached.
    pub(crate) fn reached(&self) -> usize {
        let progress = self.taken.as_ref().map(|taken| &taken.progress);
        progress.map_or(0, |progress| progress.reached().len())
    }
}

/// Puts the frames of a script into the batch.
struct Recorder<'a> {
    batch: &'a mut Vec<u8>,
}

impl Host for Recorder<'_> {
    fn device(
        &mut self,
        name: Option<&str>,
        node_id: Option<NodeId>,
    ) -> Result<od_bench::VirtualDevice, String> {
        Bare(od_devices::DEVICES).device(name, node_id)
    }

    fn frame(&mut self, at: Instant, origin: Origin, frame: &Frame) {
        let device = match origin {
            Origin::Script => None,
            Origin::Device(device) => Some(device),
        };
        packed::push(self.batch, at, device, frame);
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
