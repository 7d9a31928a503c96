//! What adapters and daemons speak: frames on one side, bytes on the other.
//!
//! | module | who speaks it |
//! |---|---|
//! | [`slcan`] | serial adapters, `slcand`, python-can's `slcan` |
//! | [`socketcand`] | the daemon of that name, python-can's `socketcand`, Kayak |
//! | [`can_frame`] | a raw socket of Linux |
//!
//! Each takes bytes as they come, in any pieces, and answers with [`Step`]s in the order in
//! which they have to happen. Nothing here waits, and nothing grows with what comes in.

pub mod can_frame;
pub mod slcan;
pub mod socketcand;

use std::prelude::v1::*;

use od_runtime::Frame;

/// What bytes of a client bring about.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum Step {
    /// These bytes go back to the client.
    Reply(Vec<u8>),
    /// This frame goes to the bus.
    Frame(Frame),
    /// The client needs time to read what it was told before frames follow.
    Pause,
}

/// Adds to the reply that comes next.
fn reply(steps: &mut Vec<Step>, bytes: &[u8]) {
    match steps.last_mut() {
        Some(Step::Reply(reply)) => reply.extend_from_slice(bytes),
        _ => steps.push(Step::Reply(bytes.to_vec())),
    }
}
