//! Values of a description as Python objects.

use od_eds::{EntryDescription, Spanned, Value};
use od_model::DataType;
use pyo3::IntoPyObjectExt;
use pyo3::prelude::*;
use pyo3::types::PyBytes;

/// A value that depends on an unknown node ID, such as `$NODEID+0x180`.
#[pyclass(frozen, eq, hash, module = "odkit")]
#[derive(Clone, PartialEq, Eq, Hash)]
pub(crate) struct Relative {
    /// The number that is added to the node ID.
    #[pyo3(get)]
    offset: u32,
}

#[pymethods]
impl Relative {
    /// Returns the number for a node ID, 1 to 127.
    fn at(&self, node_id: u8) -> u64 {
        u64::from(self.offset) + u64::from(node_id)
    }

    fn __repr__(&self) -> String {
        match self.offset {
            0 => String::from("$NODEID"),
            offset => format!("$NODEID+0x{offset:X}"),
        }
    }
}

/// The value, for a node with this ID if it is known.
pub(crate) fn to_python<'p>(
    py: Python<'p>,
    data_type: Option<DataType>,
    value: &Value,
    node_id: Option<u8>,
) -> PyResult<Bound<'p, PyAny>> {
    match value {
        Value::Unsigned(number) if data_type == Some(DataType::Boolean) => {
            (*number != 0).into_bound_py_any(py)
        }
        Value::Unsigned(number) => number.into_bound_py_any(py),
        Value::Signed(number) => number.into_bound_py_any(py),
        Value::Real(number) => number.into_bound_py_any(py),
        Value::NodeId(offset) => match node_id {
            Some(id) => (u64::from(*offset) + u64::from(id)).into_bound_py_any(py),
            None => Relative { offset: *offset }.into_bound_py_any(py),
        },
        Value::Text(text) => text.into_bound_py_any(py),
        Value::Bytes(bytes) if data_type == Some(DataType::UnicodeString) => {
            utf16(bytes).into_bound_py_any(py)
        }
        Value::Bytes(bytes) => PyBytes::new(py, bytes).into_bound_py_any(py),
    }
}

pub(crate) fn optional<'p>(
    py: Python<'p>,
    entry: &EntryDescription,
    value: Option<&Spanned<Value>>,
    node_id: Option<u8>,
) -> PyResult<Option<Bound<'p, PyAny>>> {
    let data_type = entry.data_type.map(|one| one.value);
    value
        .map(|value| to_python(py, data_type, &value.value, node_id))
        .transpose()
}

/// UTF-16, low byte first, like a UNICODE_STRING.
pub(crate) fn utf16(bytes: &[u8]) -> String {
    let units = bytes
        .chunks_exact(2)
        .map(|two| u16::from_le_bytes([two[0], two[1]]));
    let text = char::decode_utf16(units).map(|c| c.unwrap_or(char::REPLACEMENT_CHARACTER));
    text.collect()
}
