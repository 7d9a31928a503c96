//! The results as Markdown, for docs/PERFORMANCE.md.

use std::fmt::Write as _;

use crate::discipline::{Discipline, SIMULATED, Simulated};
use crate::objects::SIZES;
use crate::results::{Results, Unit};
use crate::roster::{CANOPEN_RS, NAMES, ODKIT, ZENCAN};

/// The dictionary size at which contenders are compared.
pub const COMPARED: Discipline = Discipline::Upload(120);
/// The smallest and the largest size of the bound on growth.
pub const GROWTH: (Discipline, Discipline) = (Discipline::Upload(16), Discipline::Upload(5_000));

/// Two tables: the measurements, and the bounds.
pub fn render(results: &Results) -> String {
    let mut text = measured(results);
    text.push('\n');
    text.push_str(&marks(results));
    text
}

/// One row per contender, one column per discipline.
fn measured(results: &Results) -> String {
    let disciplines: Vec<Discipline> = SIZES
        .map(Discipline::Upload)
        .into_iter()
        .chain([Discipline::Pdo, Discipline::Live, Discipline::LivePdo])
        .collect();
    let mut text = String::from("| |");
    for discipline in &disciplines {
        match discipline {
            Discipline::Upload(size) => cell(&mut text, &format!("upload, {size} objects")),
            Discipline::Pdo => cell(&mut text, "SYNC → TPDO"),
            Discipline::Live => cell(&mut text, "upload of a turning position"),
            Discipline::LivePdo => cell(&mut text, "SYNC → TPDO of it"),
            Discipline::Simulation(_) => {}
        }
    }
    text.push_str("\n|---|");
    text.push_str(&"--:|".repeat(disciplines.len()));
    text.push('\n');
    for name in NAMES {
        if !disciplines.iter().any(|d| taken(results, *d, name)) {
            continue;
        }
        text.push('|');
        cell(&mut text, name);
        for &discipline in &disciplines {
            let time = results.get(Unit::Nanoseconds, discipline, name);
            let count = results.get(Unit::Instructions, discipline, name);
            let time = time.map(|time| format!("{time:.1} ns"));
            let count = count.map(|count| format!("{count:.0} instr."));
            let parts: Vec<String> = time.into_iter().chain(count).collect();
            cell(
                &mut text,
                if parts.is_empty() {
                    "–".to_owned()
                } else {
                    parts.join(", ")
                }
                .as_str(),
            );
        }
        text.push('\n');
    }
    text
}

/// One row per bound of the project: a bound is what the one route through the node may cost, not a target.
pub fn marks(results: &Results) -> String {
    let time = |discipline, name| results.get(Unit::Nanoseconds, discipline, name);
    let count = |discipline, name| results.get(Unit::Instructions, discipline, name);
    let ours = time(COMPARED, ODKIT);
    let faster_peer = [CANOPEN_RS, ZENCAN]
        .into_iter()
        .filter_map(|name| time(COMPARED, name))
        .min_by(f64::total_cmp);

    let mut text = String::from("| bound | wanted | measured | met |\n|---|--:|--:|---|\n");
    row(
        &mut text,
        "upload at 120 objects: times as fast as the faster of canopen-rs and zencan-node",
        Wanted::AtLeast(1.0),
        ratio(faster_peer, ours),
    );
    for (what, discipline, bound) in [
        ("upload at 120 objects", COMPARED, 260.0),
        ("SYNC → TPDO", Discipline::Pdo, 380.0),
        ("upload of a turning position", Discipline::Live, 800.0),
        ("SYNC → TPDO of it", Discipline::LivePdo, 600.0),
    ] {
        row(
            &mut text,
            &format!("{what}: instructions"),
            Wanted::AtMost(bound),
            count(discipline, ODKIT),
        );
    }
    row(
        &mut text,
        "upload: times the time at 5,000 objects, against 16",
        Wanted::AtMost(1.2),
        ratio(time(GROWTH.1, ODKIT), time(GROWTH.0, ODKIT)),
    );
    for simulated in SIMULATED {
        let Simulated { device, is_moving } = simulated;
        let (what, bound) = if is_moving {
            (" of position, speed and acceleration", 5_000.0)
        } else {
            ("", 10_000.0)
        };
        row(
            &mut text,
            &format!("simulated seconds per second, {device} with a 1 ms PDO{what}"),
            Wanted::AtLeast(bound),
            time(Discipline::Simulation(simulated), ODKIT).map(|nanoseconds| 1e9 / nanoseconds),
        );
    }
    text
}

/// Whether a bound is an upper or a lower one.
enum Wanted {
    AtLeast(f64),
    AtMost(f64),
}

fn row(text: &mut String, mark: &str, wanted: Wanted, measured: Option<f64>) {
    let (sign, bound) = match wanted {
        Wanted::AtLeast(bound) => ('≥', bound),
        Wanted::AtMost(bound) => ('≤', bound),
    };
    let number = |number: f64| match number {
        large if large >= 1_000.0 => format!("{large:.0}"),
        small => format!("{small:.2}"),
    };
    let met = measured.map(|measured| match wanted {
        Wanted::AtLeast(bound) => measured >= bound,
        Wanted::AtMost(bound) => measured <= bound,
    });
    let met = match met {
        Some(true) => "yes",
        Some(false) => "**no**",
        None => "not measured",
    };
    let measured = measured.map_or_else(|| "–".to_owned(), number);
    let bound = number(bound);
    writeln!(text, "| {mark} | {sign} {bound} | {measured} | {met} |").expect("a String takes all");
}

fn ratio(dividend: Option<f64>, divisor: Option<f64>) -> Option<f64> {
    Some(dividend? / divisor?)
}

fn taken(results: &Results, discipline: Discipline, name: &str) -> bool {
    results.get(Unit::Nanoseconds, discipline, name).is_some()
        || results.get(Unit::Instructions, discipline, name).is_some()
}

fn cell(text: &mut String, content: &str) {
    write!(text, " {content} |").expect("a String takes all");
}
