//! TIME: the time of day and date (CiA 301, chapters 7.1.6.6 and 7.2.6).

/// Milliseconds of a day.
const DAY: u64 = 24 * 60 * 60 * 1000;

/// A moment in the form of a TIME message (TIME_OF_DAY).
///
/// ```
/// use od_wire::time_of_day::TimeOfDay;
///
/// // Days since 1984-01-01, milliseconds since midnight.
/// let time = TimeOfDay { days: 1, millis: 86_399_999 };
/// assert_eq!(time.plus_millis(1), TimeOfDay { days: 2, millis: 0 });
/// ```
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug, Default)]
pub struct TimeOfDay {
    /// Days since January 1, 1984.
    pub days: u16,
    /// Milliseconds after midnight, 0 to 86,399,999.
    pub millis: u32,
}

impl TimeOfDay {
    /// Reads the data of a TIME message; `None` unless it has six bytes and a valid time of day. The four bits that
    /// CiA 301 reserves are ignored.
    pub const fn parse(data: &[u8]) -> Option<Self> {
        let [a, b, c, d, low, high] = *data else {
            return None;
        };
        let millis = u32::from_le_bytes([a, b, c, d & 0x0F]);
        if millis as u64 >= DAY {
            return None;
        }
        Some(Self {
            days: u16::from_le_bytes([low, high]),
            millis,
        })
    }

    /// Returns the data of a TIME message.
    pub const fn emit(self) -> [u8; 6] {
        let [a, b, c, d] = self.millis.to_le_bytes();
        let [low, high] = self.days.to_le_bytes();
        [a, b, c, d & 0x0F, low, high]
    }

    /// The time `millis` milliseconds later. After June 6, 2163 the days begin at 0 again.
    #[must_use]
    pub const fn plus_millis(self, millis: u64) -> Self {
        let sum = self.millis as u64 + millis % DAY;
        Self {
            days: self.days.wrapping_add((millis / DAY + sum / DAY) as u16),
            millis: (sum % DAY) as u32,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn six_bytes_are_a_time() {
        // November 22, 2026, 16:00: 15,666 days.
        let time = TimeOfDay {
            days: 15_666,
            millis: 57_600_000,
        };
        let data = [0x00, 0xE8, 0x6E, 0x03, 0x32, 0x3D];
        assert_eq!(time.emit(), data);
        assert_eq!(TimeOfDay::parse(&data), Some(time));
        // The four reserved bits.
        assert_eq!(
            TimeOfDay::parse(&[0x00, 0xE8, 0x6E, 0xF3, 0x32, 0x3D]),
            Some(time)
        );
        let last = [0xFF, 0x5B, 0x26, 0x05, 0, 0];
        assert_eq!(
            TimeOfDay::parse(&last).map(|time| time.millis),
            Some(86_399_999)
        );
        for data in [
            &[][..],
            &[0; 5],
            &[0; 7],
            &[0x00, 0x5C, 0x26, 0x05, 0, 0],
            &[0xFF; 6],
        ] {
            assert_eq!(TimeOfDay::parse(data), None, "{data:X?}");
        }
    }

    #[test]
    fn the_day_changes_at_midnight() {
        let time = |days, millis| TimeOfDay { days, millis };
        assert_eq!(time(3, 86_399_999).plus_millis(1), time(4, 0));
        assert_eq!(time(3, 5).plus_millis(2 * DAY + 7), time(5, 12));
        assert_eq!(time(u16::MAX, 86_399_999).plus_millis(2), time(0, 1));
        assert_eq!(time(0, 1).plus_millis(u64::MAX).millis, 51_951_616);
    }
}
