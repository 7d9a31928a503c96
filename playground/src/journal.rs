//! The inputs of a bench, kept so that the run can be repeated.

use od_runtime::Instant;
use od_sim::VirtualDevice;
use od_sim::journal::{
    self, AddedDevice, Error, Fields, Input, InputProblem, Source, Value, check,
};
use wasm_bindgen::prelude::*;

use crate::bus::Bus;
use crate::crossing::{Crosses, Made, declaration, record};
use crate::diagnostics::Diagnostic;
use crate::record::{Object, Record, list};
use crate::values::ObjectRecord;
use crate::{diagnostics, values};

declaration!(Input::DECLARATION);
declaration!(Source::DECLARATION);

impl Crosses for Input {
    const TYPE: &'static str = "Input";

    fn value(self) -> JsValue {
        let mut record = Record::new();
        self.write(&mut record);
        record.done()
    }
}

impl Crosses for Source {
    const TYPE: &'static str = "Source";

    fn value(self) -> JsValue {
        let mut record = Record::new();
        self.write(&mut record);
        record.done()
    }
}

record! {
    DeviceInfo {
        /// Short name: `gxmm`, or the file's product name.
        name: String,
        /// One line of description.
        title: String,
        /// The node ID that it was added with.
        "nodeId" node_id: u8,
        source: Source,
        objects: Made<Vec<ObjectRecord>>,
    }

    /// An input and its virtual time in microseconds.
    Entry {
        at: f64,
        input: Input,
    }

    /// Result of an input that adds a device, starts a lesson, or plays a script.
    Applied {
        /// Its number, or null if it cannot run.
        node: Option<usize>,
        diagnostics: Vec<Diagnostic>,
    }

    /// New entries, and the number of entries before them.
    JournalNews {
        from: usize,
        entries: Made<Vec<Entry>>,
    }
}

#[wasm_bindgen]
impl Bus {
    /// Applies an input to the bench and adds it to the journal. Remaining inputs of a repeated run
    /// are dropped. A lesson replaces everything on the bench.
    ///
    /// # Errors
    /// Reason why this is not a valid input.
    #[wasm_bindgen(unchecked_return_type = "Applied")]
    pub fn act(
        &mut self,
        #[wasm_bindgen(unchecked_param_type = "Input")] input: &JsValue,
    ) -> Result<JsValue, JsError> {
        let input = read(input).map_err(error)?;
        let text = text_of(&input);
        let added = self.journal.act(input);
        Ok(outcome(added, &text).value())
    }

    /// Creates an empty bench on a real bus line, and a run that is repeated as time passes. A
    /// quiet one does not show the frames of its first moment.
    ///
    /// # Errors
    /// Reason why an entry is not valid.
    pub fn restore(
        &mut self,
        #[wasm_bindgen(unchecked_param_type = "Entry[]")] entries: Vec<JsValue>,
        quiet: bool,
    ) -> Result<(), JsError> {
        let entries: Result<Vec<_>, _> = entries.iter().map(entry).collect();
        self.journal.restore(entries.map_err(error)?, quiet);
        Ok(())
    }

    /// Restores the bench at the time `to`, in microseconds; later inputs are repeated.
    pub fn rewind(&mut self, to: f64) {
        self.journal
            .rewind(Instant::from_micros(to.max(0.0) as u64));
    }

    /// The journal.
    #[wasm_bindgen(unchecked_return_type = "Entry[]")]
    pub fn entries(&self) -> Vec<JsValue> {
        self.journal.entries().iter().map(record).collect()
    }

    /// Returns the new entries of the journal since the last call; `null` if nothing is new.
    #[wasm_bindgen(unchecked_return_type = "JournalNews | null")]
    pub fn news(&mut self) -> JsValue {
        let news = self.journal.news().map(|(from, entries)| JournalNews {
            from,
            entries: Made::list(entries.iter().map(crossing)),
        });
        news.value()
    }

    /// Returns the number of remaining inputs of a repeated run.
    #[wasm_bindgen(js_name = toCome)]
    pub fn to_come(&self) -> usize {
        self.journal.to_come()
    }

    /// Returns the inputs that bring an empty bench to this state, without its history; `null` if there are none.
    #[wasm_bindgen(unchecked_return_type = "Entry[] | null")]
    pub fn setup(&mut self) -> JsValue {
        let entries = self.journal.setup();
        entries.map_or(JsValue::NULL, |all| list(all.iter().map(record)))
    }

    /// The devices that the journal added.
    #[wasm_bindgen(unchecked_return_type = "DeviceInfo[]")]
    pub fn devices(&self) -> Vec<JsValue> {
        let all = self
            .journal
            .devices()
            .iter()
            .zip(self.journal.rig.bus.devices());
        let info = |(placed, device): (&AddedDevice, &VirtualDevice)| {
            let objects = values::dictionary(device.dictionary(), device.node_id().raw());
            DeviceInfo {
                name: placed.name.clone(),
                title: device.title().into(),
                node_id: placed.node_id.raw(),
                source: placed.source.clone(),
                objects: Made::of(list(objects.into_iter())),
            }
        };
        all.map(|one| info(one).value()).collect()
    }
}

/// Checks an untrusted input, such as from a link: all its fields, and no others.
///
/// # Errors
/// `cut` if a field is missing or has a value that is not valid, `newer` for an input or a
/// source that only a later version supports.
#[wasm_bindgen(js_name = readInput, unchecked_return_type = "Input")]
pub fn read_input(
    #[wasm_bindgen(unchecked_param_type = "unknown")] input: &JsValue,
) -> Result<JsValue, JsError> {
    read(input).map(Crosses::value).map_err(error)
}

/// Checks a run that is to be repeated to the time `until`, in microseconds, before it
/// starts.
///
/// # Errors
/// `devices`, `time` or `frames`: the limit that it exceeds.
#[wasm_bindgen(js_name = checkRun)]
pub fn check_run(
    #[wasm_bindgen(unchecked_param_type = "Entry[]")] entries: Vec<JsValue>,
    until: f64,
) -> Result<(), JsError> {
    let entries: Result<Vec<_>, _> = entries.iter().map(entry).collect();
    let until = Instant::from_micros(until.max(0.0) as u64);
    check(&entries.map_err(error)?, until).map_err(error)
}

/// The result of an input, with the findings of its text.
pub(crate) fn outcome(added: journal::Applied, text: &str) -> Applied {
    let diagnostics = match added.problem {
        InputProblem::Message(message) => vec![diagnostics::message(&message)],
        #[cfg(feature = "eds")]
        InputProblem::Findings(found) => diagnostics::findings(&found, text),
        InputProblem::Problems(all) => all.iter().map(diagnostics::problem).collect(),
        _ => Vec::new(),
    };
    #[cfg(not(feature = "eds"))]
    let _ = text;
    let node = added.node;
    Applied { node, diagnostics }
}

/// The text of the device that an input adds.
pub(crate) fn text_of(input: &Input) -> String {
    match input {
        Input::Add {
            source: Source::Eds { text, .. },
            ..
        } => text.clone(),
        _ => String::new(),
    }
}

pub(crate) fn error(error: Error) -> JsError {
    JsError::new(error.name())
}

pub(crate) fn read(input: &JsValue) -> Result<Input, Error> {
    let fields = Object::of(input).ok_or(Error::InvalidField)?;
    let Value::Text(op) = fields.get("op") else {
        return Err(Error::Newer);
    };
    Input::read(&op, &fields)
}

fn entry(one: &JsValue) -> Result<journal::Entry, Error> {
    let fields = Object::of(one).ok_or(Error::InvalidField)?;
    let Value::Number(at) = fields.get("at") else {
        return Err(Error::InvalidField);
    };
    let at = Instant::from_micros(at.max(0.0) as u64);
    let input = read(&fields.field("input"))?;
    Ok(journal::Entry { at, input })
}

fn crossing(entry: &journal::Entry) -> Entry {
    Entry {
        at: entry.at.as_micros() as f64,
        input: entry.input.clone(),
    }
}

fn record(entry: &journal::Entry) -> JsValue {
    crossing(entry).value()
}

impl Fields for Object {
    fn get(&self, key: &str) -> Value {
        let found = match key.split_once('.') {
            Some((outer, inner)) => match Object::of(&self.field(outer)) {
                Some(object) => object.field(inner),
                None => JsValue::UNDEFINED,
            },
            None => self.field(key),
        };
        crate::record::value(&found)
    }
}
