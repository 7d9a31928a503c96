//! Selection of a slave: switch state selective, identification by ranges, fastscan.

/// Steps that must arrive in order, and that each must match this slave (CiA 305, chapters 6.3.3 and 6.6.2).
#[derive(Clone, Copy, Debug)]
pub(super) struct Sequence {
    next: u8,
}

impl Sequence {
    pub(super) const fn new() -> Self {
        Self { next: 0 }
    }

    /// Returns whether this step, the `last` one, completes the sequence.
    pub(super) fn step(&mut self, step: u8, last: u8, matches: bool) -> bool {
        // Step 0 restarts the scan.
        let in_order = step == 0 || step == self.next;
        self.next = if in_order && matches { step + 1 } else { 0 };
        let complete = self.next > last;
        if complete {
            self.next = 0;
        }
        complete
    }
}

/// Number of the LSS address that a step of identify remote slave compares. Steps 0 to 5 are
/// vendor-ID, product code, lowest and highest revision number, lowest and highest serial number.
pub(super) const fn part(step: u8) -> u8 {
    match step {
        0 | 1 => step,
        _ => step / 2 + 1,
    }
}

/// Returns whether this slave's number is within the limit of a step of identify remote slave (CiA 305, chapter
/// 6.6.2).
pub(super) const fn in_range(step: u8, value: u32, own: u32) -> bool {
    match step {
        0 | 1 => own == value,
        2 | 4 => own >= value,
        3 | 5 => own <= value,
        _ => false,
    }
}

/// Result of a step of fastscan.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Seen {
    /// Another slave is meant.
    Other,
    /// This slave may be meant.
    Match,
    /// All four numbers are this slave's.
    Complete,
}

/// State of a fastscan: the number of the LSS address that is being scanned.
#[derive(Clone, Copy, Debug)]
pub(super) struct Fastscan {
    part: u8,
}

impl Fastscan {
    /// `bit` of the request that asks whether any slave responds, and begins a scan.
    const BEGIN: u8 = 0x80;

    pub(super) const fn new() -> Self {
        Self { part: 0 }
    }

    /// Handles one step (CiA 305, chapter 6.7): compares bits 31 to `bit` of this number with those
    /// of the request. `own` is this slave's number.
    ///
    /// The scan is complete only when all bits of the last number match, after the three other
    /// numbers.
    pub(super) fn step(&mut self, number: u32, bit: u8, part: u8, next: u8, own: u32) -> Seen {
        if bit == Self::BEGIN {
            self.part = 0;
            return Seen::Match;
        }
        if bit > 31 || next > 3 || part != self.part || (own ^ number) >> bit != 0 {
            return Seen::Other;
        }
        if bit > 0 {
            return Seen::Match;
        }
        match (part, next) {
            (3, 0) => {
                self.part = 0;
                Seen::Complete
            }
            // This number is confirmed, so the scan goes to the next one. A master may not leave it
            // out.
            (part, next) if next == part + 1 => {
                self.part = next;
                Seen::Match
            }
            (part, next) if next == part => Seen::Match,
            _ => Seen::Other,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ADDRESS: [u32; 4] = [0xEC, 0x0A, 0x0001_0000, 0x8000_0001];

    /// A master that scans as CiA 305 describes.
    fn scan(slave: &mut Fastscan, address: [u32; 4]) -> Option<[u32; 4]> {
        assert_eq!(slave.step(0, 0x80, 0, 0, 0), Seen::Match);
        let mut found = [0; 4];
        for part in 0..4u8 {
            for bit in (0..32).rev() {
                let number = found[usize::from(part)];
                if slave.step(number, bit, part, part, address[usize::from(part)]) == Seen::Other {
                    found[usize::from(part)] |= 1 << bit;
                }
            }
            let (next, own) = ((part + 1) % 4, address[usize::from(part)]);
            let seen = slave.step(found[usize::from(part)], 0, part, next, own);
            let wanted = if next == 0 {
                Seen::Complete
            } else {
                Seen::Match
            };
            if seen != wanted {
                return None;
            }
        }
        Some(found)
    }

    #[test]
    fn a_scan_finds_the_address() {
        assert_eq!(scan(&mut Fastscan::new(), ADDRESS), Some(ADDRESS));
        assert_eq!(scan(&mut Fastscan::new(), [0; 4]), Some([0; 4]));
        assert_eq!(
            scan(&mut Fastscan::new(), [u32::MAX; 4]),
            Some([u32::MAX; 4])
        );
    }

    #[test]
    fn no_scan_is_complete_before_its_end() {
        let mut slave = Fastscan::new();
        slave.step(0, 0x80, 0, 0, 0);
        // A master that skips numbers or goes back finds no slave.
        assert_eq!(slave.step(ADDRESS[3], 0, 3, 0, ADDRESS[3]), Seen::Other);
        assert_eq!(slave.step(ADDRESS[0], 0, 0, 3, ADDRESS[0]), Seen::Other);
        assert_eq!(slave.step(ADDRESS[0], 0, 0, 1, ADDRESS[0]), Seen::Match);
        assert_eq!(slave.step(ADDRESS[1], 0, 1, 0, ADDRESS[1]), Seen::Other);
        assert_eq!(slave.step(ADDRESS[1], 32, 1, 2, ADDRESS[1]), Seen::Other);
        assert_eq!(slave.step(0, 0, 200, 1, 0), Seen::Other);
    }

    #[test]
    fn steps_out_of_order_start_again() {
        let mut sequence = Sequence::new();
        assert!(!sequence.step(0, 3, true) && !sequence.step(1, 3, true));
        assert!(!sequence.step(3, 3, true), "2 was left out");
        assert!(!sequence.step(0, 3, true) && !sequence.step(1, 3, true));
        assert!(!sequence.step(2, 3, true) && sequence.step(3, 3, true));
        assert!(!sequence.step(3, 3, true), "once is once");
    }
}
