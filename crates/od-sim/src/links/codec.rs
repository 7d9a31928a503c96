//! The codec of a client: converts between its bytes and the frames of the bus.

use std::prelude::v1::*;

use od_runtime::{Frame, Instant};

use crate::line::Controller;

/// An effect of the bytes of a client.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum Step {
    /// These bytes go back to the client.
    Reply(Vec<u8>),
    /// This frame goes to the bus.
    Frame(Frame),
    /// This line goes to the console.
    Line(String),
    /// The client opens its channel, which restarts the CAN controller that all clients share.
    Open,
    /// The client asks for the state of that controller: [`Codec::status`] is the reply.
    Status,
    /// The client needs time to read the reply before frames follow.
    Pause,
    /// The client has finished, and the connection ends.
    Leave,
}

/// A codec: takes bytes in pieces of any size, and returns [`Step`]s in the order in
/// which they must happen. No codec waits, and none grows with the input.
pub trait Codec: Send {
    /// Returns the first bytes for a new client.
    fn hello(&self) -> &'static [u8] {
        b""
    }

    /// Takes bytes of the client, and adds their effects to `steps`.
    fn receive(&mut self, bytes: &[u8], now: Instant, steps: &mut Vec<Step>);

    /// Returns the reply to [`Step::Status`] for this controller.
    fn status(&mut self, controller: Controller) -> Vec<u8> {
        let _ = controller;
        Vec::new()
    }

    /// Takes the end of the input: the last line of a text may lack its line end.
    fn finish(&mut self, steps: &mut Vec<Step>) {
        let _ = steps;
    }

    /// Name of the encoding of the next frame. Codecs with the same name encode a frame to
    /// the same bytes; `None`: the bytes are for this client only.
    fn form(&self) -> Option<&'static str> {
        None
    }

    /// Adds a frame of the bus in the encoding of this client to `out`; nothing while the client does not
    /// receive it. `stamp` is the time of day at `now`, in microseconds.
    fn encode(&mut self, frame: &Frame, now: Instant, stamp: u64, out: &mut Vec<u8>);

    /// Time when [`wake`](Self::wake) is due; `None`: never.
    fn deadline(&self) -> Option<Instant> {
        None
    }

    /// Does the work that is due at `now`, at the time of day `stamp` in microseconds.
    fn wake(&mut self, now: Instant, stamp: u64, steps: &mut Vec<Step>) {
        let _ = (now, stamp, steps);
    }
}

/// Adds to the next reply.
pub(super) fn reply(steps: &mut Vec<Step>, bytes: &[u8]) {
    match steps.last_mut() {
        Some(Step::Reply(reply)) => reply.extend_from_slice(bytes),
        _ => steps.push(Step::Reply(bytes.to_vec())),
    }
}
