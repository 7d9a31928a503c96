//! `odkit.check`, `odkit.fix`: findings in a device description, and their fixes.

use std::path::PathBuf;

use od_eds::Document;
use od_eds::fix::{Applicability, Held, fix as fixed};
use od_eds::tools::{self, TOOLS, Tool};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyString};

use crate::faults::{Fault, write};
use crate::files::description::source_of;
use crate::files::finding::Finding;
use crate::files::object::count;

/// The tools of `for_`: a name, or a list of them; `all` is every tool.
///
/// # Errors
/// A tool is not known.
fn chosen(names: Option<&Bound<'_, PyAny>>) -> PyResult<Vec<&'static Tool>> {
    let Some(names) = names else {
        return Ok(Vec::new());
    };
    let names: Vec<String> = match names.cast::<PyString>() {
        Ok(name) => name.to_cow()?.split(',').map(str::to_owned).collect(),
        Err(_) => names.extract()?,
    };
    let mut chosen = Vec::new();
    for name in names.iter().map(|name| name.trim()) {
        if name.eq_ignore_ascii_case("all") {
            return Ok(TOOLS.to_vec());
        }
        chosen.push(tools::tool(name).ok_or_else(|| {
            let known: Vec<_> = TOOLS.iter().map(|tool| tool.name).collect();
            let known = known.join(", ");
            Fault::value(format!(
                "tool `{name}` is not known; the tools are {known}, all"
            ))
        })?);
    }
    Ok(chosen)
}

fn find(document: &Document, tools: &[&'static Tool]) -> Vec<od_eds::Finding> {
    let mut parsed = document.load();
    if !tools.is_empty() {
        let of_tools = tools::check(document, &parsed.description, tools);
        parsed.findings.extend(of_tools);
        let line = |one: &od_eds::Finding| one.span().map_or(u32::MAX, |span| span.line);
        parsed.findings.sort_by_key(line);
    }
    parsed.findings
}

/// Checks a description: a path, a built-in device, `base+overlay`, a text with line ends, or `bytes`.
///
/// Returns all findings including remarks, in file order. `for_` also checks how other tools read it:
/// `"python-canopen"`, a list of names, or `"all"`.
///
/// Raises `OSError` if the file cannot be read, `ValueError` if a tool is not known.
#[pyfunction]
#[pyo3(signature = (source, *, for_=None))]
pub(crate) fn check(
    source: &Bound<'_, PyAny>,
    for_: Option<&Bound<'_, PyAny>>,
) -> PyResult<Vec<Finding>> {
    let tools = chosen(for_)?;
    let source = source_of(source)?;
    Ok(Finding::all(&source, &find(&source.document, &tools)))
}

/// A description after its fixes.
#[pyclass(frozen, module = "odkit")]
pub(crate) struct Fixed {
    name: Option<String>,
    document: Document,
    edits: usize,
    held: Vec<String>,
    findings: Py<PyAny>,
}

#[pymethods]
impl Fixed {
    /// The text; unchanged if there was nothing to fix.
    #[getter]
    fn text(&self) -> &str {
        self.document.text()
    }

    /// The bytes of the file, in its encoding.
    #[getter]
    fn data<'p>(&self, py: Python<'p>) -> Bound<'p, PyBytes> {
        PyBytes::new(py, self.document.bytes())
    }

    /// Number of edits.
    #[getter]
    fn edits(&self) -> usize {
        self.edits
    }

    /// The remaining findings.
    #[getter]
    fn findings(&self, py: Python<'_>) -> Py<PyAny> {
        self.findings.clone_ref(py)
    }

    /// The fixes that were held back, a sentence each.
    #[getter]
    fn held(&self) -> Vec<String> {
        self.held.clone()
    }

    /// Writes the file; without a path the one that was read. Raises `OSError` if it cannot be written,
    /// `ValueError` if there is no path.
    #[pyo3(signature = (path=None))]
    fn save(&self, path: Option<PathBuf>) -> PyResult<()> {
        let path = path.or_else(|| self.name.clone().map(PathBuf::from));
        let path = path.ok_or_else(|| Fault::value("the text came from no file; name a path"))?;
        write(&path, self.document.bytes())
    }

    fn __repr__(&self) -> String {
        let places = count(self.edits, "place");
        let held = self.held.len();
        format!("<odkit.Fixed: {places} fixed, {held} held back>")
    }
}

/// Applies the fixes of a description, and returns the result; no file changes before `save()`.
///
/// Safe fixes do not change the meaning of the file; `unsafe=True` also applies unsafe fixes.
/// `for_` also fixes what these tools reject, as in `check`.
///
/// Raises `OSError` if the file cannot be read, `ValueError` for a base with an overlay (odkit cannot
/// know which of the two to change), or if a tool is not known.
#[pyfunction]
#[pyo3(signature = (source, *, r#unsafe=false, for_=None))]
pub(crate) fn fix(
    py: Python<'_>,
    source: &Bound<'_, PyAny>,
    r#unsafe: bool,
    for_: Option<&Bound<'_, PyAny>>,
) -> PyResult<Fixed> {
    let tools = chosen(for_)?;
    let source = source_of(source)?;
    if source.is_overlaid() {
        let name = source.shown();
        return Err(Fault::value(format!("{name}: fix base and overlay one by one")).into());
    }
    let level = if r#unsafe {
        Applicability::Unsafe
    } else {
        Applicability::Safe
    };
    let done = fixed(&source.document, level, |document| find(document, &tools));
    let source = source.with_document(done.document);
    let findings = Finding::all(&source, &done.findings);
    let is_file = source.kind.is_none();
    Ok(Fixed {
        findings: findings.into_pyobject(py)?.into_any().unbind(),
        edits: done.edits,
        held: done.held.iter().map(held).collect(),
        name: source.name.filter(|_| is_file),
        document: source.document,
    })
}

/// A fix that was held back, and why.
fn held(held: &Held) -> String {
    let line = match held.finding.span() {
        Some(span) => format!("line {}: ", span.line),
        None => String::new(),
    };
    let code = held.finding.code();
    format!("{line}the fix of {code} is held back: {}", held.why)
}
