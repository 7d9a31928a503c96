//! The node under test: sends frames, waits for responses, and restores values.

use od_model::Address;
use od_wire::nmt::{Command, Repr};
use od_wire::{Frame, Instant, NodeId};

use super::aside::Fresh;
use super::eds::Eds;
use super::end::{Checked, End, fail, lacks};
use super::record::{Times, Traced};
use super::rig::Rig;
use crate::link::Heard;

/// Time limit for a response, in microseconds.
pub(crate) const ANSWER: u64 = 1_000_000;
/// Time to watch for a forbidden frame.
pub(crate) const QUIET: u64 = 100_000;
/// First of the CAN-IDs that cases give to services for a while: no service has them by default (CiA 301, 7.3.4).
pub(crate) const FREE: u16 = 0x6A0;
/// Time limit from a reset to the boot-up message.
const BOOT: u64 = 10_000_000;
/// Time limit for an NMT command.
const SETTLE: u64 = 20_000;
/// Maximum time of a frame from the bus to the test: some serial adapters keep bytes for 16 ms.
const TRANSPORT: u64 = 20_000;

/// The node under test, while a case is run.
pub struct Dut<'d> {
    pub(crate) rig: &'d mut dyn Rig,
    pub(crate) eds: &'d Eds,
    pub(crate) node: NodeId,
    pub(crate) times: &'d mut Times,
    pub(crate) frames: Vec<Traced>,
    /// Values to be restored, the last one first.
    pub(crate) undo: Vec<(Address, Vec<u8>)>,
    pub(crate) notes: Vec<String>,
    /// Whether the case may reset the node.
    pub(crate) may_reset: bool,
    /// Whether the case may move axes and set outputs.
    pub(crate) may_move: bool,
    /// The last known COB-ID of SYNC.
    pub(crate) sync_id: u32,
    /// Makes the device again, if it is simulated.
    pub(crate) fresh: Option<Fresh<'d>>,
    /// Duration of the present silence of the node: of a wait for a frame that did not arrive, in
    /// microseconds; 0 if anything was sent or received since.
    pub(crate) silence: u64,
    /// Faults so far in a case that tests all its objects: expected and actual behaviour.
    pub(crate) faults: Vec<(String, String)>,
    /// Number of `frames` when the first of them was found.
    pub(crate) found: Option<usize>,
    /// Whether the case switched the power off.
    pub(crate) is_off: bool,
    /// Whether the case waited for anything but SDO responses: it then depends on the time at which the test did what it
    /// did.
    pub(crate) is_timed: bool,
    /// Longest delay of the test itself, in microseconds: a wait that lasted longer than requested, or a pause between
    /// two calls, because the computer was busy.
    pub(crate) late: u64,
    /// End of the last call of the rig; `None` before the first, and after a call that may take any time.
    pub(crate) called: Option<Instant>,
}

impl Dut<'_> {
    pub(crate) fn now(&self) -> Instant {
        self.rig.now()
    }

    /// The time at which a call of the rig begins. Nothing between two calls takes long, so a pause is a delay of the
    /// test itself.
    fn begin(&mut self) -> Instant {
        let now = self.now();
        if let Some(called) = self.called {
            self.delayed(now, called);
        }
        now
    }

    /// Records that something that was due at `due` was done at `now`. Virtual time is never late.
    fn delayed(&mut self, now: Instant, due: Instant) {
        if self.rig.slack() > 0 {
            self.late = self.late.max(now.micros_since(due));
        }
    }

    pub(crate) fn send(&mut self, frame: Frame) -> Checked {
        let at = self.begin();
        self.silence = 0;
        self.rig.send(&frame)?;
        self.called = Some(self.now());
        self.frames.push(Traced {
            at,
            ours: true,
            frame,
        });
        Ok(())
    }

    /// Sends a data frame with an 11-bit CAN-ID.
    pub(crate) fn send_to(&mut self, id: u16, data: &[u8]) -> Checked {
        match Frame::new(od_wire::CanId::standard(id), data) {
            Some(frame) => self.send(frame),
            None => Ok(()),
        }
    }

    /// Sends a remote frame.
    pub(crate) fn ask_for(&mut self, id: od_wire::CanId, dlc: u8) -> Checked {
        match Frame::remote(id, dlc) {
            Some(frame) => self.send(frame),
            None => Ok(()),
        }
    }

    /// Waits for the next frame until a moment.
    pub(crate) fn receive(&mut self, until: Instant) -> Checked<Option<Heard>> {
        let from = self.begin();
        let heard = self.rig.receive(until)?;
        let now = self.now();
        self.called = Some(now);
        // A frame that was waiting is not a delay.
        let due = heard.map_or(until, |heard| heard.at.plus_micros(TRANSPORT));
        self.delayed(now, due.max(from));
        if let Some(Heard { at, frame }) = heard {
            self.frames.push(Traced {
                at,
                ours: false,
                frame,
            });
        }
        Ok(heard)
    }

    /// Discards the frames that arrived already.
    pub(crate) fn drain(&mut self) -> Checked {
        while self.receive(Instant::ZERO)?.is_some() {}
        Ok(())
    }

    /// Waits for a frame that `wanted` accepts, for `micros` microseconds.
    pub(crate) fn next(
        &mut self,
        micros: u64,
        wanted: impl Fn(&Frame) -> bool,
    ) -> Checked<Option<Heard>> {
        self.is_timed = true;
        self.awaited(micros, wanted)
    }

    /// Waits for the response to a request. One that comes does not depend on the test's own lateness.
    pub(crate) fn awaited(
        &mut self,
        micros: u64,
        wanted: impl Fn(&Frame) -> bool,
    ) -> Checked<Option<Heard>> {
        let until = self.now().plus_micros(micros + self.rig.slack());
        self.silence = 0;
        while let Some(heard) = self.receive(until)? {
            if wanted(&heard.frame) {
                return Ok(Some(heard));
            }
        }
        self.silence = micros;
        self.is_timed = true;
        Ok(None)
    }

    /// The next data frame with this CAN-ID.
    pub(crate) fn next_of(&mut self, id: u16, micros: u64) -> Checked<Option<Heard>> {
        self.next(micros, |frame| is_data(frame, id))
    }

    /// All data frames with this CAN-ID within `micros` microseconds.
    pub(crate) fn all_of(&mut self, id: u16, micros: u64) -> Checked<Vec<Heard>> {
        self.is_timed = true;
        let until = self.now().plus_micros(micros);
        let mut all = Vec::new();
        while let Some(heard) = self.receive(until)? {
            if is_data(&heard.frame, id) {
                all.push(heard);
            }
        }
        Ok(all)
    }

    /// Fails if a frame with this CAN-ID arrives.
    pub(crate) fn silent(&mut self, id: u16, micros: u64, expected: &str) -> Checked {
        match self.next_of(id, micros)? {
            Some(heard) => fail(expected, format!("{} came", heard.frame)),
            None => Ok(()),
        }
    }

    /// Records a failure so that a case can continue with its other objects; any other end ends the case.
    pub(crate) fn fault(&mut self, done: Checked) -> Checked {
        match done {
            Err(End::Fail { expected, got }) => {
                self.found.get_or_insert(self.frames.len());
                self.faults.push((expected, got));
                Ok(())
            }
            other => other,
        }
    }

    /// The result of a case with its recorded failures: the first is the verdict, each other one a note.
    pub(crate) fn judged(&mut self, done: Checked) -> Checked {
        if matches!(done, Err(End::Lost(_))) {
            return done;
        }
        let last = self.fault(done);
        let mut faults = std::mem::take(&mut self.faults).into_iter();
        let Some((expected, got)) = faults.next() else {
            return last;
        };
        let more = faults.map(|(expected, got)| format!("also expected {expected}; {got}"));
        self.notes.extend(more);
        fail(expected, got)
    }

    /// Lets time pass.
    pub(crate) fn wait(&mut self, micros: u64) -> Checked {
        self.is_timed = true;
        self.settle(micros)
    }

    /// Gives the node time for a command.
    pub(crate) fn settle(&mut self, micros: u64) -> Checked {
        let until = self.now().plus_micros(micros);
        while self.receive(until)?.is_some() {}
        Ok(())
    }

    /// Returns whether the node sends anything: an SDO response or abort, a heartbeat, a boot-up message, or a
    /// response to node guarding.
    pub(crate) fn is_alive(&mut self) -> Checked<bool> {
        let (answer, state) = (self.id(0x580), self.id(0x700));
        // Ends an earlier transfer, also in a server that waits for a segment.
        let request = self.node.plus(0x600);
        self.send(Frame::full(request, [0x80, 0, 0, 0, 0, 0, 0, 8]))?;
        for index in [0x1000_u16, 0x1001, 0x1018] {
            let [low, high] = index.to_le_bytes();
            self.drain()?;
            self.send(Frame::full(request, [0x40, low, high, 0, 0, 0, 0, 0]))?;
            let is_its = |frame: &Frame| is_data(frame, answer) || is_data(frame, state);
            if self.next(ANSWER, is_its)?.is_some() {
                return Ok(true);
            }
        }
        Ok(self.guarded()?.is_some())
    }

    /// Sends an NMT command to the node, and gives it time.
    pub(crate) fn nmt(&mut self, command: Command) -> Checked {
        let node = self.node.raw();
        self.send(Frame::standard(0, &Repr { command, node }.emit()))?;
        self.settle(SETTLE)
    }

    /// Resets the node and waits for its boot-up message.
    pub(crate) fn reset(&mut self, command: Command) -> Checked {
        self.drain()?;
        let from = self.now();
        let node = self.node.raw();
        self.send(Frame::standard(0, &Repr { command, node }.emit()))?;
        self.booted(from)
    }

    /// Switches the power of the node.
    pub(crate) fn power(&mut self, on: bool) -> Checked {
        self.rig.power(on)?;
        self.called = None;
        self.is_off = !on;
        Ok(())
    }

    /// Switches the power of the node off and on, and waits for the boot-up message.
    pub(crate) fn power_cycle(&mut self) -> Checked {
        self.power(false)?;
        self.wait(500_000)?;
        self.drain()?;
        let from = self.now();
        self.power(true)?;
        self.booted(from)
    }

    /// Waits for the boot-up message.
    pub(crate) fn booted(&mut self, from: Instant) -> Checked {
        let id = self.id(0x700);
        let Some(heard) = self.next(BOOT, |frame| is_data(frame, id) && frame.data() == [0])?
        else {
            return fail(
                format!("the boot-up message {id:03X}#00 within 10 s of the reset"),
                "none came",
            );
        };
        self.times.boots.push(heard.at.micros_since(from));
        self.wait(SETTLE)
    }

    /// A CAN-ID of the predefined connection set: the base plus the node ID.
    pub(crate) fn id(&self, base: u16) -> u16 {
        base + u16::from(self.node.raw())
    }

    /// Sets the heartbeat to 50 ms, since a slow one does not show the NMT state in time.
    pub(crate) fn follow_state(&mut self) -> Checked {
        if self.eds.writes(0x1017, 0) {
            return self.set(Address::new(0x1017, 0), &[50, 0]);
        }
        match self.guarded()? {
            Some(_) => Ok(()),
            None => lacks("the NMT state cannot be seen: 1017h is read only, and no node guarding"),
        }
    }

    /// Finds the NMT state by heartbeat or node guarding.
    pub(crate) fn state(&mut self) -> Checked<u8> {
        let id = self.id(0x700);
        if self.eds.writes(0x1017, 0) {
            return match self.next_of(id, 200_000)? {
                Some(heard) => Ok(heard.frame.bytes()[0]),
                None => fail("a heartbeat within 200 ms", "none came"),
            };
        }
        match self.guarded()? {
            Some(state) => Ok(state & 0x7F),
            None => fail("a response to node guarding", "none came"),
        }
    }

    /// The response to a request of node guarding.
    pub(crate) fn guarded(&mut self) -> Checked<Option<u8>> {
        self.drain()?;
        let id = self.id(0x700);
        self.ask_for(od_wire::CanId::standard(id), 1)?;
        let heard = self.next_of(id, QUIET)?;
        Ok(heard.map(|heard| heard.frame.bytes()[0]))
    }

    /// Fails unless the node is in this NMT state.
    pub(crate) fn is_in(&mut self, state: u8) -> Checked {
        self.drain()?;
        match self.state()? {
            is if is == state => Ok(()),
            is => fail(
                format!("NMT state {}", state_name(state)),
                format!("the node is in {}", state_name(is)),
            ),
        }
    }

    /// Restores the values that a case has changed since `kept`, the number of values to be restored then.
    pub(crate) fn put_back_since(&mut self, kept: usize) -> Checked {
        while self.undo.len() > kept {
            if let Some((address, bytes)) = self.undo.pop()
                && let Err(code) = self.download(address, &bytes)?
            {
                self.notes
                    .push(format!("could not put back {address}: abort {code:08X}h"));
            }
        }
        Ok(())
    }

    /// Switches the power on, enters Pre-operational, and restores all values. Returns notes about values that could
    /// not be restored, also if the link is lost.
    pub(crate) fn put_back(&mut self) -> Checked {
        if self.undo.is_empty() && self.frames.is_empty() {
            return Ok(());
        }
        // A transfer that the case left open would receive the first restored value.
        let close = [0x80, 0, 0, 0, 0, 0, 0, 8];
        let mut lost = if self.is_off {
            let from = self.now();
            self.power(true).and_then(|()| self.booted(from)).err()
        } else if self.undo.is_empty() {
            None
        } else {
            self.send(Frame::full(self.node.plus(0x600), close)).err()
        };
        if lost.is_some() && self.is_off {
            self.notes
                .push("could not switch the power on again".into());
        }
        lost = lost.or(self.nmt(Command::EnterPreOperational).err());
        while let Some((address, bytes)) = self.undo.pop() {
            let shown = od_model::values::label(self.eds.dictionary(), address);
            let hex = od_model::values::hex(&bytes);
            let done = match &lost {
                Some(End::Lost(fault)) => Err(End::Lost(fault.clone())),
                _ => self.download(address, &bytes),
            };
            self.notes.push(match done {
                Ok(Ok(())) => format!("put back {shown} = {hex}"),
                Ok(Err(code)) => format!("could not put back {shown} = {hex}: abort {code:08X}h"),
                Err(End::Lost(fault)) => {
                    let note = format!("could not put back {shown} = {hex}: {fault}");
                    lost = Some(End::Lost(fault));
                    note
                }
                Err(_) => format!("could not put back {shown} = {hex}"),
            });
        }
        match lost {
            Some(End::Lost(fault)) => Err(End::Lost(fault)),
            _ => Ok(()),
        }
    }
}

/// Returns whether it is a data frame with this 11-bit CAN-ID.
pub(crate) fn is_data(frame: &Frame, id: u16) -> bool {
    frame.id().as_standard() == Some(id) && !frame.is_remote()
}

/// The NMT state of a heartbeat, in words.
pub(crate) fn state_name(state: u8) -> String {
    match od_wire::nmt::State::from_code(state) {
        Some(state) => state.name().into(),
        None => format!("a state {state:02X}h that does not exist"),
    }
}
