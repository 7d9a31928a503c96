//! The dictionaries of all contenders, and the order in which they are read.
//!
//! The build scripts include this file too, so that generated and measured objects
//! are the same.

/// The dictionary sizes, in application objects.
///
/// Every fourth is a record, so there are more than twice as many values. The objects
/// that a stack has itself (1000h, 1001h, 1017h, 1018h, PDO parameters) are added.
pub const SIZES: [usize; 4] = [16, 120, 1_000, 5_000];

/// The dictionary size of the PDO benchmark.
pub const PDO_SIZE: usize = 120;

/// The node-ID of every contender.
pub const NODE_ID: u8 = 1;

/// The first application object.
const FIRST: u16 = 0x2000;

/// One object in this many is a record.
const RECORD_EVERY: usize = 4;

/// Value of sub-index 0 of a record: sub-objects 1 to 5, each a U32.
pub const MEMBERS: u8 = 5;

/// An application object.
#[derive(Clone, Copy, Debug)]
pub struct Object {
    /// Index of the object.
    pub index: u16,
    /// Whether it is a record of [`MEMBERS`] U32 values or a VAR of type U32.
    pub is_record: bool,
}

impl Object {
    /// The sub-indices of its U32 values: 0 of a VAR, 1 to 5 of a record.
    pub fn subs(self) -> std::ops::RangeInclusive<u8> {
        if self.is_record { 1..=MEMBERS } else { 0..=0 }
    }
}

/// The `size` application objects, ascending.
///
/// Neighbours are 1 to 3 apart: dense enough for a jump table, like real
/// dictionaries, and too uneven for an index computed from the address.
/// zencan-node reserves 5000h, so the last index is below.
pub fn objects(size: usize) -> Vec<Object> {
    let mut random = Random::new(2_024);
    let mut next = FIRST;
    let objects: Vec<Object> = (0..size)
        .map(|number| {
            let index = next;
            next += 1 + u16::try_from(random.below(3)).expect("below 3");
            let is_record = number % RECORD_EVERY == RECORD_EVERY - 1;
            Object { index, is_record }
        })
        .collect();
    assert!(next < 0x5000, "the dictionary runs into 5000h");
    objects
}

/// The addresses of all U32 values of `size` objects, ascending.
pub fn addresses(size: usize) -> Vec<(u16, u8)> {
    let subs = |object: Object| object.subs().map(move |sub| (object.index, sub));
    objects(size).into_iter().flat_map(subs).collect()
}

/// Number of U32 values of `size` objects.
pub const fn values(size: usize) -> usize {
    size + records(size) * (MEMBERS as usize - 1)
}

/// Number of records among `size` objects; each has a sub-index 0 in addition to its values.
pub const fn records(size: usize) -> usize {
    size / RECORD_EVERY
}

/// The value at an address: four bytes derived from it, so that a response from
/// another place is detected.
pub fn value(index: u16, sub: u8) -> u32 {
    (u32::from(index) << 8 | u32::from(sub)).wrapping_mul(0x9E37_79B1) ^ 0x5A5A_5A5A
}

/// The VAR that the PDO benchmark maps: in the middle, where a linear search
/// meets its average.
pub fn mapped(size: usize) -> u16 {
    let middle = &objects(size)[size / 2];
    assert!(!middle.is_record, "a VAR");
    middle.index
}

/// A fixed pseudo-random sequence (a 64-bit LCG, upper half used).
/// It is computed during the measurement: the branch predictor would learn a table of requests that
/// repeats, and the lookup would not be measured.
#[derive(Clone, Debug)]
pub struct Random(u64);

impl Random {
    /// The sequence that starts at `seed`.
    pub const fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// The next number in `0..bound`, for bounds below 2³².
    pub fn below(&mut self, bound: usize) -> usize {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (((self.0 >> 32) * bound as u64) >> 32) as usize
    }
}
