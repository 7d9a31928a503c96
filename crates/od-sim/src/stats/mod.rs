//! Figures of the frames on a bus, for each CAN-ID and each SDO client.

mod clients;
mod ids;

pub use clients::{Client, Clients};
pub use ids::{Ids, Row};

/// Shortest, mean and longest time in microseconds.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Times {
    /// The shortest.
    pub least: u64,
    /// The mean.
    pub mean: f64,
    /// The longest.
    pub most: u64,
}

/// Collects times one by one.
#[derive(Clone, Copy, Default, Debug)]
struct Sum {
    count: u32,
    least: u64,
    most: u64,
    sum: u64,
}

impl Sum {
    fn add(&mut self, micros: u64) {
        self.least = match self.count {
            0 => micros,
            _ => self.least.min(micros),
        };
        self.most = self.most.max(micros);
        self.sum = self.sum.saturating_add(micros);
        self.count = self.count.saturating_add(1);
    }

    fn times(&self) -> Option<Times> {
        (self.count > 0).then(|| Times {
            least: self.least,
            mean: self.sum as f64 / f64::from(self.count),
            most: self.most,
        })
    }
}
