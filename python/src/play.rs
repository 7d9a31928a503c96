//! Plays a script on a bench: the portable form of a snapshot.

use std::time::Instant as Clock;

use od_model::Refused;
use od_runtime::NodeId;
use od_sim::VirtualDevice;
use od_sim::bus::Bus;
use od_sim::script::{Bench, Host, Reason, Script, campaign, run_on};
use pyo3::exceptions::PyAssertionError;
use pyo3::prelude::*;

use crate::faults::Fault;
use crate::pass::LOOK;
use crate::snapshot::{Snapshot, is_own};
use crate::spec::{Made, free_name};
use crate::story::Story;

/// Makes the devices of a script as those of a bench.
struct Player {
    names: Vec<String>,
    /// The last check for signals such as Ctrl-C.
    looked: Clock,
    /// The exception of a signal's handler, which ends the run.
    raised: Option<PyErr>,
}

impl Host for Player {
    fn device(
        &mut self,
        name: Option<&str>,
        node_id: Option<NodeId>,
    ) -> Result<VirtualDevice, Refused> {
        let name = name.unwrap_or("gxmm");
        let made = Made::of(name).map_err(|fault| fault.text().to_owned())?;
        let device = made
            .make(node_id)
            .map_err(|fault| fault.text().to_owned())?;
        let base = name.rsplit(['/', '\\']).next().unwrap_or(name);
        self.names.push(free_name(&self.names, base, 0));
        Ok(device.delivered())
    }

    fn stops(&mut self) -> bool {
        if self.looked.elapsed() >= LOOK {
            self.looked = Clock::now();
            let handled = Python::attach(|py| py.check_signals());
            if let Err(error) = handled {
                self.raised = Some(error);
            }
        }
        self.raised.is_some()
    }
}

/// Plays a script as `odkit run` does, and returns the state at its end: `odkit.Bench(odkit.play(script))` continues
/// from there.
///
/// Raises `AssertionError` with the line if an expectation fails, `ValueError` if a line cannot be read or
/// carried out.
#[pyfunction]
pub(crate) fn play(py: Python<'_>, script: &str) -> PyResult<Snapshot> {
    played(py, script, None)
}

/// Drops lines of a script while `fails(script)`, until no line can be dropped; `None` if the whole script does not fail.
#[pyfunction]
pub(crate) fn shrink(script: &str, fails: &Bound<'_, PyAny>) -> PyResult<Option<String>> {
    let lines: Vec<&str> = script.lines().collect();
    let text = |lines: &[&str]| {
        lines
            .iter()
            .flat_map(|line| [line, "\n"])
            .collect::<String>()
    };
    let fewest = campaign::shrink(&lines, |lines| fails.call1((text(lines),))?.is_truthy())?;
    Ok(fewest.map(|lines| text(&lines)))
}

/// A pickled snapshot.
#[pyfunction]
pub(crate) fn restore_snapshot(
    py: Python<'_>,
    form: &str,
    script: &str,
    names: Vec<String>,
) -> PyResult<Snapshot> {
    is_own(form, "snapshot")?;
    played(py, script, Some(names))
}

fn played(py: Python<'_>, script: &str, names: Option<Vec<String>>) -> PyResult<Snapshot> {
    let lines = Script::parse(script).map_err(|problems| {
        let problems: Vec<_> = problems.iter().map(ToString::to_string).collect();
        Fault::value(format!(
            "the script cannot be read:\n{}",
            problems.join("\n")
        ))
    })?;
    let played = py.detach(|| {
        let mut bench = Bench::new(Bus::new());
        let mut player = Player {
            names: Vec::new(),
            looked: Clock::now(),
            raised: None,
        };
        let end = run_on(&lines, &mut bench, &mut player);
        let end = end.map(|_| (bench.bus, player.names));
        player.raised.map_or(Ok(end), Err)
    })?;
    let (bus, own) = played.map_err(|stop| {
        let is_failed = matches!(stop.reason, Reason::Failed { .. });
        let text = stop.to_string();
        if is_failed {
            PyAssertionError::new_err(text)
        } else {
            Fault::Value(text).into()
        }
    })?;
    let story = Story::of(script, bus.now());
    Ok(Snapshot::made(bus, names.unwrap_or(own), story))
}
