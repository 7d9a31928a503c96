//! Runs the cases one after the other, and restores what each has changed.

use od_wire::NodeId;
use od_wire::nmt::Command;

use super::aside::{self, Fresh};
use super::case::{Case, Step};
use super::deviations::Deviations;
use super::dut::Dut;
use super::eds::Eds;
use super::end::{Checked, End, skip};
use super::play::play;
use super::record::{Record, Times, Verdict};
use super::rig::Rig;
use crate::error::Error;

/// A node that did not respond at all in this number of consecutive cases is lost.
const SILENCES: u8 = 3;
/// If the test itself is later than this, in microseconds, one run does not show that the node is wrong.
const LATE: u64 = 5_000;
/// A frame counts as missing after this many times the lateness of the test itself.
const PATIENCE: u64 = 50;
/// Some servers end a transfer if its client pauses: the most impatient known one after 25 ms.
const PAUSE: u64 = 20_000;
/// Groups whose cases measure time or depend on it: they may fail because the test itself is late.
const TIMED: [&str; 6] = [
    "NMT",
    "error control",
    "error behaviour",
    "EMCY",
    "PDO",
    "SYNC",
];
/// Greatest number of runs of a case.
const TRIES: usize = 3;
/// Time without power, in microseconds.
const POWER_OFF: u64 = 500_000;

/// Permissions of the test.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub struct Permissions {
    /// Reset the node.
    pub reset: bool,
    /// Save and restore values in the node's memory.
    pub store: bool,
    /// Move the axes of a drive, and set the outputs of a module.
    pub motion: bool,
}

impl Permissions {
    /// All of it, for a simulated device.
    pub const ALL: Self = Self {
        reset: true,
        store: true,
        motion: true,
    };
}

/// Weight of a failure as evidence against the node.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Trust {
    /// It is.
    Full,
    /// A slave on the same computer may have been late; a second failure is evidence.
    Unconfirmed,
    /// The test itself was late, by this number of microseconds.
    Late(u64),
}

/// A conformance test of one node.
pub struct Session<'s> {
    rig: &'s mut dyn Rig,
    eds: &'s Eds,
    node: NodeId,
    permissions: Permissions,
    deviations: Deviations,
    times: Times,
    lost: Option<String>,
    /// Number of times in a row that the node did not respond to anything.
    silences: u8,
    /// Lateness of the test in the last cases, in microseconds: half of it is left with each case. A computer that was
    /// busy a moment ago may delay a slave on the same computer, too.
    busy: u64,
    simulated: Option<(&'s str, Fresh<'s>)>,
}

impl<'s> Session<'s> {
    /// A test of `node` on `rig`, according to `eds`.
    pub fn new(rig: &'s mut dyn Rig, eds: &'s Eds, node: NodeId, permissions: Permissions) -> Self {
        Self {
            rig,
            eds,
            node,
            permissions,
            deviations: Deviations::built_in(),
            times: Times::default(),
            lost: None,
            silences: 0,
            busy: 0,
            simulated: None,
        }
    }

    /// The device that is simulated: a case that is only for this device gets a separate one.
    pub fn simulates(&mut self, name: &'s str, fresh: Fresh<'s>) {
        self.simulated = Some((name, fresh));
    }

    /// The times that the node took so far.
    pub fn times(&self) -> &Times {
        &self.times
    }

    /// Number of cases in a row in which the node did not respond at all; another session of the node continues from it.
    pub fn silences(&self) -> u8 {
        self.silences
    }

    /// Continues a test in which the node did not respond at all in the last `silences` cases.
    pub fn resume_after(&mut self, silences: u8) {
        self.silences = silences;
    }

    /// Reason why the test ended early; `None` if it did not.
    pub fn lost(&self) -> Option<&str> {
        self.lost.as_deref()
    }

    /// Runs one case. If the node does not respond, only this case fails; after `SILENCES` such
    /// cases in a row, and after the loss of the link, every further case is skipped.
    ///
    /// On a real bus a failure may have its cause in a busy computer: the test itself, or a slave on the same computer, was
    /// late. A case that fails while the test was late is repeated, and if it then passes, it is passed. If the test is late
    /// each time, the result is unknown, unless the case depends only on responses and fails in the same way each time.
    /// A case that depends on time must fail twice to be failed, since the test cannot measure how late the slave was. If the
    /// node does not respond afterwards, the first failure counts.
    pub fn run(&mut self, case: &Case) -> Record {
        let (mut record, mut trust) = self.once(case);
        if trust == Trust::Full || !record.verdict.is_fail() {
            return record;
        }
        let mut is_same = !TIMED.contains(&case.group.as_str());
        let mut late = 0;
        let mut evidence = 0;
        for _ in 1..TRIES {
            match trust {
                Trust::Late(micros) => late = late.max(micros),
                _ => evidence += 1,
            }
            if self.lost.is_some() {
                return record;
            }
            let (again, its) = self.once(case);
            if self.silences > 0 {
                record
                    .notes
                    .push("the node did not respond afterwards".into());
                return record;
            }
            trust = its;
            is_same &= again.verdict == record.verdict;
            let micros = record.micros + again.micros;
            let is_fail = again.verdict.is_fail();
            record.micros = micros;
            if let (false, 0, Verdict::Fail { expected, got }) = (is_fail, late, &record.verdict) {
                record.verdict = Verdict::Skipped(format!(
                    "inconclusive: it failed once (expected {expected}; {got}), and not when it was repeated"
                ));
                return record;
            }
            let is_proved = match trust {
                Trust::Full => true,
                Trust::Unconfirmed => evidence > 0,
                Trust::Late(_) => false,
            };
            if !is_fail || is_proved {
                record = Record { micros, ..again };
                record.notes.push(match late.div_ceil(1000) {
                    0 => "repeated, since it depends on time".into(),
                    millis => format!("repeated, since this computer was late by {millis} ms"),
                });
                return record;
            }
        }
        if !is_same {
            record.verdict = Verdict::Skipped(format!(
                "inconclusive: this computer was {} ms late, so the case could not be judged in {TRIES} runs; \
                 run it while the computer has less to do",
                late.div_ceil(1000)
            ));
        }
        record
    }

    /// Runs one case once.
    fn once(&mut self, case: &Case) -> (Record, Trust) {
        let from = self.rig.now();
        self.rig.host_late();
        let mut dut = Dut {
            rig: &mut *self.rig,
            eds: self.eds,
            node: self.node,
            times: &mut self.times,
            frames: Vec::new(),
            undo: Vec::new(),
            notes: Vec::new(),
            may_reset: self.permissions.reset,
            may_move: self.permissions.motion,
            sync_id: 0x80,
            fresh: self.simulated.map(|(_, fresh)| fresh),
            silence: 0,
            faults: Vec::new(),
            found: None,
            is_off: false,
            is_timed: false,
            late: 0,
            called: None,
        };
        let (mut silence, mut is_timed) = (0, true);
        let mut result = match &self.lost {
            Some(why) => skip(why),
            None => responds(&mut dut, self.silences)
                .and_then(|()| {
                    may(
                        case,
                        self.permissions,
                        &self.deviations,
                        &dut,
                        self.simulated,
                    )
                })
                .and_then(|()| {
                    let own = self.simulated.filter(|_| !case.devices.is_empty());
                    let done = match (own, &case.steps[..]) {
                        (Some((_, fresh)), [Step::Script(line, text)]) => {
                            let (done, frames) = aside::play(fresh, *line, text);
                            dut.frames = frames;
                            return done;
                        }
                        _ => {
                            let done = steps(case, &mut dut);
                            (silence, is_timed) = (dut.silence, dut.is_timed);
                            dut.judged(done)
                        }
                    };
                    if matches!(done, Err(End::Lost(Error::Interrupted))) {
                        dut.rig.resume();
                    }
                    let back = dut.put_back();
                    match (done, back) {
                        (done, Err(End::Lost(fault))) if !matches!(done, Err(End::Lost(_))) => {
                            done.and(Err(End::Lost(fault)))
                        }
                        (done, _) => done,
                    }
                }),
        };
        // A node that has stopped must not make all later cases fail.
        let is_in_doubt = matches!(result, Err(End::Fail { .. })) || self.silences > 0;
        if is_in_doubt && self.lost.is_none() && !matches!(result, Err(End::Lost(_))) {
            match revive(&mut dut) {
                Ok(true) => self.silences = 0,
                Ok(false) => self.silences += 1,
                Err(_) => self.lost = Some("the link is lost".into()),
            }
            if self.silences >= SILENCES {
                self.lost = Some("the node does not respond any more".into());
            }
        }
        if let Err(End::Lost(fault)) = &result {
            let why = match fault {
                Error::Link(text) => format!("the link is lost: {text}"),
                other => other.to_string(),
            };
            self.lost = Some(why.clone());
            result = Err(End::Skip(why));
        }
        let (notes, frames) = (dut.notes, dut.frames);
        let found = dut.found.unwrap_or(frames.len());
        let own = dut.late.max(self.rig.host_late());
        self.busy = own.max(self.busy / 2);
        // A frame that is missing for so much longer than the test was late was not sent.
        let is_missing = silence >= PATIENCE * self.busy;
        let trust = if self.busy > LATE && !is_missing && (is_timed || own >= PAUSE) {
            Trust::Late(self.busy)
        } else if is_timed && self.rig.slack() > 0 {
            Trust::Unconfirmed
        } else {
            Trust::Full
        };
        let record = Record {
            id: case.id.clone(),
            group: case.group.clone(),
            clause: case.clause.clone(),
            title: case.title.clone(),
            verdict: match result {
                Ok(()) => Verdict::Pass,
                Err(End::Fail { expected, got }) => Verdict::Fail { expected, got },
                Err(End::Skip(why)) => Verdict::Skipped(why),
                Err(End::NotApplicable(why)) => Verdict::NotApplicable(why),
                Err(End::Lost(fault)) => Verdict::Skipped(fault.to_string()),
            },
            notes,
            frames,
            found,
            micros: self.rig.now().micros_since(from),
        };
        (record, trust)
    }
}

/// Returns whether the case may be run, and applies to this node.
fn may(
    case: &Case,
    permissions: Permissions,
    deviations: &Deviations,
    dut: &Dut<'_>,
    simulated: Option<(&str, Fresh<'_>)>,
) -> Checked {
    let is_named = |name: &&str| case.devices.iter().any(|device| device == name);
    if !case.devices.is_empty() && simulated.is_none_or(|(name, _)| !is_named(&name)) {
        let names = case.devices.join(", ");
        return Err(End::NotApplicable(format!(
            "the case is about {names}, simulated"
        )));
    }
    for condition in &case.applies {
        match dut.eds.meets(condition) {
            Some(true) => {}
            Some(false) => {
                return Err(End::NotApplicable(format!(
                    "the EDS does not have `{condition}`"
                )));
            }
            None => return skip(format!("`{condition}` is not a condition")),
        }
    }
    if let Some(reason) = deviations.reason(dut.eds, &case.id) {
        return skip(format!("documented deviation: {reason}"));
    }
    for need in &case.needs {
        let (allowed, option) = match need.as_str() {
            "reset" => (permissions.reset, "--allow-reset"),
            "store" => (permissions.store, "--allow-store"),
            "motion" => (
                permissions.motion,
                "--allow-motion, since it moves an axis or sets outputs",
            ),
            _ => (dut.rig.has_power(), "--power COMMAND"),
        };
        if !allowed {
            return skip(format!("the case needs {option}"));
        }
    }
    Ok(())
}

fn steps(case: &Case, dut: &mut Dut<'_>) -> Checked {
    dut.drain()?;
    dut.nmt(Command::EnterPreOperational)?;
    dut.drain()?;
    for step in &case.steps {
        match step {
            Step::Check(check) => check(dut)?,
            Step::Script(line, text) => play(dut, *line, text)?,
        }
    }
    Ok(())
}

/// Checks that the node responds, if it did not in the case before.
fn responds(dut: &mut Dut<'_>, silences: u8) -> Checked {
    if silences == 0 || dut.is_alive()? {
        Ok(())
    } else {
        skip("the node does not respond")
    }
}

/// Returns whether the node responds, after a reset or a power cycle if necessary.
fn revive(dut: &mut Dut<'_>) -> Checked<bool> {
    if dut.is_alive()? {
        return Ok(true);
    }
    let mut resets: Vec<fn(&mut Dut<'_>) -> Checked> = Vec::new();
    if dut.may_reset {
        resets.push(|dut| dut.reset(Command::ResetNode));
    }
    if dut.rig.has_power() {
        resets.push(|dut| {
            dut.power(false)?;
            dut.wait(POWER_OFF)?;
            let from = dut.now();
            dut.power(true)?;
            dut.booted(from)
        });
    }
    for reset in resets {
        // A missing boot-up message proves nothing: the node may still respond.
        if let Err(End::Lost(fault)) = reset(dut) {
            return Err(End::Lost(fault));
        }
        if dut.is_alive()? {
            dut.notes.push("the node was reset to respond again".into());
            return Ok(true);
        }
    }
    Ok(false)
}
