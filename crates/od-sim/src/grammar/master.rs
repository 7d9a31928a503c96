//! Lines for the master on the bench: `master slave 5`, `master expect 5 1018h:02 = 10`, `master boot`.

use std::format;
use std::prelude::v1::*;

use od_model::{Address, Dictionary, values};
use od_wire::NodeId;

use super::named_frame::{Write, write};
use super::problem::Problem;
use super::tokens::Tokens;
use crate::bus::Bus;
use crate::master::{BootState, Download, Order, Status, from_concise};

/// Shortest SYNC period in microseconds.
const SHORTEST_SYNC: u64 = 1000;
/// Longest time of 1016h and 1F89h that a line can give, in microseconds.
const LONGEST: u64 = 65_535_000;

/// A line about the master.
#[derive(Clone, PartialEq, Debug)]
pub enum MasterLine {
    /// Complete as it is written.
    Order(Order),
    /// One object to write; the type of the value may be that of a device on the bench.
    Write(NodeId, Write),
}

impl MasterLine {
    /// Reads a line after `master`.
    pub(super) fn parse(tokens: &mut Tokens<'_>) -> Result<Self, Problem> {
        let here = *tokens;
        let order = match tokens.next() {
            "slave" => Order::Slave(node(tokens)?),
            "expect" => expect(tokens)?,
            "write" => return Ok(Self::Write(node(tokens)?, write(tokens)?)),
            "dcf" => Order::Configuration(node(tokens)?, dcf(tokens)?),
            "heartbeat" => Order::Heartbeat(node(tokens)?, time(tokens, 1000)?),
            "boot-time" => Order::BootTime(time(tokens, 1000)?),
            "sync" => Order::Sync(time(tokens, SHORTEST_SYNC)?),
            "boot" if tokens.is_empty() => Order::Boot(None),
            "boot" => Order::Boot(Some(node(tokens)?)),
            "started" => Order::Adopt(node(tokens)?),
            "clear" if tokens.is_empty() => Order::Clear(None),
            "clear" => Order::Clear(Some(node(tokens)?)),
            word => return Err(here.wrong(format!("a master cannot `{word}`"))),
        };
        Ok(Self::Order(order))
    }

    /// The order, with the types of the devices on this bus.
    ///
    /// # Errors
    /// The type of a value is not known, or the value does not fit it.
    pub(crate) fn order(&self, bus: &Bus) -> Result<Order, String> {
        let (node, write) = match self {
            Self::Order(order) => return Ok(order.clone()),
            Self::Write(node, write) => (*node, write),
        };
        let slave = bus.devices().iter().find(|one| one.node_id() == node);
        let (address, bytes) = match slave {
            Some(slave) => write.bytes(slave.dictionary())?,
            None if write.data_type.is_some() => write.bytes(Dictionary::EMPTY)?,
            None => {
                return Err(format!(
                    "no device on the bench has node ID {node}; add the type, such as `as u16`"
                ));
            }
        };
        Ok(Order::Write(node, Download { address, bytes }))
    }
}

/// Reads a node ID.
pub(super) fn node(tokens: &mut Tokens<'_>) -> Result<NodeId, Problem> {
    let here = *tokens;
    let raw = tokens.number(1, 127)? as u8;
    NodeId::new(raw).ok_or_else(|| here.wrong("the node ID is missing"))
}

/// Reads a time; 0 ends what it is for.
fn time(tokens: &mut Tokens<'_>, shortest: u64) -> Result<u64, Problem> {
    let here = *tokens;
    if tokens.take("0") {
        return Ok(0);
    }
    match tokens.duration()? {
        micros if micros > 0 && micros < shortest => {
            Err(here.problem("the time is too short", "the shortest time is 1ms"))
        }
        micros if micros > LONGEST => {
            Err(here.problem("the time is too long", "the limit is 65.535s"))
        }
        micros => Ok(micros),
    }
}

/// Reads `5 1018h:02 = 10`.
fn expect(tokens: &mut Tokens<'_>) -> Result<Order, Problem> {
    let node = node(tokens)?;
    let here = *tokens;
    let object = tokens.split_at_equals();
    let address = object.and_then(|object| values::address(object.rest()));
    let known = |address: &Address| match address.index {
        0x1000 => address.sub == 0,
        0x1018 => (1..=4).contains(&address.sub),
        _ => false,
    };
    let Some(address) = address.filter(known) else {
        let help = "write 1000h = … or 1018h:01 = … to 1018h:04 = …";
        return Err(here.problem("a master compares device type and identity only", help));
    };
    let value = tokens.number(0, u64::from(u32::MAX))? as u32;
    Ok(Order::Expect(node, address, value))
}

/// Reads `[01 00 00 00 17 10 00 02 00 00 00 64 00]`.
fn dcf(tokens: &mut Tokens<'_>) -> Result<Vec<Download>, Problem> {
    let here = *tokens;
    let text = tokens.take_rest();
    let inner = text.rest().strip_prefix('[');
    let inner = inner.and_then(|rest| rest.strip_suffix(']'));
    let bytes: Option<Vec<u8>> = inner.and_then(|inner| {
        let words = inner.split_whitespace();
        let byte = |word: &str| match word.len() {
            2 => u8::from_str_radix(word, 16).ok(),
            _ => None,
        };
        words.map(byte).collect()
    });
    let Some(bytes) = bytes else {
        let help = "write its bytes, such as `[01 00 00 00 17 10 00 02 00 00 00 64 00]`";
        return Err(here.problem("the concise DCF is missing", help));
    };
    from_concise(&bytes).map_err(|why| {
        let help = "write the number of entries in 4 bytes, then index, sub-index, length (4 bytes) and value of each";
        here.problem(why, help)
    })
}

/// A state of a slave, as a condition names it.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Wanted {
    /// The master has not begun to boot it.
    Waiting,
    /// The process runs.
    Booting,
    /// It is started.
    Started,
    /// The process stopped, with this status or with any.
    Failed(Option<Status>),
    /// Its heartbeat stopped.
    Lost,
}

impl Wanted {
    /// Reads `started`, `lost`, `failed D` …
    pub(super) fn parse(tokens: &mut Tokens<'_>) -> Result<Self, Problem> {
        let wanted = tokens.one_of(
            "state",
            &[
                ("started", Self::Started),
                ("booting", Self::Booting),
                ("lost", Self::Lost),
                ("waiting", Self::Waiting),
                ("failed", Self::Failed(None)),
            ],
        )?;
        if wanted != Self::Failed(None) || tokens.is_empty() {
            return Ok(wanted);
        }
        let letters = Status::ALL.map(|status| (status.letter(), Some(status)));
        Ok(Self::Failed(tokens.one_of("error status", &letters)?))
    }

    /// Returns whether a slave is in this state; `None`: the master has not begun to boot it.
    pub(super) fn holds(self, state: Option<BootState>) -> bool {
        match (self, state) {
            (Self::Waiting, None)
            | (Self::Booting, Some(BootState::Booting))
            | (Self::Started, Some(BootState::Started))
            | (Self::Failed(None), Some(BootState::Failed(_)))
            | (Self::Lost, Some(BootState::Lost)) => true,
            (Self::Failed(Some(wanted)), Some(BootState::Failed(status))) => wanted == status,
            _ => false,
        }
    }

    /// The state in words, for use after the node.
    pub(super) fn words(self) -> String {
        match self {
            Self::Waiting => "is not booted yet".into(),
            Self::Booting => "is being booted".into(),
            Self::Started => "is started".into(),
            Self::Failed(None) => "has failed to boot".into(),
            Self::Failed(Some(status)) => {
                format!("has failed to boot with error status {}", status.letter())
            }
            Self::Lost => "is lost".into(),
        }
    }

    /// The state in one or a few words, for use after "it is".
    pub(super) fn short(self) -> String {
        match self {
            Self::Waiting => "not booted yet".into(),
            Self::Booting => "being booted".into(),
            Self::Started => "started".into(),
            Self::Failed(None) => "failed".into(),
            Self::Failed(Some(status)) => format!("failed, error status {}", status.letter()),
            Self::Lost => "lost".into(),
        }
    }

    /// The state of a slave as a condition names it.
    pub(super) fn of(state: Option<BootState>) -> Self {
        match state {
            None => Self::Waiting,
            Some(BootState::Booting) => Self::Booting,
            Some(BootState::Started) => Self::Started,
            Some(BootState::Failed(status)) => Self::Failed(Some(status)),
            Some(BootState::Lost) => Self::Lost,
        }
    }
}
