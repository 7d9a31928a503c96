//! The fault cases of the page: a case by its seed, its probes, and the mark for a cause.

use od_sim::faults::sight::{Language, Sight};
use od_sim::faults::{Case, Cause, Collection, Mark, Trial};
use od_sim::rig::LineEvent;
use od_sim::script::Bare;
use od_sim::words::Decoder;
use wasm_bindgen::prelude::*;

use crate::crossing::{Crosses, record};

/// Maximum number of frames of a probe that are shown.
const SHOWN: usize = 200;

record! {
    /// A fault case of the list.
    FaultCase {
        name: String,
        /// The symptom.
        title: String,
    }

    /// A fault case with a seed; the story is Markdown.
    OpenedCase {
        title: String,
        story: String,
        /// The possible causes.
        causes: Vec<String>,
        /// Actions that the learner can choose.
        probes: Vec<String>,
    }

    /// A frame or an error frame that a probe shows.
    ProbeFrame {
        /// Virtual microseconds since the first one.
        at: f64,
        id: String,
        data: String,
        words: String,
        /// It is an error frame.
        "isError" is_error: bool,
    }

    /// Observations of a probe.
    ProbeReading {
        lines: Vec<String>,
        frames: Vec<ProbeFrame>,
        /// Frames after those that are listed.
        more: usize,
    }

    /// A probe that the learner used, and what it ruled out. Causes and probes are places in the lists of the case.
    UsedProbe {
        probe: usize,
        /// Causes that fit the reading.
        fit: Vec<usize>,
        /// Causes that fit it and the readings before.
        left: Vec<usize>,
    }

    /// The mark of a fault case.
    CaseMark {
        cause: usize,
        "isRight" is_right: bool,
        /// Only this cause fits the readings.
        "isProven" is_proven: bool,
        /// Smallest number of probes that proves it.
        fewest: usize,
        best: Vec<usize>,
        used: Vec<UsedProbe>,
        /// Proof of the cause, as Markdown.
        proof: String,
    }
}

/// The text of the cases, and its translation to German; an empty translation is English.
fn read(text: &str, german: &str) -> Result<(Collection, Language), JsError> {
    let read = Collection::parse(text).and_then(|all| match german {
        "" => Ok((all, Language::English)),
        german => Ok((all.translate(german)?, Language::German)),
    });
    read.map_err(|problems| {
        let lines: Vec<_> = problems.iter().map(ToString::to_string).collect();
        JsError::new(&lines.join("\n"))
    })
}

fn trial<'c>(collection: &'c Collection, name: &str, seed: u32) -> Result<Trial<'c>, JsError> {
    let trial = Trial::new(collection, name, seed.into());
    trial.ok_or_else(|| JsError::new(&format!("case `{name}` does not exist")))
}

const HOST: Bare = Bare(od_devices::DEVICES);

/// The fault cases of a text, with the titles of its German translation if there is one.
///
/// # Errors
/// The problems of the texts.
#[wasm_bindgen(js_name = faultCases, unchecked_return_type = "FaultCase[]")]
pub fn fault_cases(text: &str, german: &str) -> Result<Vec<JsValue>, JsError> {
    let (collection, _) = read(text, german)?;
    let one = |case: &Case| FaultCase {
        name: case.name.clone(),
        title: case.title.clone(),
    };
    Ok(collection
        .cases
        .iter()
        .map(|case| one(case).value())
        .collect())
}

/// Opens a case; its seed draws one of its causes.
///
/// # Errors
/// The problems of the texts, or the case does not exist.
#[wasm_bindgen(js_name = openCase, unchecked_return_type = "OpenedCase")]
pub fn open_case(text: &str, german: &str, name: &str, seed: u32) -> Result<JsValue, JsError> {
    let (collection, language) = read(text, german)?;
    let trial = trial(&collection, name, seed)?;
    let case = OpenedCase {
        title: trial.case().title.clone(),
        story: trial.case().story.clone(),
        causes: trial.causes().map(|cause| cause.title.clone()).collect(),
        probes: trial.probes(language, &mut HOST.clone())?,
    };
    Ok(case.value())
}

/// Makes a probe of a case.
///
/// # Errors
/// As `openCase`, or the probe does not exist.
#[wasm_bindgen(js_name = tryProbe, unchecked_return_type = "ProbeReading")]
pub fn try_probe(
    text: &str,
    german: &str,
    name: &str,
    seed: u32,
    probe: usize,
) -> Result<JsValue, JsError> {
    let (collection, language) = read(text, german)?;
    let reading = trial(&collection, name, seed)?.probe(probe, &mut HOST.clone())?;
    let mut decoder = Decoder::default();
    let mut begin = None;
    let frames: Vec<_> = reading
        .frames
        .iter()
        .take(SHOWN)
        .map(|seen| {
            let (at, frame, is_error) = match seen {
                LineEvent::Frame { at, frame, .. } | LineEvent::Heard { at, frame, .. } => {
                    (*at, frame, false)
                }
                LineEvent::Disturbed(one) => (one.at, &one.frame, true),
            };
            let begin = *begin.get_or_insert(at);
            let data = frame.data().iter().map(|byte| format!("{byte:02X} "));
            ProbeFrame {
                at: at.micros_since(begin) as f64,
                id: format!("{:03X}", frame.id().raw()),
                data: data.collect::<String>().trim_end().into(),
                words: if is_error {
                    String::new()
                } else {
                    decoder.explain(&[], frame).to_string()
                },
                is_error,
            }
        })
        .collect();
    let more = reading.frames.len() - frames.len();
    let lines = reading.sights.iter().map(|sight| sight.words(language));
    let lines = lines.collect();
    Ok(ProbeReading {
        lines,
        frames,
        more,
    }
    .value())
}

/// Returns what each probe of a case would show with one of its causes, for `judgeCase`. It takes the time of all
/// probes, so a mark asks for one cause after the other.
///
/// # Errors
/// As `openCase`.
#[wasm_bindgen(js_name = caseRow)]
pub fn case_row(text: &str, name: &str, seed: u32, cause: usize) -> Result<Vec<String>, JsError> {
    let (collection, language) = read(text, "")?;
    let row = trial(&collection, name, seed)?.row(cause, &mut HOST.clone())?;
    let words = |sights: &Vec<Sight>| {
        let words: Vec<_> = sights.iter().map(|sight| sight.words(language)).collect();
        words.join("\n")
    };
    Ok(row.iter().map(words).collect())
}

/// Marks a cause that the learner names after these probes. `rows` are those of `caseRow` for all causes, one after
/// the other.
///
/// # Errors
/// As `openCase`.
#[wasm_bindgen(js_name = judgeCase, unchecked_return_type = "CaseMark")]
pub fn judge_case(
    text: &str,
    german: &str,
    name: &str,
    seed: u32,
    rows: Vec<String>,
    used: Vec<usize>,
    named: usize,
) -> Result<JsValue, JsError> {
    let (collection, _) = read(text, german)?;
    let trial = trial(&collection, name, seed)?;
    let probes = trial.case().probes.len().max(1);
    let table: Vec<_> = rows.chunks(probes).map(<[String]>::to_vec).collect();
    let mark = trial.mark(&table, &used, named);
    let Mark {
        cause,
        is_right,
        is_proven,
        fewest,
        best,
        used,
    } = mark;
    let used = used.into_iter().map(|one| UsedProbe {
        probe: one.probe,
        fit: one.fit,
        left: one.left,
    });
    let proof = |cause: &Cause| cause.proof.clone();
    let mark = CaseMark {
        cause,
        is_right,
        is_proven,
        fewest,
        best,
        used: used.collect(),
        proof: trial.causes().nth(cause).map_or(String::new(), proof),
    };
    Ok(mark.value())
}
