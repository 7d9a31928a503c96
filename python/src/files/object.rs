//! One object of a description.

use std::sync::Arc;

use od_model::Address;
use pyo3::exceptions::PyKeyError;
use pyo3::prelude::*;
use pyo3::types::PyList;

use crate::files::entry::Entry;
use crate::files::read::Read;

/// One object: a VAR with its one value, or an ARRAY or RECORD with its sub-objects.
///
/// `object[sub]` and `object["name"]` are its values, `for entry in object` iterates over them. For a VAR,
/// `data_type`, `access`, `mappable`, `default`, `low`, `high` and `value` are those of its one value;
/// for another object they are `None`.
#[pyclass(frozen, module = "odkit")]
pub(crate) struct Object {
    pub(crate) read: Arc<Read>,
    pub(crate) index: u16,
}

impl Object {
    fn entry(&self, sub: u8) -> Entry {
        Entry {
            read: Arc::clone(&self.read),
            address: Address::new(self.index, sub),
        }
    }

    /// An attribute of the one value of a VAR.
    fn own<'p>(&self, py: Python<'p>, name: &str) -> PyResult<Option<Bound<'p, PyAny>>> {
        let object = self.read.object(self.index)?;
        if object.code.has_members() || !object.entries.contains_key(&0) {
            return Ok(None);
        }
        let entry = Bound::new(py, self.entry(0))?;
        Ok(Some(entry.getattr(name)?))
    }
}

#[pymethods]
impl Object {
    /// Index, 0001h to FFFFh.
    #[getter]
    fn index(&self) -> u16 {
        self.index
    }

    /// ParameterName.
    #[getter]
    fn name(&self) -> PyResult<&str> {
        Ok(&self.read.object(self.index)?.name.value)
    }

    /// ObjectType by its name in CiA 301: `VAR`, `ARRAY`, `RECORD`, `DOMAIN` …
    #[getter]
    fn code(&self) -> PyResult<&'static str> {
        Ok(self.read.object(self.index)?.code.name())
    }

    /// SubNumber.
    #[getter]
    fn sub_number(&self) -> PyResult<Option<u32>> {
        let object = self.read.object(self.index)?;
        Ok(object.sub_number.map(|one| one.value))
    }

    /// The line of its section, from 1; `None` if it has none (CompactPDO).
    #[getter]
    fn line(&self) -> PyResult<Option<u32>> {
        let line = self.read.object(self.index)?.span.line;
        Ok((line > 0).then_some(line))
    }

    /// The values, by sub-index.
    #[getter]
    fn entries(&self) -> PyResult<Vec<Entry>> {
        let object = self.read.object(self.index)?;
        Ok(object.entries.keys().map(|sub| self.entry(*sub)).collect())
    }

    /// The type of a VAR, such as `UNSIGNED32`; else `None`.
    #[getter]
    fn data_type<'p>(&self, py: Python<'p>) -> PyResult<Option<Bound<'p, PyAny>>> {
        self.own(py, "data_type")
    }

    /// AccessType of a VAR; else `None`.
    #[getter]
    fn access<'p>(&self, py: Python<'p>) -> PyResult<Option<Bound<'p, PyAny>>> {
        self.own(py, "access")
    }

    /// PDOMapping of a VAR; else `None`.
    #[getter]
    fn mappable<'p>(&self, py: Python<'p>) -> PyResult<Option<Bound<'p, PyAny>>> {
        self.own(py, "mappable")
    }

    /// DefaultValue of a VAR, as `Entry.default`; else `None`.
    #[getter]
    fn default<'p>(&self, py: Python<'p>) -> PyResult<Option<Bound<'p, PyAny>>> {
        self.own(py, "default")
    }

    /// LowLimit of a VAR; else `None`.
    #[getter]
    fn low<'p>(&self, py: Python<'p>) -> PyResult<Option<Bound<'p, PyAny>>> {
        self.own(py, "low")
    }

    /// HighLimit of a VAR; else `None`.
    #[getter]
    fn high<'p>(&self, py: Python<'p>) -> PyResult<Option<Bound<'p, PyAny>>> {
        self.own(py, "high")
    }

    /// ParameterValue of a VAR in a DCF; else `None`.
    #[getter]
    fn value<'p>(&self, py: Python<'p>) -> PyResult<Option<Bound<'p, PyAny>>> {
        self.own(py, "value")
    }

    /// The value with a sub-index or a name. Raises `KeyError` if it does not exist.
    fn __getitem__(&self, key: &Bound<'_, PyAny>) -> PyResult<Entry> {
        let object = self.read.object(self.index)?;
        let sub = match key.extract::<u8>() {
            Ok(sub) => object.entries.contains_key(&sub).then_some(sub),
            Err(_) => {
                let name: String = key.extract()?;
                let mut entries = object.entries.iter();
                let found = entries.find(|(_, one)| one.name.eq_ignore_ascii_case(&name));
                found.map(|(sub, _)| *sub)
            }
        };
        let sub = sub.ok_or_else(|| {
            let index = self.index;
            let subs = object.entries.keys().map(u8::to_string);
            let subs = subs.collect::<Vec<_>>().join(", ");
            PyKeyError::new_err(format!(
                "object {index:04X}h has no value {key}; its sub-indices are {subs}"
            ))
        })?;
        Ok(self.entry(sub))
    }

    fn __contains__(&self, key: &Bound<'_, PyAny>) -> bool {
        self.__getitem__(key).is_ok()
    }

    fn __len__(&self) -> PyResult<usize> {
        Ok(self.read.object(self.index)?.entries.len())
    }

    fn __iter__<'p>(&self, py: Python<'p>) -> PyResult<Bound<'p, PyAny>> {
        Ok(PyList::new(py, self.entries()?)?.try_iter()?.into_any())
    }

    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        let (index, name, code) = (self.index, self.name()?, self.code()?);
        let head = format!("<odkit.Object {index:04X}h {name:?}: {code}");
        let (Some(data_type), Some(access)) = (self.data_type(py)?, self.access(py)?) else {
            return Ok(format!("{head} of {}>", count(self.__len__()?, "value")));
        };
        let default = match self.default(py)? {
            Some(default) => format!(", default {}", default.repr()?),
            None => String::new(),
        };
        Ok(format!("{head} {data_type} {access}{default}>"))
    }
}

/// `1 value`, `2 values`.
pub(crate) fn count(number: usize, noun: &str) -> String {
    match number {
        1 => format!("1 {noun}"),
        _ => format!("{number} {noun}s"),
    }
}
