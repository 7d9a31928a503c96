//! Figures of each CAN-ID: number of frames, period, and time of the last change of its data.

use std::prelude::v1::*;

use od_wire::{Frame, Instant};

use super::{Sum, Times};

/// Number of intervals for the jitter.
const GAPS: usize = 32;

/// Frames with one CAN-ID.
#[derive(Clone, Debug)]
pub struct Row {
    /// The last frame.
    pub frame: Frame,
    /// Time of the last frame.
    pub at: Instant,
    /// Number of frames.
    pub count: u32,
    /// Time of the last change of the data; `None` if each frame has the data of the first.
    pub changed: Option<Instant>,
    all: Sum,
    /// The last intervals, in microseconds.
    gaps: [u64; GAPS],
}

impl Row {
    fn new(at: Instant, frame: Frame) -> Self {
        Self {
            frame,
            at,
            count: 0,
            changed: None,
            all: Sum::default(),
            gaps: [0; GAPS],
        }
    }

    fn take(&mut self, at: Instant, frame: Frame) {
        if self.count > 0 {
            let gap = at.micros_since(self.at);
            self.gaps[self.all.count as usize % GAPS] = gap;
            self.all.add(gap);
            let is_same = self.frame.data() == frame.data() && self.frame.dlc() == frame.dlc();
            if !is_same {
                self.changed = Some(at);
            }
        }
        self.count = self.count.saturating_add(1);
        (self.frame, self.at) = (frame, at);
    }

    /// Intervals of all frames; `None` before the second frame.
    pub fn period(&self) -> Option<Times> {
        self.all.times()
    }

    /// The last interval in microseconds; `None` before the second frame.
    pub fn cycle(&self) -> Option<u64> {
        let last = (self.all.count as usize).checked_sub(1)?;
        Some(self.gaps[last % GAPS])
    }

    fn recent(&self) -> &[u64] {
        &self.gaps[..GAPS.min(self.all.count as usize)]
    }

    /// The mean of the last 32 intervals in microseconds; `None` before the second frame.
    pub fn recent_period(&self) -> Option<f64> {
        let gaps = self.recent();
        (!gaps.is_empty()).then(|| gaps.iter().sum::<u64>() as f64 / gaps.len() as f64)
    }

    /// The longest minus the shortest of the last 32 intervals in microseconds; `None` before the third frame.
    pub fn jitter(&self) -> Option<u64> {
        let gaps = self.recent();
        let (low, high) = (gaps.iter().min()?, gaps.iter().max()?);
        (gaps.len() > 1).then(|| high - low)
    }
}

/// The CAN-IDs of a bus: those of 11 bits first, each in ascending order.
///
/// ```
/// use od_sim::stats::Ids;
/// use od_wire::{Frame, Instant};
///
/// let mut ids = Ids::default();
/// let heartbeat = Frame::standard(0x701, &[0x05]);
/// for millis in [0, 100, 201, 300] {
///     ids.take(Instant::from_micros(millis * 1000), &heartbeat);
/// }
/// let [row] = ids.rows() else { panic!("one CAN-ID") };
/// assert_eq!((row.count, row.recent_period(), row.jitter()), (4, Some(100_000.0), Some(2_000)));
/// ```
#[derive(Clone, Debug, Default)]
pub struct Ids(Vec<Row>);

impl Ids {
    /// Counts the next frame.
    pub fn take(&mut self, at: Instant, frame: &Frame) {
        let key = frame.id();
        let place = self.0.binary_search_by_key(&key, |row| row.frame.id());
        let place = place.unwrap_or_else(|place| {
            self.0.insert(place, Row::new(at, *frame));
            place
        });
        self.0[place].take(at, *frame);
    }

    /// All CAN-IDs so far.
    pub fn rows(&self) -> &[Row] {
        &self.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(frames: &[(u64, u8)]) -> Row {
        let mut ids = Ids::default();
        for (micros, byte) in frames {
            let frame = Frame::standard(0x185, &[*byte]);
            ids.take(Instant::from_micros(*micros), &frame);
        }
        ids.rows()[0].clone()
    }

    #[test]
    fn period_jitter_and_last_change_are_measured() {
        // Every 10 ms, one of them 2 ms late; its data changes once.
        let row = of(&[(0, 1), (10_000, 1), (20_000, 2), (32_000, 2), (40_000, 2)]);
        let Times { least, mean, most } = row.period().expect("five frames");
        assert_eq!((least, mean, most), (8_000, 10_000.0, 12_000));
        assert_eq!((row.count, row.jitter()), (5, Some(4_000)));
        assert_eq!(row.changed, Some(Instant::from_millis(20)));
        assert_eq!(row.recent_period(), Some(10_000.0));
        assert_eq!(row.cycle(), Some(8_000));
    }

    #[test]
    fn a_single_frame_has_no_period() {
        let row = of(&[(5, 0)]);
        assert_eq!((row.period(), row.jitter()), (None, None));
        assert_eq!((row.recent_period(), row.changed), (None, None));
        assert_eq!(row.cycle(), None);
        assert_eq!(of(&[(5, 0), (6, 0)]).jitter(), None);
    }

    #[test]
    fn jitter_counts_the_last_intervals_and_the_period_all() {
        let mut frames = vec![(0, 0), (900_000, 0)];
        frames.extend((1..=32).map(|n| (900_000 + n * 1000, 0)));
        let row = of(&frames);
        assert_eq!(row.jitter(), Some(0));
        assert_eq!(row.recent_period(), Some(1000.0));
        assert_eq!(row.period().map(|period| period.most), Some(900_000));
    }

    #[test]
    fn identifiers_of_29_bits_have_rows_of_their_own() {
        use od_wire::CanId;
        let mut ids = Ids::default();
        for id in [
            CanId::extended(0x181),
            CanId::standard(0x701),
            CanId::standard(0x181),
        ] {
            ids.take(Instant::from_micros(1), &Frame::of(id, &[0]));
        }
        let ids = ids.rows().iter().map(|row| row.frame.id().to_string());
        assert_eq!(ids.collect::<Vec<_>>(), ["181", "701", "00000181"]);
    }
}
