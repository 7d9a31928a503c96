//! Frames in words, with names from the given files.

use std::collections::BTreeSet;

use od_model::Visible;
use od_runtime::NodeId;
use od_sim::VirtualDevice;
use od_sim::dbc::{Database, Value as Signal};
use od_sim::words::{self, Decoder, Field, Words, tag};
use od_tools::filter::{Filter, FilteredFrame};
use od_wire::{Frame, Instant};
use serde_json::{Value, json};

use super::names::Names;
use crate::failure::Failure;

/// Explains the frames of a bus, in order.
pub(crate) struct Narrator {
    names: Names,
    /// Devices without a bus, which supply names and mappings.
    devices: Vec<VirtualDevice>,
    /// Nodes of which a frame was received.
    seen: BTreeSet<u8>,
    decoder: Decoder,
    filter: Filter,
    /// DBC files; the first one that describes a frame has its signals.
    databases: Vec<Database>,
}

/// A frame and its meaning.
pub(crate) struct ExplainedFrame {
    pub(crate) at: Instant,
    pub(crate) frame: Frame,
    pub(crate) sent: bool,
    pub(crate) words: Words,
    /// The signals of a DBC file; `None` without one.
    signals: Option<Signals>,
}

/// The message of a DBC file with its signals; both are empty if no file describes the frame.
#[derive(Default)]
struct Signals {
    words: String,
    values: Vec<Signal>,
}

impl Narrator {
    pub(crate) fn new(names: Names, filter: &str) -> Result<Self, Failure> {
        let filter = Filter::parse(filter)
            .map_err(|mistake| Failure::Usage(format!("--filter: {mistake}")))?;
        let mut narrator = Self {
            names,
            devices: Vec::new(),
            seen: BTreeSet::new(),
            decoder: Decoder::default(),
            filter,
            databases: Vec::new(),
        };
        let named: Vec<NodeId> = narrator.names.nodes().collect();
        for node in named {
            narrator.meet(node)?;
        }
        Ok(narrator)
    }

    /// Adds the signals of DBC files to each frame.
    pub(crate) fn with_databases(self, databases: Vec<Database>) -> Self {
        Self { databases, ..self }
    }

    /// Explains the next frame; `None`: the filter excludes it.
    pub(crate) fn tell(&mut self, at: Instant, frame: Frame, sent: bool) -> Option<ExplainedFrame> {
        let node = tag(&frame).node;
        if let Some(node) = NodeId::new(node).filter(|node| !self.seen.contains(&node.raw())) {
            // A file that describes no device has no names; its errors were reported when it was read.
            let _ = self.meet(node);
        }
        let words = self.decoder.explain(&self.devices, &frame);
        let signals = self.signals(&frame);
        let mut text = words.to_string();
        if let Some(signals) = signals.as_ref() {
            text.push(' ');
            text.push_str(&signals.words);
        }
        let seen = FilteredFrame {
            frame: &frame,
            sent,
            words: &text,
        };
        let passes = self.filter.passes(&seen);
        passes.then_some(ExplainedFrame {
            at,
            frame,
            sent,
            words,
            signals,
        })
    }

    /// The values that a frame contains.
    pub(crate) fn fields(&self, frame: &Frame) -> Vec<Field> {
        words::fields(&self.devices, frame)
    }

    fn signals(&self, frame: &Frame) -> Option<Signals> {
        self.databases.first()?;
        let known = self
            .databases
            .iter()
            .find(|one| one.message(frame).is_some());
        let signals = known.map(|database| Signals {
            words: database.words(frame).unwrap_or_default(),
            values: database.signals(frame),
        });
        Some(signals.unwrap_or_default())
    }

    fn meet(&mut self, node: NodeId) -> Result<(), Failure> {
        self.seen.insert(node.raw());
        if let Some(mut device) = self.names.device(node)? {
            device.power_on(Instant::ZERO);
            self.devices.push(device);
        }
        Ok(())
    }
}

impl ExplainedFrame {
    /// `   0.100000  181  92 95 07 00              PDO node 1: TPDO1 …`
    pub(crate) fn line(&self) -> String {
        let at = self.at.as_micros();
        let (seconds, micros) = (at / 1_000_000, at % 1_000_000);
        let data = if self.frame.is_remote() {
            format!("RTR {}", self.frame.dlc())
        } else {
            od_model::values::hex(self.frame.data())
        };
        let id = self.frame.id().to_string();
        let mark = if self.words.error { "! " } else { "" };
        let mut line = format!(
            "{seconds:>5}.{micros:06}  {id:>3}  {data:<23}  {mark}{}",
            self.words
        );
        if let Some(signals) = self.signals.as_ref().filter(|one| !one.words.is_empty()) {
            line.push_str("  | ");
            line.push_str(&signals.words);
        }
        line
    }

    pub(crate) fn json(&self, fields: &[Field]) -> Value {
        let fields = fields.iter().map(|field| {
            json!({
                "name": field.name,
                "value": field.value,
                "object": field.object.map(|object| object.to_string()),
            })
        });
        let signals = self.signals.as_ref().map(|signals| {
            let signal =
                |one: &Signal| json!({ "name": one.name, "value": one.value, "unit": one.unit });
            signals.values.iter().map(signal).collect::<Vec<_>>()
        });
        let mut told = json!({
            "time": self.at.as_micros() as f64 / 1e6,
            "id": self.frame.id().to_string(),
            "data": od_model::values::hex(self.frame.data()),
            "remote": self.frame.is_remote(),
            "sent": self.sent,
            "service": self.words.service.name(),
            "node": self.words.node,
            "object": self.words.address.map(|address| address.to_string()),
            "error": self.words.error,
            "text": self.words.text,
            "fields": fields.collect::<Vec<_>>(),
        });
        if let Some(signals) = signals {
            told["signals"] = signals.into();
        }
        told
    }

    /// The columns of [`CSV`], and with DBC files that of the signals.
    pub(crate) fn csv(&self) -> String {
        let at = self.at.as_micros();
        let words = &self.words;
        let cells = [
            format!("{}.{:06}", at / 1_000_000, at % 1_000_000),
            self.frame.id().to_string(),
            od_model::values::hex(self.frame.data()),
            words.service.name().to_owned(),
            words.node.map_or(String::new(), |node| node.to_string()),
            words
                .address
                .map_or(String::new(), |address| address.to_string()),
            words.error.to_string(),
            words.text.clone(),
        ];
        let signals = self.signals.iter().map(|signals| signals.words.clone());
        let cells = cells.into_iter().chain(signals);
        let cells: Vec<_> = cells.map(|cell| Visible(&cell).csv()).collect();
        cells.join(",")
    }
}

/// The first line of a CSV file of frames.
pub(crate) const CSV: &str = "time,id,data,service,node,object,error,text";
