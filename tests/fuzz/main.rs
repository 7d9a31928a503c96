//! Fuzzing: an input must not panic, compute without end, or break a property that its target checks.
//! `tests/fuzz/src/targets` has the targets, and `cargo xtask fuzz TARGET` runs the same ones with
//! libFuzzer, guided by coverage. Here they run on a stable compiler, with mutated seeds.
//!
//! ```text
//! cargo test -p od-tests --test fuzz                      a second for each target
//! cargo test -p od-tests --test fuzz slcan                one of them
//! ODKIT_FUZZ_SECONDS=600 cargo test …                     longer
//! ODKIT_FUZZ_SEED=7 cargo test …                          the inputs of seed 7
//! ODKIT_FUZZ_INPUT=FILE cargo test … -- --exact slcan     one input, with its steps (--nocapture)
//! cargo xtask test --long --only fuzz                     a minute each, and dictionaries that the
//!                                                         macro makes (`compiled.rs`)
//! ```
//!
//! Each run has a new seed and prints it. An input that fails is written to `tests/fuzz/found/TARGET`, where
//! every run tries it first: commit it with the correction. `tests/fuzz/corpus/TARGET` has inputs that
//! libFuzzer found worth keeping.

use od_fuzz::harness;
use od_fuzz::targets::{ALL, of};

macro_rules! targets {
    ($($name:ident)*) => {
        $(
            #[test]
            fn $name() {
                harness::test(of(stringify!($name)).expect("a target"));
            }
        )*

        #[test]
        fn every_target_is_a_test() {
            let names: Vec<&str> = ALL.iter().map(|target| target.name).collect();
            assert_eq!(names, [$(stringify!($name)),*]);
        }
    };
}

targets! {
    sdo node eeprom cob_ids structure eds xdd overlay fix script lesson console slcan socketcand candump logs
}

/// An input that fails makes the test fail.
#[test]
fn a_broken_promise_is_found() {
    use od_fuzz::target::Target;

    const BROKEN: Target = Target {
        run: |input| assert_ne!(input, b"xy", "x and y"),
        ..Target::PLAIN
    };
    harness::attempt(&BROKEN, b"x");
    let panic = std::panic::catch_unwind(|| harness::attempt(&BROKEN, b"xy"));
    assert!(panic.is_err());
}
