//! The stages, in the order they run: what is quick and fails often comes first.

mod page;
mod rust;

use super::Context;
use crate::error::Result;

/// One check with a name.
#[derive(Debug)]
pub(super) struct Stage {
    /// What `--only` takes.
    pub(super) name: &'static str,
    /// One line for `--list`.
    pub(super) about: &'static str,
    /// Part of `--quick`?
    pub(super) quick: bool,
    /// Does it consist of tests, so that none at all is a mistake?
    pub(super) counts: bool,
    /// Runs it; the log says how many tests there were.
    pub(super) run: fn(&Context<'_>) -> Result<()>,
}

/// Every stage there is.
pub(super) const STAGES: &[Stage] = &[
    Stage {
        name: "fmt",
        about: "rustfmt has nothing to change",
        quick: true,
        counts: false,
        run: rust::fmt,
    },
    Stage {
        name: "clippy",
        about: "no warning, with every feature on",
        quick: true,
        counts: false,
        run: rust::clippy,
    },
    Stage {
        name: "unit",
        about: "tests inside the crates",
        quick: true,
        counts: true,
        run: rust::unit,
    },
    Stage {
        name: "conformance",
        about: "frame scripts per CANopen service",
        quick: true,
        counts: true,
        run: |c| rust::outside(c, "conformance"),
    },
    Stage {
        name: "ui",
        about: "what must not compile, and what the compiler says",
        quick: true,
        counts: true,
        run: |c| rust::outside(c, "ui"),
    },
    Stage {
        name: "tests",
        about: "all other tests from outside",
        quick: false,
        counts: true,
        run: rust::other_outside,
    },
    Stage {
        name: "fuzz",
        about: "mutated input: SDO frames, node, EEPROM, EDS, scripts, adapters",
        quick: false,
        counts: true,
        run: rust::fuzz,
    },
    Stage {
        name: "doc",
        about: "the examples in the documentation",
        quick: false,
        counts: false,
        run: rust::doc,
    },
    Stage {
        name: "rustdoc",
        about: "the documentation builds without a warning",
        quick: false,
        counts: false,
        run: rust::rustdoc,
    },
    Stage {
        name: "no_std",
        about: "model, runtime and devices build for a bare Cortex-M3",
        quick: false,
        counts: false,
        run: rust::no_std,
    },
    Stage {
        name: "wasm",
        about: "the WebAssembly module and its tests under Node.js",
        quick: false,
        counts: false,
        run: page::wasm,
    },
    Stage {
        name: "page",
        about: "types, tests and size of the TypeScript page",
        quick: false,
        counts: false,
        run: page::page,
    },
    Stage {
        name: "wasm-pack",
        about: "wasm-pack makes the npm package",
        quick: false,
        counts: false,
        run: page::wasm_pack,
    },
    Stage {
        name: "browser",
        about: "the page in Chromium",
        quick: false,
        counts: true,
        run: page::browser,
    },
    Stage {
        name: "interop",
        about: "python-canopen as master of the simulated devices",
        quick: false,
        counts: true,
        run: page::interop,
    },
    Stage {
        name: "bench-build",
        about: "the benchmarks compile",
        quick: false,
        counts: false,
        run: rust::bench_build,
    },
];
