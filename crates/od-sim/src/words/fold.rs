//! Combines the frames of an SDO transfer into one (CiA 301, chapter 7.2.4).

use std::prelude::v1::*;

use od_model::Address;
use od_wire::Frame;
use od_wire::sdo::{Request, Response};

use super::sorted::Sorted;
use crate::sdo::{Message, Observer, default_sdo};

/// A segmented or block transfer, as far as its frames were seen.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Fold {
    /// Numbers of its frames.
    pub frames: Vec<u32>,
    /// The node ID of the server.
    pub node: u8,
    /// Object of the transfer.
    pub object: Address,
    /// Whether the object is written; otherwise it is read.
    pub is_write: bool,
    /// The bytes so far.
    pub bytes: Vec<u8>,
    /// State of the transfer.
    pub state: State,
}

/// State of a transfer.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum State {
    /// More frames are missing.
    UnderWay,
    /// Complete.
    Done,
    /// Aborted.
    Aborted,
}

#[derive(Clone, Debug)]
struct Open {
    first: u32,
    /// The request announces segments or blocks.
    is_long: bool,
    /// The server responded to the request.
    is_answered: bool,
    /// The last segment of a download was sent.
    is_last: bool,
}

/// Limit of bytes that are kept of a transfer.
const MOST: usize = 1 << 20;

/// Combines the frames of each transfer.
#[derive(Clone, Debug, Default)]
pub struct Folder {
    observers: Sorted<u8, Observer>,
    open: Sorted<u8, Open>,
    /// Transfers by the number of their first frame.
    folds: Sorted<u32, Fold>,
}

impl Folder {
    /// Forgets everything.
    pub fn clear(&mut self) {
        *self = Self::default();
    }

    /// Forgets transfers whose first frame has a lower number.
    pub fn forget_before(&mut self, number: u32) {
        self.folds.forget_before(number);
        self.open.retain(|open| open.first >= number);
    }

    /// The transfer that starts with this frame, if it has several frames.
    pub fn fold(&self, first: u32) -> Option<&Fold> {
        self.folds.get(first).filter(|fold| fold.frames.len() > 1)
    }

    /// Handles the next frame. Returns the number of the first frame of its transfer; `None` if the
    /// frame has a row of its own, like the first frame of a transfer.
    pub fn take(&mut self, frame: &Frame, number: u32) -> Option<u32> {
        let (node, is_response) = default_sdo(frame)?;
        let message = self
            .observers
            .get_or_default(node)
            .read(is_response, frame)?;
        if let Message::Request(request) = message
            && self.begin(request, number, node)
        {
            return None;
        }
        let open = self.open.get_mut(node)?;
        let first = open.first;
        if !open.is_answered && !is_response {
            return None;
        }
        let fold = self.folds.get_mut(first)?;
        let belongs = open.is_answered || starts(open.is_long, fold.is_write, message);
        let state = match message {
            Message::Request(Request::Abort { .. }) | Message::Response(Response::Abort { .. }) => {
                State::Aborted
            }
            _ => follow(open, fold, message),
        };
        if !belongs {
            self.open.remove(node);
            self.folds.remove(first);
            return None;
        }
        open.is_answered = true;
        fold.state = state;
        fold.frames.push(number);
        if state != State::UnderWay {
            self.open.remove(node);
        }
        Some(first)
    }

    /// Returns whether a request starts a transfer; segments and confirmations do not.
    fn begin(&mut self, request: Request, number: u32, node: u8) -> bool {
        let (object, is_write, is_long) = match request {
            Request::InitiateUpload { address } => (address, false, true),
            Request::InitiateDownload {
                address, expedited, ..
            } => (address, true, expedited.is_none()),
            Request::InitiateBlockUpload { address, .. } => (address, false, true),
            Request::InitiateBlockDownload { address, .. } => (address, true, true),
            _ => return false,
        };
        let fold = Fold {
            frames: vec![number],
            node,
            object,
            is_write,
            bytes: Vec::new(),
            state: State::UnderWay,
        };
        let open = Open {
            first: number,
            is_long,
            is_answered: false,
            is_last: false,
        };
        if let Some(before) = self.open.insert(node, open)
            && !before.is_answered
        {
            self.folds.remove(before.first);
        }
        self.folds.insert(number, fold);
        true
    }
}

/// Returns whether this response to the request starts a transfer of several frames.
fn starts(is_long: bool, is_write: bool, message: Message<'_>) -> bool {
    let Message::Response(response) = message else {
        return false;
    };
    match response {
        Response::InitiateDownload { .. } => is_write && is_long,
        Response::InitiateBlockDownload { .. } => is_write,
        Response::InitiateUpload { expedited, .. } => !is_write && expedited.is_none(),
        Response::InitiateBlockUpload { .. } => !is_write,
        _ => false,
    }
}

/// Adds the content of a frame to its transfer.
fn follow(open: &mut Open, fold: &mut Fold, message: Message<'_>) -> State {
    match message {
        Message::Request(Request::DownloadSegment(segment)) => {
            keep(fold, segment.bytes());
            open.is_last = segment.last;
        }
        Message::Response(Response::UploadSegment(segment)) => {
            keep(fold, segment.bytes());
            if segment.last {
                return State::Done;
            }
        }
        Message::Response(Response::DownloadSegment { .. }) if open.is_last => return State::Done,
        Message::Segment { data, .. } => keep(fold, data),
        Message::Request(Request::EndBlockDownload { unused, .. })
        | Message::Response(Response::EndBlockUpload { unused, .. }) => cut(fold, unused),
        Message::Request(Request::EndBlockUpload)
        | Message::Response(Response::EndBlockDownload) => {
            return State::Done;
        }
        _ => {}
    }
    State::UnderWay
}

fn keep(fold: &mut Fold, bytes: &[u8]) {
    if fold.bytes.len() < MOST {
        fold.bytes.extend_from_slice(bytes);
    }
}

/// Removes the unused bytes of the last segment of a block.
fn cut(fold: &mut Fold, unused: u8) {
    let len = fold.bytes.len().saturating_sub(usize::from(unused));
    fold.bytes.truncate(len);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::logs::candump::parse_frame;

    /// Rows, and the transfer that starts with frame 0.
    fn run(lines: &[&str]) -> (usize, Option<Fold>) {
        let mut folder = Folder::default();
        let mut rows = 0;
        for (number, line) in (0..).zip(lines) {
            let frame = parse_frame(line).expect(line);
            rows += usize::from(folder.take(&frame, number).is_none());
        }
        (rows, folder.fold(0).cloned())
    }

    #[track_caller]
    fn whole(lines: &[&str], rows: usize) {
        let (seen, fold) = run(lines);
        let fold = fold.expect("a transfer");
        assert_eq!(seen, rows);
        assert_eq!(fold.state, State::Done);
        assert_eq!(fold.bytes, b"123456789");
    }

    #[test]
    fn expedited_transfers_keep_their_rows() {
        let (rows, fold) = run(&[
            "601#4004600000000000",
            "581#4304600001020304",
            "601#2B17100064000000",
            "581#6017100000000000",
        ]);
        assert_eq!((rows, fold), (4, None));
    }

    #[test]
    fn a_segmented_upload_is_one_row() {
        let lines = [
            "601#4008100000000000",
            "581#4108100009000000",
            "701#7F",
            "601#6000000000000000",
            "581#0031323334353637",
            "601#7000000000000000",
            "581#1B38390000000000",
            "601#4000100000000000",
        ];
        whole(&lines, 3);
        let (_, fold) = run(&lines);
        assert_eq!(fold.expect("a transfer").frames, [0, 1, 3, 4, 5, 6]);
    }

    #[test]
    fn a_segmented_download_is_one_row_and_one_that_is_aborted() {
        whole(
            &[
                "601#2101200009000000",
                "581#6001200000000000",
                "601#0031323334353637",
                "581#2000000000000000",
                "601#1B38390000000000",
                "581#3000000000000000",
            ],
            1,
        );
        let (rows, fold) = run(&[
            "601#2101200009000000",
            "581#6001200000000000",
            "601#0031323334353637",
            "581#8001200000000504",
            "601#4000100000000000",
            "581#4300100000000000",
        ]);
        assert_eq!(rows, 3);
        assert_eq!(fold.expect("a transfer").state, State::Aborted);
    }

    #[test]
    fn block_transfers_are_one_row() {
        whole(
            &[
                "601#A408100008000000",
                "581#C208100009000000",
                "601#A300000000000000",
                "581#0131323334353637",
                "581#8238390000000000",
                "601#A202080000000000",
                "581#D500000000000000",
                "601#A100000000000000",
            ],
            1,
        );
        whole(
            &[
                "601#C201200009000000",
                "581#A401200008000000",
                "601#0131323334353637",
                "601#8238390000000000",
                "581#A202080000000000",
                "601#D500000000000000",
                "581#A100000000000000",
                "601#4000100000000000",
            ],
            2,
        );
    }
}
