//! The physics of the line: its length against the bit rate, the sample point, terminators, and clocks that deviate.
//!
//! The model is simple. A bit has 16 time quanta. All stations sample at the same point. All stations are at the
//! ends of the line. The model answers whether a frame can get through at all; each formula has its source.

use std::prelude::v1::*;

use od_runtime::Frame;

use super::bits;

/// Time quanta of a bit (CiA 301, bit rates and timing: 16 at 500 kbit/s and less).
pub const QUANTA: u16 = 16;
/// Sample point that CiA 301 recommends at 500 kbit/s and less, in thousandths of a bit.
const SAMPLE_POINT: u16 = 875;
/// Highest synchronisation jump width in time quanta (ISO 11898-1).
pub(crate) const MOST_JUMP: u8 = 4;
/// Limit of the length in metres; that of the table of CiA 301 is 5000 m at 10 kbit/s.
pub const LONGEST: u16 = 6000;
/// Limit of the deviation of a clock in millionths.
const MOST_DEVIATION: i32 = 50_000;

/// Propagation delay of a line in nanoseconds per metre (CiA 301, bit rates and timing, note 1).
const PER_METRE: u64 = 5;
/// Capacity of a line in picofarads per metre, typical of a twisted pair with 120 Ω.
const FARADS_PER_METRE: u64 = 50;
/// Capacity of a station in picofarads.
const FARADS_PER_STATION: u64 = 100;
/// Terminating resistor in ohms (ISO 11898-2).
const TERMINATOR: u64 = 120;
/// Differential internal resistance of a station in ohms (ISO 11898-2: 10 to 100 kΩ).
const STATION: u64 = 30_000;
/// ln(2.0 V / 0.5 V) in thousandths: from the dominant level of a transmitter down to the recessive threshold of a receiver
/// (ISO 11898-2).
const DISCHARGE: u64 = 1386;
/// One bit in the unit of deviations: a deviation in millionths is the phase error of one bit.
const BIT: i64 = 1_000_000;

/// One property of the line or of a station on it.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Property {
    /// Length in metres.
    Length(u16),
    /// Sample point in thousandths of a bit.
    SamplePoint(u16),
    /// Synchronisation jump width in time quanta.
    Jump(u8),
    /// Deviation of the clock of one station in millionths; a positive one is too slow.
    Clock(i32),
    /// Whether CAN_H and CAN_L are connected.
    Shorted(bool),
}

/// A value of the line or of a station on it, as conditions name it.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Measure {
    /// Length in metres.
    Length,
    /// Sample point in percent.
    SamplePoint,
    /// Synchronisation jump width in time quanta.
    Jump,
    /// Deviation of the clock of a station in percent.
    Clock,
}

/// The physical properties of the line and its stations.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Cable {
    /// Length in metres; 0: the short line of a bench, whose delay does not matter.
    pub length: u16,
    /// Sample point in thousandths of a bit.
    pub sample_point: u16,
    /// Synchronisation jump width in time quanta, 1 to 4.
    pub jump: u8,
    /// CAN_H and CAN_L are connected: no bit is dominant.
    pub shorted: bool,
    /// Deviation of each station's clock in millionths; a positive one is too slow.
    deviations: Vec<i32>,
}

impl Default for Cable {
    fn default() -> Self {
        Self {
            length: 0,
            sample_point: SAMPLE_POINT,
            jump: 1,
            shorted: false,
            deviations: Vec::new(),
        }
    }
}

/// Delay of a station from its receiver to its transmitter in nanoseconds, at a bit rate in kbit/s. CiA 301 (bit rates and
/// timing, note 1) assumes these values; those below 800 kbit/s contain opto-couplers.
fn station_delay(kbit: u16) -> u64 {
    match kbit {
        800.. => 210,
        250.. => 300,
        125.. => 450,
        // 1.5 time quanta.
        _ => bit_time(kbit) * 3 / (2 * u64::from(QUANTA)),
    }
}

/// Duration of a bit in nanoseconds.
pub fn bit_time(kbit: u16) -> u64 {
    1_000_000 / u64::from(kbit.max(1))
}

impl Cable {
    /// Time from the start of a bit to its sample point, in nanoseconds.
    pub fn sample_time(&self, kbit: u16) -> u64 {
        bit_time(kbit) * u64::from(self.sample_point) / 1000
    }

    /// Time from the first edge of a bit until the response of the farthest station is back, in nanoseconds: twice the delay
    /// of the line and of a station (CiA 301, bit rates and timing, note 1).
    pub fn round_trip(&self, kbit: u16) -> u64 {
        2 * (u64::from(self.length) * PER_METRE + station_delay(kbit))
    }

    /// Longest line in metres at a bit rate: the acknowledgement arrives before the sample point.
    pub fn longest(&self, kbit: u16) -> u64 {
        let delay = 2 * station_delay(kbit);
        self.sample_time(kbit).saturating_sub(delay) / (2 * PER_METRE)
    }

    /// Time from the end of a dominant bit until the line is recessive, in nanoseconds: the capacitance of the line discharges
    /// through terminators and stations (thresholds of ISO 11898-2).
    pub fn settling(&self, terminators: u8, stations: usize) -> u64 {
        let stations = stations.max(1) as u64;
        let pico = u64::from(self.length) * FARADS_PER_METRE + stations * FARADS_PER_STATION;
        // Conductance in nanosiemens.
        let nano = 1_000_000_000 * u64::from(terminators) / TERMINATOR
            + 1_000_000_000 * stations / STATION;
        // pF / nS is milliseconds; the last factor makes nanoseconds of it, with the thousandths of `DISCHARGE`.
        pico * DISCHARGE * 1000 / nano
    }

    /// Returns whether the acknowledgement of the farthest station comes after the sample point.
    pub(super) fn is_late(&self, kbit: u16) -> bool {
        self.length > 0 && self.round_trip(kbit) > self.sample_time(kbit)
    }

    /// Returns whether the line is still dominant at the sample point of a recessive bit.
    pub(super) fn is_slow(&self, kbit: u16, terminators: u8, stations: usize) -> bool {
        self.length > 0 && self.settling(terminators, stations) > self.sample_time(kbit)
    }

    /// The deviation of a station's clock in millionths.
    pub fn deviation(&self, station: usize) -> i32 {
        self.deviations.get(station).copied().unwrap_or(0)
    }

    /// Sets a property; a clock is that of this station.
    pub(super) fn set(&mut self, station: usize, property: Property) {
        match property {
            Property::Length(metres) => self.length = metres.min(LONGEST),
            Property::SamplePoint(thousandths) => self.sample_point = thousandths.clamp(500, 950),
            Property::Jump(quanta) => self.jump = quanta.clamp(1, MOST_JUMP),
            Property::Clock(millionths) => self.set_deviation(station, millionths),
            Property::Shorted(shorted) => self.shorted = shorted,
        }
    }

    /// Returns a value; a clock is that of this station.
    pub(super) fn measure(&self, station: usize, measure: Measure) -> f64 {
        match measure {
            Measure::Length => self.length.into(),
            Measure::SamplePoint => f64::from(self.sample_point) / 10.0,
            Measure::Jump => self.jump.into(),
            Measure::Clock => f64::from(self.deviation(station)) / 10_000.0,
        }
    }

    /// Sets the deviation of a station's clock in millionths.
    fn set_deviation(&mut self, station: usize, millionths: i32) {
        if self.deviations.len() <= station {
            self.deviations.resize(station + 1, 0);
        }
        self.deviations[station] = millionths.clamp(-MOST_DEVIATION, MOST_DEVIATION);
    }

    /// Removes a station; later ones move up.
    pub(super) fn remove(&mut self, station: usize) {
        if station < self.deviations.len() {
            self.deviations.remove(station);
        }
    }

    /// Returns whether a receiver samples a bit of this frame wrong.
    pub(crate) fn misreads(&self, frame: &Frame, sender: usize, receiver: usize) -> bool {
        let apart = self.deviation(receiver) - self.deviation(sender);
        apart != 0 && self.first_wrong(frame, apart).is_some()
    }

    /// Returns the first bit of a frame, counted from 0, that a receiver samples outside of it; its clock is slower than
    /// that of the sender by this deviation in millionths.
    ///
    /// The phase error grows with each bit. An edge from recessive to dominant takes it back by the jump width at
    /// most (ISO 11898-1, resynchronisation); the first one, the start of frame, takes it back to 0.
    pub fn first_wrong(&self, frame: &Frame, deviation: i32) -> Option<usize> {
        let jump = i64::from(self.jump) * BIT / i64::from(QUANTA);
        let sample = i64::from(self.sample_point) * BIT / 1000;
        let (mut error, mut before) = (0, true);
        for (place, bit) in bits::bits(frame).iter().enumerate() {
            if before && !bit.recessive && place > 0 {
                error -= error.clamp(-jump, jump);
            }
            before = bit.recessive;
            // The error at the sample point of this bit; at its end it is that of the whole bit.
            let at_sample = error + i64::from(deviation) * sample / BIT;
            if !(0..BIT).contains(&(sample + at_sample)) {
                return Some(place);
            }
            error += i64::from(deviation);
        }
        None
    }

    /// Largest deviation between two clocks in millionths at which all frames get through: after ten bits between two
    /// edges the jump width corrects the error, and the error stays within the shorter part of the bit (ISO 11898-1,
    /// oscillator tolerance).
    pub fn tolerance(&self) -> i32 {
        let jump = i64::from(self.jump) * BIT / i64::from(QUANTA) / 10;
        let sample = i64::from(self.sample_point) * BIT / 1000;
        // Bits after an error flag until the next edge.
        let behind = (BIT - sample).min(sample) / 13;
        jump.min(behind) as i32
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The table of CiA 301, bit rates and timing: bit rate, length, sample point.
    const TABLE: [(u16, u16, u16); 8] = [
        (1000, 25, 750),
        (800, 50, 800),
        (500, 100, 875),
        (250, 250, 875),
        (125, 500, 875),
        (50, 1000, 875),
        (20, 2500, 875),
        (10, 5000, 875),
    ];

    #[test]
    fn each_line_of_the_table_of_cia_301_gets_through_and_twice_its_length_does_not() {
        for (kbit, length, sample_point) in TABLE {
            let cable = Cable {
                length,
                sample_point,
                ..Cable::default()
            };
            assert!(!cable.is_late(kbit), "{kbit}");
            assert!(!cable.is_slow(kbit, 2, 2), "{kbit}");
            let twice = Cable {
                length: 2 * length,
                ..cable.clone()
            };
            assert!(twice.is_late(kbit), "{kbit}");
            assert!(cable.longest(kbit) >= length.into(), "{kbit}");
            assert!(cable.longest(kbit) < 2 * u64::from(length), "{kbit}");
        }
    }

    #[test]
    fn the_numbers_of_500_kbit_by_hand() {
        let cable = Cable {
            length: 100,
            ..Cable::default()
        };
        // 2 × (100 m × 5 ns + 300 ns), and 87.5 % of 2 µs.
        assert_eq!(cable.round_trip(500), 1600);
        assert_eq!(cable.sample_time(500), 1750);
        // (1750 − 600) / 10.
        assert_eq!(cable.longest(500), 115);
        // (2000 − 600) / 10, as the lesson `bus-length` says of a sample point at 50 % and 250 kbit/s.
        let early = Cable {
            sample_point: 500,
            ..Cable::default()
        };
        assert_eq!(early.longest(250), 140);
        // 5.2 nF × 1.386 × (60 Ω beside 15 kΩ).
        assert_eq!(cable.settling(2, 2), 430);
        // 5.2 nF × 1.386 × 15 kΩ.
        assert!((108_000..108_200).contains(&cable.settling(0, 2)));
    }

    #[test]
    fn a_line_without_terminators_stays_dominant() {
        let cable = Cable {
            length: 100,
            ..Cable::default()
        };
        assert!(cable.is_slow(500, 0, 2));
        assert!(!cable.is_slow(500, 1, 2));
        assert!(
            !Cable::default().is_slow(1000, 0, 2),
            "the short line of a bench"
        );
    }

    /// Zeros have the longest distance between two edges that stuff bits leave: ten bits.
    #[test]
    fn a_clock_within_the_tolerance_reads_every_frame_and_one_far_outside_none() {
        let cable = Cable::default();
        // 1/16 of a bit in ten bits.
        assert_eq!(cable.tolerance(), 6250);
        let frames = [
            Frame::standard(0x705, &[0x7F]),
            Frame::standard(0x185, &[0; 8]),
            Frame::standard(0x000, &[0xFF; 8]),
            Frame::standard(0x555, &[0x55; 8]),
        ];
        for frame in &frames {
            for deviation in [-6250, -1000, 0, 1000, 6250] {
                assert_eq!(
                    cable.first_wrong(frame, deviation),
                    None,
                    "{frame} {deviation}"
                );
            }
            assert!(cable.first_wrong(frame, 40_000).is_some(), "{frame}");
            assert!(cable.first_wrong(frame, -130_000).is_some(), "{frame}");
        }
    }

    /// The sentence of the lesson `bus-length` about a clock that is 2 % too slow.
    #[test]
    fn a_clock_that_is_2_percent_too_slow_samples_the_next_bit_in_the_seventh_after_an_edge() {
        // Five dominant bits, a stuff bit and five recessive ones follow the edge of the start of frame.
        let frame = Frame::standard(0x078, &[]);
        let cable = Cable::default();
        assert_eq!(cable.first_wrong(&frame, 20_000), Some(6));
        assert_eq!(cable.first_wrong(&frame, 10_000), None);
    }

    #[test]
    fn a_wider_jump_width_and_an_earlier_sample_point_tolerate_more() {
        let frame = Frame::standard(0x185, &[0; 8]);
        let narrow = Cable::default();
        let wide = Cable {
            jump: 4,
            sample_point: 750,
            ..Cable::default()
        };
        assert!(narrow.first_wrong(&frame, 16_000).is_some());
        assert_eq!(wide.first_wrong(&frame, 16_000), None);
        assert!(wide.tolerance() > narrow.tolerance());
        // The price is a shorter line.
        assert!(wide.longest(500) < narrow.longest(500));
    }

    #[test]
    fn deviations_follow_their_stations() {
        let mut cable = Cable::default();
        cable.set_deviation(2, 9000);
        cable.remove(1);
        assert_eq!((cable.deviation(1), cable.deviation(2)), (9000, 0));
        let frame = Frame::standard(0x185, &[0; 8]);
        assert!(!cable.misreads(&frame, 0, 2));
        cable.set_deviation(1, i32::MAX);
        assert_eq!(cable.deviation(1), MOST_DEVIATION);
        assert!(cable.misreads(&frame, 0, 1));
        assert!(cable.misreads(&frame, 1, 0));
    }
}
