//! The dictionaries every contender serves, and the order in which they are read.
//!
//! The build scripts include this file too, so that what is generated and what
//! is measured cannot drift apart.

/// The dictionary sizes, in application objects.
///
/// The objects a stack brings along itself (1000h, 1001h, 1017h, 1018h, PDO
/// parameters) come on top.
pub const SIZES: [usize; 4] = [16, 120, 1_000, 5_000];

/// The dictionary size of the PDO benchmark.
pub const PDO_SIZE: usize = 120;

/// The node-ID of every contender.
pub const NODE_ID: u8 = 1;

/// The first application object.
const FIRST: u16 = 0x2000;

/// The indices of the `size` application objects, ascending.
///
/// Neighbours are 1 to 3 apart: dense enough for a jump table, as real
/// dictionaries are, and too uneven for an index computed from the address.
/// zencan-node keeps 5000h for itself, so the last one stays below.
pub fn indices(size: usize) -> Vec<u16> {
    let mut random = Random::new(2_024);
    let mut next = FIRST;
    let indices: Vec<u16> = (0..size)
        .map(|_| {
            let index = next;
            next += 1 + u16::try_from(random.below(3)).expect("below 3");
            index
        })
        .collect();
    assert!(next < 0x5000, "the dictionary runs into 5000h");
    indices
}

/// The value of the object at `index`: four bytes that follow from the index,
/// so that an answer from the wrong object is seen.
pub fn value(index: u16) -> u32 {
    u32::from(index).wrapping_mul(0x9E37_79B1) ^ 0x5A5A_5A5A
}

/// The object that the PDO benchmark maps: in the middle, where a linear search
/// meets its average.
pub fn mapped(size: usize) -> u16 {
    indices(size)[size / 2]
}

/// A fixed pseudo-random sequence (a 64-bit LCG, upper half used).
///
/// It is drawn while measuring, not before: a table of requests that repeats is
/// soon known to the branch predictor, and the lookup is then not measured.
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
