//! LSS without a selection: identify remote slave and fastscan.

use od_model::{Address, values};
use od_wire::Frame;
use od_wire::lss::{MASTER, Part, Request, SLAVE};
use od_wire::nmt::Command;

use super::lss::{answers, ask, begin, configured, select, stays_silent, waiting};
use crate::conform::dut::{Dut, QUIET, is_data};
use crate::conform::end::{Checked, fail, lacks};
use crate::conform::sdo::request;

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
        Some([0x4F, 0, 0, 0, 0, 0, 0, 0]) => {
            let vendor = Request::Inquire { part: Part::Vendor };
            stays_silent(
                dut,
                vendor.emit(),
                "as identify remote slave selects no node",
            )?;
        }
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
    let wide = [vendor, product, 0, u32::MAX, 0, u32::MAX];
    if identified(dut, wide)?.is_none() {
        return fail("LSS response 4F to the widest ranges", "none came");
    }
    // A sequence that the master broke off does not count.
    for step in [0, 1] {
        ask(
            dut,
            Request::IdentifyRemote {
                step,
                value: right[usize::from(step)],
            },
        )?;
    }
    if identified(dut, right)?.is_none() {
        let done = fail(
            "LSS response 4F after a sequence that was broken off",
            "none came",
        );
        dut.fault(done)?;
    }
    // Identification is a service of both LSS states.
    select(dut, [vendor, product, revision, serial])?;
    let here = identified(dut, right);
    waiting(dut)?;
    if here?.is_none() {
        let done = fail(
            "LSS response 4F in the configuration state, as in the waiting state",
            "none came",
        );
        dut.fault(done)?;
    }
    for (place, name) in [(0, "vendor-ID"), (1, "product code")] {
        for bit in [8, 16, 31] {
            let mut wrong = wide;
            wrong[place] ^= 1 << bit;
            if let Some(answer) = identified(dut, wrong)? {
                let done = fail(
                    format!("no LSS response to identify remote slave with another {name}"),
                    format!("{} came", values::hex(&answer)),
                );
                dut.fault(done)?;
            }
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
    stays_silent(dut, START.emit(), "as the node has a node ID")
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
        fail(
            "no boot-up message, as node ID 255 was accepted, with which the node has none",
            "the node keeps its node ID",
        )
    } else {
        has_only_lss(dut).and_then(|()| scan(dut, all))
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
            dut.fault(fail(
                "the boot-up message with the node ID from LSS",
                "none came",
            ))?;
            return done;
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

/// A node without a node ID has no service besides LSS.
fn has_only_lss(dut: &mut Dut<'_>) -> Checked {
    let from = dut.frames.len();
    let all_nodes = Frame::standard(0, &[Command::Start as u8, 0]);
    let hello = request(0x40, Address::new(0x1000, 0), [0; 4]);
    dut.send(all_nodes)?;
    dut.send(Frame::full(dut.node.plus(0x600), hello))?;
    dut.ask_for(dut.node.plus(0x700), 1)?;
    dut.wait(QUIET)?;
    let ids = [0x80, 0x180, 0x580, 0x700].map(|base| dut.id(base));
    let frames = dut.frames.get(from..).unwrap_or_default().iter();
    let mut own =
        frames.filter(|traced| !traced.ours && ids.iter().any(|id| is_data(&traced.frame, *id)));
    match own.next().map(|traced| traced.frame) {
        Some(frame) => fail(
            "LSS only, as the node has no node ID",
            format!("{frame} came"),
        ),
        None => Ok(()),
    }
}

/// The request that every node without a node ID responds to.
const START: Request = Request::Fastscan {
    number: 0,
    bit: 128,
    part: 0,
    next: 0,
};

fn scan(dut: &mut Dut<'_>, all: [u32; 4]) -> Checked {
    if ask(dut, START)?.is_none() {
        return lacks("the node does not have fastscan");
    }
    early_end(dut, all)?;
    ask(dut, START)?;
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
    answers(dut, Request::Inquire { part: Part::Vendor }, &[0x5A])?;
    waiting(dut)?;
    again(dut, all)
}

/// A second fastscan finds the node, too: it confirms the numbers that the first one found.
fn again(dut: &mut Dut<'_>, all: [u32; 4]) -> Checked {
    answers(dut, START, &[0x4F])?;
    for (part, number) in (0..).zip(all) {
        let next = if part == 3 { 0 } else { part + 1 };
        let request = Request::Fastscan {
            number,
            bit: 0,
            part,
            next,
        };
        answers(dut, request, &[0x4F])?;
    }
    answers(dut, Request::Inquire { part: Part::Vendor }, &[0x5A])
}
