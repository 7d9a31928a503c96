//! Interface of a contender, and the two loops that measure it.

use std::hint::black_box;

use crate::objects::{self, Random};

/// A node that answers SDO uploads.
pub trait Upload {
    /// Whether it distinguishes sub-index 0 of a record from a U32; the loop without a node does not.
    const HAS_RECORDS: bool = true;

    /// Accepts the payload of a request to 601h, returns that of the response on 581h.
    fn upload(&mut self, request: &[u8; 8]) -> [u8; 8];
}

/// A node in Operational with one TPDO on every SYNC.
pub trait Pdo {
    /// Accepts a SYNC, returns the TPDO: its COB-ID and its four bytes.
    fn sync(&mut self) -> (u16, [u8; 4]);
}

/// The request for an address.
///
/// Written as one word: if it were put together from bytes, reading it would have to wait until
/// the processor has stored them one by one, for every contender.
#[inline]
pub fn request((index, sub): (u16, u8)) -> [u8; 8] {
    (0x40 | u64::from(index) << 8 | u64::from(sub) << 24).to_le_bytes()
}

/// The only right response to [`request`]: expedited, size indicated, four bytes.
pub fn answer((index, sub): (u16, u8)) -> [u8; 8] {
    let [low, high] = index.to_le_bytes();
    let [a, b, c, d] = objects::value(index, sub).to_le_bytes();
    [0x43, low, high, sub, a, b, c, d]
}

/// The only right response for sub-index 0 of a record: expedited, one byte.
fn count(index: u16) -> [u8; 8] {
    let [low, high] = index.to_le_bytes();
    [0x4F, low, high, 0, objects::MEMBERS, 0, 0, 0]
}

/// The only right response to a SYNC, from a dictionary of `size` objects.
pub fn tpdo(size: usize) -> (u16, [u8; 4]) {
    let value = objects::value(objects::mapped(size), 0);
    (0x180 + u16::from(objects::NODE_ID), value.to_le_bytes())
}

/// A subject that does one operation many times.
pub trait Subject {
    /// Panics if the result of the operation is wrong.
    fn verify(&mut self);
    /// Does the operation `count` times.
    fn run(&mut self, count: u64);
}

/// A contender that gets uploads from its whole dictionary.
#[derive(Debug)]
pub struct Uploads<C> {
    contender: C,
    size: usize,
    addresses: Vec<(u16, u8)>,
    random: Random,
}

impl<C: Upload> Uploads<C> {
    /// Reads from the dictionary of `size` objects.
    pub fn new(contender: C, size: usize) -> Self {
        Self {
            contender,
            size,
            addresses: objects::addresses(size),
            random: Random::new(1),
        }
    }
}

impl<C: Upload> Subject for Uploads<C> {
    fn verify(&mut self) {
        for &address in &self.addresses {
            let (index, sub) = address;
            assert_eq!(
                self.contender.upload(&request(address)),
                answer(address),
                "{index:04X}h:{sub:02X}"
            );
        }
        if C::HAS_RECORDS {
            let objects = objects::objects(self.size).into_iter();
            for index in objects.filter(|o| o.is_record).map(|o| o.index) {
                let answer = self.contender.upload(&request((index, 0)));
                assert_eq!(answer, count(index), "{index:04X}h:00");
            }
        }
    }

    fn run(&mut self, count: u64) {
        for _ in 0..count {
            let address = self.addresses[self.random.below(self.addresses.len())];
            black_box(self.contender.upload(&black_box(request(address))));
        }
    }
}

/// A contender that gets SYNC messages.
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

/// The loop itself: draws the index and builds the request, without a lookup.
///
/// It is not a contender; its time is included in the numbers of the others.
#[derive(Debug)]
pub struct Nothing;

impl Upload for Nothing {
    const HAS_RECORDS: bool = false;

    fn upload(&mut self, request: &[u8; 8]) -> [u8; 8] {
        answer((u16::from_le_bytes([request[1], request[2]]), request[3]))
    }
}
