//! Lines of the script language as input, a candump log as output.

use std::prelude::v1::*;

use od_runtime::{Frame, Instant};

use super::codec::{Codec, Step};
use crate::logs::candump;

/// Longest line of input, in bytes; longer lines are cut.
const LONGEST: usize = 4096;

/// The codec of standard input and output; it keeps an incomplete line.
#[derive(Debug, Default)]
pub struct Lines(Vec<u8>);

impl Codec for Lines {
    fn receive(&mut self, bytes: &[u8], _: Instant, steps: &mut Vec<Step>) {
        for byte in bytes {
            match byte {
                b'\n' => {
                    steps.push(Step::Line(String::from_utf8_lossy(&self.0).into_owned()));
                    self.0.clear();
                }
                // A cut line could have another meaning, so it is refused.
                _ if self.0.len() > LONGEST => {}
                _ => self.0.push(*byte),
            }
        }
    }

    fn finish(&mut self, steps: &mut Vec<Step>) {
        if !self.0.is_empty() {
            self.receive(b"\n", Instant::ZERO, steps);
        }
    }

    fn form(&self) -> Option<&'static str> {
        Some("candump")
    }

    fn encode(&mut self, frame: &Frame, now: Instant, _: u64, out: &mut Vec<u8>) {
        out.extend_from_slice(candump::format_line(now, "can0", frame).as_bytes());
        out.push(b'\n');
    }
}
