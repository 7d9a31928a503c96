//! An answer that waits until the device has stored (1010h), and the request that waits for it.

/// The answer that waits, and what came since.
#[derive(Clone, Copy, Debug)]
pub(super) struct Late {
    is_awaited: bool,
    /// `None` if the client gave up.
    pub(super) answer: Option<[u8; 8]>,
    /// The next request: a client that did not wait is answered after the answer.
    pub(super) held: Option<Held>,
}

/// A request: its bytes and its DLC.
pub(crate) type Held = ([u8; 8], u8);

impl Late {
    pub(super) const NONE: Self = Self {
        is_awaited: false,
        answer: None,
        held: None,
    };

    pub(super) const fn new(answer: [u8; 8]) -> Self {
        Self {
            is_awaited: true,
            answer: Some(answer),
            held: None,
        }
    }

    pub(super) const fn is_awaited(&self) -> bool {
        self.is_awaited
    }

    /// A frame comes before the answer has gone: an abort ends the transfer, though not the
    /// storing; of requests the newest is kept, as a new one replaces an old one.
    pub(super) fn hold(&mut self, data: &[u8; 8], dlc: u8) {
        if data[0] >> 5 == 4 {
            self.answer = None;
            self.held = None;
        } else {
            self.held = Some((*data, dlc));
        }
    }
}
