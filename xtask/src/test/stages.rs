//! The stages, in the order they start. The first ones build what the tests in a browser and on a bus need, which
//! take longest. One cargo at a time writes into `target/debug`, and the others wait for it: `build` compiles all tests,
//! the stages after it only run theirs, and the lints, which compile again, come last.

mod alone;
mod boards;
mod c;
mod corpus;
mod dist;
mod editor;
mod page;
mod promised;
mod python;
mod release;
mod rust;

use super::context::Context;
use crate::error::Result;

/// The content of a stage.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    /// Tests; a stage without tests is an error.
    Tests,
    /// A single check.
    Check,
}
use Kind::{Check, Tests};

/// Stages of one lane run one after another; the lanes run in parallel.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Lane {
    /// cargo, which uses all processors, and the tests inside the crates.
    Cargo,
    /// The integration tests.
    Outside,
    /// Lints and documentation; cargo compiles them while tests run.
    Lint,
    /// The page, from its build to the tests in a browser.
    Page,
    /// Tests on a bus, which mostly wait.
    Bus,
    /// Programs as a user runs them, which mostly wait.
    Programs,
    /// Microcontrollers, built and emulated; they use one processor.
    Board,
    /// Code that compiles for other computers or into separate target directories: one compiler waits for another
    /// that uses the same directory.
    Cross,
}

impl Lane {
    /// All lanes except that of cargo.
    pub(super) const BESIDE: [Lane; 7] = [
        Lane::Outside,
        Lane::Lint,
        Lane::Page,
        Lane::Bus,
        Lane::Programs,
        Lane::Board,
        Lane::Cross,
    ];

    /// Returns whether its tests depend on time; other lanes then run with lower priority.
    pub(super) fn looks_at_the_time(self) -> bool {
        matches!(self, Lane::Page | Lane::Bus | Lane::Programs | Lane::Board)
    }
}

/// One check with a name.
#[derive(Debug)]
pub(super) struct Stage {
    /// The name, as `--only` accepts it.
    pub(super) name: &'static str,
    /// One line for `--list`.
    pub(super) about: &'static str,
    /// Tests or a check.
    pub(super) kind: Kind,
    /// Runs it. The log has the number of tests.
    pub(super) run: fn(&Context<'_>) -> Result<()>,
    /// Whether it is part of `--quick`.
    pub(super) quick: bool,
    /// Whether it runs only with `--long`, or by its name.
    pub(super) long: bool,
    /// A stage outside [`Lane::Cargo`] starts when the stages of that lane before it have ended.
    pub(super) lane: Lane,
}

type Run = fn(&Context<'_>) -> Result<()>;

const fn stage(name: &'static str, kind: Kind, about: &'static str, run: Run) -> Stage {
    Stage {
        name,
        about,
        kind,
        run,
        quick: false,
        long: false,
        lane: Lane::Cargo,
    }
}

impl Stage {
    const fn quick(mut self) -> Stage {
        self.quick = true;
        self
    }

    const fn long(mut self) -> Stage {
        self.long = true;
        self
    }

    const fn beside(mut self, lane: Lane) -> Stage {
        self.lane = lane;
        self
    }
}

#[rustfmt::skip]
pub(super) const STAGES: &[Stage] = &[
    stage("fmt", Check, "rustfmt has nothing to change", rust::fmt).quick().beside(Lane::Lint),
    stage("page", Check, "types, tests and size of the TypeScript page", page::page).beside(Lane::Page),
    stage("wasm", Tests, "the tests of the WebAssembly module under Node.js", page::wasm).beside(Lane::Page),
    stage("browser", Tests, "the page in Chromium", page::browser).beside(Lane::Page),
    stage("interop", Tests, "python-canopen as master of the simulated devices", page::interop).beside(Lane::Bus),
    stage("python", Tests, "the Python package: a bus of python-can with devices in it", python::python).beside(Lane::Bus),
    stage("size", Check, "no firmware is larger than docs/PERFORMANCE.md says, and a boot loader starts a program, on an emulated Cortex-M3", rust::size).beside(Lane::Board),
    stage("boards", Check, "the firmware of `odkit new` for a generic board is built and runs; with --long those of all boards", boards::boards).beside(Lane::Board),
    stage("no_std", Check, "what runs in a node builds for a bare Cortex-M3 and M0", rust::no_std).beside(Lane::Cross),
    stage("hosts", Check, "the command line compiles for Windows and macOS", rust::hosts).long().beside(Lane::Cross),
    stage("build", Check, "all tests compile", rust::build),
    stage("programs", Tests, "the command line as a user runs it, and the client and the node as a whole", rust::programs).beside(Lane::Programs),
    stage("firmware", Tests, "conformance scripts on an emulated Cortex-M3, to the byte", rust::firmware).beside(Lane::Board),
    stage("c", Tests, "a node in C answers as the bench does: here, and on an emulated Cortex-M3", c::c).beside(Lane::Board),
    stage("ui", Tests, "what must not compile, and what the compiler says", |c| rust::outside(c, &["ui", "pass"])).beside(Lane::Cross),
    stage("wasm-pack", Tests, "wasm-pack makes the npm packages, and they work", page::wasm_pack).long().beside(Lane::Cross),
    stage("package", Check, "every crate is packed with its licences, and compiles from that with --long", release::package).beside(Lane::Bus),
    stage("conformance", Tests, "frame scripts per CANopen service", |c| rust::outside(c, &["conformance"])).quick().beside(Lane::Outside),
    stage("tests", Tests, "all other tests from outside", rust::other_outside).beside(Lane::Outside),
    stage("fuzz", Tests, "mutated input: SDO frames, node, EEPROM, EDS, scripts, adapters", rust::fuzz).beside(Lane::Outside),
    stage("corpus", Tests, "device files of others: the tests of tests/corpus on the folder that ODKIT_CORPUS names", corpus::corpus).beside(Lane::Bus),
    stage("unit", Tests, "tests inside the crates", rust::unit).quick(),
    stage("clippy", Check, "no warning, with every feature on", rust::clippy).quick().beside(Lane::Lint),
    stage("rustdoc", Check, "the documentation builds without a warning", rust::rustdoc).beside(Lane::Lint),
    stage("doc", Tests, "the examples in the documentation", rust::doc).beside(Lane::Lint),
    stage("typos", Check, "spelling of code and documents", promised::typos).beside(Lane::Lint),
    stage("msrv", Check, "what is published compiles with the oldest Rust that it promises", promised::msrv).long().beside(Lane::Cross),
    stage("minimal", Check, "what is published compiles with the oldest versions of its dependencies", promised::minimal).long().beside(Lane::Cross),
    stage("deny", Check, "advisories, licences and sources of all dependencies", promised::deny).long().beside(Lane::Cross),
    stage("alone", Check, "a clone in an empty folder passes, with no environment but PATH, HOME and CI=true", alone::alone).long(),
    stage("editor", Check, "a session in Neovim, the extension, hooks and action", editor::editor).long(),
    stage("dist", Tests, "a release is made, and each part of it installed and used in an empty folder", dist::dist).long(),
    stage("bench", Check, "each benchmark compiles and runs once", rust::bench).long(),
];
