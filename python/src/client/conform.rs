//! The conformance test, case by case.

use od_sim::words::Decoder;
use od_tools::conform::case::{Case, built_in};
use od_tools::conform::eds::Eds;
use od_tools::conform::session::{Permissions, Session};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::client::arguments::id_of;
use crate::client::calls::Client;
use crate::files::description::read_of;

/// The cases of the conformance test: id, group, clause, and requirement. `only` selects cases or groups,
/// with `*` and `?`.
///
/// Raises `ValueError` if no case matches a name of `only`.
#[pyfunction]
#[pyo3(signature = (only=None))]
pub(crate) fn conform_cases(
    only: Option<Vec<String>>,
) -> PyResult<Vec<(&'static str, &'static str, &'static str, &'static str)>> {
    let only = only.unwrap_or_default();
    let wanted = |case: &&Case| only.is_empty() || only.iter().any(|name| case.is_named_by(name));
    let parts = |case: &'static Case| {
        (
            case.id.as_str(),
            case.group.as_str(),
            case.clause.as_str(),
            case.title.as_str(),
        )
    };
    let found: Vec<_> = built_in().iter().filter(wanted).map(parts).collect();
    if found.is_empty() {
        Err(PyValueError::new_err(format!(
            "no case has this name: {}; `odkit conform --list` lists all cases",
            only.join(", ")
        )))
    } else {
        Ok(found)
    }
}

/// The result of a case of the conformance test.
#[pyclass(frozen, get_all, module = "odkit")]
pub(crate) struct Record {
    /// The case, such as `sdo-upload-expedited`.
    id: String,
    /// `SDO`, `NMT` …
    group: String,
    /// Standard and clause.
    clause: String,
    /// The required behaviour, in words.
    title: String,
    /// `pass`, `fail`, `skipped`, or `n/a`: the node lacks the object or service of the case.
    verdict: &'static str,
    /// The expected and the actual behaviour, or the reason for skipping it; empty if it passed.
    reason: String,
    /// Values that were changed and restored, and those that could not be restored.
    notes: Vec<String>,
    /// The frames, one text per line: time, direction, frame, and its meaning in words.
    frames: Vec<String>,
    /// Its duration, in seconds of the link's clock.
    seconds: f64,
}

#[pymethods]
impl Record {
    fn __repr__(&self) -> String {
        let (id, verdict) = (&self.id, self.verdict);
        let reason = match self.reason.as_str() {
            "" => String::new(),
            reason => format!(": {reason}"),
        };
        format!("<odkit.Record {id} {verdict}{reason}>")
    }
}

/// The open conformance test of a node: each case is about one clause of CiA 301, 305 or 306, or of the
/// profile.
///
/// `client` is on the bus of the node, `eds` describes it (as for `odkit.read`). `allow_reset` and
/// `allow_store` allow cases that reset the node, and save and restore its values, `allow_motion` cases that move the
/// axes of a drive and set the outputs of a module; changed values are restored. On a bench the power is switched, too.
#[pyclass(frozen, module = "odkit")]
pub(crate) struct Conform {
    client: Py<Client>,
    node: od_wire::NodeId,
    eds: Eds,
    permissions: Permissions,
    /// Reason why the test cannot continue, and number of cases in a row without a response.
    past: std::sync::Mutex<(Option<String>, u8)>,
}

#[pymethods]
impl Conform {
    #[new]
    #[pyo3(signature = (client, node_id, eds, *, allow_reset=false, allow_store=false, allow_motion=false))]
    fn new(
        client: Py<Client>,
        node_id: u8,
        eds: &Bound<'_, PyAny>,
        allow_reset: bool,
        allow_store: bool,
        allow_motion: bool,
    ) -> PyResult<Self> {
        let read = read_of(eds)?;
        read.has_objects()?;
        Ok(Self {
            client,
            node: id_of(node_id)?,
            eds: Eds::read(read.source.document.text()),
            permissions: Permissions {
                reset: allow_reset,
                store: allow_store,
                motion: allow_motion,
            },
            past: std::sync::Mutex::default(),
        })
    }

    /// Runs a case, and returns its result. After the node or the link was lost every case is skipped.
    ///
    /// Raises `ValueError` if the case does not exist.
    fn run(&self, py: Python<'_>, id: &str) -> PyResult<Record> {
        let case = built_in().iter().find(|case| case.id == id);
        let case = case.ok_or_else(|| {
            PyValueError::new_err(format!(
                "case `{id}` does not exist; `odkit.conform_cases()` lists all cases"
            ))
        })?;
        let past = || {
            self.past
                .lock()
                .unwrap_or_else(std::sync::PoisonError::into_inner)
        };
        let (lost, silences) = past().clone();
        if let Some(why) = lost {
            return Ok(Record {
                id: case.id.clone(),
                group: case.group.clone(),
                clause: case.clause.clone(),
                title: case.title.clone(),
                verdict: "skipped",
                reason: why,
                notes: Vec::new(),
                frames: Vec::new(),
                seconds: 0.0,
            });
        }
        let (record, now) = self.client.bind(py).get().with(py, |core| {
            core.catch_up()?;
            let mut session = Session::new(&mut core.line, &self.eds, self.node, self.permissions);
            session.resume_after(silences);
            let record = session.run(case);
            Ok((
                record,
                (session.lost().map(str::to_owned), session.silences()),
            ))
        })?;
        *past() = now;
        let mut decoder = Decoder::default();
        let frames = record.frames.iter().map(|one| {
            let direction = if one.ours { "->" } else { "<-" };
            let words = decoder.explain(&[], &one.frame);
            format!(
                "{:?} {direction} {:<21}  {words}",
                one.at,
                one.frame.to_string()
            )
        });
        Ok(Record {
            frames: frames.collect(),
            verdict: record.verdict.word(),
            reason: record.verdict.reason(),
            id: record.id,
            group: record.group,
            clause: record.clause,
            title: record.title,
            notes: record.notes,
            seconds: record.micros as f64 / 1e6,
        })
    }

    fn __repr__(&self) -> String {
        format!("<odkit.Conform of node {}>", self.node)
    }
}
