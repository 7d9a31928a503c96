//! The process *boot NMT slave* of one node (CiA 302-2).

use std::format;
use std::prelude::v1::*;

use od_client::nmt::{Command, State};
use od_client::{Client, Error, Event, Job};
use od_model::Address;
use od_wire::{Duration, Instant, NodeId};

use super::plan::{Plan, Slave};
use super::status::{Stage, Status};

/// The state of a slave, as its master sees it.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub enum BootState {
    /// The process runs.
    Booting,
    /// The process is done: the master has started the node.
    Started,
    /// The process stopped at its stage, with this status.
    Failed(Status),
    /// The heartbeat of the node stopped after it was started.
    Lost,
}

impl BootState {
    /// `booting`, `started`, `failed`, `lost`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Booting => "booting",
            Self::Started => "started",
            Self::Failed(_) => "failed",
            Self::Lost => "lost",
        }
    }
}

/// The process of one slave.
#[derive(Clone, Debug)]
pub struct Boot {
    /// The node.
    pub node: NodeId,
    /// The state.
    pub state: BootState,
    /// The present stage, or the one at which the process ended.
    pub stage: Stage,
    /// The reason of a failure with the values that differ, in words; otherwise empty.
    pub reason: String,
    /// Whether no boot-up message came within the boot time.
    pub is_silent: bool,
    /// Times at which the stages began, from [`Stage::List`] to the present one.
    pub began: Vec<Instant>,
    job: Option<Job>,
    /// Entry of the identity or of the configuration that is in progress, counted from 0.
    entry: usize,
    deadline: Option<Instant>,
}

impl Boot {
    pub(super) fn new(node: NodeId) -> Self {
        Self {
            node,
            state: BootState::Booting,
            stage: Stage::List,
            reason: String::new(),
            is_silent: false,
            began: Vec::new(),
            job: None,
            entry: 0,
            deadline: None,
        }
    }

    /// Begins with the first stage.
    pub(super) fn begin(&mut self, plan: &Plan, client: &mut Client, now: Instant) {
        self.restart(client, now);
        self.began.clear();
        self.enter(Stage::List, now);
        if plan.slave(self.node).is_none_or(|slave| !slave.is_listed) {
            return self.fail(client, Status::A, String::new());
        }
        self.enter(Stage::Reset, now);
        client.nmt(Some(self.node), Command::ResetCommunication);
        self.enter(Stage::BootUp, now);
        self.deadline = Some(now.plus_micros(plan.boot_time));
    }

    /// Ends the process as if all its stages had been passed now.
    pub(super) fn adopt(&mut self, plan: &Plan, client: &mut Client, now: Instant) {
        self.restart(client, now);
        self.began.clear();
        for stage in Stage::ALL {
            self.enter(stage, now);
        }
        self.state = BootState::Started;
        let time = plan.slave(self.node).map_or(0, |slave| slave.heartbeat);
        if time > 0 {
            client.watch(self.node, Duration::from_micros(time));
        }
    }

    /// Time of the next deadline of this process.
    pub(super) fn deadline(&self) -> Option<Instant> {
        self.deadline
    }

    pub(super) fn handle_timeout(&mut self, plan: &Plan, client: &mut Client, now: Instant) {
        if self.deadline.is_none_or(|at| at > now) {
            return;
        }
        self.deadline = None;
        match self.stage {
            // The upload of the device type shows whether the node exists.
            Stage::BootUp => {
                self.is_silent = true;
                self.read_device_type(client, now);
            }
            Stage::ErrorControl => {
                let time = plan.slave(self.node).map_or(0, |slave| slave.heartbeat);
                let reason = format!("no heartbeat within {} ms", time / 1000);
                self.fail(client, Status::K, reason);
            }
            _ => {}
        }
    }

    pub(super) fn handle_event(
        &mut self,
        event: &Event,
        plan: &Plan,
        client: &mut Client,
        now: Instant,
    ) {
        match event {
            Event::Read(job, result) if self.job == Some(*job) => {
                self.job = None;
                self.handle_read(result, plan, client, now);
            }
            Event::Written(job, result) if self.job == Some(*job) => {
                self.job = None;
                match result {
                    Ok(()) => {
                        self.entry += 1;
                        self.configure(plan, client, now);
                    }
                    Err(why) => {
                        let object = plan.slave(self.node).and_then(|slave| {
                            let download = slave.downloads.get(self.entry)?;
                            Some(download.object())
                        });
                        let object = object.map_or(String::new(), |object| format!("{object}: "));
                        self.fail(client, Status::J, format!("{object}{why}"));
                    }
                }
            }
            // In each stage, also after the end: a node that starts again has lost its configuration.
            Event::BootUp(node) if *node == self.node && self.stage >= Stage::BootUp => {
                self.restart(client, now);
                self.began.truncate(Stage::BootUp as usize + 1);
                self.is_silent = false;
                self.read_device_type(client, now);
            }
            // A heartbeat without a boot-up message: the node was disconnected, and its configuration is unknown.
            Event::Back(node)
                if *node == self.node
                    && self.state == BootState::Lost
                    && client.state(*node) != Some(State::Initialising) =>
            {
                self.begin(plan, client, now);
            }
            Event::Lost(node) if *node == self.node && self.state == BootState::Started => {
                let time = plan.slave(self.node).map_or(0, |slave| slave.heartbeat);
                self.state = BootState::Lost;
                self.reason = format!("no heartbeat for {} ms", time / 1000);
            }
            _ => {}
        }
    }

    /// Handles a heartbeat of the node.
    pub(super) fn handle_heartbeat(&mut self, client: &mut Client, now: Instant) {
        if self.stage == Stage::ErrorControl && self.state == BootState::Booting {
            self.start(client, now);
        }
    }

    fn restart(&mut self, client: &mut Client, now: Instant) {
        if let Some(job) = self.job.take() {
            client.cancel(now, job);
        }
        client.unwatch(self.node);
        self.state = BootState::Booting;
        self.reason.clear();
        self.is_silent = false;
        self.entry = 0;
        self.deadline = None;
    }

    fn enter(&mut self, stage: Stage, now: Instant) {
        self.stage = stage;
        self.began.push(now);
    }

    fn fail(&mut self, client: &mut Client, status: Status, reason: String) {
        client.unwatch(self.node);
        self.state = BootState::Failed(status);
        self.reason = reason;
    }

    fn read_device_type(&mut self, client: &mut Client, now: Instant) {
        self.deadline = None;
        self.enter(Stage::DeviceType, now);
        self.job = Some(client.read(self.node, Address::new(0x1000, 0)));
    }

    /// Handles the end of an upload of the device type or of an entry of the identity.
    fn handle_read(
        &mut self,
        result: &Result<Vec<u8>, Error>,
        plan: &Plan,
        client: &mut Client,
        now: Instant,
    ) {
        let Some(slave) = plan.slave(self.node) else {
            return self.fail(client, Status::A, String::new());
        };
        let (expected, differs) = match self.stage {
            Stage::DeviceType => (slave.device_type, Status::C),
            _ => {
                let sub = self.entry as u8 + 1;
                (slave.identity[self.entry], Status::of_identity(sub))
            }
        };
        let value = match result {
            Ok(bytes) => bytes,
            Err(why) => {
                let status = match self.stage {
                    Stage::DeviceType => Status::B,
                    _ => differs,
                };
                return self.fail(client, status, format!("{why}"));
            }
        };
        let number = <[u8; 4]>::try_from(value.as_slice()).ok();
        let number = number.map(u32::from_le_bytes);
        if expected != 0 && number != Some(expected) {
            let is = match number {
                Some(number) => format!("{number:08X}h"),
                None => format!("a value of another length ({})", value.len()),
            };
            let reason = format!("the node has {is}, expected is {expected:08X}h");
            return self.fail(client, differs, reason);
        }
        if self.stage == Stage::DeviceType {
            self.enter(Stage::Identity, now);
            self.entry = 0;
        } else {
            self.entry += 1;
        }
        self.read_identity(slave, plan, client, now);
    }

    /// Reads the next entry of the identity that the list names; then the configuration begins.
    fn read_identity(&mut self, slave: &Slave, plan: &Plan, client: &mut Client, now: Instant) {
        let next = (self.entry..slave.identity.len()).find(|at| slave.identity[*at] != 0);
        match next {
            Some(at) => {
                self.entry = at;
                let address = Address::new(0x1018, at as u8 + 1);
                self.job = Some(client.read(self.node, address));
            }
            None => {
                self.enter(Stage::Configuration, now);
                self.entry = 0;
                self.configure(plan, client, now);
            }
        }
    }

    /// Writes the next entry of the configuration; then error control begins.
    fn configure(&mut self, plan: &Plan, client: &mut Client, now: Instant) {
        let Some(slave) = plan.slave(self.node) else {
            return;
        };
        if let Some(download) = slave.downloads.get(self.entry) {
            self.job = Some(client.write(self.node, download.address, &download.bytes));
            return;
        }
        self.enter(Stage::ErrorControl, now);
        if slave.heartbeat == 0 {
            return self.start(client, now);
        }
        client.watch(self.node, Duration::from_micros(slave.heartbeat));
        self.deadline = Some(now.plus_micros(slave.heartbeat));
    }

    fn start(&mut self, client: &mut Client, now: Instant) {
        self.deadline = None;
        self.enter(Stage::Start, now);
        client.nmt(Some(self.node), Command::Start);
        self.state = BootState::Started;
    }
}
