//! SDO transfers of several frames as one (CiA 301, chapter 7.2.4).

use std::prelude::v1::*;

use od_model::Address;
use od_wire::Frame;
use od_wire::sdo::{Request, Response};

use super::sorted::Sorted;

/// A segmented or block transfer, as far as its frames have been seen.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Fold {
    /// Numbers of its frames.
    pub frames: Vec<u32>,
    /// The node ID of the server.
    pub node: u8,
    /// Object that is read or written.
    pub object: Address,
    /// Written; else read.
    pub is_write: bool,
    /// The bytes so far.
    pub bytes: Vec<u8>,
    /// State of the transfer.
    pub state: State,
}

/// State of a transfer.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum State {
    /// More frames follow.
    UnderWay,
    /// Complete.
    Done,
    /// Aborted.
    Aborted,
}

#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Phase {
    /// Nothing but its request was seen.
    Request {
        is_segmented: bool,
    },
    Upload,
    Download {
        is_last: bool,
    },
    BlockUpload,
    BlockUploadEnd,
    BlockDownload {
        is_last: bool,
    },
}

#[derive(Debug)]
struct Open {
    first: u32,
    phase: Phase,
}

/// Most bytes that are kept of a transfer.
const MOST: usize = 1 << 20;

/// Puts the frames of each transfer together.
#[derive(Debug, Default)]
pub struct Folder {
    open: Sorted<u8, Open>,
    /// By the number of the first frame.
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

    /// Takes the next frame. Returns the number of the first frame of the transfer that it
    /// belongs to; `None` if it has a row of its own, as the first frame of a transfer has.
    pub fn take(&mut self, frame: &Frame, number: u32) -> Option<u32> {
        let id = frame.id().as_standard().filter(|_| !frame.is_remote())?;
        let is_answer = match id {
            0x581..=0x5FF => true,
            0x601..=0x67F => false,
            _ => return None,
        };
        let node = (id & 0x7F) as u8;
        if !is_answer && self.begin(frame, number, node) {
            return None;
        }
        let open = self.open.get_mut(node)?;
        let first = open.first;
        let is_request = matches!(open.phase, Phase::Request { .. });
        if is_request && !is_answer {
            return None;
        }
        let fold = self.folds.get_mut(first)?;
        if frame.bytes()[0] == 0x80 {
            self.open.remove(node);
            if is_request {
                self.folds.remove(first);
                return None;
            }
            fold.state = State::Aborted;
            fold.frames.push(number);
            return Some(first);
        }
        let belongs = if is_answer {
            answer(open, fold, frame)
        } else {
            request(open, fold, frame)
        };
        if !belongs {
            self.open.remove(node);
            self.folds.remove(first);
            return None;
        }
        if fold.state != State::UnderWay {
            self.open.remove(node);
        }
        fold.frames.push(number);
        Some(first)
    }

    /// Does a request start a transfer? Segments and confirmations do not.
    fn begin(&mut self, frame: &Frame, number: u32, node: u8) -> bool {
        let phase = self.open.get(node).map(|open| open.phase);
        if matches!(phase, Some(Phase::BlockDownload { .. })) {
            return false;
        }
        let (object, is_write, is_segmented) = match Request::parse(frame.bytes()) {
            Request::InitiateUpload { address } => (address, false, true),
            Request::InitiateDownload {
                address, expedited, ..
            } => (address, true, expedited.is_none()),
            Request::InitiateBlockUpload { address, .. } => (address, false, false),
            Request::InitiateBlockDownload { address, .. } => (address, true, false),
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
        let phase = Phase::Request { is_segmented };
        let open = Open {
            first: number,
            phase,
        };
        if let Some(before) = self.open.insert(node, open)
            && matches!(before.phase, Phase::Request { .. })
        {
            self.folds.remove(before.first);
        }
        self.folds.insert(number, fold);
        true
    }
}

/// Whether an answer belongs to the transfer.
fn answer(open: &mut Open, fold: &mut Fold, frame: &Frame) -> bool {
    let response = Response::parse(frame.bytes());
    match open.phase {
        Phase::Request { is_segmented } => {
            open.phase = match response {
                Response::InitiateDownload { .. } if fold.is_write && is_segmented => {
                    Phase::Download { is_last: false }
                }
                Response::InitiateBlockDownload { .. } if fold.is_write => {
                    Phase::BlockDownload { is_last: false }
                }
                Response::InitiateUpload {
                    expedited: None, ..
                } if !fold.is_write => Phase::Upload,
                Response::InitiateBlockUpload { .. } if !fold.is_write => Phase::BlockUpload,
                _ => return false,
            };
        }
        Phase::Upload => {
            if let Response::UploadSegment(segment) = response {
                keep(fold, segment.bytes());
                if segment.last {
                    fold.state = State::Done;
                }
            }
        }
        Phase::BlockUpload => match response {
            Response::EndBlockUpload { unused, .. } if !fold.bytes.is_empty() => {
                cut(fold, unused);
                open.phase = Phase::BlockUploadEnd;
            }
            _ => keep(fold, &frame.bytes()[1..]),
        },
        Phase::Download { is_last } => {
            if is_last {
                fold.state = State::Done;
            }
        }
        Phase::BlockDownload { .. } => {
            if matches!(response, Response::EndBlockDownload) {
                fold.state = State::Done;
            }
        }
        Phase::BlockUploadEnd => {}
    }
    true
}

/// Whether a request belongs to the transfer.
fn request(open: &mut Open, fold: &mut Fold, frame: &Frame) -> bool {
    let request = Request::parse(frame.bytes());
    match open.phase {
        Phase::Download { .. } => {
            if let Request::DownloadSegment(segment) = request {
                keep(fold, segment.bytes());
                open.phase = Phase::Download {
                    is_last: segment.last,
                };
            }
        }
        Phase::BlockDownload { is_last } => match request {
            Request::EndBlockDownload { unused, .. } if is_last => cut(fold, unused),
            _ => {
                keep(fold, &frame.bytes()[1..]);
                let is_last = is_last || frame.bytes()[0] & 0x80 != 0;
                open.phase = Phase::BlockDownload { is_last };
            }
        },
        Phase::BlockUploadEnd => fold.state = State::Done,
        _ => {}
    }
    true
}

fn keep(fold: &mut Fold, bytes: &[u8]) {
    if fold.bytes.len() < MOST {
        fold.bytes.extend_from_slice(bytes);
    }
}

/// The last segment of a block has bytes that mean nothing.
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
