//! A case with the cause that a seed draws: its bench, its probes, and the mark for a cause that the learner names.

use std::format;
use std::prelude::v1::*;

use super::collection::{Case, Cause, Collection};
use super::probe::{Nodes, Probe, Reading};
use super::sight::{Language, Sight};
use crate::bench::Bench;
use crate::chance::Chance;
use crate::device::VirtualDevice;
use crate::grammar::problem::Problem;
use crate::lesson::Block;
use crate::script::{Host, Stop, run_on};

/// Time between the fault and the first probe, in microseconds.
const SETTLE: u64 = 1_500_000;
/// Time until the frames of a healthy bench are through, in microseconds.
const QUIET: u64 = 100_000;
/// Label of the device that a seed draws.
const SUSPECT: &str = "suspect";

/// A case with a seed.
#[derive(Debug)]
pub struct Trial<'c> {
    collection: &'c Collection,
    case: &'c Case,
    seed: u64,
    /// The cause: its place among the causes of the case.
    cause: usize,
}

/// The mark for a cause that a learner names. Causes and probes are places in the lists of the case.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Mark {
    /// The cause that the seed drew.
    pub cause: usize,
    /// Whether the learner named it.
    pub is_right: bool,
    /// Whether only this cause fits all readings of the learner.
    pub is_proven: bool,
    /// The smallest number of probes that proves it.
    pub fewest: usize,
    /// Probes of this number that prove it.
    pub best: Vec<usize>,
    /// The probes of the learner, in order.
    pub used: Vec<UsedProbe>,
}

/// A probe that the learner used, and what it ruled out.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct UsedProbe {
    /// Its position in the list of the case.
    pub probe: usize,
    /// Causes that fit its reading.
    pub fit: Vec<usize>,
    /// Causes that fit this reading and those before it.
    pub left: Vec<usize>,
}

impl<'c> Trial<'c> {
    /// The case with this name, with the cause of a seed; `None` if it does not exist.
    pub fn new(collection: &'c Collection, name: &str, seed: u64) -> Option<Self> {
        let case = collection.cases.iter().find(|case| case.name == name)?;
        let last = case.causes.len().saturating_sub(1);
        // Draws within the scripts begin with the seed itself.
        let cause = Chance::of_seed(!seed).up_to(last as u64) as usize;
        Some(Self {
            collection,
            case,
            seed,
            cause,
        })
    }

    /// The case.
    pub fn case(&self) -> &'c Case {
        self.case
    }

    /// The causes of the case, in its order.
    pub fn causes(&self) -> impl Iterator<Item = &'c Cause> + use<'c> {
        let all = &self.collection.causes;
        self.case
            .causes
            .iter()
            .filter_map(|number| all.get(*number))
    }

    /// The place of the drawn cause.
    pub fn cause(&self) -> usize {
        self.cause
    }

    /// The probes in words.
    ///
    /// # Errors
    /// The bench cannot be made.
    pub fn probes(&self, language: Language, host: &mut dyn Host) -> Result<Vec<String>, Problem> {
        let (_, nodes) = self.healthy(host)?;
        let words = |probe: &Probe| probe.words(&nodes, language);
        Ok(self.case.probes.iter().map(words).collect())
    }

    /// Makes a probe of the case on its bench with the drawn cause. The next probe begins on the same bench.
    ///
    /// # Errors
    /// The bench cannot be made, or the probe does not exist.
    pub fn probe(&self, number: usize, host: &mut dyn Host) -> Result<Reading, Problem> {
        let (healthy, nodes) = self.healthy(host)?;
        let mut bench = healthy.clone();
        if let Some(cause) = self.causes().nth(self.cause) {
            bench = self.broken(&healthy, cause, host)?;
        }
        match self.case.probes.get(number) {
            Some(probe) => Ok(probe.play(&bench, &nodes)),
            None => Err(Problem::new(
                0,
                format!("probe {number} does not exist"),
                "write the number of a probe of the case",
            )),
        }
    }

    /// Observations of each probe with a cause: a row of the table that a mark needs. It takes the time of all probes.
    ///
    /// # Errors
    /// The bench cannot be made.
    pub fn row(&self, cause: usize, host: &mut dyn Host) -> Result<Vec<Vec<Sight>>, Problem> {
        let (healthy, nodes) = self.healthy(host)?;
        let mut bench = healthy.clone();
        if let Some(cause) = self.causes().nth(cause) {
            bench = self.broken(&healthy, cause, host)?;
        }
        let sights = |probe: &Probe| probe.play(&bench, &nodes).sights;
        Ok(self.case.probes.iter().map(sights).collect())
    }

    /// Marks a named cause after some probes.
    ///
    /// # Errors
    /// A bench cannot be made.
    pub fn judge(
        &self,
        used: &[usize],
        named: usize,
        host: &mut dyn Host,
    ) -> Result<Mark, Problem> {
        let rows = (0..self.case.causes.len()).map(|cause| self.row(cause, host));
        let table: Vec<_> = rows.collect::<Result<_, _>>()?;
        Ok(self.mark(&table, used, named))
    }

    /// As [`judge`](Self::judge), with the [rows](Self::row) of all causes, whose readings can have any type.
    pub fn mark<R: PartialEq>(&self, table: &[Vec<R>], order: &[usize], named: usize) -> Mark {
        let all = 0..self.case.causes.len();
        let fits = |probe: usize, cause: usize| {
            let reading = |cause: usize| table.get(cause).and_then(|row| row.get(probe));
            reading(cause) == reading(self.cause)
        };
        let mut left: Vec<usize> = all.clone().collect();
        let used = order.iter().map(|probe| {
            let fit: Vec<_> = all.clone().filter(|cause| fits(*probe, *cause)).collect();
            left.retain(|cause| fit.contains(cause));
            let left = left.clone();
            UsedProbe {
                probe: *probe,
                fit,
                left,
            }
        });
        let used: Vec<UsedProbe> = used.collect();
        let best = self.best(fits);
        Mark {
            cause: self.cause,
            is_right: named == self.cause,
            is_proven: used.last().is_some_and(|last| last.left == [self.cause]),
            fewest: best.len(),
            best,
            used,
        }
    }

    /// The smallest set of probes after which only the drawn cause fits; all probes if none does.
    fn best(&self, fits: impl Fn(usize, usize) -> bool) -> Vec<usize> {
        let probes = self.case.probes.len();
        let chosen = |set: u32| (0..probes).filter(move |probe| set >> probe & 1 == 1);
        let others = || (0..self.case.causes.len()).filter(|cause| *cause != self.cause);
        let mut sets: Vec<u32> = (0..1_u32 << probes).collect();
        sets.sort_by_key(|set| set.count_ones());
        let proves =
            |set: &u32| others().all(|cause| chosen(*set).any(|probe| !fits(probe, cause)));
        let best = sets.into_iter().find(proves);
        best.map_or((0..probes).collect(), |set| chosen(set).collect())
    }

    /// Proves that the case works with its seed. Returns one sentence for each of these that does not hold:
    /// the symptom shows with each cause, each two causes differ in a probe, each probe tells something, and the
    /// probes of [`Mark::best`] prove each cause.
    pub fn prove(&self, host: &mut dyn Host) -> Vec<String> {
        match self.proof(host) {
            Ok(found) => found,
            Err(problem) => Vec::from([format!("{}: {problem}", self.case.name)]),
        }
    }

    fn proof(&self, host: &mut dyn Host) -> Result<Vec<String>, Problem> {
        let mut found = Vec::new();
        let place = format!("{} with seed {}", self.case.name, self.seed);
        let name = |cause: usize| self.causes().nth(cause).map_or("", |cause| &cause.name);
        let (bench, nodes) = self.healthy(host)?;
        for probe in self.case.probes.iter().chain(&self.case.symptom) {
            if probe
                .device()
                .is_some_and(|device| bench.device(device).is_none())
            {
                found.push(format!(
                    "{place}: {probe:?} names a device that is not on the bench"
                ));
            }
        }
        let mut table: Vec<Vec<Vec<Sight>>> = Vec::new();
        let sights = |bench: &Bench, probe: &Probe| probe.play(bench, &nodes).sights;
        for cause in self.causes() {
            let broken = self.broken(&bench, cause, host)?;
            if let Some(symptom) = &self.case.symptom
                && sights(&broken, symptom) == sights(&bench, symptom)
            {
                found.push(format!("{place}: {} does not show the symptom", cause.name));
            }
            table.push(
                self.case
                    .probes
                    .iter()
                    .map(|probe| sights(&broken, probe))
                    .collect(),
            );
        }
        for (one, row) in table.iter().enumerate() {
            for (other, _) in table
                .iter()
                .enumerate()
                .skip(one + 1)
                .filter(|(_, two)| *two == row)
            {
                found.push(format!(
                    "{place}: no probe separates {} and {}",
                    name(one),
                    name(other)
                ));
            }
        }
        for (number, probe) in self.case.probes.iter().enumerate() {
            let first = table.first().and_then(|row| row.get(number));
            if table.iter().all(|row| row.get(number) == first) {
                found.push(format!("{place}: {probe:?} tells nothing"));
            }
        }
        Ok(found)
    }

    /// The bench without the fault, after its frames are through, and its node IDs.
    fn healthy(&self, host: &mut dyn Host) -> Result<(Bench, Nodes), Problem> {
        let mut bench = Bench::default();
        bench.bus.line.set_real(true);
        bench.bus.line.set_seed(self.seed);
        for block in &self.case.bench {
            let text = self.drawn_device(&block.text);
            let line = block.line;
            self.run(&Block { line, text }, &mut bench, host)?;
        }
        let_pass(&mut bench, QUIET);
        let devices = bench.bus.devices();
        let labels = bench.labels.iter().zip(devices);
        let node = |(label, device): (&Option<String>, &VirtualDevice)| {
            Some((label.clone()?, device.node_id().raw()))
        };
        let nodes = labels.filter_map(node).collect();
        Ok((bench, nodes))
    }

    /// A copy of the healthy bench with a cause, some time later.
    fn broken(
        &self,
        healthy: &Bench,
        cause: &Cause,
        host: &mut dyn Host,
    ) -> Result<Bench, Problem> {
        let mut bench = healthy.clone();
        self.run(&cause.fault, &mut bench, host)?;
        let_pass(&mut bench, SETTLE);
        Ok(bench)
    }

    fn run(&self, block: &Block, bench: &mut Bench, host: &mut dyn Host) -> Result<(), Problem> {
        let script = block.script().map_err(|mut all| all.remove(0))?;
        let mut seeded = Seeded {
            seed: self.seed,
            host,
        };
        let stopped = |stop: Box<Stop>| {
            let help = "run the lines with `odkit run` to see their frames";
            Problem::new(stop.line, format!("{stop}"), help)
        };
        run_on(&script, bench, &mut seeded).map_err(stopped)?;
        Ok(())
    }

    /// The lines of the bench with the device that the seed draws in the place of the suspect.
    fn drawn_device(&self, text: &str) -> String {
        let devices = &self.case.devices;
        let Some(last) = devices.len().checked_sub(1) else {
            return text.to_owned();
        };
        let drawn = Chance::of_seed(self.seed.rotate_left(32)).up_to(last as u64) as usize;
        let line = |line: &str| {
            let rest = line.strip_prefix("device ").filter(|rest| {
                let words: Vec<_> = rest.split_whitespace().collect();
                words.windows(2).any(|pair| pair == ["as", SUSPECT])
            });
            match rest.and_then(|rest| rest.split_once(' ')) {
                Some((_, rest)) => format!("device {} {rest}", devices[drawn]),
                None => line.to_owned(),
            }
        };
        text.lines().map(line).collect::<Vec<_>>().join("\n")
    }
}

/// Lets time pass; frames of that time are not part of a reading.
fn let_pass(bench: &mut Bench, micros: u64) {
    let end = bench.bus.now().plus_micros(micros);
    bench.bus.advance(end);
    while bench.bus.poll().is_some() {}
    while bench.bus.line.poll().is_some() {}
}

/// A host whose `random` lines draw by a seed.
struct Seeded<'h> {
    seed: u64,
    host: &'h mut dyn Host,
}

impl Host for Seeded<'_> {
    fn inner(&mut self) -> Option<&mut dyn Host> {
        Some(self.host)
    }

    fn seed(&mut self) -> u64 {
        self.seed
    }
}
