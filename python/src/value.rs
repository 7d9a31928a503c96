//! Converts frames and values to and from Python.

use od_model::{DataType, Kind, values};
use od_sim::journal::frame;
use od_wire::Frame;
use pyo3::IntoPyObjectExt;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyString};

use crate::faults::Fault;

/// Parts of a frame: CAN-ID, extended, remote, number of bytes of a remote frame, data.
#[derive(FromPyObject)]
pub(crate) struct Parts(u32, bool, bool, usize, Vec<u8>);

impl Parts {
    /// The frame.
    ///
    /// # Errors
    /// The CAN-ID or the length is too large.
    pub(crate) fn frame(self) -> Result<Frame, Fault> {
        let Self(id, extended, remote, length, mut data) = self;
        let most = if extended { 0x1FFF_FFFF } else { 0x7FF };
        if id > most {
            let bits = if extended { 29 } else { 11 };
            return Err(Fault::value(format!(
                "CAN-ID {id:X}h has more than {bits} bits"
            )));
        }
        if remote {
            data = vec![0; length];
        }
        let bytes = data.len();
        let made = frame(id, &data, extended, remote);
        made.ok_or_else(|| Fault::value(format!("a CAN frame has at most 8 bytes, not {bytes}")))
    }
}

/// The value of these bytes in Python: `bool`, `int`, `float`, `str` or `bytes`.
pub(crate) fn to_python<'p>(
    py: Python<'p>,
    data_type: DataType,
    bytes: &[u8],
) -> PyResult<Bound<'p, PyAny>> {
    if data_type.size().is_some_and(|size| size != bytes.len()) {
        return PyBytes::new(py, bytes).into_bound_py_any(py);
    }
    let number = || {
        bytes
            .iter()
            .rev()
            .fold(0_u64, |value, byte| value << 8 | u64::from(*byte))
    };
    match data_type.kind() {
        Kind::Boolean => (bytes != [0]).into_bound_py_any(py),
        Kind::Unsigned => number().into_bound_py_any(py),
        Kind::Signed => {
            let unused = 64 - 8 * bytes.len().clamp(1, 8) as u32;
            ((number() << unused) as i64 >> unused).into_bound_py_any(py)
        }
        Kind::Real => match *bytes {
            [a, b, c, d] => f32::from_le_bytes([a, b, c, d]).into_bound_py_any(py),
            _ => f64::from_bits(number()).into_bound_py_any(py),
        },
        Kind::Text => {
            let text = String::from_utf8_lossy(bytes);
            text.trim_end_matches('\0').into_bound_py_any(py)
        }
        Kind::Bytes | Kind::Record => PyBytes::new(py, bytes).into_bound_py_any(py),
    }
}

/// The bytes of a Python value.
///
/// # Errors
/// A sentence, if the value is not valid for the type.
pub(crate) fn from_python(data_type: DataType, value: &Bound<'_, PyAny>) -> PyResult<Vec<u8>> {
    if let Ok(bytes) = value.cast::<PyBytes>() {
        return Ok(bytes.as_bytes().to_vec());
    }
    let is_text = value.is_instance_of::<PyString>();
    let text: String = value.str()?.extract()?;
    if is_text && matches!(data_type.kind(), Kind::Text) {
        return Ok(text.into_bytes());
    }
    // `True` counts as `true`.
    let text = match data_type.kind() {
        Kind::Boolean => text.to_ascii_lowercase(),
        _ => text,
    };
    Ok(values::parse(data_type, &text).map_err(Fault::from)?)
}
