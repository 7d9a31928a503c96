//! A run of the conformance test, and the common parts of its reports.

use od_sim::words::Decoder;
use od_sim::{EdsOptions, VirtualDevice};
use od_wire::{Instant, NodeId};

use crate::conform::official::numbers;
use crate::conform::record::{Record, Times, Traced, Verdict, percentile};

/// Place, time, tester and equipment of the test.
#[derive(Clone, PartialEq, Eq, Debug, Default)]
pub struct About {
    /// Date and time, UTC.
    pub date: String,
    /// Name of the person or company that ran the test.
    pub tester: Option<String>,
    /// Name and version of the program.
    pub version: String,
    /// The options of the run, as they are typed.
    pub options: String,
    /// Bit rate in kbit/s, if it is known.
    pub bit_rate: Option<u16>,
    /// SHA-256 of the EDS, in hexadecimal digits.
    pub eds_hash: String,
    /// Objects by which the node identifies itself: name and value.
    pub identity: Vec<(String, String)>,
    /// The text of the EDS, which names the values of frames.
    pub eds_text: String,
}

/// A run of the conformance test.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Report {
    /// Place, time, tester and equipment.
    pub about: About,
    /// The device, as the EDS names it.
    pub device: String,
    /// The EDS.
    pub eds: String,
    /// The link.
    pub link: String,
    /// The node ID.
    pub node: u8,
    /// The cases, in the order in which they were run.
    pub records: Vec<Record>,
    /// Response times of the node.
    pub times: Times,
    /// Reason why the run ended early, if it did.
    pub lost: Option<String>,
}

/// Number of cases with each verdict.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub struct Counts {
    /// The node meets the requirement.
    pub pass: usize,
    /// The node violates the requirement.
    pub fail: usize,
    /// Not tested.
    pub skipped: usize,
    /// The node does not have the object or service.
    pub not_applicable: usize,
}

impl Report {
    /// Returns whether no case failed and the run came to its end.
    pub fn is_pass(&self) -> bool {
        self.lost.is_none() && self.counts().fail == 0
    }

    /// Number of cases with each verdict.
    pub fn counts(&self) -> Counts {
        count(self.records.iter())
    }

    /// `12 passed, 1 failed, 2 skipped, 3 not applicable`.
    pub fn summary(&self) -> String {
        let Counts {
            pass,
            fail,
            skipped,
            not_applicable,
        } = self.counts();
        let all = self.records.len();
        let cases = if all == 1 { "case" } else { "cases" };
        format!(
            "{all} {cases}: {pass} passed, {fail} failed, {skipped} skipped, {not_applicable} not applicable"
        )
    }

    /// Sentence about values that were changed and restored, and those that could not be; `None` if none was changed.
    pub(super) fn put_back(&self) -> Option<String> {
        let notes = self.records.iter().flat_map(|record| &record.notes);
        let count = |start: &str| notes.clone().filter(|note| note.starts_with(start)).count();
        let (back, not) = (count("put back"), count("could not"));
        let values = if back == 1 { "value" } else { "values" };
        match (back, not) {
            (0, 0) => None,
            (_, 0) => Some(format!("changed and put back: {back} {values}")),
            _ => Some(format!(
                "changed and put back: {back} {values}; could not be put back: {not}"
            )),
        }
    }

    /// Response times of the node with percentiles, one line each.
    pub(super) fn timings(&self) -> Vec<(&'static str, usize, [u64; 3])> {
        let both = [
            ("SDO response", &self.times.answers),
            ("boot-up after a reset", &self.times.boots),
        ];
        let line = |(name, values): (&'static str, &Vec<u64>)| {
            let at = |percent| percentile(values, percent);
            Some((name, values.len(), [at(50)?, at(95)?, at(100)?]))
        };
        both.into_iter().filter_map(line).collect()
    }
}

/// Microseconds as milliseconds.
pub(super) fn millis(micros: u64) -> String {
    format!("{}.{:03} ms", micros / 1000, micros % 1000)
}

/// Line between the frames of a failed case.
const FOUND: &str = "-- the failure was found here --";

/// Frames in words, by the EDS.
pub(super) struct Narrator {
    devices: Vec<VirtualDevice>,
    decoder: Decoder,
}

impl Narrator {
    /// With the names of a report's EDS.
    pub(super) fn new(report: &Report) -> Self {
        let options = EdsOptions {
            node_id: NodeId::new(report.node),
            lenient: true,
        };
        let (device, _) = VirtualDevice::read_eds(&report.about.eds_text, options);
        let mut devices = Vec::from_iter(device);
        for device in &mut devices {
            device.power_on(Instant::ZERO);
        }
        Self {
            devices,
            decoder: Decoder::default(),
        }
    }

    /// A frame as a line: when, whose, what, and in words.
    pub(super) fn line(&mut self, traced: &Traced) -> String {
        let mark = if traced.ours { "->" } else { "<-" };
        let words = self.words(traced);
        let frame = traced.frame.to_string();
        format!("{:?} {mark} {frame:<21} {words}", traced.at)
    }

    /// A frame in words.
    pub(super) fn words(&mut self, traced: &Traced) -> String {
        self.decoder
            .explain(&self.devices, &traced.frame)
            .to_string()
    }

    /// The lines of all frames of a case; of a failed one with a line where the failure was found.
    pub(super) fn lines(&mut self, record: &Record) -> Vec<String> {
        // A transfer does not continue in the next case.
        self.decoder = Decoder::default();
        let frames = record.frames.iter();
        let mut lines: Vec<String> = frames.map(|traced| self.line(traced)).collect();
        if record.verdict.is_fail() && record.found < lines.len() {
            lines.insert(record.found, FOUND.into());
        }
        lines
    }
}

impl Report {
    /// The head of a report: what was tested, when, by whom and with what; name and value.
    pub(super) fn head(&self) -> Vec<(&str, String)> {
        let About {
            date,
            tester,
            version,
            options,
            bit_rate,
            eds_hash,
            identity,
            ..
        } = &self.about;
        let mut head = vec![("Device", self.device.clone())];
        head.extend(
            identity
                .iter()
                .map(|(name, value)| (&**name, value.clone())),
        );
        head.push(("Node ID", self.node.to_string()));
        head.push(("Link", self.link.clone()));
        head.extend(bit_rate.map(|kbit| ("Bit rate", format!("{kbit} kbit/s"))));
        head.push(("EDS", self.eds.clone()));
        let texts = [
            ("SHA-256 of the EDS", eds_hash),
            ("Date", date),
            ("Program", version),
            ("Options", options),
        ];
        let given = texts.into_iter().filter(|(_, text)| !text.is_empty());
        head.extend(given.map(|(name, text)| (name, text.clone())));
        head.extend(tester.iter().map(|tester| ("Tester", tester.clone())));
        head
    }

    /// Cases that failed.
    pub(super) fn failures(&self) -> impl Iterator<Item = &Record> {
        self.records
            .iter()
            .filter(|record| record.verdict.is_fail())
    }

    /// The number of cases with each verdict, for each group.
    pub(super) fn by_group(&self) -> Vec<(&str, Counts)> {
        let groups = groups(self).into_iter();
        groups
            .map(|(group, records)| (group, count(records.into_iter())))
            .collect()
    }
}

/// Number of cases with each verdict.
fn count<'r>(records: impl Iterator<Item = &'r Record>) -> Counts {
    let mut counts = Counts::default();
    for record in records {
        *match record.verdict {
            Verdict::Pass => &mut counts.pass,
            Verdict::Fail { .. } => &mut counts.fail,
            Verdict::Skipped(_) => &mut counts.skipped,
            Verdict::NotApplicable(_) => &mut counts.not_applicable,
        } += 1;
    }
    counts
}

/// Clause of a case, with the numbers of the official cases that it covers.
pub(super) fn source(record: &Record) -> String {
    match numbers(&record.id) {
        "" => record.clause.clone(),
        numbers => format!("{}; CiA test {numbers}", record.clause),
    }
}

/// The groups in order, each with its cases.
pub(super) fn groups(report: &Report) -> Vec<(&str, Vec<&Record>)> {
    let mut all: Vec<(&str, Vec<&Record>)> = Vec::new();
    for record in &report.records {
        match all.iter_mut().find(|(group, _)| *group == record.group) {
            Some((_, records)) => records.push(record),
            None => all.push((&record.group, vec![record])),
        }
    }
    all
}
