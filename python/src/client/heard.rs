//! Messages of the nodes of a bus: PDOs, EMCY messages, and the nodes that a scan found.

use od_client::emcy;
use od_tools::scan;
use pyo3::exceptions::PyKeyError;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};

use crate::client::core::Came;
use crate::client::known::{Known, fields};
use crate::value::to_python;

/// A TPDO of a node, with its values.
///
/// `pdo["Position value"]`, `pdo[0x6004]` and `pdo[0x6020, 1]` are values.
#[pyclass(frozen, get_all, module = "odkit")]
pub(crate) struct Pdo {
    /// Node ID, 1 to 127.
    node_id: u8,
    /// Number of the TPDO, from 1.
    number: u16,
    /// CAN-ID of the frame.
    can_id: u32,
    /// Time of reception, in seconds of the link's clock.
    time: f64,
    /// The data.
    data: Py<PyBytes>,
    /// The values by the names of their objects; without a description by `6004h:00`.
    values: Py<PyDict>,
    /// The values by index and sub-index.
    by_address: Py<PyDict>,
}

impl Pdo {
    pub(crate) fn of(py: Python<'_>, came: &Came, known: Option<&Known>) -> PyResult<Self> {
        let (values, by_address) = (PyDict::new(py), PyDict::new(py));
        for field in fields(known, &came.tpdo, &came.data) {
            let whole = |one: &od_model::DataType| one.bits() == Some(field.bits);
            let value = match field.data_type.filter(whole) {
                Some(data_type) => to_python(py, data_type, &field.bytes)?,
                None => number(&field.bytes).into_pyobject(py)?.into_any(),
            };
            values.set_item(&field.name, &value)?;
            let address = (field.address.index, field.address.sub);
            by_address.set_item(address, value)?;
        }
        Ok(Self {
            node_id: came.tpdo.node,
            number: came.tpdo.number,
            can_id: came.tpdo.id.raw(),
            time: came.at.as_micros() as f64 / 1e6,
            data: PyBytes::new(py, &came.data).unbind(),
            values: values.unbind(),
            by_address: by_address.unbind(),
        })
    }
}

fn number(bytes: &[u8]) -> u64 {
    let bytes = bytes.iter().rev();
    bytes.fold(0, |number, byte| number << 8 | u64::from(*byte))
}

#[pymethods]
impl Pdo {
    /// The value with a name or an address. Raises `KeyError` if it is not mapped.
    fn __getitem__<'p>(
        &self,
        py: Python<'p>,
        key: &Bound<'p, PyAny>,
    ) -> PyResult<Bound<'p, PyAny>> {
        let found = match key.extract::<u16>() {
            Ok(index) => self.by_address.bind(py).get_item((index, 0_u8))?,
            Err(_) => match self.values.bind(py).get_item(key)? {
                Some(value) => Some(value),
                None => self.by_address.bind(py).get_item(key)?,
            },
        };
        let names = self.values.bind(py).keys();
        found
            .ok_or_else(|| PyKeyError::new_err(format!("{key} is not mapped; the PDO has {names}")))
    }

    fn __repr__(&self, py: Python<'_>) -> String {
        let (node, number, values) = (self.node_id, self.number, self.values.bind(py));
        format!("<odkit.Pdo TPDO{number} of node {node}: {values}>")
    }
}

/// An EMCY message of a node.
#[pyclass(frozen, get_all, module = "odkit")]
pub(crate) struct Emcy {
    /// Node ID, 1 to 127.
    node_id: u8,
    /// Error code, such as 0x8130; 0: the error has ended.
    code: u16,
    /// The bits of 1001h.
    register: u8,
    /// The five manufacturer-specific bytes.
    info: Py<PyBytes>,
    /// Time of reception, in seconds of the link's clock.
    time: f64,
}

impl Emcy {
    pub(crate) fn of(py: Python<'_>, node_id: u8, time: f64, emcy: &emcy::Emcy) -> Self {
        Self {
            node_id,
            code: emcy.code,
            register: emcy.register,
            info: PyBytes::new(py, &emcy.info).unbind(),
            time,
        }
    }
}

#[pymethods]
impl Emcy {
    fn __repr__(&self) -> String {
        let (node, code, register) = (self.node_id, self.code, self.register);
        format!("<odkit.Emcy {code:04X}h of node {node}, error register {register:02X}h>")
    }
}

/// A node found by a scan.
#[pyclass(frozen, get_all, module = "odkit")]
pub(crate) struct Found {
    /// Node ID, 1 to 127.
    node_id: u8,
    /// State in its last heartbeat; `None`: it sent none while odkit listened.
    state: Option<&'static str>,
    /// Whether it responds to SDO requests; in Stopped it does not.
    answers: bool,
    /// 1000h.
    device_type: Option<u32>,
    /// 1018h: vendor-ID, product code, revision number, serial number.
    identity: (Option<u32>, Option<u32>, Option<u32>, Option<u32>),
    /// 1008h.
    name: Option<String>,
    /// 1009h.
    hardware: Option<String>,
    /// 100Ah.
    software: Option<String>,
    /// Serial numbers of all nodes with this node ID, if several respond; otherwise empty.
    conflict: Vec<u32>,
}

impl From<scan::FoundNode> for Found {
    fn from(found: scan::FoundNode) -> Self {
        let [name, hardware, software] = found.texts;
        Self {
            node_id: found.node.raw(),
            state: found.state.map(od_wire::nmt::State::name),
            answers: found.answers,
            device_type: found.device_type,
            identity: found.identity.into(),
            name,
            hardware,
            software,
            conflict: found.conflict,
        }
    }
}

#[pymethods]
impl Found {
    fn __repr__(&self) -> String {
        let name = self.name.as_deref().unwrap_or("without a name");
        let state = self.state.unwrap_or("no heartbeat");
        let conflict = match self.conflict.len() {
            0 => String::new(),
            count => format!(", {count} nodes have this node ID"),
        };
        format!(
            "<odkit.Found node {}: {name}, {state}{conflict}>",
            self.node_id
        )
    }
}
