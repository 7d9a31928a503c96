//! Comparison of results with the marks, and its verdicts.

use std::path::Path;

use od_benches::results::{Results, Unit};
use od_benches::roster::{CANOPEN_RS, CANOPEN_SDO, ODKIT, ZENCAN};
use od_benches::table::{COMPARED, GROWTH, marks};

#[test]
fn bounds_are_checked_on_the_right_side() {
    let mut results = Results::load(Path::new("a missing directory"));
    for (name, time) in [
        (ODKIT, 30.0),
        (CANOPEN_RS, 90.0),
        (ZENCAN, 120.0),
        (CANOPEN_SDO, 10.0),
    ] {
        results.set(Unit::Nanoseconds, COMPARED, name, time);
    }
    results.set(Unit::Nanoseconds, GROWTH.1, ODKIT, 36.0);
    let text = marks(&results);
    let verdicts: Vec<&str> = text
        .lines()
        .skip(2)
        .filter_map(|line| line.rsplit('|').nth(1))
        .map(str::trim)
        .collect();
    assert_eq!(verdicts[..4], ["yes", "**no**", "yes", "not measured"]);
}
