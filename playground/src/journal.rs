//! Inputs of a bench, kept so that the bench can be made again.

use od_bench::VirtualDevice;
use od_bench::journal::{
    Added, Entry, Excess, Fault, Fields, Input, Placed, Source, Trouble, Value, check,
};
use od_runtime::Instant;
use wasm_bindgen::prelude::*;

use crate::bus::Bus;
use crate::record::{Object, Record, list};
use crate::{diagnostics, values};

#[wasm_bindgen]
impl Bus {
    /// Does something to the bench and keeps it in the journal. What was still to come of a run
    /// that is made again does not come any more. A lesson takes the place of all that was there.
    ///
    /// # Errors
    /// Why this is not an input.
    #[wasm_bindgen(unchecked_return_type = "Added")]
    pub fn act(
        &mut self,
        #[wasm_bindgen(unchecked_param_type = "Input")] input: &JsValue,
    ) -> Result<JsValue, JsError> {
        let input = read(input).map_err(error)?;
        let text = text_of(&input);
        let added = self.journal.act(input);
        Ok(outcome(added, &text))
    }

    /// Makes an empty bench on a real bus line, and a run that is made again as time passes. A
    /// quiet one does not show what happens at its first moment.
    ///
    /// # Errors
    /// Why an entry is not one.
    pub fn restore(
        &mut self,
        #[wasm_bindgen(unchecked_param_type = "Entry[]")] entries: Vec<JsValue>,
        quiet: bool,
    ) -> Result<(), JsError> {
        let entries: Result<Vec<_>, _> = entries.iter().map(entry).collect();
        self.journal.restore(entries.map_err(error)?, quiet);
        Ok(())
    }

    /// Makes the bench as it was at `to`, in microseconds; what came after comes again.
    pub fn rewind(&mut self, to: f64) {
        self.journal
            .rewind(Instant::from_micros(to.max(0.0) as u64));
    }

    /// The journal.
    #[wasm_bindgen(unchecked_return_type = "Entry[]")]
    pub fn entries(&self) -> Vec<JsValue> {
        self.journal.entries().iter().map(record).collect()
    }

    /// Returns the new entries of the journal since the last call; `null` if there are none.
    #[wasm_bindgen(unchecked_return_type = "JournalNews | null")]
    pub fn news(&mut self) -> JsValue {
        let Some((from, entries)) = self.journal.news() else {
            return JsValue::NULL;
        };
        Record::new()
            .with("from", from as u32)
            .with("entries", list(entries.iter().map(record)))
            .done()
    }

    /// Returns the number of entries still to come of a run that is made again.
    #[wasm_bindgen(js_name = toCome)]
    pub fn to_come(&self) -> usize {
        self.journal.to_come()
    }

    /// Returns inputs that bring an empty bench to the state of this one, without its past; `null` if none do.
    #[wasm_bindgen(unchecked_return_type = "Entry[] | null")]
    pub fn still(&mut self) -> JsValue {
        let entries = self.journal.still();
        entries.map_or(JsValue::NULL, |all| list(all.iter().map(record)))
    }

    /// The devices that the journal put on the bus.
    #[wasm_bindgen(unchecked_return_type = "DeviceInfo[]")]
    pub fn devices(&self) -> Vec<JsValue> {
        let all = self
            .journal
            .devices()
            .iter()
            .zip(self.journal.rig.bus.devices());
        let info = |(placed, device): (&Placed, &VirtualDevice)| {
            let node_id = placed.node_id.raw();
            let objects = values::dictionary(device.dictionary(), device.node_id().raw());
            Record::new()
                .with("name", placed.name.as_str())
                .with("title", device.title())
                .with("nodeId", node_id)
                .with("source", source(&placed.source))
                .with("objects", list(objects.into_iter()))
                .done()
        };
        all.map(info).collect()
    }
}

/// Checks an input that comes from outside, such as from a link: all its fields, and no others.
///
/// # Errors
/// `cut` if a field is missing or has a value that is not allowed, `newer` for an input or a
/// source that only a later version knows.
#[wasm_bindgen(js_name = readInput, unchecked_return_type = "Input")]
pub fn read_input(
    #[wasm_bindgen(unchecked_param_type = "unknown")] input: &JsValue,
) -> Result<JsValue, JsError> {
    read(input).map(write).map_err(error)
}

/// Checks a run that is to be made again to the moment `until`, in microseconds, before any of it
/// happens.
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
    check(&entries.map_err(error)?, until).map_err(|excess| {
        JsError::new(match excess {
            Excess::Devices => "devices",
            Excess::Time => "time",
            Excess::Frames => "frames",
        })
    })
}

/// The result of an input, and of the text of its device.
pub(crate) fn outcome(Added { node, trouble }: Added, text: &str) -> JsValue {
    let diagnostics = match trouble {
        Trouble::None => list(std::iter::empty()),
        Trouble::Message(message) => list([diagnostics::message(&message)].into_iter()),
        #[cfg(feature = "eds")]
        Trouble::Findings(found) => diagnostics::findings(&found, text),
        Trouble::Problems(all) => list(all.iter().map(diagnostics::problem)),
    };
    #[cfg(not(feature = "eds"))]
    let _ = text;
    Record::new()
        .with(
            "node",
            node.map_or(JsValue::NULL, |node| (node as u32).into()),
        )
        .with("diagnostics", diagnostics)
        .done()
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

pub(crate) fn error(fault: Fault) -> JsError {
    JsError::new(match fault {
        Fault::Cut => "cut",
        Fault::Newer => "newer",
    })
}

pub(crate) fn read(input: &JsValue) -> Result<Input, Fault> {
    let fields = Object::of(input).ok_or(Fault::Cut)?;
    let Value::Text(op) = fields.get("op") else {
        return Err(Fault::Newer);
    };
    Input::read(&op, &fields)
}

fn entry(one: &JsValue) -> Result<Entry, Fault> {
    let fields = Object::of(one).ok_or(Fault::Cut)?;
    let Value::Number(at) = fields.get("at") else {
        return Err(Fault::Cut);
    };
    let at = Instant::from_micros(at.max(0.0) as u64);
    let input = read(&fields.field("input"))?;
    Ok(Entry { at, input })
}

fn record(entry: &Entry) -> JsValue {
    Record::new()
        .with("at", entry.at.as_micros() as f64)
        .with("input", write(entry.input.clone()))
        .done()
}

fn write(input: Input) -> JsValue {
    let mut record = Record::new();
    input.write(&mut record);
    record.done()
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

fn source(source: &Source) -> JsValue {
    match source {
        Source::Builtin { name } => Record::new()
            .with("kind", "builtin")
            .with("name", name.as_str())
            .done(),
        Source::Eds {
            name,
            text,
            lenient,
        } => Record::new()
            .with("kind", "eds")
            .with("name", name.as_str())
            .with("text", text.as_str())
            .with("lenient", *lenient)
            .done(),
    }
}
