//! A client on a link: it sends the frames of its jobs, and waits for responses.

use std::collections::{BTreeMap, VecDeque};
use std::sync::Arc;

use od_client::emcy::Emcy;
use od_client::sdo::Options;
use od_client::{Client, Event, Job, lss, nmt, watch};
use od_model::{Address, DataType};
use od_tools::Error;
use od_tools::link::{Heard, Link};
use od_tools::tpdos;
use od_wire::nmt::{Command, State};
use od_wire::{Duration, Instant, NodeId};

use crate::client::known::{Known, Tpdo};
use crate::client::link::Line;

/// Maximum number of PDOs and EMCY messages that wait for the caller; the oldest ones are dropped.
const KEPT: usize = 100_000;

/// A received PDO.
pub(crate) struct Came {
    pub(crate) at: Instant,
    pub(crate) tpdo: Tpdo,
    pub(crate) data: Vec<u8>,
}

/// A client, its link, and its state.
pub(crate) struct Core {
    pub(crate) line: Line,
    client: Client,
    pub(crate) timeout: Duration,
    pub(crate) known: BTreeMap<u8, Arc<Known>>,
    pub(crate) tpdos: Vec<Tpdo>,
    pub(crate) pdos: VecDeque<Came>,
    pub(crate) emcys: VecDeque<(Instant, NodeId, Emcy)>,
    /// Nodes whose heartbeat is missing.
    pub(crate) lost: Vec<NodeId>,
}

fn keep<T>(queue: &mut VecDeque<T>, one: T) {
    if queue.len() == KEPT {
        queue.pop_front();
    }
    queue.push_back(one);
}

impl Core {
    pub(crate) fn new(line: Line, timeout: Duration) -> Self {
        let mut options = Options::DEFAULT;
        options.timeout = timeout;
        Self {
            line,
            client: Client::with(options, lss::Options::DEFAULT),
            timeout,
            known: BTreeMap::new(),
            tpdos: Vec::new(),
            pdos: VecDeque::new(),
            emcys: VecDeque::new(),
            lost: Vec::new(),
        }
    }

    /// Reads an object; the type says the size of a value whose response names none.
    pub(crate) fn upload(
        &mut self,
        node: NodeId,
        address: Address,
        data_type: Option<DataType>,
    ) -> Result<Result<Vec<u8>, od_client::Error>, Error> {
        let job = match data_type {
            Some(data_type) => self.client.read_as(node, address, data_type),
            None => self.client.read(node, address),
        };
        loop {
            if let Event::Read(_, result) = self.end(job)? {
                return Ok(result);
            }
        }
    }

    /// Writes an object.
    pub(crate) fn download(
        &mut self,
        node: NodeId,
        address: Address,
        bytes: &[u8],
    ) -> Result<Result<(), od_client::Error>, Error> {
        let job = self.client.write(node, address, bytes);
        loop {
            if let Event::Written(_, result) = self.end(job)? {
                return Ok(result);
            }
        }
    }

    /// Reads which TPDOs of a node are valid, and their mapping; returns their numbers, from 1.
    pub(crate) fn read_mapping(
        &mut self,
        node: NodeId,
    ) -> Result<Result<Vec<u16>, (Address, od_client::Error)>, Error> {
        let found = tpdos::read(|address| match self.number(node, address) {
            Ok(Ok(number)) => Ok(number),
            Ok(Err(failed)) => Err(Ok(failed)),
            Err(error) => Err(Err(error)),
        });
        let found = match found {
            Ok(found) => found,
            Err(Ok(failed)) => return Ok(Err(failed)),
            Err(Err(error)) => return Err(error),
        };
        let numbers = found.iter().map(|one| one.number).collect();
        self.tpdos.retain(|one| one.node != node.raw());
        self.tpdos.extend(found.into_iter().map(|one| Tpdo {
            node: node.raw(),
            number: one.number,
            id: one.id,
            mapping: one.mapping,
        }));
        Ok(Ok(numbers))
    }

    /// A number of at most 4 bytes; `None` if the node does not have it.
    fn number(
        &mut self,
        node: NodeId,
        address: Address,
    ) -> Result<Result<Option<u32>, (Address, od_client::Error)>, Error> {
        Ok(match self.upload(node, address, None)? {
            Ok(bytes) if bytes.len() <= 4 => {
                let bytes = bytes.iter().rev();
                Ok(Some(
                    bytes.fold(0, |number, byte| number << 8 | u32::from(*byte)),
                ))
            }
            Ok(_) | Err(od_client::Error::Abort(_)) => Ok(None),
            Err(error) => Err((address, error)),
        })
    }

    /// Sends an NMT command and waits for the resulting state; `None` if it was not received.
    pub(crate) fn nmt(
        &mut self,
        node: Option<NodeId>,
        command: Command,
        wait: Duration,
    ) -> Result<Option<State>, Error> {
        let wanted = match command {
            Command::Start => State::Operational,
            Command::Stop => State::Stopped,
            Command::EnterPreOperational => State::PreOperational,
            Command::ResetNode | Command::ResetCommunication => State::Initialising,
        };
        self.line.send(&nmt::frame(node, command))?;
        let until = self.line.now() + wait;
        self.listen(until, |heard| {
            let (from, state) = watch::parse(&heard.frame)?;
            (node.is_none_or(|node| node == from) && state == wanted).then_some(state)
        })
    }

    /// Waits for an event until a moment; `None` if it did not happen.
    pub(crate) fn listen<T>(
        &mut self,
        until: Instant,
        mut found: impl FnMut(&Heard) -> Option<T>,
    ) -> Result<Option<T>, Error> {
        loop {
            self.send()?;
            let next = self
                .client
                .poll_timeout()
                .map_or(until, |due| due.min(until));
            match self.line.receive(next)? {
                Some(heard) => {
                    self.hear(&heard);
                    self.take_events();
                    let result = found(&heard);
                    if result.is_some() {
                        return Ok(result);
                    }
                }
                None => {
                    self.client.handle_timeout(self.line.now());
                    self.take_events();
                }
            }
            if self.line.now() >= until {
                // Events at that moment count.
                while let Some(heard) = self.line.receive(Instant::ZERO)? {
                    self.hear(&heard);
                    let result = found(&heard);
                    if result.is_some() {
                        return Ok(result);
                    }
                }
                return Ok(None);
            }
        }
    }

    /// Handles the frames received so far.
    pub(crate) fn catch_up(&mut self) -> Result<(), Error> {
        while let Some(heard) = self.line.receive(Instant::ZERO)? {
            self.hear(&heard);
        }
        self.take_events();
        Ok(())
    }

    /// The state in the last heartbeat of a node.
    pub(crate) fn state(&self, node: NodeId) -> Option<State> {
        self.client.state(node)
    }

    /// Monitors the heartbeat of a node; `None` ends that.
    pub(crate) fn watch(&mut self, node: NodeId, heartbeat: Option<Duration>) {
        match heartbeat {
            Some(time) => self.client.watch(node, time),
            None => self.client.unwatch(node),
        }
    }

    /// Waits for the end of a job. If the program is to stop, the transfer is aborted.
    fn end(&mut self, job: Job) -> Result<Event, Error> {
        let event = self.wait();
        if matches!(event, Err(Error::Interrupted)) {
            let now = self.line.now();
            self.client.cancel(now, job);
            while let Some(frame) = self.client.poll_transmit(now) {
                self.line.send(&frame)?;
            }
        }
        event
    }

    fn wait(&mut self) -> Result<Event, Error> {
        loop {
            self.send()?;
            if let Some(event) = self.next_end() {
                return Ok(event);
            }
            let until = self.client.poll_timeout().unwrap_or(Instant::ZERO);
            match self.line.receive(until)? {
                Some(heard) => self.hear(&heard),
                None => self.client.handle_timeout(self.line.now()),
            }
        }
    }

    fn send(&mut self) -> Result<(), Error> {
        while let Some(frame) = self.client.poll_transmit(self.line.now()) {
            self.line.send(&frame)?;
        }
        Ok(())
    }

    fn hear(&mut self, heard: &Heard) {
        self.client.handle_frame(heard.at, &heard.frame);
        if self.tpdos.is_empty() || heard.frame.is_remote() {
            return;
        }
        let id = heard.frame.id();
        if let Some(tpdo) = self.tpdos.iter().find(|one| one.id == id) {
            let came = Came {
                at: heard.at,
                tpdo: tpdo.clone(),
                data: heard.frame.data().to_vec(),
            };
            keep(&mut self.pdos, came);
        }
    }

    fn take_events(&mut self) {
        while self.next_end().is_some() {}
    }

    /// Waits for the next end of a job; other events are stored.
    fn next_end(&mut self) -> Option<Event> {
        loop {
            match self.client.poll_event()? {
                Event::Emcy(node, emcy) => {
                    let now = self.line.now();
                    keep(&mut self.emcys, (now, node, emcy));
                }
                Event::Lost(node) => self.lost.push(node),
                Event::Back(node) => self.lost.retain(|one| *one != node),
                end @ (Event::Read(..) | Event::Written(..)) => return Some(end),
                _ => {}
            }
        }
    }
}
