//! Converts a description to another format.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use od_devices::text::datasheet;
use od_eds::convert::{c_header, canopennode, dbc, dcf, json, lost, markdown};
use od_eds::{Description, Finding, Severity, Tables, check, xdd};
use pyo3::IntoPyObjectExt;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::faults::{Fault, write};
use crate::files::description::read_of;

const FORMS: [&str; 8] = ["eds", "dcf", "xdd", "md", "c", "canopennode", "dbc", "json"];

/// The format with this name, or for this file extension.
fn form(name: Option<&str>, output: Option<&Path>) -> Result<&'static str, Fault> {
    let extension = output.and_then(|path| path.extension()?.to_str());
    let given = name.or(extension).unwrap_or_default().to_ascii_lowercase();
    let meant = match given.as_str() {
        "xdc" => "xdd",
        "h" => "c",
        // An OD.c is selected by its name.
        "c" if name.is_none() => "",
        other => other,
    };
    let found = FORMS.iter().find(|form| **form == meant);
    found.copied().ok_or_else(|| {
        Fault::value(format!(
            "format `{given}` is not known; write {}",
            FORMS.join(", ")
        ))
    })
}

/// Converts a description to another format, and returns its text; `output` also writes it to a file, whose
/// extension selects the format if `to` does not.
///
/// `source` is a path, a built-in device, a text, or the result of `read`. `to` is `eds`, `dcf`, `xdd`,
/// `md` (datasheet), `c` (header), `canopennode`, `dbc` or `json`. For `canopennode` the result is a
/// dictionary of two texts by file name; `output` names the first (`OD.c`). `node_id` (1 to 127),
/// `bit_rate` (kbit/s) and `values` (`{0x6001: 4096, "1018sub4": 7}`) configure the device of a DCF;
/// DBC and CANopenNode use `node_id`, too. `lossy` accepts that the target lacks
/// content of the source.
///
/// Raises `ValueError` if the format is not known, the source does not define any object, an argument is
/// not valid, or the target lacks objects of the source (each with its line); `OSError` if a file cannot be
/// read or written.
#[pyfunction]
#[pyo3(signature = (source, to=None, output=None, *, node_id=None, bit_rate=None, values=None, lossy=false))]
#[allow(clippy::too_many_arguments)] // They are keywords in Python.
pub(crate) fn convert<'p>(
    py: Python<'p>,
    source: &Bound<'p, PyAny>,
    to: Option<&str>,
    output: Option<PathBuf>,
    node_id: Option<u8>,
    bit_rate: Option<u16>,
    values: Option<&Bound<'p, PyDict>>,
    lossy: bool,
) -> PyResult<Bound<'p, PyAny>> {
    let form = form(to, output.as_deref())?;
    let wrong = |why: &str| PyErr::from(Fault::value(why));
    if form != "dcf" && (bit_rate.is_some() || values.is_some()) {
        return Err(wrong("`bit_rate` and `values` are for `dcf`"));
    }
    if node_id.is_some_and(|id| !(1..=127).contains(&id)) {
        return Err(wrong("`node_id` must be 1 to 127"));
    }
    let read = read_of(source)?;
    read.has_objects()?;
    let source = &read.source;
    let mut description = read.description.clone();
    let mut missing = lost::unread(&read.findings);
    if matches!(form, "md" | "canopennode") {
        let checked = check::check(&description);
        let all: Vec<_> = read.findings.iter().chain(&checked).cloned().collect();
        let untyped = lost::untyped(&description, &all);
        missing.extend(untyped);
    }
    if form == "dcf" {
        configure(&mut description, node_id.or(read.node_id), bit_rate, values)?;
    }
    let node_id = node_id.or(read.node_id);
    let name = source.shown();
    let mut files = BTreeMap::new();
    let mut unexpressed = |findings: Vec<Finding>| {
        let lost = findings
            .into_iter()
            .filter(|one| one.severity > Severity::Info);
        missing.extend(lost);
    };
    let stem = |path: &Path, or: &str| {
        let stem = path.file_stem().and_then(|stem| stem.to_str());
        stem.unwrap_or(or).to_owned()
    };
    let text = match form {
        "eds" | "dcf" => od_eds::canonical(&description),
        "xdd" => xdd::write(&description),
        "md" => match source.kind {
            Some(kind) => datasheet::page(kind),
            None => markdown::page(name, Tables::new(&description).dictionary()),
        },
        "c" => c_header::write(&description, &stem(Path::new(name), "device"), name),
        "dbc" => {
            let (text, findings) = dbc::write(&description, node_id.unwrap_or(1));
            unexpressed(findings);
            text
        }
        "canopennode" => {
            let stem = stem(output.as_deref().unwrap_or(Path::new("OD.c")), "OD");
            let made = canopennode::write(&description, &stem, name, node_id);
            unexpressed(made.findings);
            files.insert(format!("{stem}.c"), made.source);
            files.insert(format!("{stem}.h"), made.header);
            String::new()
        }
        _ => json::write(&description, name),
    };
    if !missing.is_empty() && !lossy {
        let lost: Vec<&Finding> = missing.iter().collect();
        return Err(Fault::value(format!(
            "the target cannot express all of the source: {}; correct it, or add `lossy=True`",
            source.words(&lost)
        ))
        .into());
    }
    if files.is_empty() {
        if let Some(output) = output {
            write(&output, &text)?;
        }
        return text.into_bound_py_any(py);
    }
    if let Some(output) = output {
        for (name, text) in &files {
            write(&output.with_file_name(name), text)?;
        }
    }
    files.into_bound_py_any(py)
}

/// Node ID, bit rate and values of the device. A value of the file stays if none is given.
fn configure(
    description: &mut Description,
    node_id: Option<u8>,
    bit_rate: Option<u16>,
    values: Option<&Bound<'_, PyDict>>,
) -> PyResult<()> {
    let id = node_id.ok_or_else(|| Fault::value("a DCF needs a node ID; add `node_id=5`"))?;
    description.commission("NodeID", &id.to_string());
    if let Some(rate) = bit_rate {
        description.commission("Baudrate", &rate.to_string());
    }
    for (object, value) in values.into_iter().flat_map(|values| values.iter()) {
        let object = match object.extract::<u16>() {
            Ok(index) => format!("{index:04X}h"),
            Err(_) => match object.extract::<(u16, u8)>() {
                Ok((index, sub)) => format!("{index:04X}sub{sub:X}"),
                Err(_) => object.extract()?,
            },
        };
        let text: String = match value.extract::<bool>() {
            Ok(flag) => flag.to_string(),
            Err(_) => value.str()?.extract()?,
        };
        dcf::set(description, &object, &text).map_err(Fault::from)?;
    }
    Ok(())
}
