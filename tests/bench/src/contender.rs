//! What a contender does, and the two loops that measure it.

use std::hint::black_box;

use crate::objects::{self, Random};

/// A node that answers SDO uploads.
pub trait Upload {
    /// Takes the payload of a request to 601h, returns that of the answer on 581h.
    fn upload(&mut self, request: &[u8; 8]) -> [u8; 8];
}

/// A node in the state operational, with one TPDO on every SYNC.
pub trait Pdo {
    /// Takes a SYNC, returns the TPDO: its COB-ID and its four bytes.
    fn sync(&mut self) -> (u16, [u8; 4]);
}

/// The request for sub-index 0 of `index`.
#[inline]
pub fn request(index: u16) -> [u8; 8] {
    let [low, high] = index.to_le_bytes();
    [0x40, low, high, 0, 0, 0, 0, 0]
}

/// The one right answer to [`request`]: expedited, size indicated, four bytes.
pub fn answer(index: u16) -> [u8; 8] {
    let [low, high] = index.to_le_bytes();
    let [a, b, c, d] = objects::value(index).to_le_bytes();
    [0x43, low, high, 0, a, b, c, d]
}

/// The one right answer to a SYNC, from a dictionary of `size` objects.
pub fn tpdo(size: usize) -> (u16, [u8; 4]) {
    let value = objects::value(objects::mapped(size));
    (0x180 + u16::from(objects::NODE_ID), value.to_le_bytes())
}

/// Something that does one operation many times.
pub trait Subject {
    /// Panics unless the operation is done right.
    fn verify(&mut self);
    /// Does the operation `count` times.
    fn run(&mut self, count: u64);
}

/// A contender under the load of uploads from all over its dictionary.
#[derive(Debug)]
pub struct Uploads<C> {
    contender: C,
    indices: Vec<u16>,
    random: Random,
}

impl<C: Upload> Uploads<C> {
    /// Reads from the dictionary of `size` objects.
    pub fn new(contender: C, size: usize) -> Self {
        Self {
            contender,
            indices: objects::indices(size),
            random: Random::new(1),
        }
    }
}

impl<C: Upload> Subject for Uploads<C> {
    fn verify(&mut self) {
        for &index in &self.indices {
            assert_eq!(
                self.contender.upload(&request(index)),
                answer(index),
                "{index:04X}h"
            );
        }
    }

    fn run(&mut self, count: u64) {
        for _ in 0..count {
            let index = self.indices[self.random.below(self.indices.len())];
            black_box(self.contender.upload(&black_box(request(index))));
        }
    }
}

/// A contender under the load of SYNC.
#[derive(Debug)]
pub struct Cycles<C>(pub C);

impl<C: Pdo> Subject for Cycles<C> {
    fn verify(&mut self) {
        for _ in 0..3 {
            assert_eq!(self.0.sync(), tpdo(objects::PDO_SIZE));
        }
    }

    fn run(&mut self, count: u64) {
        for _ in 0..count {
            black_box(black_box(&mut self.0).sync());
        }
    }
}

/// The loop itself: draws the index, builds the request, looks nothing up.
///
/// Not a contender, but what is in every number of the others.
#[derive(Debug)]
pub struct Nothing;

impl Upload for Nothing {
    fn upload(&mut self, request: &[u8; 8]) -> [u8; 8] {
        answer(u16::from_le_bytes([request[1], request[2]]))
    }
}
