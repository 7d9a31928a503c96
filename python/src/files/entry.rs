//! One value of an object.

use std::collections::HashMap;
use std::sync::Arc;

use od_model::Address;
use pyo3::prelude::*;

use crate::files::read::Read;
use crate::files::value::optional;

/// One value of an object: the content of a section with a DataType.
#[pyclass(frozen, module = "odkit")]
pub(crate) struct Entry {
    pub(crate) read: Arc<Read>,
    pub(crate) address: Address,
}

#[pymethods]
impl Entry {
    /// Index, 0001h to FFFFh.
    #[getter]
    fn index(&self) -> u16 {
        self.address.index
    }

    /// Sub-index; 0 of a VAR.
    #[getter]
    fn sub(&self) -> u8 {
        self.address.sub
    }

    /// ParameterName.
    #[getter]
    fn name(&self) -> PyResult<&str> {
        Ok(&self.read.entry(self.address)?.name.value)
    }

    /// The type by its name in CiA 301, such as `UNSIGNED32`; `None` if it is missing or unknown.
    #[getter]
    fn data_type(&self) -> PyResult<Option<&'static str>> {
        let entry = self.read.entry(self.address)?;
        Ok(entry.data_type.map(|one| one.value.name()))
    }

    /// The type by its code in CiA 301, such as 7 for UNSIGNED32.
    #[getter]
    fn type_code(&self) -> PyResult<Option<u16>> {
        let entry = self.read.entry(self.address)?;
        Ok(entry.data_type.map(|one| one.value.code()))
    }

    /// Length in bits; `None` for texts, bytes and DOMAIN.
    #[getter]
    fn bits(&self) -> PyResult<Option<u8>> {
        let entry = self.read.entry(self.address)?;
        Ok(entry.data_type.and_then(|one| one.value.bits()))
    }

    /// AccessType, seen from the bus: `ro`, `wo`, `rw`, `rwr`, `rww` or `const`.
    #[getter]
    fn access(&self) -> PyResult<&'static str> {
        Ok(self.read.entry(self.address)?.access.name())
    }

    /// Whether a master may read it.
    #[getter]
    fn readable(&self) -> PyResult<bool> {
        Ok(self.read.entry(self.address)?.access.readable())
    }

    /// Whether a master may write it.
    #[getter]
    fn writable(&self) -> PyResult<bool> {
        Ok(self.read.entry(self.address)?.access.writable())
    }

    /// PDOMapping.
    #[getter]
    fn mappable(&self) -> PyResult<bool> {
        Ok(self.read.entry(self.address)?.mappable.value)
    }

    /// DefaultValue: `bool`, `int`, `float`, `str` or `bytes`; `odkit.Relative` if it depends on an
    /// unknown node ID; `None` if it is missing or not valid for the type.
    #[getter]
    fn default<'p>(&self, py: Python<'p>) -> PyResult<Option<Bound<'p, PyAny>>> {
        let entry = self.read.entry(self.address)?;
        optional(py, entry, entry.default.as_ref(), self.read.node_id)
    }

    /// LowLimit, like `default`.
    #[getter]
    fn low<'p>(&self, py: Python<'p>) -> PyResult<Option<Bound<'p, PyAny>>> {
        let entry = self.read.entry(self.address)?;
        optional(py, entry, entry.low.as_ref(), self.read.node_id)
    }

    /// HighLimit, like `default`.
    #[getter]
    fn high<'p>(&self, py: Python<'p>) -> PyResult<Option<Bound<'p, PyAny>>> {
        let entry = self.read.entry(self.address)?;
        optional(py, entry, entry.high.as_ref(), self.read.node_id)
    }

    /// ParameterValue of a DCF, like `default`.
    #[getter]
    fn value<'p>(&self, py: Python<'p>) -> PyResult<Option<Bound<'p, PyAny>>> {
        let entry = self.read.entry(self.address)?;
        optional(py, entry, entry.parameter.as_ref(), self.read.node_id)
    }

    /// Whether the default depends on the node ID (`$NODEID`).
    #[getter]
    fn relative(&self) -> PyResult<bool> {
        let default = self.read.entry(self.address)?.default.as_ref();
        Ok(default.is_some_and(|one| matches!(one.value, od_eds::Value::NodeId(_))))
    }

    /// The group in which the device saves it: `communication`, `application`, `manufacturer`, or `None`.
    #[getter]
    fn storage(&self) -> PyResult<Option<&'static str>> {
        let entry = self.read.entry(self.address)?;
        Ok(entry.group_at(self.address).name())
    }

    /// Keys of the file that CiA 306 does not have, such as `Unit`, and their texts.
    #[getter]
    fn extra(&self) -> PyResult<HashMap<String, String>> {
        let entry = self.read.entry(self.address)?;
        Ok(entry.extra.iter().cloned().collect())
    }

    /// The line of its section, from 1; `None` if it has none (CompactSubObj).
    #[getter]
    fn line(&self) -> PyResult<Option<u32>> {
        let line = self.read.entry(self.address)?.span.line;
        Ok((line > 0).then_some(line))
    }

    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        let entry = self.read.entry(self.address)?;
        let data_type = self.data_type()?.unwrap_or("without a type");
        let mut words = format!(
            "<odkit.Entry {} {:?}: {data_type} {}",
            self.address, entry.name.value, entry.access.value
        );
        for (what, value) in [
            ("default", self.default(py)?),
            ("value", self.value(py)?),
            ("from", self.low(py)?),
            ("to", self.high(py)?),
        ] {
            if let Some(value) = value {
                words.push_str(&format!(", {what} {}", value.repr()?));
            }
        }
        Ok(words + ">")
    }
}
