//! LSS in Stopped, where every slave supports it; other slaves on the bus stay in the waiting
//! state.

use od_model::{Address, values};
use od_wire::lss::{MASTER, Part, Request, SLAVE};
use od_wire::nmt::Command;
use od_wire::{Frame, NodeId};

use crate::conform::dut::{Dut, QUIET, is_data};
use crate::conform::end::{Checked, End, ensure, fail, lacks, skip};
use crate::conform::sdo::{number, request};

/// The four numbers of 1018h.
fn address(dut: &mut Dut<'_>) -> Checked<[u32; 4]> {
    let mut all = [0; 4];
    for (sub, part) in (1..).zip(&mut all) {
        if let Ok(bytes) = dut.upload(Address::new(0x1018, sub))? {
            *part = number(&bytes) as u32;
        }
    }
    Ok(all)
}

/// Sends a request; returns the response, if there is one.
pub(super) fn ask(dut: &mut Dut<'_>, request: Request) -> Checked<Option<[u8; 8]>> {
    raw(dut, request.emit())
}

fn raw(dut: &mut Dut<'_>, data: [u8; 8]) -> Checked<Option<[u8; 8]>> {
    dut.drain()?;
    dut.send(Frame::standard(MASTER, &data))?;
    let heard = dut.next(QUIET, |frame| is_data(frame, SLAVE))?;
    match heard {
        Some(heard) if heard.frame.dlc() != 8 => fail(
            "an LSS response of 8 bytes",
            format!("{} came", heard.frame),
        ),
        heard => Ok(heard.map(|heard| *heard.frame.bytes())),
    }
}

/// Fails unless the response of the slave begins with these bytes.
fn answers(dut: &mut Dut<'_>, request: Request, wanted: &[u8]) -> Checked {
    let shown = format!("LSS response {}", values::hex(wanted));
    match ask(dut, request)? {
        Some(answer) => {
            let got = format!("{} came", values::hex(&answer));
            ensure(answer.starts_with(wanted), &*shown, got)?;
            one(dut, &shown)
        }
        None => fail(shown, "none came"),
    }
}

/// Fails if a second response follows the one that is shown.
fn one(dut: &mut Dut<'_>, shown: &str) -> Checked {
    match dut.next(10_000, |frame| is_data(frame, SLAVE))? {
        Some(heard) => fail(format!("one {shown}"), format!("{} came, too", heard.frame)),
        None => Ok(()),
    }
}

fn stays_silent(dut: &mut Dut<'_>, data: [u8; 8], why: &str) -> Checked {
    match raw(dut, data)? {
        Some(answer) => fail(
            format!("no LSS response to {}, {why}", values::hex(&data)),
            format!("{} came", values::hex(&answer)),
        ),
        None => Ok(()),
    }
}

pub(super) fn waiting(dut: &mut Dut<'_>) -> Checked {
    dut.send(Frame::standard(
        MASTER,
        &Request::SwitchGlobal {
            configuration: false,
        }
        .emit(),
    ))?;
    dut.wait(20_000)
}

/// Enters Stopped and the LSS waiting state; returns the LSS address.
fn begin(dut: &mut Dut<'_>) -> Checked<[u32; 4]> {
    let all = address(dut)?;
    dut.nmt(Command::Stop)?;
    waiting(dut)?;
    Ok(all)
}

/// Selects the node by its address; returns the response to the last of the four frames.
fn select(dut: &mut Dut<'_>, all: [u32; 4]) -> Checked<Option<[u8; 8]>> {
    let mut last = None;
    for (part, value) in Part::ALL.into_iter().zip(all) {
        if last.is_some() {
            return fail("no LSS response before the fourth number", "one came");
        }
        last = ask(dut, Request::SwitchSelective { part, value })?;
    }
    Ok(last)
}

/// Enters the configuration state; returns the LSS address.
pub(super) fn configured(dut: &mut Dut<'_>) -> Checked<[u32; 4]> {
    let all = begin(dut)?;
    match select(dut, all)? {
        Some([0x44, ..]) => Ok(all),
        Some(other) => fail("LSS response 44", format!("{} came", values::hex(&other))),
        None => fail("LSS response 44 to switch state selective", "none came"),
    }
}

/// Calls `act` in the configuration state, and leaves the state.
fn with(dut: &mut Dut<'_>, act: impl FnOnce(&mut Dut<'_>, [u32; 4]) -> Checked) -> Checked {
    let all = configured(dut)?;
    let done = act(dut, all);
    waiting(dut)?;
    done
}

pub(super) fn selective(dut: &mut Dut<'_>) -> Checked {
    with(dut, |_, _| Ok(()))
}

pub(super) fn selective_other(dut: &mut Dut<'_>) -> Checked {
    let all = begin(dut)?;
    for part in 0..4 {
        let mut other = all;
        other[part] ^= 1;
        if let Some(answer) = select(dut, other)? {
            waiting(dut)?;
            return fail(
                "no LSS response to another LSS address",
                values::hex(&answer),
            );
        }
    }
    Ok(())
}

pub(super) fn waiting_silent(dut: &mut Dut<'_>) -> Checked {
    begin(dut)?;
    let why = "as the node is in the waiting state";
    let node_id = dut.node.raw();
    for request in [
        Request::InquireNodeId,
        Request::Inquire { part: Part::Vendor },
        Request::ConfigureNodeId { node_id },
        Request::ConfigureBitTiming {
            table: 0,
            index: 0x55,
        },
        Request::ActivateBitTiming { delay_ms: 100 },
        Request::Store,
    ] {
        stays_silent(dut, request.emit(), why)?;
    }
    Ok(())
}

pub(super) fn inquire_identity(dut: &mut Dut<'_>) -> Checked {
    with(dut, |dut, all| {
        for (part, value) in Part::ALL.into_iter().zip(all) {
            let [a, b, c, d] = value.to_le_bytes();
            answers(
                dut,
                Request::Inquire { part },
                &[0x5A + part as u8, a, b, c, d],
            )?;
        }
        Ok(())
    })
}

pub(super) fn inquire_node_id(dut: &mut Dut<'_>) -> Checked {
    with(dut, |dut, _| {
        let node = dut.node.raw();
        answers(dut, Request::InquireNodeId, &[0x5E, node])
    })
}

/// Sends the six numbers of identify remote slave; returns the response to the last one.
fn identified(dut: &mut Dut<'_>, range: [u32; 6]) -> Checked<Option<[u8; 8]>> {
    for (step, value) in (0..5).zip(range) {
        dut.drain()?;
        let request = Request::IdentifyRemote { step, value };
        dut.send(Frame::standard(MASTER, &request.emit()))?;
        if let Some(heard) = dut.next(20_000, |frame| is_data(frame, SLAVE))? {
            return fail(
                "no LSS response before the sixth number",
                format!("{} came", heard.frame),
            );
        }
    }
    let [.., value] = range;
    ask(dut, Request::IdentifyRemote { step: 5, value })
}

pub(super) fn identify(dut: &mut Dut<'_>) -> Checked {
    let [vendor, product, revision, serial] = begin(dut)?;
    let right = [vendor, product, revision, revision, serial, serial];
    match identified(dut, right)? {
        Some([0x4F, 0, 0, 0, 0, 0, 0, 0]) => {}
        Some(other) => {
            return fail(
                "LSS response 4F with 0 in bytes 1 to 7",
                values::hex(&other),
            );
        }
        None => {
            let wide = [vendor, product, 0, u32::MAX, 0, u32::MAX];
            if identified(dut, wide)?.is_some() {
                return fail(
                    "LSS response 4F to ranges that begin and end with the numbers of the node",
                    "only a wider range has a response",
                );
            }
            return lacks(
                "the node does not answer LSS identify remote slave; one that has fastscan need not",
            );
        }
    }
    // A range that begins above the number, or ends below it.
    for (place, name, is_high) in [
        (0, "vendor-ID", false),
        (1, "product code", false),
        (2, "revision number", false),
        (3, "revision number", true),
        (4, "serial number", false),
        (5, "serial number", true),
    ] {
        let mut wrong = right;
        if is_high {
            let Some(below) = wrong[place].checked_sub(1) else {
                continue;
            };
            wrong[place - 1] = 0;
            wrong[place] = below;
        } else {
            wrong[place] = wrong[place].wrapping_add(1);
            if place == 2 || place == 4 {
                wrong[place + 1] = u32::MAX;
            }
            if wrong[place] == 0 {
                continue;
            }
        }
        if let Some(answer) = identified(dut, wrong)? {
            let done = fail(
                format!("no LSS response to identify remote slave with another {name}"),
                format!("{} came", values::hex(&answer)),
            );
            dut.fault(done)?;
        }
    }
    Ok(())
}

pub(super) fn identify_unconfigured(dut: &mut Dut<'_>) -> Checked {
    begin(dut)?;
    let request = Request::IdentifyNonConfigured.emit();
    stays_silent(dut, request, "as the node has a node ID")
}

pub(super) fn fastscan_configured(dut: &mut Dut<'_>) -> Checked {
    begin(dut)?;
    let request = Request::Fastscan {
        number: 0,
        bit: 128,
        part: 0,
        next: 0,
    };
    stays_silent(dut, request.emit(), "as the node has a node ID")
}

pub(super) fn node_id_range(dut: &mut Dut<'_>) -> Checked {
    with(dut, |dut, _| {
        let mut done = Ok(());
        for node_id in [0, 128, 129, 200, 254] {
            done = answers(dut, Request::ConfigureNodeId { node_id }, &[0x11, 1]);
            if done.is_err() {
                break;
            }
        }
        // A node that accepted one of them would leave the configuration state with it.
        if let Err(End::Fail { .. }) = done {
            let node_id = dut.node.raw();
            ask(dut, Request::ConfigureNodeId { node_id })?;
        }
        done
    })
}

/// Another node ID and the one of the node: until a reset, the heartbeat has the node ID from before.
pub(super) fn node_id(dut: &mut Dut<'_>) -> Checked {
    let sees_state = match dut.follow_state() {
        Ok(()) => true,
        Err(End::NotApplicable(_)) => false,
        Err(other) => return Err(other),
    };
    with(dut, |dut, _| {
        let node_id = dut.node.raw();
        let other = if node_id == 100 { 101 } else { 100 };
        answers(dut, Request::ConfigureNodeId { node_id: other }, &[0x11, 0])?;
        let done = if sees_state { dut.is_in(4) } else { Ok(()) };
        answers(dut, Request::ConfigureNodeId { node_id }, &[0x11, 0])?;
        done
    })
}

/// Node ID 255 makes a node one without a node ID; until a reset it keeps the one that it has.
pub(super) fn node_id_255(dut: &mut Dut<'_>) -> Checked {
    with(dut, |dut, _| {
        let done = answers(dut, Request::ConfigureNodeId { node_id: 255 }, &[0x11, 0]);
        let node_id = dut.node.raw();
        let back = answers(dut, Request::ConfigureNodeId { node_id }, &[0x11, 0]);
        done.and(back)
    })
}

/// A mode of switch state global that CiA 305 reserves does not select the node.
pub(super) fn global_reserved(dut: &mut Dut<'_>) -> Checked {
    begin(dut)?;
    for mode in [2, 255] {
        raw(dut, [4, mode, 0, 0, 0, 0, 0, 0])?;
        let done = stays_silent(
            dut,
            Request::Inquire { part: Part::Vendor }.emit(),
            &format!("as switch state global with mode {mode} selects no node"),
        );
        if done.is_err() {
            waiting(dut)?;
            return done;
        }
    }
    Ok(())
}

/// Activation without a new bit timing: no response, and the node communicates as before when its delays have passed.
pub(super) fn activate(dut: &mut Dut<'_>) -> Checked {
    const DELAY: u16 = 50;
    configured(dut)?;
    let request = Request::ActivateBitTiming { delay_ms: DELAY };
    let done = stays_silent(dut, request.emit(), "as activate bit timing has none");
    dut.wait(4 * u64::from(DELAY) * 1000)?;
    waiting(dut)?;
    dut.nmt(Command::EnterPreOperational)?;
    done?;
    dut.still_serves()
}

pub(super) fn undeclared(dut: &mut Dut<'_>) -> Checked {
    if dut.eds.info("LSS_Supported") != Some(0) {
        return lacks("the EDS declares LSS, or says nothing about it");
    }
    let all = begin(dut)?;
    let found = select(dut, all)?;
    waiting(dut)?;
    ensure(
        found.is_none(),
        "LSS_Supported=1 in [DeviceInfo], as the node has LSS",
        "it is 0",
    )
}

pub(super) fn bit_timing_range(dut: &mut Dut<'_>) -> Checked {
    let done = with(dut, |dut, _| {
        // CiA 305 reserves the tables 1 to 127.
        for (table, index) in [(0, 0x55), (1, 0), (127, 0)] {
            let request = Request::ConfigureBitTiming { table, index };
            answers(dut, request, &[0x13, 1])?;
        }
        Ok(())
    });
    if matches!(done, Err(End::Fail { .. })) && dut.may_reset {
        dut.reset(Command::ResetNode)?;
    }
    done
}

/// The bit rates of the table that the EDS does not name are refused; a node that accepts one is reset.
pub(super) fn bit_rates(dut: &mut Dut<'_>) -> Checked {
    let Some(named) = dut.eds.description.lss_bit_rates() else {
        return lacks("the EDS does not declare LSS");
    };
    // Index 5 is reserved, and some devices have 100 kbit/s there.
    let others = (0u8..)
        .zip(named)
        .filter(|(index, named)| *index != 5 && !named);
    let others: Vec<u8> = others.map(|(index, _)| index).collect();
    if others.is_empty() {
        return lacks("the EDS names all bit rates of the table");
    }
    let done = with(dut, |dut, _| {
        for index in others {
            let request = Request::ConfigureBitTiming { table: 0, index };
            answers(dut, request, &[0x13, 1])?;
        }
        Ok(())
    });
    if matches!(done, Err(End::Fail { .. })) {
        dut.reset(Command::ResetNode)?;
    }
    done
}

pub(super) fn unknown(dut: &mut Dut<'_>) -> Checked {
    with(dut, |dut, _| {
        for command in [0x60, 0x02, 0x70] {
            let data = [command, 0, 0, 0, 0, 0, 0, 0];
            stays_silent(dut, data, "as the command does not exist")?;
        }
        Ok(())
    })
}

/// The node stores its configuration, or reports that it does not support this.
pub(super) fn store(dut: &mut Dut<'_>) -> Checked {
    with(dut, |dut, _| {
        let node_id = dut.node.raw();
        answers(dut, Request::ConfigureNodeId { node_id }, &[0x11, 0])?;
        dut.drain()?;
        dut.send(Frame::standard(MASTER, &Request::Store.emit()))?;
        match dut.next(2_000_000, |frame| is_data(frame, SLAVE))? {
            Some(heard) => match heard.frame.data() {
                [0x17, 0, _, 0, 0, 0, 0, 0] => one(dut, "LSS response 17 00"),
                [0x17, 0, ..] => fail(
                    "0 in the reserved bytes 3 to 7 of the LSS response 17h",
                    format!("{} came", heard.frame),
                ),
                [0x17, 1, ..] => lacks("the node does not store its configuration"),
                _ => fail("LSS response 17 00", format!("{} came", heard.frame)),
            },
            None => fail("LSS response 17 00 within 2 s", "none came"),
        }
    })
}

/// Switch state global to the configuration state has no response.
pub(super) fn global_silent(dut: &mut Dut<'_>) -> Checked {
    begin(dut)?;
    let request = Request::SwitchGlobal {
        configuration: true,
    };
    let done = stays_silent(dut, request.emit(), "as it is for all slaves");
    waiting(dut)?;
    done
}

/// The slave leaves the configuration state without a response and without a boot-up message.
pub(super) fn leave_silent(dut: &mut Dut<'_>) -> Checked {
    configured(dut)?;
    dut.drain()?;
    let request = Request::SwitchGlobal {
        configuration: false,
    };
    dut.send(Frame::standard(MASTER, &request.emit()))?;
    let boot = dut.id(0x700);
    let is_wrong =
        |frame: &Frame| is_data(frame, SLAVE) || is_data(frame, boot) && frame.data() == [0];
    match dut.next(2 * QUIET, is_wrong)? {
        Some(heard) => fail(
            "no LSS response and no boot-up message when the configuration state is left",
            format!("{} came", heard.frame),
        ),
        None => stays_silent(
            dut,
            Request::InquireNodeId.emit(),
            "as the node left the configuration state",
        ),
    }
}

/// A reset leads to the waiting state.
pub(super) fn over_reset(dut: &mut Dut<'_>) -> Checked {
    for reset in [Command::ResetCommunication, Command::ResetNode] {
        dut.nmt(Command::EnterPreOperational)?;
        configured(dut)?;
        dut.reset(reset)?;
        dut.nmt(Command::Stop)?;
        let done = stays_silent(
            dut,
            Request::InquireNodeId.emit(),
            "as the node is in the waiting state after a reset",
        );
        waiting(dut)?;
        done?;
    }
    Ok(())
}

/// Bytes that CiA 305 reserves in responses are 0.
pub(super) fn reserved(dut: &mut Dut<'_>) -> Checked {
    let all = begin(dut)?;
    // In older versions of CiA 305, and in many devices, byte 1 of the response 44h is the state.
    let mut answers = vec![(select(dut, all)?, 2)];
    if answers[0].0.is_none() {
        return fail("LSS response 44 to switch state selective", "none came");
    }
    answers.push((ask(dut, Request::InquireNodeId)?, 2));
    let timing = Request::ConfigureBitTiming {
        table: 0,
        index: 0x55,
    };
    answers.push((ask(dut, timing)?, 3));
    for part in Part::ALL {
        answers.push((ask(dut, Request::Inquire { part })?, 5));
    }
    let node_id = dut.node.raw();
    answers.push((ask(dut, Request::ConfigureNodeId { node_id })?, 3));
    waiting(dut)?;
    for (answer, first) in answers {
        // A missing response fails another case.
        let Some(answer) = answer else {
            continue;
        };
        // The specific error is one with the error code 255 only.
        let first = if first == 3 && answer[1] != 255 {
            2
        } else {
            first
        };
        let done = ensure(
            answer[first..].iter().all(|byte| *byte == 0),
            format!(
                "0 in the reserved bytes {first} to 7 of the LSS response {:02X}h",
                answer[0]
            ),
            format!("{} came", values::hex(&answer)),
        );
        dut.fault(done)?;
    }
    Ok(())
}

/// A stored node ID is active after a reset or a power cycle.
pub(super) fn store_node_id(dut: &mut Dut<'_>) -> Checked {
    let own = dut.node;
    let other = if own.raw() == 126 { 125 } else { 126 };
    let Some(other) = NodeId::new(other) else {
        return Ok(());
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
                format!("the stored node ID {} after a start", ids[1]),
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
            select(dut, all)?;
            let node_id = before.raw();
            ask(dut, Request::ConfigureNodeId { node_id })?;
            waiting(dut)?;
            Ok(false)
        }
    }
}

/// Fastscan finds a node without a node ID, number by number, and the node gets its node ID back.
pub(super) fn fastscan(dut: &mut Dut<'_>) -> Checked {
    let all = configured(dut)?;
    match ask(dut, Request::ConfigureNodeId { node_id: 255 })? {
        Some([0x11, 0, ..]) => {}
        _ => {
            waiting(dut)?;
            return lacks("the node cannot be without a node ID");
        }
    }
    waiting(dut)?;
    let node = dut.node.raw();
    dut.send(Frame::standard(0, &[0x82, node]))?;
    let id = dut.id(0x700);
    let keeps = dut.next_of(id, 1_000_000)?.is_some();
    let done = if keeps {
        lacks("the node keeps its node ID")
    } else {
        scan(dut, all)
    };
    // In any case the node gets its node ID back.
    if keeps {
        begin(dut)?;
    }
    let found = select(dut, all)?;
    if found.is_none() {
        ask(
            dut,
            Request::SwitchGlobal {
                configuration: true,
            },
        )?;
    }
    ask(dut, Request::ConfigureNodeId { node_id: node })?;
    let from = dut.now();
    if keeps {
        waiting(dut)?;
    } else {
        let request = Request::SwitchGlobal {
            configuration: false,
        };
        dut.send(Frame::standard(MASTER, &request.emit()))?;
        if dut.next_of(id, 5_000_000)?.is_none() {
            return done.and(fail(
                "the boot-up message with the node ID from LSS",
                "none came",
            ));
        }
        dut.times.boots.push(dut.now().micros_since(from));
    }
    done
}

/// A fastscan that continues with a known number ends early. According to the flow chart of CiA 305
/// a slave may then be in the configuration state; according to its text all four numbers must
/// match. This is a remark only.
fn early_end(dut: &mut Dut<'_>, all: [u32; 4]) -> Checked {
    for (part, next) in [(0, 1), (1, 0)] {
        let number = all[usize::from(part)];
        let request = Request::Fastscan {
            number,
            bit: 0,
            part,
            next,
        };
        ask(dut, request)?;
    }
    if ask(dut, Request::Inquire { part: Part::Vendor })?.is_some() {
        dut.notes.push(
            "remark, CiA 305 6.7: after two of the four numbers, with LSS next below LSS sub, the node is in the \
             configuration state; the flow chart allows it, the text wants all four numbers"
                .into(),
        );
    }
    waiting(dut)
}

fn scan(dut: &mut Dut<'_>, all: [u32; 4]) -> Checked {
    let start = Request::Fastscan {
        number: 0,
        bit: 128,
        part: 0,
        next: 0,
    };
    if ask(dut, start)?.is_none() {
        return lacks("the node does not have fastscan");
    }
    early_end(dut, all)?;
    ask(dut, start)?;
    for (part, number) in (0..).zip(all) {
        for bit in (0..32u8).rev() {
            // The bits so far are right and this bit is 0, so the node responds if the bit of its
            // number is 0, too.
            let known = u64::from(number) >> (bit + 1) << (bit + 1);
            let request = Request::Fastscan {
                number: known as u32,
                bit,
                part,
                next: part,
            };
            let came = ask(dut, request)?;
            if let Some(answer) = came.filter(|answer| answer[1..] != [0; 7]) {
                return fail(
                    "LSS response 4F with 0 in bytes 1 to 7",
                    format!("{} came", values::hex(&answer)),
                );
            }
            let wanted = number >> bit & 1 == 0;
            if came.is_some() != wanted {
                let word = |yes| if yes { "a response" } else { "no response" };
                return fail(
                    format!("{} to bit {bit} of number {part}", word(wanted)),
                    word(came.is_some()),
                );
            }
        }
        let next = if part == 3 { 0 } else { part + 1 };
        answers(
            dut,
            Request::Fastscan {
                number,
                bit: 0,
                part,
                next,
            },
            &[0x4F],
        )?;
    }
    // Now it is in the configuration state.
    answers(dut, Request::Inquire { part: Part::Vendor }, &[0x5A])
}
