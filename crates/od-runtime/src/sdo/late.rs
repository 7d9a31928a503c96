//! An answer that waits until the device has stored (1010h) or a stream can go on, and the request
//! that waits for it.

use crate::blank::Blank;

/// The answer that waits, and what came since.
#[derive(Clone, Copy, Debug)]
pub(super) struct Late {
    awaited: Awaited,
    /// `None` if the client gave up.
    pub(super) answer: Option<[u8; 8]>,
    /// The next request: a client that did not wait is answered after the answer. Where a stream
    /// is awaited it is the request that the stream could not serve.
    pub(super) held: Option<Held>,
}

#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Awaited {
    Nothing,
    Storing,
    Stream,
}

/// A request: its bytes and its DLC.
pub(crate) type Held = ([u8; 8], u8);

impl Blank for Late {
    const BLANK: Self = Self {
        awaited: Awaited::Nothing,
        answer: None,
        held: None,
    };
}

impl Late {
    pub(super) const fn new(answer: [u8; 8]) -> Self {
        Self {
            awaited: Awaited::Storing,
            answer: Some(answer),
            held: None,
        }
    }

    /// A stream could not serve this request.
    pub(super) const fn stream(held: Option<Held>) -> Self {
        Self {
            awaited: Awaited::Stream,
            answer: None,
            held,
        }
    }

    /// Nothing is awaited any more. Returns the answer.
    pub(super) fn end(&mut self) -> Option<[u8; 8]> {
        self.awaited = Awaited::Nothing;
        self.answer.take()
    }

    pub(super) fn is_awaited(&self) -> bool {
        self.awaited != Awaited::Nothing
    }

    pub(super) fn awaits_stream(&self) -> bool {
        self.awaited == Awaited::Stream
    }

    /// A frame comes before the answer has gone: an abort ends the transfer, though not the
    /// storing; of requests the newest is kept, as a new one replaces an old one.
    pub(super) fn hold(&mut self, data: &[u8; 8], dlc: u8, streams: bool) {
        // Where a block waits for a stream, other bits belong to a segment.
        if data[0] >> 5 == 4 && (data[0] == 0x80 || !(streams && self.awaits_stream())) {
            self.answer = None;
            self.held = None;
        } else {
            self.held = Some((*data, dlc));
        }
    }
}
