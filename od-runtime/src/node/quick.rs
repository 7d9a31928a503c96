//! Short path of the most frequent frames: an upload of a number, a SYNC, the TPDO behind it. All
//! other frames take the general path.

use od_model::Slot;
use od_model::row::Row;
use od_wire::sdo::{Response, upload_command};
use od_wire::{AbortCode, Frame, Instant, NodeId};

use super::ear::{self, Ear};
use super::output::words;
use super::{Machines, Node, pending};
use crate::application::Context;
use crate::device::{Device, ROOMY};
use crate::extras::Extras;
use crate::lent::Lent;
use crate::number::{put_word, word};
use crate::pdo;
use crate::rooms::{Room, Rooms};
use crate::store::Store;

/// Outcome of a request on the short path.
enum Upload<'d> {
    /// The response waits.
    Done,
    /// The application may have to bring the value up to date first; with the beginning of the request.
    Live(&'d Row, u32),
    /// The way of all other frames.
    Other,
}

impl<D: Device, const PDO: usize, const SDO: usize, X: Extras<D, SDO>> Node<D, PDO, SDO, X> {
    /// A request of an SDO client.
    #[cfg_attr(not(target_os = "none"), inline(never))]
    pub(super) fn handle_request(&mut self, device: &mut Lent<'_>, frame: &Frame) {
        match self.upload(device, frame) {
            Upload::Done => {}
            Upload::Live(row, head) if ROOMY => self.upload_live(device, frame, row, head),
            _ => self.handle_seldom(device, frame),
        }
    }

    /// A request for a number that the store has, where all day nothing else is to be done.
    #[inline(always)]
    fn upload<'d>(&mut self, device: &mut Lent<'d>, frame: &Frame) -> Upload<'d> {
        let node = &mut self.machines;
        let Some(head) = node.sdo.quick(frame) else {
            return Upload::Other;
        };
        // A frame that waits goes first.
        let is_quick =
            node.quick.requests && node.pending & (pending::ANSWER | pending::OTHER) == 0;
        if !is_quick || device.values.len() < device.dictionary.store_len() {
            return Upload::Other;
        }
        // Index and sub-index, as `Address::key` has them.
        let key = head & 0xFF_FF00 | head >> 24;
        let Some(row) = device.dictionary.plain_row(key) else {
            return Upload::Other;
        };
        if self.outbox.is_marked(key) && (ROOMY || key >= 0x20_0000) {
            return Upload::Live(row, head);
        }
        let Some((value, unused)) = word(device.values, row) else {
            return Upload::Other;
        };
        node.sdo.reset();
        node.respond(head, value, unused);
        Upload::Done
    }

    /// As [`upload`](Self::upload), of a value that the application may have to bring up to date. `head` is
    /// the beginning of the request.
    #[inline(never)]
    fn upload_live(&mut self, device: &mut Lent<'_>, frame: &Frame, row: &Row, head: u32) {
        let node = &mut self.machines;
        let (Slot { offset, len }, address) = (row.plain(), row.address());
        // One of the services' own may look like a live one.
        if address.index < 0x2000 {
            return self.upload_refreshed(device, frame, row, head);
        }
        let unused = u32::from(len).wrapping_neg() & 3;
        // No answer waits, so its place is free; the fewer values are kept over the call, the better.
        node.respond(head, 0, unused);
        node.sdo.reset();
        let number = device.application.number(node.now, address);
        let value = number.and_then(|it| put_word(device.values, offset as usize, 8 * unused, it));
        let Some(value) = value else {
            node.pending &= !pending::ANSWER;
            return self.upload_anew(device, frame);
        };
        node.answer[1] = value;
        if D::CHANGES && node.watches_changes {
            self.end_upload(device);
        }
    }

    /// As [`upload_refreshed`](Self::upload_refreshed), by the frame alone.
    #[inline(never)]
    fn upload_anew(&mut self, device: &mut Lent<'_>, frame: &Frame) {
        match self.upload(device, frame) {
            Upload::Live(row, head) => self.upload_refreshed(device, frame, row, head),
            _ => self.handle_seldom(device, frame),
        }
    }

    /// As [`upload_live`](Self::upload_live), where the application needs the store, or does not have the
    /// value at hand.
    #[inline(never)]
    fn upload_refreshed(&mut self, device: &mut Lent<'_>, frame: &Frame, row: &Row, head: u32) {
        let node = &mut self.machines;
        let outbox = Room::outbox(&mut self.outbox);
        let is_word = word(device.values, row).is_some();
        let store = Store::new(&device.dictionary, device.values, node.node_id);
        let (true, Ok(mut store)) = (is_word, store) else {
            return self.handle_seldom(device, frame);
        };
        let mut context = Context {
            store: &mut store,
            now: node.now,
            signals: &mut outbox.signals,
        };
        let address = row.address();
        let refreshed = match address.index {
            ..0x2000 => Ok(()),
            _ => device.application.refresh(&mut context, address),
        };
        node.sdo.reset();
        match (refreshed, word(device.values, row)) {
            (Ok(()), Some((value, unused))) => node.respond(head, value, unused),
            (refreshed, _) => {
                let code = refreshed.err().unwrap_or(AbortCode::General).code();
                node.answer = words(Response::Abort { address, code }.emit());
                node.pending |= pending::ANSWER;
            }
        }
        if !outbox.is_empty() || D::CHANGES && node.watches_changes {
            self.end_upload(device);
        }
    }

    /// The application had more to say of a value, or a PDO is sent for it.
    #[cold]
    fn end_upload(&mut self, device: &mut Lent<'_>) {
        let now = self.machines.now;
        if let Some((node, mut objects)) = self.open(device, now) {
            node.finish(&mut objects);
            node.reset_if_due(&mut objects);
        }
    }

    /// SYNC.
    #[cfg_attr(not(target_os = "none"), inline(never))]
    pub(super) fn handle_count(&mut self, device: &mut Lent<'_>, frame: &Frame) {
        let node = &mut self.machines;
        let is_plain = frame.dlc() <= 1 && !frame.is_remote();
        if ROOMY && is_plain && node.quick.marks != 0 {
            node.pending |= node.quick.marks;
        } else if is_plain && node.quick.syncs {
            node.count_sync();
        } else {
            self.handle_seldom(device, frame);
        }
    }

    /// Returns the next of the frames that wait.
    #[inline(never)]
    pub(super) fn poll_waiting(&mut self, device: &mut Lent<'_>, now: Instant) -> Option<Frame> {
        let node = &mut self.machines;
        let marks = node.pending;
        if marks & !pending::MARKS != 0 {
            return self.poll_seldom(device, now);
        }
        let at = pending::position(marks);
        let Some(pdo) = node.tpdo.get_mut(at) else {
            return self.poll_seldom(device, now);
        };
        node.pending = marks & marks.wrapping_sub(1);
        let now = now.max(node.now);
        match (pdo.is_plain(), pdo.is_live()) {
            (true, false) => send_plain::<D, _>(pdo, device, node.node_id, now),
            (true, true) => self.send_live(device, now, at),
            _ => self.send_pdo(device, now, at),
        }
    }

    /// As [`send_pdo`](Self::send_pdo), of a plain one with live values.
    #[inline(never)]
    fn send_live(&mut self, device: &mut Lent<'_>, now: Instant, at: usize) -> Option<Frame> {
        let node = &mut self.machines;
        let pdo = node.tpdo.get_mut(at)?;
        match pdo.fetch_live(device.application, device.values, now) {
            Some(()) => send_plain::<D, _>(pdo, device, node.node_id, now),
            None => self.send_pdo(device, now, at),
        }
    }
}

impl<D: Device, const PDO: usize, const SDO: usize, X: Extras<D, SDO>> Machines<D, PDO, SDO, X> {
    /// The response to an upload waits, by the beginning of the request.
    #[inline(always)]
    fn respond(&mut self, head: u32, value: u32, unused: u32) {
        self.answer = [head & !0xFF | upload_command(unused), value];
        self.pending |= pending::ANSWER;
    }

    /// SYNC, where nothing has to be done for it now.
    #[cfg_attr(not(target_os = "none"), inline(never))]
    fn count_sync(&mut self) {
        let mut pending = false;
        for pdo in self.tpdos_mut() {
            pending |= pdo.count_sync();
        }
        self.pend_pdo(pending);
    }

    /// Finds out whether all that the next SYNC does is to be [counted](Self::count_sync), and whether it
    /// is the same for each.
    #[inline(never)]
    pub(super) fn expect_sync(&mut self) {
        self.quick.syncs = self.ear.sync != ear::NONE
            && self.ear.codes != Ear::EVERYTHING
            && self.tpdos().iter().all(pdo::Tpdo::only_counts::<D>)
            && !(D::RPDOS && self.rpdo.all().iter().any(pdo::Rpdo::is_waiting));
        if ROOMY {
            self.quick.marks = if self.quick.syncs { self.marks() } else { 0 };
        }
    }

    /// The TPDOs that each SYNC marks, if it does no more; else 0.
    fn marks(&self) -> u8 {
        let (mut marks, mut mark) = (0, pending::FIRST_MARK);
        for pdo in self.tpdos() {
            match pdo.cycle() {
                0 => {}
                1 if mark != 0 => marks |= mark,
                _ => return 0,
            }
            mark <<= 1;
        }
        marks
    }

    /// TPDOs that a SYNC marked, if there are any, are waiting to be sent, as any others.
    #[inline(always)]
    pub(super) fn pend_marks(&mut self) {
        if ROOMY && self.pending & pending::MARKS != 0 {
            self.pend_marked();
        }
    }

    #[cold]
    #[inline(never)]
    fn pend_marked(&mut self) {
        let mut marks = self.pending;
        self.pending = marks & !pending::MARKS | pending::PDO;
        marks &= pending::MARKS;
        for pdo in self.tpdos_mut() {
            pdo.pend_if(marks & pending::FIRST_MARK != 0);
            marks >>= 1;
        }
    }
}

/// Sends a plain PDO whose values are up to date.
#[inline(never)]
fn send_plain<D: Device, R: Rooms>(
    pdo: &mut pdo::Tpdo<R>,
    device: &mut Lent<'_>,
    node_id: NodeId,
    now: Instant,
) -> Option<Frame> {
    match pdo.send_single::<D>(device.values, now) {
        None => send_stored::<D, R>(pdo, device, node_id, now),
        frame => frame,
    }
}

/// As [`send_plain`], of more than one value, or of the last one of the store.
#[inline(never)]
fn send_stored<D: Device, R: Rooms>(
    pdo: &mut pdo::Tpdo<R>,
    device: &mut Lent<'_>,
    node_id: NodeId,
    now: Instant,
) -> Option<Frame> {
    pdo.send::<D>(&device.dictionary, device.values, node_id, now)
}

#[cfg(test)]
mod tests;
