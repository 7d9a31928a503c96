//! A small NMT master on the virtual bench. It boots the slaves of a list, which has the content of the objects 1F80h
//! to 1F89h of a CANopen manager.
//!
//! The process is the one that CiA 302-2 calls *boot NMT slave*: reset communication, boot-up message, device type,
//! identity, configuration, error control, start. A slave that does not follow stops it, with an error status of CiA 302-2
//! (a letter) and the reason in words. These parts of CiA 302-2 are left out: node guarding, download of programs,
//! comparison of the date of a configuration (1F26h, 1F27h), the flying master, and slaves that stay Operational while
//! the master starts.
//!
//! The master is sans-io like a device: `handle_frame`, `poll_transmit`, `poll_timeout`. A [`Bus`](crate::bus::Bus) connects it to the CAN interface of the outside.

mod boot;
mod plan;
mod status;

use std::prelude::v1::*;

use od_client::sdo::Options;
use od_client::{Client, Event, lss, watch};
use od_wire::nmt::State;
use od_wire::{Duration, Frame, Instant, NodeId};

pub use self::boot::{Boot, BootState};
pub use self::plan::{Download, Order, Plan, Slave, concise, from_concise};
pub use self::status::{Stage, Status};
use crate::sdo::is_timeout;

/// Longest time from an SDO request to its response.
const SDO_TIMEOUT: Duration = Duration::from_millis(500);

/// The SYNC message without a counter.
const SYNC: Frame = Frame::standard(0x080, &[]);

/// The master: its list, and the state of each slave.
#[derive(Clone, Debug)]
pub struct Master {
    plan: Plan,
    boots: Vec<Boot>,
    client: Client,
    /// It was told to boot; it produces SYNC from then on.
    is_on: bool,
    /// Time of the next SYNC message.
    sync: Option<Instant>,
}

impl Default for Master {
    fn default() -> Self {
        let mut options = Options::SEGMENTED;
        options.timeout = SDO_TIMEOUT;
        Self {
            plan: Plan::default(),
            boots: Vec::new(),
            client: Client::with(options, lss::Options::DEFAULT),
            is_on: false,
            sync: None,
        }
    }
}

impl Master {
    /// The list.
    pub fn plan(&self) -> &Plan {
        &self.plan
    }

    /// The state of a slave; `None` if the master has not begun to boot it.
    pub fn boot(&self, node: NodeId) -> Option<&Boot> {
        self.boots.iter().find(|boot| boot.node == node)
    }

    /// The states of all slaves, in the order in which they were booted first.
    pub fn boots(&self) -> &[Boot] {
        &self.boots
    }

    /// Carries out an order.
    ///
    /// # Errors
    /// A sentence: the list has no slave to boot.
    pub fn order(&mut self, now: Instant, order: &Order) -> Result<(), String> {
        match order {
            Order::Clear(None) => *self = Self::default(),
            Order::Clear(Some(node)) => {
                self.plan.add(order);
                self.client.unwatch(*node);
                self.boots.retain(|boot| boot.node != *node);
            }
            Order::Boot(Some(node)) => self.begin(now, *node),
            Order::Boot(None) => {
                let listed = self.plan.slaves.iter().filter(|slave| slave.is_listed);
                let nodes: Vec<_> = listed.map(|slave| slave.node).collect();
                if nodes.is_empty() {
                    return Err("the network list is empty; write `master slave 5`".into());
                }
                for node in nodes {
                    self.begin(now, node);
                }
            }
            Order::Adopt(node) => self.adopt(now, *node),
            _ => self.plan.add(order),
        }
        if matches!(order, Order::Sync(_) | Order::Boot(_) | Order::Adopt(_)) {
            self.sync = self.period().map(|period| now.plus_micros(period));
        }
        Ok(())
    }

    fn begin(&mut self, now: Instant, node: NodeId) {
        let at = self.place(node);
        self.boots[at].begin(&self.plan, &mut self.client, now);
    }

    fn adopt(&mut self, now: Instant, node: NodeId) {
        let at = self.place(node);
        self.boots[at].adopt(&self.plan, &mut self.client, now);
    }

    /// The number of the process of a node, which is new if the node has none. The master works from now on.
    fn place(&mut self, node: NodeId) -> usize {
        self.is_on = true;
        let at = self.boots.iter().position(|boot| boot.node == node);
        at.unwrap_or_else(|| {
            self.boots.push(Boot::new(node));
            self.boots.len() - 1
        })
    }

    /// Handles a frame that the master hears.
    pub(crate) fn handle_frame(&mut self, now: Instant, frame: &Frame) {
        if self.is_on {
            self.client.handle_frame(now, frame);
            self.follow(now);
            if let Some((node, state)) = watch::parse(frame)
                && state != State::Initialising
            {
                let mut boots = self.boots.iter_mut();
                if let Some(boot) = boots.find(|boot| boot.node == node) {
                    boot.handle_heartbeat(&mut self.client, now);
                }
            }
        }
    }

    /// Handles deadlines that have passed.
    pub(crate) fn handle_timeout(&mut self, now: Instant) {
        self.client.handle_timeout(now);
        self.follow(now);
        for boot in &mut self.boots {
            boot.handle_timeout(&self.plan, &mut self.client, now);
        }
    }

    /// Returns the next frame to send.
    pub(crate) fn poll_transmit(&mut self, now: Instant) -> Option<Frame> {
        if self.sync.is_some_and(|at| at <= now)
            && let Some(period) = self.period()
        {
            // A master that is late leaves SYNC messages out instead of sending them at once.
            self.sync = self.sync.map(|at| at.next_period(period, now));
            return Some(SYNC);
        }
        loop {
            let frame = self.client.poll_transmit(now)?;
            if !is_timeout(&frame) {
                return Some(frame);
            }
        }
    }

    /// Returns when to call [`handle_timeout`](Self::handle_timeout) and [`poll_transmit`](Self::poll_transmit).
    pub(crate) fn poll_timeout(&self) -> Option<Instant> {
        if !self.is_on {
            return None;
        }
        let boots = self.boots.iter().filter_map(Boot::deadline);
        boots
            .chain(self.client.poll_timeout())
            .chain(self.sync)
            .min()
    }

    /// The SYNC period in microseconds, while the master produces SYNC.
    fn period(&self) -> Option<u64> {
        (self.is_on && self.plan.sync > 0).then_some(self.plan.sync)
    }

    /// Passes the events of the client to the slaves that they are about.
    fn follow(&mut self, now: Instant) {
        while let Some(event) = self.client.poll_event() {
            let Self {
                plan,
                boots,
                client,
                ..
            } = self;
            for boot in boots.iter_mut() {
                boot.handle_event(&event, plan, client, now);
            }
            // A slave of the list that starts later is booted when it reports (CiA 302-2).
            if let Event::BootUp(node) = event
                && self.boot(node).is_none()
                && self.plan.slave(node).is_some_and(|slave| slave.is_listed)
            {
                self.begin(now, node);
            }
        }
    }
}

#[cfg(all(test, feature = "training"))]
mod tests;
