//! Names of packages that appear in command lines.

/// The command line of odkit: package and program.
pub(crate) const CLI: (&str, &str) = ("od-cli", "odkit");
/// The WebAssembly module: package and library.
pub(crate) const PAGE: (&str, &str) = ("od-playground", "od_playground");
/// The smaller module that the page loads first: the same sources without features.
pub(crate) const PAGE_CORE: (&str, &str) = ("od-playground-core", "od_playground_core");
/// The integration tests.
pub(crate) const TESTS: &str = "od-tests";
/// The tests of code that must compile or must not compile; a package of its own, since trybuild builds the
/// dependencies of such a package once more.
pub(crate) const COMPILE: &str = "od-tests-compile";
/// The benchmarks, whose peers take long to build.
pub(crate) const BENCHES: &str = "od-benches";
/// A peer whose generated code takes as long to compile as odkit.
pub(crate) const PEER: &str = "od-benches-zencan";

/// The fuzz targets, for the integration tests and for libFuzzer.
pub(crate) const FUZZ: &str = "od-fuzz";

/// The Python module.
pub(crate) const PYTHON: &str = "odkit-python";

/// Packages that are not for crates.io; the playground is for npm, the Python module for PyPI.
#[rustfmt::skip]
pub(crate) const UNPUBLISHED: [&str; 9] =
    [BENCHES, PEER, PAGE.0, PAGE_CORE.0, PYTHON, TESTS, COMPILE, FUZZ, "xtask"];

/// Packages that `cargo xtask mutants` changes.
pub(crate) const MUTATED: [Mutated; 3] = [
    (
        "od-runtime",
        "crates/od-runtime/src/",
        &[
            (TESTS, &["conformance", "power_loss"]),
            ("od-devices", &["encoders"]),
        ],
    ),
    ("od-client", "crates/od-client/src/", &[]),
    (
        "od-eds",
        "crates/od-eds/src/rules/",
        &[(TESTS, &["catalogue", "cases", "rules_eds"])],
    ),
];

/// The package, the folder of the changes, and the tests of other packages that must notice them,
/// in addition to its own.
pub(crate) type Mutated = (
    &'static str,
    &'static str,
    &'static [(&'static str, &'static [&'static str])],
);

/// Packages that build without the standard library.
pub(crate) const NO_STD: [&str; 9] = [
    "od-model",
    "od-wire",
    "od-client",
    "od-runtime",
    "od-board",
    "od-thumb",
    "odkit",
    "od-capi",
    "od-devices",
];
