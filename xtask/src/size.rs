//! `cargo xtask size`: what a node costs on a microcontroller, measured on an emulated Cortex-M3.

mod generated;
pub(crate) mod measure;
mod services;
pub(crate) mod text;

use std::fmt::Write as _;
use std::fs;

use crate::console::{Console, say};
use crate::error::{Error, Result};
use crate::repo::Repo;

use measure::{COUNTS, Cost, SMALL, boot, build, play, prepare};
use text::{grouped, has_grown, page, row, split};

/// The programs in `firmware/src/bin`, and what each is.
const PROGRAMS: [(&str, &str); 3] = [
    (
        "minimal",
        "NMT, boot-up, heartbeat, expedited SDO, EMCY, two TPDOs, 16 objects",
    ),
    ("ds301", "every service of CiA 301 but LSS, 170 values"),
    ("gxmm", "an encoder of the bus-cover family, complete"),
];
/// The lines of docs/PERFORMANCE.md around the table.
const MARKS: (&str, &str) = ("<!-- size -->\n", "<!-- /size -->");
const HEAD: &str = "| | flash, `s` | flash, `z` | static RAM | stack | power-on | SDO upload | SYNC → TPDO | frame for another | idle timeout |
|---|--:|--:|--:|--:|--:|--:|--:|--:|--:|
";

/// Measures, and prints a table or JSON; `--services` prints what each service costs. `--accept`
/// renews both tables in docs/PERFORMANCE.md.
pub(crate) fn run(repo: &Repo, args: &[String]) -> Result<()> {
    let args: Vec<&str> = args.iter().flat_map(|arg| arg.split('=')).collect();
    prepare(repo, &Console::terminal())?;
    match args[..] {
        [] | ["--format", "table"] => say(whole(repo)?.trim_end()),
        ["--format", "json"] => say(&json(&measure(repo, true)?)),
        ["--services"] => say(services::table(&services::measure(repo)?).trim_end()),
        ["--accept"] => {
            let (path, mut text) = page(repo)?;
            let tables = [
                (MARKS, whole(repo)?),
                (services::MARKS, services::table(&services::measure(repo)?)),
            ];
            for (marks, table) in tables {
                let (before, _, after) = split(&text, marks)?;
                text = [before, &table, after].concat();
            }
            fs::write(&path, text).map_err(|e| Error::io("write", &path, &e))?;
        }
        _ => {
            let text =
                "size accepts `--format table`, `--format json`, `--services` and `--accept`";
            return Err(Error::Usage(String::from(text)));
        }
    }
    Ok(())
}

/// Fails if a figure is more than 5 % above the tables in docs/PERFORMANCE.md. The table by service takes
/// 14 builds, `-Oz` one of every crate, and the firmware of `odkit new` one of od-cli; they are checked in a long run.
pub(crate) fn check(repo: &Repo, console: &Console, long: bool) -> Result<()> {
    prepare(repo, console)?;
    let (_, text) = page(repo)?;
    let (_, listed, _) = split(&text, MARKS)?;
    let now = if long {
        whole(repo)?
    } else {
        table(&measure(repo, false)?)
    };
    let mut rows = grown(listed, &now);
    if long {
        let (_, listed, _) = split(&text, services::MARKS)?;
        rows.extend(services::grown(listed, &services::measure(repo)?));
    }
    if rows.is_empty() {
        return Ok(());
    }
    let list = rows.join("\n");
    Err(Error::Failed(format!(
        "larger than the tables in docs/PERFORMANCE.md say; `cargo xtask size --accept` renews them:\n{list}"
    )))
}

/// The rows with a number more than 5 % above the listed one, and the rows that are not listed.
fn grown(listed: &str, now: &str) -> Vec<String> {
    let is_grown = |line: &&str| {
        row(line).is_some_and(|(name, now)| {
            let mut known = listed.lines().filter_map(row);
            let before = known.find(|(other, _)| *other == name);
            has_grown(&before.unwrap_or_default().1, &now)
        })
    };
    now.lines().filter(is_grown).map(String::from).collect()
}

/// The table with the firmware of `odkit new`, which takes a build of od-cli.
fn whole(repo: &Repo) -> Result<String> {
    let mut text = table(&measure(repo, true)?);
    for ((name, about), flash) in generated::ROWS.iter().zip(generated::measure(repo)?) {
        let rest = " – |".repeat(3 + COUNTS.len());
        let _ = writeln!(text, "| `{name}`: {about} | {} |{rest}", grouped(flash));
    }
    Ok(text)
}

fn table(costs: &[Cost]) -> String {
    let mut text = String::from(HEAD);
    for ((name, about), cost) in PROGRAMS.iter().zip(costs) {
        let _ = write!(text, "| `{name}`: {about} |");
        let bytes = [cost.flash, cost.flash_z, cost.ram, cost.stack];
        for number in bytes.iter().chain(&cost.instructions) {
            let _ = write!(text, " {} |", grouped(*number));
        }
        text.push('\n');
    }
    text
}

fn json(costs: &[Cost]) -> String {
    let programs = PROGRAMS.iter().zip(costs).map(|((name, _), cost)| {
        let Cost {
            flash,
            flash_z,
            ram,
            stack,
            instructions,
        } = cost;
        let counts = COUNTS.iter().zip(instructions);
        let counts: String = counts
            .map(|(what, count)| format!(", \"{what}\": {count}"))
            .collect();
        format!(
            "\"{name}\": {{\"flash\": {flash}, \"ram\": {ram}, \"stack\": {stack}, \
             \"flash_z\": {flash_z}{counts}}}"
        )
    });
    format!("{{{}}}", programs.collect::<Vec<_>>().join(", "))
}

/// Builds and runs every program; without `with_z`, their flash with the optimisation `z` is 0.
fn measure(repo: &Repo, with_z: bool) -> Result<Vec<Cost>> {
    let names = PROGRAMS.map(|(name, _)| name);
    let played = |level: &str, others: &[&str]| {
        let folder = build(repo, &[&names, others].concat(), level, &[])?;
        others
            .iter()
            .try_for_each(|name| boot(&folder.join(name)))?;
        let costs = names.iter().map(|name| play(&folder.join(name)));
        costs.collect::<Result<Vec<Cost>>>()
    };
    let mut costs = played(SMALL, &["boot_loader", "memory"])?;
    let smaller = if with_z {
        played("z", &[])?
    } else {
        Vec::new()
    };
    costs.iter_mut().for_each(|cost| cost.flash_z = 0);
    for (cost, z) in costs.iter_mut().zip(smaller) {
        cost.flash_z = z.flash;
    }
    Ok(costs)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_growth_past_five_percent_is_reported() {
        let instructions = [60_000, 300, 500, 200, 200];
        let cost = Cost {
            flash: 46_316,
            flash_z: 40_000,
            ram: 2_624,
            stack: 2_376,
            instructions,
        };
        let listed = table(&[cost]);
        let with = |flash| table(&[Cost { flash, ..cost }]);
        assert!(listed.contains("| 46,316 | 40,000 | 2,624 |"), "{listed}");
        assert!(grown(&listed, &with(46_316 / 20 * 21)).is_empty());
        assert_eq!(grown(&listed, &with(48_640)).len(), 1);
        assert_eq!(grown("", &listed).len(), 1);
    }
}
