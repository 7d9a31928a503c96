//! The SDO servers past the default one (1201h to 127Fh; CiA 301, chapter 7.5.2.33).

use od_wire::sdo::address;
use od_wire::{AbortCode, Frame};

use super::{Event, Machines};
use crate::deadline::Deadline;
use crate::device::Device;
use crate::extras::Extras;
use crate::objects::Objects;

/// The first object of a further server.
const FIRST: u16 = 0x1201;

impl<D: Device, const PDO: usize, const SDO: usize, X: Extras<D, SDO>> Machines<D, PDO, SDO, X> {
    /// Reads the COB-IDs again; a server that has another channel forgets its transfer.
    pub(super) fn configure_servers(&mut self, objects: &mut Objects<'_, D>) {
        if !D::SERVERS {
            return;
        }
        let others = Self::senders(objects);
        for at in 0..self.extras.servers().len() {
            let servers = self.extras.servers_mut();
            let Some((before, [one, ..])) = servers.split_at_mut_checked(at) else {
                break;
            };
            let is_taken = |id| {
                others.contains(&Some(id)) || before.iter().any(|one| one.sent_by() == Some(id))
            };
            let index = FIRST + at as u16;
            let configured = one.configure(&objects.store, index, &is_taken);
            if configured.has_changed {
                one.server.cut(objects);
            }
            if configured.is_refused {
                self.event(Event::CobIdRefused(index));
            }
        }
    }

    /// COB-IDs that were assigned dynamically (bit 30) are not kept, whatever was saved.
    #[inline]
    pub(super) fn forget_dynamic(objects: &mut Objects<'_, D>) {
        if !D::SERVERS {
            return;
        }
        for row in objects.store.dictionary().rows() {
            let address = row.address();
            if matches!((address.index, address.sub), (0x1201..=0x127F, 1 | 2))
                && row.has_integer_default()
                && objects.store.number_of(row) & 1 << 30 != 0
            {
                objects.store.reset_row(row);
            }
        }
    }

    /// A frame that may be the request of a further server. Returns whether it is.
    #[inline(never)]
    pub(super) fn handle_server(&mut self, objects: &mut Objects<'_, D>, frame: &Frame) -> bool {
        let servers = self.extras.servers();
        let Some(at) = servers.iter().position(|one| one.takes(frame.id())) else {
            return false;
        };
        let data = frame.bytes();
        let is_taken = self.is_streamed(data, Some(at));
        let Some(one) = self.extras.servers_mut().get_mut(at) else {
            return false;
        };
        let answer = match is_taken {
            true => Some(one.server.refuse(objects, address(data), TAKEN)),
            false => one.server.ask(objects, data, frame.dlc()),
        };
        let response = answer.and_then(|answer| one.frame(answer));
        self.send(response);
        true
    }

    /// A request for the default server. Returns whether it is refused: another one has to be done
    /// with the value first.
    #[inline(never)]
    pub(super) fn refuses(&mut self, objects: &mut Objects<'_, D>, frame: &Frame) -> bool {
        let is_taken = self.is_streamed(frame.bytes(), None);
        if is_taken {
            let abort = self.sdo.refuse(objects, address(frame.bytes()), TAKEN);
            self.answer(abort);
        }
        is_taken
    }

    /// Whether a request begins a transfer of a value that is on its way to or from the
    /// application by another server: a stream is one for all of them. `None`: the default server.
    fn is_streamed(&self, data: &[u8; 8], by: Option<usize>) -> bool {
        if !D::STREAMS {
            return false;
        }
        let servers = self.extras.servers();
        let own = match by.and_then(|at| servers.get(at)) {
            Some(one) => &one.server,
            None => &self.sdo,
        };
        let begins = matches!(data[0] >> 5, 1 | 2)
            || data[0] >> 5 == 5 && data[0] & 3 == 0
            || data[0] >> 5 == 6 && data[0] & 1 == 0;
        if !begins || own.takes_anything() {
            return false;
        }
        let address = Some(address(data));
        let others = servers.iter().enumerate();
        let mut others = others.filter(|(at, _)| Some(*at) != by);
        by.is_some() && self.sdo.streamed() == address
            || others.any(|(_, one)| one.server.streamed() == address)
    }

    /// All transfers end without a word to the clients.
    pub(super) fn cut_transfers(&mut self, objects: &mut Objects<'_, D>) {
        self.sdo.cut(objects);
        if D::SERVERS {
            for one in self.extras.servers_mut() {
                one.server.cut(objects);
            }
        }
    }

    /// As [`cut_transfers`](Self::cut_transfers), without telling a client.
    pub(super) fn forget_transfers(&mut self) {
        self.sdo.forget();
        if D::SERVERS {
            for one in self.extras.servers_mut() {
                one.server.forget();
            }
        }
    }

    /// Continues transfers that are due, and streams that were held up outside the bus.
    pub(super) fn wake_servers(&mut self, objects: &mut Objects<'_, D>, is_change: bool) {
        if !D::SERVERS {
            return;
        }
        for at in 0..self.extras.servers().len() {
            let Some(one) = self.extras.servers_mut().get_mut(at) else {
                return;
            };
            let answer = match is_change {
                true => one.server.handle_change(objects),
                false => one.server.handle_timeout(objects),
            };
            let response = answer.and_then(|answer| one.frame(answer));
            self.send(response);
        }
    }

    /// Ends a save that is complete (`done`) or failed: its client gets the response, and the
    /// request behind it is handled.
    pub(super) fn end_save_of_servers(&mut self, objects: &mut Objects<'_, D>, done: bool) {
        if !D::SERVERS {
            return;
        }
        for at in 0..self.extras.servers().len() {
            let Some(one) = self.extras.servers_mut().get_mut(at) else {
                return;
            };
            if !one.server.awaits_save() {
                continue;
            }
            let answer = one.server.finish(objects, done);
            let first = answer.and_then(|answer| one.frame(answer));
            let held = one.server.held();
            let next = held.and_then(|(data, dlc)| one.server.ask(objects, &data, dlc));
            let next = next.and_then(|answer| one.frame(answer));
            self.send(first);
            self.send(next);
        }
    }

    /// Whether a further server may have a segment to send.
    #[inline]
    pub(super) fn is_server_sending(&self) -> bool {
        let mut servers = self.extras.servers().iter();
        D::SERVERS && D::BLOCK && servers.any(|one| one.server.is_sending())
    }

    /// The next segment of a block upload.
    pub(super) fn poll_servers(&mut self, objects: &mut Objects<'_, D>) -> Option<Frame> {
        let mut servers = self.extras.servers_mut().iter_mut();
        servers.find_map(|one| {
            let segment = one.server.poll(objects)?;
            one.frame(segment)
        })
    }

    /// Time when one of them has something to do.
    pub(super) fn servers_deadline(&self) -> Deadline {
        let servers = self.extras.servers().iter();
        servers.fold(Deadline::NEVER, |first, one| {
            first.or(one.server.deadline())
        })
    }

    fn send(&mut self, frame: Option<Frame>) {
        if let Some(frame) = frame {
            self.push(frame);
        }
    }
}

/// Abort code for a value that another server streams.
const TAKEN: AbortCode = AbortCode::DeviceState;
