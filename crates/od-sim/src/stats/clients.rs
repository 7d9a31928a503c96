//! Figures of the SDO client of each node (its default SDO, CiA 301, chapter 7.2.4): response time and aborts.

use std::prelude::v1::*;

use od_wire::sdo::{Request, Response};
use od_wire::{Frame, Instant};

use super::{Sum, Times};
use crate::sdo::{Message, Observer, default_sdo};

/// The requests to one node, and its responses.
#[derive(Clone, Debug, Default)]
pub struct Client {
    /// Node ID of the server.
    pub node: u8,
    /// Requests that need a response; segments of a block do not count.
    pub requests: u32,
    /// Transfers that the client or the server aborted.
    pub aborts: u32,
    /// Requests without a response before the next one.
    pub unanswered: u32,
    times: Sum,
    /// Time of the last request, while it waits for its response.
    asked: Option<Instant>,
    observer: Observer,
}

impl Client {
    /// Time from a request to its response; `None` before the first response.
    pub fn times(&self) -> Option<Times> {
        self.times.times()
    }

    fn take(&mut self, at: Instant, message: Message<'_>, is_response: bool) {
        let is_abort = matches!(
            message,
            Message::Request(Request::Abort { .. }) | Message::Response(Response::Abort { .. })
        );
        self.aborts += u32::from(is_abort);
        if is_response {
            if let Some(asked) = self.asked.take() {
                self.times.add(at.micros_since(asked));
            }
            return;
        }
        match message {
            Message::Request(Request::Abort { .. }) => {
                self.unanswered += u32::from(self.asked.take().is_some());
            }
            // The response comes after the last segment of a block.
            Message::Segment { .. } | Message::Request(Request::EndBlockDownload { .. }) => {
                self.asked = Some(at);
            }
            Message::Request(Request::EndBlockUpload) => {}
            _ => {
                self.unanswered += u32::from(self.asked.replace(at).is_some());
                self.requests += 1;
            }
        }
    }
}

/// The SDO clients of a bus, by ascending node ID of their server.
///
/// ```
/// use od_sim::stats::Clients;
/// use od_wire::{Frame, Instant};
///
/// let mut clients = Clients::default();
/// let request = Frame::standard(0x605, &[0x40, 0x00, 0x10, 0, 0, 0, 0, 0]);
/// let response = Frame::standard(0x585, &[0x43, 0x00, 0x10, 0, 0x96, 1, 2, 0]);
/// clients.take(Instant::from_micros(0), &request);
/// clients.take(Instant::from_micros(400), &response);
/// let [client] = clients.all() else { panic!("one client") };
/// assert_eq!((client.node, client.requests, client.unanswered), (5, 1, 0));
/// assert_eq!(client.times().map(|times| times.most), Some(400));
/// ```
#[derive(Clone, Debug, Default)]
pub struct Clients(Vec<Client>);

impl Clients {
    /// Handles the next frame. Frames other than those of a default SDO are ignored.
    pub fn take(&mut self, at: Instant, frame: &Frame) {
        let Some((node, is_response)) = default_sdo(frame) else {
            return;
        };
        let place = self.0.binary_search_by_key(&node, |client| client.node);
        let place = place.unwrap_or_else(|place| {
            let new = Client {
                node,
                ..Client::default()
            };
            self.0.insert(place, new);
            place
        });
        let client = &mut self.0[place];
        if let Some(message) = client.observer.read(is_response, frame) {
            client.take(at, message, is_response);
        }
    }

    /// The clients so far.
    pub fn all(&self) -> &[Client] {
        &self.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::logs::candump::parse_frame;

    /// Frames 1 ms apart: requests, aborts, unanswered, times.
    #[track_caller]
    fn check(lines: &[&str], counts: [u32; 3], times: Option<(u64, u64)>) {
        let mut clients = Clients::default();
        for (at, line) in (0..).zip(lines) {
            let frame = parse_frame(line).expect(line);
            clients.take(Instant::from_millis(at), &frame);
        }
        let [client] = clients.all() else {
            panic!("one client");
        };
        let Client {
            node,
            requests,
            aborts,
            unanswered,
            ..
        } = *client;
        assert_eq!((node, [requests, aborts, unanswered]), (1, counts));
        let times = times.map(|(least, most)| (least * 1000, most * 1000));
        assert_eq!(client.times().map(|one| (one.least, one.most)), times);
    }

    #[test]
    fn a_response_has_its_time() {
        check(
            &[
                "601#4004600000000000",
                "581#4304600001020304",
                "601#4004600000000000",
                "701#05",
                "581#4304600001020304",
            ],
            [2, 0, 0],
            Some((1, 2)),
        );
    }

    #[test]
    fn aborts_and_missing_responses_are_counted() {
        check(
            &[
                "601#4000700000000000",
                "581#8000700000000206",
                "601#4004600000000000",
                "601#8004600000000405",
                "601#4004600000000000",
                "601#4004600000000000",
            ],
            [4, 2, 2],
            Some((1, 1)),
        );
    }

    #[test]
    fn segments_of_a_block_are_neither_requests_nor_responses() {
        check(
            &[
                "601#C201200009000000",
                "581#A401200008000000",
                "601#0131323334353637",
                "601#8238390000000000",
                "581#A202080000000000",
                "601#D500000000000000",
                "581#A100000000000000",
                "601#4004600000000000",
                "581#4304600001020304",
            ],
            [2, 0, 0],
            Some((1, 1)),
        );
        check(
            &[
                "601#A408100008000000",
                "581#C208100009000000",
                "601#A300000000000000",
                // Segment 36 looks like the start of a block download.
                "581#2431323334353637",
                "581#A438390000000000",
                "601#A202080000000000",
                "581#D500000000000000",
                "601#A100000000000000",
                "601#4004600000000000",
                "581#4304600001020304",
            ],
            [4, 0, 0],
            Some((1, 1)),
        );
    }
}
