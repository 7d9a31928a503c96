//! Short path of the most frequent frames: an upload of a number, a SYNC, the TPDO behind it. All
//! other frames take the general path.

use od_model::Slot;
use od_model::row::Row;
use od_wire::sdo::{Response, upload_command};
use od_wire::{Frame, Instant};

use super::ear::{self, Ear};
use super::output::words;
use super::{Machines, Node, pending};
use crate::application::Context;
use crate::device::{Device, ROOMY};
use crate::extras::Extras;
use crate::lent::Lent;
use crate::number::{little_endian, word};
use crate::pdo;
use crate::rooms::Room;
use crate::store::Store;

impl<D: Device, const PDO: usize, const SDO: usize, X: Extras<D, SDO>> Node<D, PDO, SDO, X> {
    /// A request of an SDO client.
    #[cfg_attr(not(target_os = "none"), inline(never))]
    pub(super) fn handle_request(&mut self, device: &mut Lent<'_>, frame: &Frame) {
        if self.upload(device, frame).is_none() {
            self.handle_seldom(device, frame);
        }
    }

    /// A request for a number that the store has, where all day nothing else is to be done. `None` if
    /// something is.
    #[inline(always)]
    fn upload(&mut self, device: &mut Lent<'_>, frame: &Frame) -> Option<()> {
        let node = &mut self.machines;
        let head = node.sdo.quick(frame)?;
        // A frame that waits goes first.
        let is_quick =
            node.quick.requests && node.pending & (pending::ANSWER | pending::OTHER) == 0;
        if !is_quick || device.values.len() < device.dictionary.store_len() {
            return None;
        }
        // Index and sub-index, as `Address::key` has them.
        let key = head & 0xFF_FF00 | head >> 24;
        let row = device.dictionary.plain_row(key)?;
        if self.outbox.is_marked(key) && (ROOMY || key >= 0x20_0000) {
            return self.upload_live(device, row, head);
        }
        let (value, unused) = word(device.values, row)?;
        node.sdo.reset();
        node.respond(head, value, unused);
        Some(())
    }

    /// As [`upload`](Self::upload), of a value that the application may have to bring up to date. `head` is
    /// the beginning of the request.
    #[inline(never)]
    fn upload_live(&mut self, device: &mut Lent<'_>, row: &Row, head: u32) -> Option<()> {
        if !ROOMY {
            return None;
        }
        let node = &mut self.machines;
        let outbox = Room::outbox(&mut self.outbox);
        let address = row.address();
        if address.index >= 0x2000 {
            let mut store = Store::new(&device.dictionary, device.values, node.node_id).ok()?;
            let mut context = Context {
                store: &mut store,
                now: node.now,
                signals: &mut outbox.signals,
            };
            if let Err(code) = device.application.refresh(&mut context, address) {
                let code = code.code();
                node.answer = words(Response::Abort { address, code }.emit());
                node.pending |= pending::ANSWER;
                node.sdo.reset();
                return self.end_upload(device);
            }
        }
        let (value, unused) = match word(device.values, row) {
            Some(word) => word,
            None => {
                let Slot { offset, len } = row.plain();
                let bytes = device.values.get(offset as usize..)?;
                let bytes = bytes.get(..len.into())?;
                (little_endian(bytes) as u32, 4u32.wrapping_sub(len.into()))
            }
        };
        node.sdo.reset();
        node.respond(head, value, unused);
        match !outbox.is_empty() || D::CHANGES && node.watches_changes {
            true => self.end_upload(device),
            false => Some(()),
        }
    }

    /// The application had more to say of a value, or a PDO is sent for it.
    #[cold]
    fn end_upload(&mut self, device: &mut Lent<'_>) -> Option<()> {
        let now = self.machines.now;
        let (node, mut objects) = self.open(device, now)?;
        node.finish(&mut objects);
        node.reset_if_due(&mut objects);
        Some(())
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
        let at = u32::from(marks)
            .trailing_zeros()
            .wrapping_sub(pending::FIRST_MARK.trailing_zeros());
        if marks & !pending::MARKS == 0
            && device.values.len() >= device.dictionary.store_len()
            && let Some(pdo) = node.tpdo.get_mut(at as usize)
        {
            if pdo.is_live() {
                node.pending = marks & marks.wrapping_sub(1);
                let now = now.max(node.now);
                return self.send_pdo(device, now, at as usize);
            }
            if let Some(frame) = pdo.send_plain(&device.dictionary, device.values) {
                node.pending = marks & marks.wrapping_sub(1);
                return Some(frame);
            }
        }
        self.poll_seldom(device, now)
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

    /// TPDOs that a SYNC marked are waiting to be sent, as any others.
    #[cold]
    #[inline(never)]
    pub(super) fn pend_marked(&mut self) {
        let mut marks = self.pending;
        self.pending = marks & !pending::MARKS | pending::PDO;
        marks &= pending::MARKS;
        for pdo in self.tpdos_mut() {
            pdo.pend_if(marks & pending::FIRST_MARK != 0);
            marks >>= 1;
        }
    }
}

#[cfg(test)]
mod tests;
