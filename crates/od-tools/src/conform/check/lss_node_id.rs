//! LSS: a node ID that is configured and stored.

use od_model::{Address, Entry, Group, values};
use od_wire::lss::{MASTER, Request, SLAVE};
use od_wire::nmt::Command;
use od_wire::{Frame, NodeId};

use super::lss::{ask, configured, select, waiting};
use super::store;
use crate::conform::dut::{Dut, QUIET, is_data};
use crate::conform::end::{Checked, End, ensure, fail, lacks, skip};
use crate::conform::sdo::request;

/// A node ID that the node does not have, and no other node on the bus.
fn another_id(dut: &mut Dut<'_>) -> Checked<NodeId> {
    let raw = if dut.node.raw() == 126 { 125 } else { 126 };
    let Some(other) = NodeId::new(raw) else {
        return lacks("there is no other node ID");
    };
    dut.drain()?;
    let hello = request(0x40, Address::new(0x1000, 0), [0; 4]);
    dut.send(Frame::full(other.plus(0x600), hello))?;
    if dut
        .next(QUIET, |frame| frame.id() == other.plus(0x580))?
        .is_some()
    {
        return skip(format!("another node has node ID {other}"));
    }
    Ok(other)
}

/// A node ID that was configured is in use after reset communication: for SDO, and in each default with $NODEID.
pub(super) fn taken(dut: &mut Dut<'_>) -> Checked {
    let saves = dut.eds.has(0x1010);
    takes(dut, saves)
}

/// As [`taken`], after a restore: then no saved value hides a default.
pub(super) fn follows_when_restored(dut: &mut Dut<'_>) -> Checked {
    let before = store::backup(dut)?;
    let done = store::command(dut, 0x1011, 1, b"load")
        .and_then(|()| dut.reset(Command::ResetNode))
        .and_then(|()| takes(dut, false));
    if let Err(End::Lost(_)) = done {
        return done;
    }
    done.and(store::bring_back(dut, &before))
}

fn takes(dut: &mut Dut<'_>, saves: bool) -> Checked {
    let own = dut.node;
    let other = another_id(dut)?;
    let mut done = has_taken(dut, other, saves);
    if dut.node != own {
        dut.nmt(Command::EnterPreOperational)?;
        if !renumber(dut, own)? {
            let note = format!("could not put back node ID {own}: the node has node ID {other}");
            dut.notes.push(note.clone());
            done = done.and(fail("the node to take its own node ID again", note));
        }
    }
    dut.nmt(Command::EnterPreOperational)?;
    done
}

/// Defaults that follow the node ID, now and with the other one. If the node may have saved values, only those of objects
/// that no save includes, since a node may save a COB-ID as it is.
fn defaults(dut: &mut Dut<'_>, other: NodeId, saves: bool) -> Checked<Vec<(Address, Vec<u8>)>> {
    let own = dut.node;
    let mut follow = Vec::new();
    for entry in dut.eds.dictionary().entries().collect::<Vec<Entry>>() {
        let is_saved = saves && entry.access.writable() && entry.group != Group::None;
        let values = [own, other].map(|node| dut.eds.default(&entry, node));
        if let [Some(here), Some(there)] = values
            && here != there
            && !is_saved
            && entry.access.readable()
            && dut.upload(entry.address)?.as_ref() == Ok(&here)
        {
            follow.push((entry.address, there));
        }
    }
    Ok(follow)
}

fn has_taken(dut: &mut Dut<'_>, other: NodeId, saves: bool) -> Checked {
    let own = dut.node;
    let follow = defaults(dut, other, saves)?;
    if !renumber(dut, other)? {
        configured(dut)?;
        let answer = ask(
            dut,
            Request::ConfigureNodeId {
                node_id: other.raw(),
            },
        )?;
        ask(dut, Request::ConfigureNodeId { node_id: own.raw() })?;
        waiting(dut)?;
        return match answer {
            Some([0x11, 0, ..]) => fail(
                format!("node ID {other} after reset communication, as it was configured"),
                format!("the node has node ID {own}"),
            ),
            _ => lacks(format!("the node refuses node ID {other}")),
        };
    }
    dut.still_serves()?;
    for (address, wanted) in follow {
        let is = dut.upload(address)?.unwrap_or_default();
        let name = values::label(dut.eds.dictionary(), address);
        let done = ensure(
            is == wanted,
            format!(
                "{} in {name} with node ID {other}, the default",
                values::hex(&wanted)
            ),
            format!("{} was read", values::hex(&is)),
        );
        dut.fault(done)?;
    }
    dut.drain()?;
    let hello = request(0x40, Address::new(0x1000, 0), [0; 4]);
    dut.send(Frame::full(own.plus(0x600), hello))?;
    match dut.next(QUIET, |frame| {
        [own, other]
            .iter()
            .any(|node| frame.id() == node.plus(0x580))
    })? {
        Some(heard) => fail(
            format!("no response to a request to node ID {own}, which the node had before"),
            format!("{} came", heard.frame),
        ),
        None => Ok(()),
    }
}

/// A stored node ID is active after a reset or a power cycle.
pub(super) fn store_node_id(dut: &mut Dut<'_>) -> Checked {
    let own = dut.node;
    let other = another_id(dut)?;
    if !renumber(dut, other)? {
        dut.nmt(Command::EnterPreOperational)?;
        return lacks("the node does not take another node ID by LSS before it is stored");
    }
    let done = stored(dut).and_then(|()| started_as(dut, [own, other]));
    // In any case the node gets its node ID back.
    if dut.node != own {
        dut.nmt(Command::EnterPreOperational)?;
        if !renumber(dut, own)? {
            let note = format!("could not put back node ID {own}: the node has node ID {other}");
            dut.notes.push(note);
            return done;
        }
    }
    let back = stored(dut);
    dut.nmt(Command::EnterPreOperational)?;
    done.and(back)
}

/// A node ID that was configured, and not stored, is forgotten with a start.
pub(super) fn forgets_node_id(dut: &mut Dut<'_>) -> Checked {
    let own = dut.node;
    let other = another_id(dut)?;
    let all = configured(dut)?;
    let node_id = other.raw();
    let answer = ask(dut, Request::ConfigureNodeId { node_id })?;
    waiting(dut)?;
    if !matches!(answer, Some([0x11, 0, ..])) {
        dut.nmt(Command::EnterPreOperational)?;
        return lacks(format!("the node refuses node ID {other}"));
    }
    let done = started_as(dut, [other, own]);
    if dut.node != own {
        dut.nmt(Command::EnterPreOperational)?;
        if renumber(dut, own)? {
            stored(dut)?;
        } else {
            let note = format!("could not put back node ID {own}: the node has node ID {other}");
            dut.notes.push(note);
        }
    } else if done.is_err() {
        // It may have the other one without a start.
        give_back(dut, all)?;
    }
    dut.nmt(Command::EnterPreOperational)?;
    done
}

/// Configures the node ID of the node, which may have another one, by its LSS address.
fn give_back(dut: &mut Dut<'_>, all: [u32; 4]) -> Checked {
    select(dut, all)?;
    let node_id = dut.node.raw();
    ask(dut, Request::ConfigureNodeId { node_id })?;
    waiting(dut)
}

/// Stores the LSS configuration.
fn stored(dut: &mut Dut<'_>) -> Checked {
    configured(dut)?;
    // A slave may store only values that were configured since its selection.
    let node_id = dut.node.raw();
    ask(dut, Request::ConfigureNodeId { node_id })?;
    dut.drain()?;
    dut.send(Frame::standard(MASTER, &Request::Store.emit()))?;
    let heard = dut.next(2_000_000, |frame| is_data(frame, SLAVE))?;
    waiting(dut)?;
    match heard {
        Some(heard) if heard.frame.data().starts_with(&[0x17, 0]) => Ok(()),
        Some(heard) if heard.frame.data().starts_with(&[0x17, 1]) => {
            lacks("the node does not store its configuration")
        }
        _ => fail("LSS response 17 00 within 2 s", "none came"),
    }
}

/// Restarts the node, which must then have the second of these node IDs.
fn started_as(dut: &mut Dut<'_>, ids: [NodeId; 2]) -> Checked {
    dut.drain()?;
    if dut.rig.has_power() {
        dut.power(false)?;
        dut.wait(500_000)?;
        dut.power(true)?;
    } else {
        let node = dut.node.raw();
        dut.send(Frame::standard(0, &[0x81, node]))?;
    }
    let boots = ids.map(|node| node.plus(0x700));
    let is_boot = |frame: &Frame| boots.contains(&frame.id()) && frame.data() == [0];
    let heard = dut.next(10_000_000, is_boot)?;
    dut.wait(20_000)?;
    match heard {
        Some(heard) => {
            dut.node = if heard.frame.id() == boots[0] {
                ids[0]
            } else {
                ids[1]
            };
            ensure(
                dut.node == ids[1],
                format!("node ID {}, the stored one, after a start", ids[1]),
                format!("{} came", heard.frame),
            )
        }
        None => fail("a boot-up message within 10 s of the start", "none came"),
    }
}

/// Configures a node ID without storing it, and resets the communication. Returns whether the node
/// has the node ID then.
pub(super) fn renumber(dut: &mut Dut<'_>, node: NodeId) -> Checked<bool> {
    let all = configured(dut)?;
    let node_id = node.raw();
    let answer = ask(dut, Request::ConfigureNodeId { node_id })?;
    waiting(dut)?;
    if !matches!(answer, Some([0x11, 0, ..])) {
        return Ok(false);
    }
    dut.drain()?;
    let before = dut.node;
    dut.send(Frame::standard(0, &[0x82, before.raw()]))?;
    let ids = [before, node].map(|node| node.plus(0x700));
    let is_boot = |frame: &Frame| ids.contains(&frame.id()) && frame.data() == [0];
    match dut.next(10_000_000, is_boot)? {
        Some(heard) if heard.frame.id() == ids[1] => {
            dut.node = node;
            dut.wait(20_000)?;
            Ok(true)
        }
        _ => {
            // The node may have taken the node ID without a boot-up message: it gets its own again.
            give_back(dut, all)?;
            Ok(false)
        }
    }
}
