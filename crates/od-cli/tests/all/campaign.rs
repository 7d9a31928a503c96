//! `odkit campaign`: seeds, parts, reports, and scripts that fail in the same way.

use std::fs;
use std::path::Path;

use crate::support::{Done, file, folder, fresh, odkit, repository};

/// 1017h is not saved, so it is 0 again after a power cut.
const SCRIPT: &str = "device gxmm node 5\n\
    sdo write 1017h = 100       # a heartbeat\n\
    ignore 085#*\n\
    random 6 times shaft rpm -3000..3000 | fault | wait 0..20ms | power cut 1ms..300ms\n\
    skip\n\
    expect value 1017h = 100\n\
    wait 1s\n";

/// A run of the seeds 0 to 39.
fn campaign(name: &str, more: &[&str]) -> Done {
    let path = file(name, SCRIPT).display().to_string();
    odkit(
        &[&["campaign", &path, "--seeds", "0..40"], more].concat(),
        "",
    )
}

/// The seeds that the output names.
fn seeds(out: &str) -> Vec<u64> {
    let first = out
        .strip_prefix("seed ")
        .and_then(|rest| rest.split(':').next());
    let others = out
        .lines()
        .find_map(|line| line.split_once("other seeds: "));
    let others = others.map_or("", |(_, others)| others).split(", ");
    let all = first
        .into_iter()
        .chain(others)
        .filter(|seed| !seed.is_empty());
    all.map(|seed| seed.parse().expect(seed)).collect()
}

#[test]
fn a_failure_has_seeds_and_a_script_that_run_plays() {
    let run = campaign("campaign-1.script", &[]);
    assert_eq!(run.code, 1, "{}", run.err);
    let failed = seeds(&run.out);
    assert!((20..40).contains(&failed.len()), "{}", run.out);
    assert!(failed.is_sorted(), "{}", run.out);
    let expected = "expect value 1017h = 100\n  expected  1017h Producer heartbeat time is 100\n  but       it is 0";
    assert!(run.out.contains(expected), "{}", run.out);
    let passed = format!("{} of 40 seeds passed in", 40 - failed.len());
    assert!(run.err.contains(&passed), "{}", run.err);
    let (_, script) = run.out.split_once("  script:\n").expect("a script");
    let lines: Vec<&str> = script.lines().map(str::trim).collect();
    assert_eq!(lines.len(), 6, "{script}");
    assert!(lines[3].starts_with("power cycle "), "{script}");
    let replay = odkit(&["run", "-"], script);
    assert_eq!(replay.code, 1, "{}", replay.err);
    assert!(replay.err.contains(expected), "{}", replay.err);
    // Each seed repeats its run, alone and in `odkit run`.
    assert_eq!(campaign("campaign-1.script", &[]).out, run.out);
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join("campaign-1.script");
    for seed in 0..5 {
        let text = seed.to_string();
        let path = path.display().to_string();
        let code = i32::from(failed.contains(&seed));
        assert_eq!(
            odkit(&["run", &path, "--seed", &text], "").code,
            code,
            "seed {seed}"
        );
        assert_eq!(
            odkit(&["campaign", &path, "--seeds", &text], "").code,
            code,
            "seed {seed}"
        );
    }
}

#[test]
fn the_parts_are_all_seeds_once() {
    let all = seeds(&campaign("campaign-2.script", &[]).out);
    let mut found = Vec::new();
    for part in ["1/3", "2/3", "3/3"] {
        let run = campaign("campaign-2.script", &["--shard", part]);
        let own = seeds(&run.out);
        assert!(!own.is_empty() && run.code == 1, "{part}: {}", run.err);
        found.extend(own);
    }
    found.sort_unstable();
    assert_eq!(found, all);
    let run = campaign("campaign-2.script", &["--shard", "40/41"]);
    assert!(run.err.contains("of 1 seeds passed"), "{}", run.err);
    let run = campaign("campaign-2.script", &["--shard", "41/41"]);
    assert_eq!((run.code, run.out.as_str()), (0, ""));
    assert!(run.err.contains("0 of 0 seeds passed"), "{}", run.err);
}

#[test]
fn reports_and_scripts_are_files() {
    let (report, scripts) = (fresh("campaign.xml"), fresh("campaign-scripts"));
    let names = [&report, &scripts].map(|path| path.display().to_string());
    let run = campaign(
        "campaign-3.script",
        &["--junit", &names[0], "--save", &names[1]],
    );
    let failed = seeds(&run.out);
    let xml = fs::read_to_string(&report).expect("a report");
    let counts = format!(
        "tests=\"{}\" failures=\"{}\"",
        failed.len() + 1,
        failed.len()
    );
    assert_eq!(xml.matches(&counts).count(), 2, "{xml}");
    assert_eq!(
        xml.matches("<failure message=\"line 6 at ").count(),
        failed.len(),
        "{xml}"
    );
    assert_eq!(xml.matches("<testcase ").count(), failed.len() + 1, "{xml}");
    assert!(
        xml.contains(&format!("{} seeds that pass", 40 - failed.len())),
        "{xml}"
    );
    let saved = scripts.join(format!("seed-{}.script", failed[0]));
    let replay = odkit(&["run", &saved.display().to_string()], "");
    assert_eq!(replay.code, 1, "{}", replay.err);
    assert_eq!(fs::read_dir(&scripts).expect("a folder").count(), 1);
}

#[test]
fn a_script_of_files_plays_in_any_folder() {
    let eds = fs::read(repository("devices/eds/GXMM.eds")).expect("an EDS of ours");
    let folder = folder("campaign beside", &[]);
    fs::write(folder.join("own.eds"), eds).expect("a file");
    let path = folder.join("it.script");
    let text = "device own.eds node 3\nrandom set 1017h = 1..9\nexpect value 1017h = 0\n";
    fs::write(&path, text).expect("a file");
    let run = odkit(
        &["campaign", &path.display().to_string(), "--seeds", "7"],
        "",
    );
    assert_eq!(run.code, 1, "{}", run.err);
    assert!(run.out.starts_with("seed 7: line 3 at"), "{}", run.out);
    let (_, script) = run.out.split_once("  script:\n").expect("a script");
    let replay = odkit(&["run", "-"], script);
    assert_eq!(replay.code, 1, "{script}\n{}", replay.err);
}

#[test]
fn mistakes_are_told_before_the_first_seed() {
    for (script, arguments, why) in [
        (
            "expect 701#00\n",
            &[][..],
            "the script has no `random` line",
        ),
        ("random shaft\n", &[], "-:1:8: a shaft cannot ``"),
        (
            "expect 702#00\nrandom fault\n",
            &[],
            "line 1 at 10.000000 s: expect 702#00",
        ),
        ("random fault\n", &["--seeds", "5..5"], "write `0..1000`"),
        ("random fault\n", &["--seeds", "x"], "write `0..1000`"),
        ("random fault\n", &["--shard", "0/4"], "write `3/16`"),
        ("random fault\n", &["--shard", "5/4"], "write `3/16`"),
        (
            "device io\nrandom fault\n",
            &[],
            "does not support any fault",
        ),
    ] {
        let run = odkit(&[&["campaign", "-"], arguments].concat(), script);
        let expected = if script.starts_with("expect 702") {
            1
        } else {
            2
        };
        assert_eq!(run.code, expected, "{script}: {}", run.err);
        let told = format!("{}{}", run.err, run.out);
        assert!(told.contains(why), "{script}: {told}");
    }
    let run = odkit(&["campaign", "-", "--seeds", "0..3"], "random fault\n");
    assert_eq!((run.code, run.out.as_str()), (0, ""), "{}", run.err);
}
