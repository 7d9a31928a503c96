//! A response that waits until the values are stored (1010h) or a stream can continue, and the next
//! request, which waits for it.

use crate::blank::Blank;

/// The response that waits, and the requests that arrived since.
#[derive(Clone, Copy, Debug)]
pub(super) struct Late {
    awaited: Awaited,
    /// `None` if the client aborted the transfer.
    pub(super) answer: Option<[u8; 8]>,
    /// The next request, of a client that did not wait; it is handled after the response. For a
    /// stream: the request that the stream could not serve.
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

    /// Waits for a stream that could not serve this request.
    pub(super) const fn stream(held: Option<Held>) -> Self {
        Self {
            awaited: Awaited::Stream,
            answer: None,
            held,
        }
    }

    /// Ends the wait. Returns the response.
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

    /// Handles a frame that arrives before the response was sent. An abort ends the transfer, but
    /// not the save. A new request replaces an older one that waits.
    pub(super) fn hold(&mut self, data: &[u8; 8], dlc: u8, streams: bool) {
        // In a segment of a block that waits for a stream these bits have another meaning.
        if data[0] >> 5 == 4 && (data[0] == 0x80 || !(streams && self.awaits_stream())) {
            self.answer = None;
            self.held = None;
        } else {
            self.held = Some((*data, dlc));
        }
    }
}
