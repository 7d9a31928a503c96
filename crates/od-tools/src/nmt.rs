//! NMT commands, and the states that follow.

use std::collections::BTreeMap;

use od_client::{nmt, watch};
use od_wire::nmt::{Command, State};
use od_wire::{Duration, NodeId};

use crate::error::Error;
use crate::link::Link;

/// Sends a command to a node or to all nodes, and returns the states that they report;
/// [`State::Initialising`] stands for a boot-up message. With all nodes it listens for `wait`, with one
/// node at most until that node reports the state that the command leads to.
///
/// # Errors
/// The link is lost.
pub fn command(
    link: &mut impl Link,
    node: Option<NodeId>,
    command: Command,
    wait: Duration,
) -> Result<BTreeMap<NodeId, State>, Error> {
    let wanted = match command {
        Command::Start => State::Operational,
        Command::Stop => State::Stopped,
        Command::EnterPreOperational => State::PreOperational,
        Command::ResetNode | Command::ResetCommunication => State::Initialising,
    };
    link.send(&nmt::frame(node, command))?;
    let until = link.now() + wait;
    let mut states = BTreeMap::new();
    while let Some(heard) = link.receive(until)? {
        if let Some((from, state)) = watch::parse(&heard.frame)
            && node.is_none_or(|node| node == from)
        {
            // A heartbeat from just before the command does not count.
            if node.is_none() || state == wanted {
                states.insert(from, state);
            }
            if node.is_some() && state == wanted {
                break;
            }
        }
        if heard.at > until {
            break;
        }
    }
    Ok(states)
}
