//! An application that computes a value at each reading: the position of a turning shaft.

use std::hint::black_box;

use crate::contender::{Pdo, Subject, Upload, request};
use crate::odkit::Turning;

/// 6004h of gxmm at 60 revolutions per minute, 250 ms after the start at 0: 1/4 of 8,192 steps.
const POSITION: u32 = 0x0800;
const ADDRESS: (u16, u8) = (0x6004, 0);

/// The position by SDO.
#[allow(missing_debug_implementations)] // nobody looks into it
pub struct Reading(pub Turning);

impl Subject for Reading {
    fn verify(&mut self) {
        let answer = self.0.upload(&request(ADDRESS));
        let expected = 0x43 | u64::from(ADDRESS.0) << 8 | u64::from(POSITION) << 32;
        assert_eq!(u64::from_le_bytes(answer), expected);
    }

    fn run(&mut self, count: u64) {
        for _ in 0..count {
            black_box(self.0.upload(&black_box(request(ADDRESS))));
        }
    }
}

/// The position by the TPDO on each SYNC.
#[allow(missing_debug_implementations)] // nobody looks into it
pub struct Cycle(pub Turning);

impl Subject for Cycle {
    fn verify(&mut self) {
        assert_eq!(self.0.sync(), (0x181, POSITION.to_le_bytes()));
    }

    fn run(&mut self, count: u64) {
        for _ in 0..count {
            black_box(black_box(&mut self.0).sync());
        }
    }
}
