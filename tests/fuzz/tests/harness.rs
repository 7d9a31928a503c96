//! The harness itself: what fails is kept, small, and can be had again.

use std::fs;
use std::path::Path;
use std::sync::Once;
use std::time::Duration;

use od_fuzz::harness::{Failure, quiet_panics, run};
use od_fuzz::plan::{Plan, Seed};
use od_fuzz::target::Target;

/// Fails for an `x` with a `y` somewhere behind it.
const BROKEN: Target = Target {
    name: "broken",
    run: |input| {
        let x = input.iter().position(|byte| *byte == b'x');
        let rest = x.map_or(&[][..], |x| &input[x..]);
        assert!(!rest.contains(&b'y'), "y behind x");
    },
    words: &["x", "y", "z"],
    ..Target::PLAIN
};

/// As much as it takes to find something, in a folder of its own.
fn plan(name: &str, seed: Seed) -> Plan {
    static QUIET: Once = Once::new();
    QUIET.call_once(quiet_panics);
    let found = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = fs::remove_dir_all(&found);
    Plan {
        time: Duration::from_secs(60),
        seed,
        frames: None,
        workers: 2,
        patience: Duration::from_secs(60),
        found,
        is_long: false,
    }
}

fn failure(plan: &Plan) -> Failure {
    *run(&BROKEN, plan).expect_err("chance finds x and y")
}

#[test]
fn what_fails_is_kept_small_and_tried_first() {
    let plan = plan("kept", Seed::new());
    let first = failure(&plan);
    assert_eq!(first.input, b"xy");
    let path = first.kept.clone().expect("it is written");
    assert_eq!(path.parent(), Some(&*plan.found.join("broken")));
    assert_eq!(fs::read(&path).expect("it is there"), b"xy");
    let shown = first.shown(&BROKEN);
    for part in ["y behind x", "commit it", "--replay", "ODKIT_FUZZ_SEED="] {
        assert!(shown.contains(part), "{part} in {shown}");
    }

    // No time for anything else, and any seed.
    let again = Plan {
        time: Duration::ZERO,
        seed: Seed::new(),
        ..plan
    };
    let again = failure(&again);
    assert_eq!((again.input, again.seed), (b"xy".to_vec(), None));
    assert_eq!(again.kept, Ok(path), "no second file");
}

/// However many threads share the inputs.
#[test]
fn the_printed_seed_finds_it_again() {
    let plan = plan("again", Seed::new());
    let seed = failure(&plan).seed.expect("it came from chance");
    assert_eq!(seed.number, plan.seed.number);
    assert_eq!(Seed::parse(&seed.to_string()), Some(seed));
    let with_one = |seed| {
        fs::remove_dir_all(&plan.found).expect("the run before wrote a file");
        let one = Plan {
            workers: 1,
            seed,
            ..plan.clone()
        };
        failure(&one).seed.expect("it came from chance")
    };
    assert_eq!(with_one(seed), seed, "this input is the first");
    assert!(with_one(plan.seed).first <= seed.first, "the whole run");
}

#[test]
fn each_run_has_a_seed_of_its_own() {
    assert_ne!(Seed::new(), Seed::new());
    assert_eq!(
        Seed::parse("7"),
        Some(Seed {
            number: 7,
            first: 0
        })
    );
    assert_eq!(Seed::parse("seven"), None);
    assert_eq!(Seed::parse("7:"), None);
}
