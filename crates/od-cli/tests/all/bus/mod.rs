//! Commands on a bus, as processes, against `odkit sim`.

mod conform;
mod everyday;
mod links;
mod setup;
mod time;
mod wrong;

use crate::support::odkit;

/// A run that must succeed: its standard output.
#[track_caller]
fn done(args: &[&str]) -> String {
    let done = odkit(args, "");
    assert_eq!(done.code, 0, "{args:?}: {}{}", done.out, done.err);
    done.out
}

/// A run that must fail: its standard error.
#[track_caller]
fn fails(code: i32, args: &[&str]) -> String {
    let done = odkit(args, "");
    assert_eq!(done.code, code, "{args:?}: {}{}", done.out, done.err);
    done.err
}

/// The slcan port of a simulation.
fn link(sim: &crate::support::quiet::Sim) -> String {
    let address = sim.ready["links"][0]["address"].as_str().expect("a port");
    format!("slcan:{address}")
}
