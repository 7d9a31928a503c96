//! The SDO servers: the default one, and those of 1201h to 127Fh (CiA 301, chapters 7.2.4 and 7.5.2.33).

use od_wire::sdo::address;
use od_wire::{AbortCode, CanId, Frame};

use super::{Event, Machines};
use crate::device::Device;
use crate::objects::Objects;
use crate::rooms::{Rooms, Slices};
use crate::sdo::Server;
use crate::services::may_have;

/// Index of the second server.
const FURTHER: u16 = 0x1201;

/// Abort code for a value that another server streams.
const STREAMED: AbortCode = AbortCode::DeviceState;

impl<D: Device> Machines<D> {
    /// Returns a server by its position, with its buffer.
    fn server(&mut self, at: usize) -> Option<Server<'_, D>> {
        let Slices {
            servers, buffers, ..
        } = self.rooms.all_mut();
        let room = buffers.len().checked_div(servers.len())?;
        let buffer = buffers.get_mut(at * room..(at + 1) * room)?;
        Some(Server::new(servers.get_mut(at)?, buffer))
    }

    fn server_count(&self) -> usize {
        if D::SERVERS {
            self.rooms.all().servers.len()
        } else {
            1
        }
    }

    /// Reads the COB-IDs again; a server with a changed channel drops its transfer. `senders` are
    /// the CAN-IDs of services that have priority over the servers.
    pub(super) fn configure_servers(
        &mut self,
        objects: &mut Objects<'_, D>,
        senders: [Option<CanId>; 3],
    ) {
        let node_id = self.node_id;
        if let Some(server) = self.rooms.all_mut().servers.first_mut() {
            server.configure_default(node_id);
        }
        for at in 1..self.server_count() {
            let Some((before, [one, ..])) = self.rooms.all_mut().servers.split_at_mut_checked(at)
            else {
                break;
            };
            let is_taken = |id| {
                senders.contains(&Some(id)) || before.iter().any(|one| one.sent_by() == Some(id))
            };
            let index = FURTHER + at as u16 - 1;
            let configured = one.configure(&objects.store, index, &is_taken);
            if configured.has_changed
                && let Some(mut server) = self.server(at)
            {
                server.cut(objects);
            }
            if configured.is_refused {
                self.event(Event::CobIdRefused(index));
            }
        }
    }

    /// Restores the defaults of COB-IDs of SDO servers and clients that were assigned dynamically
    /// (bit 30), also of saved ones.
    pub(super) fn forget_dynamic(objects: &mut Objects<'_, D>) {
        if !(D::SERVERS || const { may_have::<D>(0x1280, 0x12FF, None) }) {
            return;
        }
        for row in objects.store.dictionary().rows() {
            let address = row.address();
            if matches!((address.index, address.sub), (0x1201..=0x12FF, 1 | 2))
                && row.has_integer_default()
                && objects.store.number_of(row) & 1 << 30 != 0
            {
                objects.store.reset_row(row);
            }
        }
    }

    /// Handles a request for a server. Commands such as a save are carried out here, because they
    /// need the most stack.
    pub(super) fn handle_sdo(&mut self, objects: &mut Objects<'_, D>, at: usize, frame: &Frame) {
        let data = frame.bytes();
        if self.is_streamed(data, at) {
            if let Some(mut server) = self.server(at) {
                let abort = server.refuse(objects, address(data), STREAMED);
                self.respond(at, Some(abort));
            }
            return;
        }
        self.serve_request(objects, at, data, frame.dlc());
    }

    /// Passes a request to its server, queues the response, and carries out the command that the request wrote.
    fn serve_request(&mut self, objects: &mut Objects<'_, D>, at: usize, data: &[u8; 8], dlc: u8) {
        let Some(mut server) = self.server(at) else {
            return;
        };
        let response = server.handle(objects, data, dlc);
        self.respond(at, response);
        if let Some(done) = objects.carry_out() {
            self.respond_late(objects, at, done);
        }
    }

    /// Sends the response that waited for the end of a command.
    fn respond_late(&mut self, objects: &mut Objects<'_, D>, at: usize, done: bool) {
        if let Some(mut server) = self.server(at) {
            let response = server.finish(objects, done);
            self.respond(at, response);
        }
    }

    /// Queues a response of a server.
    fn respond(&mut self, at: usize, response: Option<[u8; 8]>) {
        let Slices {
            servers, frames, ..
        } = self.rooms.all_mut();
        if let Some(response) = response
            && let Some(frame) = servers.get(at).and_then(|server| server.frame(response))
        {
            frames.push(frame);
        }
    }

    /// Returns whether a request begins a transfer of a value that another server streams. A stream
    /// serves one server at a time.
    fn is_streamed(&self, data: &[u8; 8], by: usize) -> bool {
        if !(D::STREAMS && D::SERVERS) {
            return false;
        }
        let servers = self.rooms.all().servers;
        // Command specifiers of initiate download and upload, of a block download, and of a block upload.
        let begins = matches!(data[0] >> 5, 1 | 2)
            || data[0] >> 5 == 5 && data[0] & 3 == 0
            || data[0] >> 5 == 6 && data[0] & 1 == 0;
        if !begins || servers.get(by).is_none_or(|own| own.takes_anything()) {
            return false;
        }
        let address = Some(address(data));
        let mut others = servers.iter().enumerate().filter(|(at, _)| *at != by);
        others.any(|(_, one)| one.streamed() == address)
    }

    /// Ends all transfers without a message to the clients.
    pub(super) fn cut_transfers(&mut self, objects: &mut Objects<'_, D>) {
        for at in 0..self.server_count() {
            if let Some(mut server) = self.server(at) {
                server.cut(objects);
            }
        }
    }

    /// Ends all transfers as [`cut_transfers`](Self::cut_transfers) does, without telling the
    /// application.
    pub(super) fn forget_transfers(&mut self) {
        for server in self.rooms.all_mut().servers {
            server.forget();
        }
    }

    /// Continues transfers that are due; after a change outside the bus also paused streams.
    pub(super) fn wake_servers(&mut self, objects: &mut Objects<'_, D>, is_change: bool) {
        if !(D::BLOCK || D::STREAMS) {
            return;
        }
        for at in 0..self.server_count() {
            let Some(mut server) = self.server(at) else {
                return;
            };
            let response = if is_change {
                server.handle_change(objects)
            } else {
                server.handle_timeout(objects)
            };
            self.respond(at, response);
        }
    }

    /// Ends a save with a duration: its client gets the response, and the request that waited is
    /// handled.
    pub(super) fn end_save(&mut self, objects: &mut Objects<'_, D>) {
        let Some(done) = objects.complete_save() else {
            return;
        };
        for at in 0..self.server_count() {
            if !self
                .rooms
                .all()
                .servers
                .get(at)
                .is_some_and(|one| one.awaits_save())
            {
                continue;
            }
            self.respond_late(objects, at, done);
            let server = self.rooms.all_mut().servers.get_mut(at);
            if let Some((data, dlc)) = server.and_then(|server| server.held()) {
                self.serve_request(objects, at, &data, dlc);
            }
        }
    }

    /// Makes the next segment of a block upload (CiA 301, chapter 7.2.4.3.14).
    pub(super) fn next_segment(&mut self, objects: &mut Objects<'_, D>) -> Option<Frame> {
        if !D::BLOCK {
            return None;
        }
        (0..self.server_count()).find_map(|at| {
            let segment = self.server(at)?.poll(objects)?;
            self.rooms.all().servers.get(at)?.frame(segment)
        })
    }
}
