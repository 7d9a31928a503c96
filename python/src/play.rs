//! Plays a script on a bench: the portable form of a snapshot.

use od_model::Refused;
use od_runtime::NodeId;
use od_sim::VirtualDevice;
use od_sim::bus::Bus;
use od_sim::script::{Bench, Host, Reason, Script, run_on};
use pyo3::exceptions::PyAssertionError;
use pyo3::prelude::*;

use crate::faults::Fault;
use crate::snapshot::{Snapshot, is_own};
use crate::spec::{Made, free_name};
use crate::story::Story;

/// Makes the devices of a script as those of a bench.
#[derive(Default)]
struct Player {
    names: Vec<String>,
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
}

/// Plays a script as `odkit run` does, and returns the state at its end: `odkit.Bench(odkit.play(script))` goes on
/// from there.
///
/// Raises `AssertionError` with the line if an expectation fails, `ValueError` if a line cannot be read or
/// carried out.
#[pyfunction]
pub(crate) fn play(py: Python<'_>, script: &str) -> PyResult<Snapshot> {
    played(py, script, None)
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
        let (mut bench, mut player) = (Bench::new(Bus::new()), Player::default());
        let end = run_on(&lines, &mut bench, &mut player);
        end.map(|_| (bench.bus, player.names))
    });
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
