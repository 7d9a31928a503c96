//! LSS in Stopped, where every slave supports it; other slaves on the bus stay in the waiting
//! state.

use od_model::{Address, values};
use od_wire::Frame;
use od_wire::lss::{MASTER, Part, Request, SLAVE};
use od_wire::nmt::Command;

use crate::conform::dut::{Dut, QUIET, is_data};
use crate::conform::end::{Checked, End, ensure, fail, lacks};
use crate::conform::sdo::number;

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

pub(super) fn raw(dut: &mut Dut<'_>, data: [u8; 8]) -> Checked<Option<[u8; 8]>> {
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
pub(super) fn answers(dut: &mut Dut<'_>, request: Request, wanted: &[u8]) -> Checked {
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

pub(super) fn stays_silent(dut: &mut Dut<'_>, data: [u8; 8], why: &str) -> Checked {
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
pub(super) fn begin(dut: &mut Dut<'_>) -> Checked<[u32; 4]> {
    let all = address(dut)?;
    dut.nmt(Command::Stop)?;
    waiting(dut)?;
    Ok(all)
}

/// Selects the node by its address; returns the response to the last of the four frames.
pub(super) fn select(dut: &mut Dut<'_>, all: [u32; 4]) -> Checked<Option<[u8; 8]>> {
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
        // One bit of each byte.
        for bit in [0, 8, 16, 31] {
            let mut other = all;
            other[part] ^= 1 << bit;
            if let Some(answer) = select(dut, other)? {
                waiting(dut)?;
                return fail(
                    "no LSS response to another LSS address",
                    values::hex(&answer),
                );
            }
        }
        // The last number right, and this one left out.
        let some = Part::ALL.into_iter().zip(all).enumerate();
        for (place, (number, value)) in some.filter(|(place, _)| *place != part && part != 3) {
            let request = Request::SwitchSelective {
                part: number,
                value,
            };
            if let Some(answer) = ask(dut, request)? {
                waiting(dut)?;
                return fail(
                    format!("no LSS response to number {place} without number {part}"),
                    values::hex(&answer),
                );
            }
        }
    }
    // The right one selects it afterwards, without switch state global in between, and after one that was broken off.
    for (part, value) in Part::ALL.into_iter().zip(all).take(2) {
        ask(dut, Request::SwitchSelective { part, value })?;
    }
    let right = select(dut, all)?;
    waiting(dut)?;
    ensure(
        matches!(right, Some([0x44, ..])),
        "LSS response 44 to the LSS address of the node, after those of others",
        right.map_or("none came".into(), |answer| values::hex(&answer)),
    )
}

pub(super) fn waiting_silent(dut: &mut Dut<'_>) -> Checked {
    begin(dut)?;
    let why = "as the node is in the waiting state";
    let node_id = dut.node.raw();
    for request in [
        Request::InquireNodeId,
        Request::Inquire { part: Part::Vendor },
        Request::Inquire {
            part: Part::Product,
        },
        Request::Inquire {
            part: Part::Revision,
        },
        Request::Inquire { part: Part::Serial },
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

pub(super) fn node_id_range(dut: &mut Dut<'_>) -> Checked {
    with(dut, |dut, _| {
        let mut done = Ok(());
        for node_id in (128..=254).chain([0]) {
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
        let mut done = if sees_state { dut.is_in(4) } else { Ok(()) };
        // Some slaves respond with the node ID that is active, others with the one that a reset makes active.
        if let Some(answer) = ask(dut, Request::InquireNodeId)? {
            let pending = ensure(
                answer[0] == 0x5E && [node_id, other].contains(&answer[1]),
                format!(
                    "node ID {node_id}, or {other} that was configured, in the LSS response 5E"
                ),
                format!("{} came", values::hex(&answer)),
            );
            done = done.and(pending);
        }
        for other in (1..=127).filter(|other| *other != node_id) {
            if done.is_ok() {
                let request = Request::ConfigureNodeId { node_id: other };
                done = answers(dut, request, &[0x11, 0]);
            }
        }
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
    let why = "as the node is in the waiting state after the activation";
    let silent = stays_silent(dut, Request::InquireNodeId.emit(), why);
    dut.nmt(Command::EnterPreOperational)?;
    done?;
    silent?;
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
        for (table, index) in [
            (0, 10),
            (0, 0x55),
            (0, 0xFF),
            (1, 0),
            (2, 0),
            (64, 0),
            (127, 0),
        ] {
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

/// The bit rates of the table that the EDS names are accepted, and the others refused; then the node is reset. A node that
/// refuses all of them has no bit rate by LSS.
pub(super) fn bit_rates(dut: &mut Dut<'_>) -> Checked {
    let Some(named) = dut.eds.description.lss_bit_rates() else {
        return lacks("the EDS does not declare LSS");
    };
    let mut any = false;
    let done = with(dut, |dut, _| {
        for (index, is_named) in (0u8..).zip(named) {
            // Index 5 is reserved, and some devices have 100 kbit/s there.
            if index == 5 {
                continue;
            }
            let request = Request::ConfigureBitTiming { table: 0, index };
            let done = answers(dut, request, &[0x13, u8::from(!is_named)]);
            any |= is_named && done.is_ok();
            dut.fault(done)?;
        }
        Ok(())
    });
    let has_none = done.is_ok() && !any && named.contains(&true);
    if has_none {
        dut.faults.clear();
    }
    dut.reset(Command::ResetNode)?;
    done?;
    if has_none {
        return lacks("the node refuses every bit rate by LSS");
    }
    Ok(())
}

pub(super) fn unknown(dut: &mut Dut<'_>) -> Checked {
    with(dut, |dut, _| {
        let exists = |code: &u8| {
            let codes = [0x04, 0x11, 0x13, 0x15, 0x17, 0x51];
            codes.contains(code) || matches!(code, 0x40..=0x43 | 0x46..=0x4C | 0x5A..=0x5E)
        };
        dut.drain()?;
        for command in (0..=0xFF).filter(|code| !exists(code)) {
            dut.send(Frame::standard(MASTER, &[command, 0, 0, 0, 0, 0, 0, 0]))?;
            if let Some(heard) = dut.next(2_000, |frame| is_data(frame, SLAVE))? {
                return fail(
                    format!("no LSS response to {command:02X}h, a command that does not exist"),
                    format!("{} came", heard.frame),
                );
            }
        }
        let is_ours = |frame: &Frame| is_data(frame, SLAVE);
        match dut.next(QUIET, is_ours)? {
            Some(heard) => fail(
                "no LSS response to commands that do not exist",
                format!("{} came", heard.frame),
            ),
            None => Ok(()),
        }
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
                [0x17, 0, _, 0, 0, 0, 0, 0] => {
                    one(dut, "LSS response 17 00")?;
                    // A stored configuration can be changed again.
                    answers(dut, Request::ConfigureNodeId { node_id }, &[0x11, 0])
                }
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

/// Switch state global to the configuration state has no response, and the node is in this state then.
pub(super) fn global_silent(dut: &mut Dut<'_>) -> Checked {
    let all = begin(dut)?;
    let request = Request::SwitchGlobal {
        configuration: true,
    };
    let silent = stays_silent(dut, request.emit(), "as it is for all slaves");
    // All slaves refuse this bit rate with the same frame, so that several may answer at once.
    let timing = Request::ConfigureBitTiming {
        table: 0,
        index: 0x55,
    };
    let answer = ask(dut, timing)?;
    waiting(dut)?;
    silent?;
    // A slave without this service is silent after a selection, too.
    if answer.is_none() {
        let chosen = select(dut, all)?;
        let selected = ask(dut, timing)?;
        waiting(dut)?;
        if chosen.is_some() && selected.is_none() {
            return lacks("the node does not respond to configure bit timing");
        }
    }
    ensure(
        matches!(answer, Some([0x13, ..])),
        "LSS response 13, as the node is in the configuration state after switch state global",
        match answer {
            Some(answer) => format!("{} came", values::hex(&answer)),
            None => "none came".into(),
        },
    )
}

/// The slave leaves the configuration state without a response and without a boot-up message, also with a node ID that a
/// reset makes active.
pub(super) fn leave_silent(dut: &mut Dut<'_>) -> Checked {
    let own = dut.node.raw();
    let other = if own == 100 { 101 } else { 100 };
    for node_id in [None, Some(own), Some(other)] {
        dut.nmt(Command::EnterPreOperational)?;
        let all = configured(dut)?;
        if let Some(node_id) = node_id {
            ask(dut, Request::ConfigureNodeId { node_id })?;
        }
        let done = leaves(dut);
        dut.fault(done)?;
        // The node may have the other node ID now, so it is selected by its LSS address.
        select(dut, all)?;
        ask(dut, Request::ConfigureNodeId { node_id: own })?;
        waiting(dut)?;
    }
    Ok(())
}

fn leaves(dut: &mut Dut<'_>) -> Checked {
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
    for node_id in [0, dut.node.raw()] {
        answers.push((ask(dut, Request::ConfigureNodeId { node_id })?, 3));
    }
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
