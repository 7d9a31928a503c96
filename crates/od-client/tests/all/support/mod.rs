//! Transfers frame by frame, and nodes on a bus: frames in the notation of candump.

pub(crate) mod blocks;
pub(crate) mod bus;
pub(crate) mod slave;

use od_client::Error;
use od_client::sdo::{Buffer, Channel, Download, Options, Upload};
use od_client::{CanId, Frame, Instant, NodeId};
use od_model::Address;

/// The object of every transfer that a test plays frame by frame.
pub(crate) const OBJECT: Address = Address::new(0x2003, 0);

/// `581#43…`; `581#R8` is a remote frame. Data is filled up with 0 to eight bytes.
pub(crate) fn frame(text: &str) -> Frame {
    let (id, data) = text.split_once('#').expect("id#data");
    let id = CanId::standard(u16::from_str_radix(id, 16).expect("hex"));
    if data.starts_with('R') {
        return Frame::remote(id, 8).unwrap();
    }
    Frame::new(id, &bytes(&format!("{data:0<16}"))).unwrap()
}

pub(crate) fn bytes(hex: &str) -> Vec<u8> {
    let pairs = hex.as_bytes().chunks(2);
    let pair = |pair: &[u8]| u8::from_str_radix(core::str::from_utf8(pair).ok()?, 16).ok();
    pairs.map(|it| pair(it).expect("hex")).collect()
}

pub(crate) fn at(millis: u64) -> Instant {
    Instant::from_millis(millis)
}

/// `len` bytes; each differs from its neighbours.
pub(crate) fn pattern(len: usize) -> Vec<u8> {
    (0..len).map(pattern_at).collect()
}

pub(crate) const fn pattern_at(at: usize) -> u8 {
    (at * 31 + at / 251 + 1) as u8
}

/// Functions that both directions have.
pub(crate) trait Machine {
    fn handle_frame(&mut self, now: Instant, frame: &Frame);
    fn poll_transmit(&mut self, now: Instant) -> Option<Frame>;
    fn poll_timeout(&self) -> Option<Instant>;
    fn outcome(&self) -> Option<Result<(), Error>>;

    /// Returns all frames that are sent.
    fn out(&mut self, now: Instant) -> Vec<String> {
        let frames = core::iter::from_fn(|| self.poll_transmit(now));
        frames.map(|frame| frame.to_string()).collect()
    }

    /// Handles a frame; returns the frames that are sent.
    fn on(&mut self, now: Instant, text: &str) -> Vec<String> {
        self.handle_frame(now, &frame(text));
        self.out(now)
    }

    /// Handles each frame, and returns the frame sent after it, or `-`. Data is written without the
    /// zeros at its end.
    #[track_caller]
    fn talk(&mut self, steps: &[(&str, &str)]) {
        for (step, (input, output)) in steps.iter().enumerate() {
            let out = match *input {
                "" => self.out(at(0)),
                input => self.on(at(0), &format!("581#{input}")),
            };
            let wanted: Vec<String> = match *output {
                "-" => Vec::new(),
                data => vec![format!("601#{data:0<16}")],
            };
            assert_eq!(out, wanted, "step {step}: {input}");
        }
    }
}

macro_rules! machine {
    ($type:ty, $bound:path, $param:ident) => {
        impl<$param: $bound> Machine for $type {
            fn handle_frame(&mut self, now: Instant, frame: &Frame) {
                self.handle_frame(now, frame);
            }
            fn poll_transmit(&mut self, now: Instant) -> Option<Frame> {
                self.poll_transmit(now)
            }
            fn poll_timeout(&self) -> Option<Instant> {
                self.poll_timeout()
            }
            fn outcome(&self) -> Option<Result<(), Error>> {
                self.outcome()
            }
        }
    };
}
machine!(Upload<B>, Buffer, B);
machine!(Download<D>, AsRef<[u8]>, D);

pub(crate) fn upload(options: Options) -> Upload<Vec<u8>> {
    Upload::new(Channel::of(NodeId::ONE), OBJECT, Vec::new(), options)
}

pub(crate) fn download(bytes: &[u8], options: Options) -> Download<Vec<u8>> {
    Download::new(Channel::of(NodeId::ONE), OBJECT, bytes.to_vec(), options)
}
