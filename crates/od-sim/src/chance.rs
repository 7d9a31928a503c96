//! Random numbers that are the same on every computer.

/// The number at a place of the sequence of a seed (splitmix64).
pub(crate) fn drawn(seed: u64, place: u64) -> u64 {
    let step = 0x9E37_79B9_7F4A_7C15_u64;
    let mixed = seed.wrapping_add(step.wrapping_mul(place.wrapping_add(1)));
    let mixed = (mixed ^ mixed >> 30).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    let mixed = (mixed ^ mixed >> 27).wrapping_mul(0x94D0_49BB_1331_11EB);
    mixed ^ mixed >> 31
}

/// A sequence of random numbers (xorshift64*).
#[derive(Clone, Debug)]
pub(crate) struct Chance(u64);

impl Chance {
    /// The sequence that continues from a state.
    pub(crate) fn new(state: u64) -> Self {
        // A state of 0 would stay 0.
        Self(state.max(1))
    }

    /// The sequence of a seed. Seeds that are close together, such as 1 and 2, give unrelated sequences.
    pub(crate) fn of_seed(seed: u64) -> Self {
        Self::new(drawn(seed, 0))
    }

    /// The next number.
    pub(crate) fn number(&mut self) -> u64 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        self.0.wrapping_mul(0x2545_F491_4F6C_DD1D)
    }

    /// A number from 0 to `last`, each as likely as the others.
    pub(crate) fn up_to(&mut self, last: u64) -> u64 {
        let wide = u128::from(self.number()) * (u128::from(last) + 1);
        (wide >> 64) as u64
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;
    use std::prelude::v1::*;

    #[test]
    fn seeds_give_different_sequences_within_their_bounds() {
        let firsts: BTreeSet<u64> = (0..1000)
            .map(|seed| Chance::of_seed(seed).up_to(999))
            .collect();
        assert!(firsts.len() > 600, "{}", firsts.len());
        let mut chance = Chance::of_seed(0);
        let all: BTreeSet<u64> = (0..1000).map(|_| chance.up_to(5)).collect();
        assert_eq!(all, (0..=5).collect());
        assert_eq!(chance.up_to(0), 0);
        assert!((0..100).any(|_| chance.up_to(u64::MAX) > u64::MAX / 2));
        assert_ne!(Chance::new(0).number(), 0);
    }
}
