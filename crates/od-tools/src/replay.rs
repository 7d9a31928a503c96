//! Sends the frames of a log to a bus.

use od_wire::{Duration, Frame, Instant};

use crate::error::Error;
use crate::link::Link;

/// Sends these frames at their intervals, `speed` times as fast; 0 sends them without waiting. Frames from
/// the bus are ignored. Returns the number of sent frames.
///
/// # Errors
/// The link is lost.
pub fn replay(
    link: &mut impl Link,
    frames: &[(Instant, Frame)],
    speed: f64,
) -> Result<usize, Error> {
    let begin = link.now();
    let first = frames.first().map_or(Instant::ZERO, |(at, _)| *at);
    for (at, frame) in frames {
        let distance = at.micros_since(first) as f64;
        let wait = if speed > 0.0 { distance / speed } else { 0.0 };
        // Times count from the start, so that delays do not add up.
        let due = begin + Duration::from_micros(wait as u64);
        while link.now() < due {
            link.receive(due)?;
        }
        link.send(frame)?;
    }
    Ok(frames.len())
}
