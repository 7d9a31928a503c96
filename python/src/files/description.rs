//! A device description: what `odkit.read` returns.

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::Arc;

use od_eds::is_xml;
use pyo3::prelude::*;
use pyo3::types::PyList;

use crate::faults::{Fault, write};
use crate::files::entry::Entry;
use crate::files::finding::Finding;
use crate::files::identity::Identity;
use crate::files::object::{Object, count};
use crate::files::read::{Found, Read};
use crate::files::source::Source;
use crate::snapshot::{FORM, Pickled, is_own};

/// A device description: objects, identity, and findings about it.
///
/// `description[0x6004]`, `description["Position value"]` are objects, `description[0x1018, 2]`,
/// `description["1018h:02"]`, `description["Identity object.Vendor-ID"]` values. `for object in
/// description` iterates over the objects by index. `odkit.read` makes one.
#[pyclass(frozen, module = "odkit")]
pub(crate) struct Description {
    pub(crate) read: Arc<Read>,
}

impl Read {
    /// # Errors
    /// It does not define any object.
    pub(crate) fn has_objects(&self) -> Result<(), Fault> {
        if self.description.objects.is_empty() {
            Err(Fault::value(format!(
                "{} does not define any object; is it an EDS, DCF or XDD file?",
                self.source.shown()
            )))
        } else {
            Ok(())
        }
    }
}

/// A description that a caller names, or that was read before.
///
/// # Errors
/// It cannot be read.
pub(crate) fn read_of(source: &Bound<'_, PyAny>) -> PyResult<Arc<Read>> {
    match source.cast::<Description>() {
        Ok(description) => Ok(Arc::clone(&description.get().read)),
        Err(_) => Ok(Arc::new(Read::checked(Source::of(source)?, None))),
    }
}

/// The text that a caller names, or that of a description that was read before.
///
/// # Errors
/// It cannot be read.
pub(crate) fn source_of(source: &Bound<'_, PyAny>) -> PyResult<Source> {
    match source.cast::<Description>() {
        Ok(description) => Ok(description.get().read.source.clone()),
        Err(_) => Source::of(source),
    }
}

/// Reads and checks an EDS, DCF, XDD or XDC.
///
/// `source` is a path, a built-in device, `base.eds+variant.overlay`, a text with line ends, the
/// `bytes` of a file in any encoding, or a description. Errors in a file are findings, not exceptions; with
/// `strict=True` errors that prevent a valid device raise `ValueError`, with their lines.
/// `node_id` (1 to 127) resolves values such as `$NODEID+0x180`; without it that of a DCF is used.
///
/// Raises `OSError` (`FileNotFoundError`) if the file cannot be read, `ValueError` if the overlay does not
/// fit its base or the node ID is not valid.
#[pyfunction]
#[pyo3(signature = (source, node_id=None, *, strict=false))]
pub(crate) fn read(
    source: &Bound<'_, PyAny>,
    node_id: Option<u8>,
    strict: bool,
) -> PyResult<Description> {
    let read = Read::checked(source_of(source)?, valid(node_id)?);
    if strict {
        let unsound: Vec<_> = read
            .findings
            .iter()
            .filter(|one| one.is_unsound())
            .collect();
        if !unsound.is_empty() {
            return Err(Fault::value(read.source.words(&unsound)).into());
        }
        read.has_objects()?;
    }
    Ok(Description {
        read: Arc::new(read),
    })
}

/// Applies an overlay to a base, and reads the result: `odkit.read("base.eds+variant.overlay")` with both as
/// paths, texts with line ends, or `bytes`; the base may be a description.
///
/// Raises `ValueError` with the line of the overlay if it removes what the base lacks, `OSError` if a file
/// cannot be read.
#[pyfunction]
#[pyo3(signature = (base, overlay, node_id=None))]
pub(crate) fn overlay(
    base: &Bound<'_, PyAny>,
    overlay: &Bound<'_, PyAny>,
    node_id: Option<u8>,
) -> PyResult<Description> {
    let source = source_of(base)?.with(Source::of(overlay)?)?;
    Ok(Description {
        read: Arc::new(Read::checked(source, valid(node_id)?)),
    })
}

/// A pickled description.
#[pyfunction]
pub(crate) fn restore_description(
    form: &str,
    text: String,
    name: Option<String>,
    node_id: Option<u8>,
) -> PyResult<Description> {
    is_own(form, "description")?;
    let source = Source::pickled(text, name);
    Ok(Description {
        read: Arc::new(Read::checked(source, valid(node_id)?)),
    })
}

fn valid(node_id: Option<u8>) -> Result<Option<u8>, Fault> {
    if node_id.is_none_or(|id| (1..=127).contains(&id)) {
        Ok(node_id)
    } else {
        Err(Fault::value("`node_id` must be 1 to 127"))
    }
}

impl Description {
    fn object(&self, index: u16) -> Object {
        Object {
            read: Arc::clone(&self.read),
            index,
        }
    }
}

#[pymethods]
impl Description {
    /// The path, or the name of the built-in device; `None` for a text.
    #[getter]
    fn path(&self) -> Option<&str> {
        self.read.source.name.as_deref()
    }

    /// The text; base and overlay are joined.
    #[getter]
    fn text(&self) -> &str {
        self.read.source.document.text()
    }

    /// The encoding of the file, such as `UTF-8` or `Windows-1252`.
    #[getter]
    fn encoding(&self) -> &'static str {
        self.read.source.document.encoding().name()
    }

    /// `xdd` for XML, `dcf` for a configured device, else `eds`.
    #[getter]
    fn kind(&self) -> &'static str {
        if is_xml(self.text()) {
            "xdd"
        } else if self.read.description.commissioning().is_some() {
            "dcf"
        } else {
            "eds"
        }
    }

    /// The node ID of `read`, or else that of a DCF; `None` if neither gives one.
    #[getter]
    fn node_id(&self) -> Option<u8> {
        self.read.node_id
    }

    /// The bit rate of a DCF in kbit/s.
    #[getter]
    fn bit_rate(&self) -> Option<u16> {
        self.read.description.commissioning()?.bit_rate
    }

    /// Vendor, product and profile.
    #[getter]
    fn identity(&self) -> Identity {
        Identity::of(&self.read)
    }

    /// All findings including remarks, in file order.
    #[getter]
    fn findings(&self) -> Vec<Finding> {
        Finding::all(&self.read.source, &self.read.findings)
    }

    /// The findings that are errors.
    #[getter]
    fn errors(&self) -> Vec<Finding> {
        let errors = self.read.findings.iter().filter(|one| one.is_error());
        errors
            .map(|one| Finding::of(&self.read.source, one))
            .collect()
    }

    /// The objects, by index.
    #[getter]
    fn objects(&self) -> Vec<Object> {
        let indices = self.read.description.objects.keys();
        indices.map(|index| self.object(*index)).collect()
    }

    /// The values of all objects, by index and sub-index.
    #[getter]
    fn entries(&self) -> Vec<Entry> {
        let entries = self.read.description.entries();
        entries
            .map(|(address, _)| Entry {
                read: Arc::clone(&self.read),
                address,
            })
            .collect()
    }

    /// The sections that describe no object, such as `DeviceInfo`: each its keys and texts.
    #[getter]
    fn sections(&self) -> BTreeMap<String, BTreeMap<String, String>> {
        let sections = self.read.description.sections.iter();
        sections
            .map(|section| {
                let pairs = section.pairs.iter().rev();
                let pairs = pairs.map(|(key, value)| (key.value.clone(), value.value.clone()));
                (section.name.value.clone(), pairs.collect())
            })
            .collect()
    }

    /// The object or value with an address or a name. Raises `KeyError` if it does not exist.
    fn __getitem__<'p>(
        &self,
        py: Python<'p>,
        key: &Bound<'p, PyAny>,
    ) -> PyResult<Bound<'p, PyAny>> {
        Ok(match self.read.find(key)? {
            Found::Object(index) => Bound::new(py, self.object(index))?.into_any(),
            Found::Entry(address) => {
                let read = Arc::clone(&self.read);
                Bound::new(py, Entry { read, address })?.into_any()
            }
        })
    }

    /// The object or value with an address or a name, or `default` if it does not exist.
    #[pyo3(signature = (key, default=None))]
    fn get<'p>(
        &self,
        py: Python<'p>,
        key: &Bound<'p, PyAny>,
        default: Option<Bound<'p, PyAny>>,
    ) -> Option<Bound<'p, PyAny>> {
        self.__getitem__(py, key).ok().or(default)
    }

    fn __contains__(&self, key: &Bound<'_, PyAny>) -> bool {
        self.read.find(key).is_ok()
    }

    fn __len__(&self) -> usize {
        self.read.description.objects.len()
    }

    fn __iter__<'p>(&self, py: Python<'p>) -> PyResult<Bound<'p, PyAny>> {
        Ok(PyList::new(py, self.objects())?.try_iter()?.into_any())
    }

    /// Writes the text in UTF-8; base and overlay are joined. Raises `OSError` if it cannot be
    /// written.
    fn save(&self, path: PathBuf) -> PyResult<()> {
        write(&path, self.text())
    }

    /// Pickles the text and its name, with the version of odkit.
    fn __reduce__<'p>(
        &self,
        py: Python<'p>,
    ) -> Pickled<'p, (&'static str, &str, Option<&str>, Option<u8>)> {
        let restore = py.import("odkit._odkit")?.getattr("restore_description")?;
        Ok((restore, (FORM, self.text(), self.path(), self.node_id())))
    }

    fn __repr__(&self) -> String {
        let read = &self.read;
        let objects = count(self.__len__(), "object");
        let errors = read.findings.iter().filter(|one| one.is_error()).count();
        let errors = count(errors, "error");
        let more = count(read.findings.len(), "finding");
        let name = read.source.shown();
        format!("<odkit.Description {name}: {objects}, {more} ({errors})>")
    }
}
