//! LSS and the rest of the node: in each NMT state, after each other command, and beside the other services.

use od_model::values;
use od_wire::lss::{MASTER, Part, Request, SLAVE};
use od_wire::nmt::Command;
use od_wire::{CanId, Frame};

use super::lss::{answers, ask, begin, configured, raw, select, stays_silent, waiting};
use crate::conform::dut::{Dut, QUIET, is_data, state_name};
use crate::conform::end::{Checked, at_least_one, ensure, fail};

const VENDOR: Request = Request::Inquire { part: Part::Vendor };
const SELECT_ALL: Request = Request::SwitchGlobal {
    configuration: true,
};
/// A bit timing that does not exist.
const NO_TIMING: Request = Request::ConfigureBitTiming {
    table: 0,
    index: 0x55,
};

/// Commands of the configuration state that leave the node as it is.
fn commands(dut: &Dut<'_>) -> Vec<Request> {
    let node_id = dut.node.raw();
    let inquiries = Part::ALL.into_iter().map(|part| Request::Inquire { part });
    let others = [
        Request::InquireNodeId,
        NO_TIMING,
        Request::ConfigureNodeId { node_id: 0 },
        Request::ConfigureNodeId { node_id },
    ];
    inquiries.chain(others).collect()
}

/// Ends the configuration state. A node that has accepted node ID 0 gets its own one back before, so that it is not lost.
fn leave(dut: &mut Dut<'_>) -> Checked {
    let node_id = dut.node.raw();
    ask(dut, Request::ConfigureNodeId { node_id })?;
    waiting(dut)
}

type Answers = Vec<(Request, Option<[u8; 8]>)>;

/// Each of these commands with its response, in the configuration state.
fn responses(dut: &mut Dut<'_>) -> Checked<Answers> {
    let mut all = Vec::new();
    for request in commands(dut) {
        all.push((request, ask(dut, request)?));
    }
    Ok(all)
}

fn shown(answer: Option<[u8; 8]>) -> String {
    answer.map_or("none".into(), |answer| values::hex(&answer))
}

fn wanted_text(answer: Option<[u8; 8]>) -> String {
    match answer {
        Some(answer) => format!("LSS response {}", values::hex(&answer)),
        None => "no LSS response".into(),
    }
}

/// A node that can be selected in Pre-operational or in Operational has the same responses there as in Stopped.
pub(super) fn other_states(dut: &mut Dut<'_>) -> Checked {
    let all = configured(dut)?;
    let in_stopped = responses(dut)?;
    leave(dut)?;
    let mut any = false;
    for (command, state) in [(Command::EnterPreOperational, 0x7F), (Command::Start, 5)] {
        dut.nmt(command)?;
        let state = state_name(state);
        let why = format!("as the node is in the waiting state, in {state}");
        stays_silent(dut, VENDOR.emit(), &why)?;
        if select(dut, all)?.is_none() {
            continue;
        }
        any = true;
        let here = responses(dut)?;
        leave(dut)?;
        for ((request, wanted), (_, is)) in in_stopped.iter().zip(here) {
            let command = values::hex(&request.emit());
            let done = ensure(
                is == *wanted,
                format!(
                    "{} to {command} in {state}, as in Stopped",
                    wanted_text(*wanted)
                ),
                format!("{} came", shown(is)),
            );
            dut.fault(done)?;
        }
        let done = stays_silent(dut, VENDOR.emit(), &why);
        dut.fault(done)?;
    }
    at_least_one(any, "the node can be selected in Stopped only")
}

/// In the configuration state each command has the same response after every other one, also after one that is
/// refused, one that does not exist, and a second switch to the configuration state.
pub(super) fn each_after_each(dut: &mut Dut<'_>) -> Checked {
    configured(dut)?;
    let mut all = responses(dut)?;
    all.retain(|(_, answer)| answer.is_some());
    let known = all.iter().map(|(request, _)| request.emit());
    let others = [SELECT_ALL.emit(), [0x70, 0, 0, 0, 0, 0, 0, 0]];
    let first: Vec<[u8; 8]> = known.chain(others).collect();
    let done = (|| {
        for before in &first {
            for (request, wanted) in &all {
                if others.contains(before) {
                    // These have no response.
                    dut.send(Frame::standard(MASTER, before))?;
                    dut.settle(20_000)?;
                } else {
                    raw(dut, *before)?;
                }
                let is = ask(dut, *request)?;
                ensure(
                    is == *wanted,
                    format!(
                        "LSS response {} to {} after {}, as before",
                        shown(*wanted),
                        values::hex(&request.emit()),
                        values::hex(before)
                    ),
                    format!("{} came", shown(is)),
                )?;
            }
        }
        Ok(())
    })();
    leave(dut)?;
    done
}

/// In the configuration state the node follows NMT commands, sends its heartbeat and serves SDO requests.
pub(super) fn beside_others(dut: &mut Dut<'_>) -> Checked {
    dut.follow_state()?;
    configured(dut)?;
    let done = (|| {
        for (command, state) in [
            (Command::EnterPreOperational, 0x7F),
            (Command::Start, 5),
            (Command::Stop, 4),
            (Command::EnterPreOperational, 0x7F),
        ] {
            dut.nmt(command)?;
            dut.is_in(state)?;
            if state != 4 {
                dut.still_serves()?;
            }
        }
        Ok(())
    })();
    waiting(dut)?;
    done
}

/// A frame of 29 bits with the number of LSS requests, and a remote frame, are not requests.
pub(super) fn other_frames(dut: &mut Dut<'_>) -> Checked {
    let all = begin(dut)?;
    let wide = CanId::extended(MASTER.into());
    dut.send(Frame::full(wide, SELECT_ALL.emit()))?;
    dut.settle(10_000)?;
    let why = "as a frame with a CAN-ID of 29 bits is not switch state global";
    let done = stays_silent(dut, VENDOR.emit(), why);
    dut.fault(done)?;
    waiting(dut)?;
    if select(dut, all)?.is_none() {
        return fail("LSS response 44 to switch state selective", "none came");
    }
    let wides = commands(dut).into_iter();
    let mut frames: Vec<Frame> = wides.map(|one| Frame::full(wide, one.emit())).collect();
    frames.extend(Frame::remote(CanId::standard(MASTER), 8));
    for frame in frames {
        dut.drain()?;
        dut.send(frame)?;
        if let Some(heard) = dut.next(QUIET / 5, |frame| is_data(frame, SLAVE))? {
            let done = fail(
                format!("no LSS response to {frame}"),
                format!("{} came", heard.frame),
            );
            dut.fault(done)?;
        }
    }
    let [a, b, c, d] = all[0].to_le_bytes();
    let done = answers(dut, VENDOR, &[0x5A, a, b, c, d]);
    leave(dut)?;
    done
}
