//! Comparison of results with the bounds, and its verdicts.

use std::path::Path;

use od_benches::discipline::Discipline;
use od_benches::results::{Results, Unit};
use od_benches::roster::{CANOPEN_RS, ODKIT, ZENCAN};
use od_benches::table::{COMPARED, GROWTH, marks};

#[test]
fn bounds_are_checked_on_the_right_side() {
    let mut results = Results::load(Path::new("a missing directory"));
    for (name, time) in [(ODKIT, 30.0), (CANOPEN_RS, 90.0), (ZENCAN, 120.0)] {
        results.set(Unit::Nanoseconds, COMPARED, name, time);
    }
    results.set(Unit::Instructions, COMPARED, ODKIT, 260.0);
    results.set(Unit::Instructions, Discipline::Pdo, ODKIT, 381.0);
    results.set(Unit::Nanoseconds, GROWTH.0, ODKIT, 30.0);
    results.set(Unit::Nanoseconds, GROWTH.1, ODKIT, 37.0);
    let text = marks(&results);
    let verdicts: Vec<&str> = text
        .lines()
        .skip(2)
        .filter_map(|line| line.rsplit('|').nth(1))
        .map(str::trim)
        .collect();
    let missing = "not measured";
    assert_eq!(
        verdicts[..7],
        ["yes", "yes", "**no**", missing, missing, "**no**", missing]
    );
}
