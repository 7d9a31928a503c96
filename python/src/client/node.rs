//! One node of a bus.

use od_wire::NodeId;
use pyo3::prelude::*;

/// A node of a bus, as its client sees it; `client.node(5, "drive.eds")` makes one.
///
/// `node[0x6004]`, `node[0x1018, 1]` and `node["Position value"]` read and write by SDO.
#[pyclass(frozen, module = "odkit")]
pub(crate) struct Node {
    pub(crate) client: Py<PyAny>,
    pub(crate) id: NodeId,
}

impl Node {
    fn call<'p>(
        &self,
        py: Python<'p>,
        name: &str,
        arguments: impl pyo3::call::PyCallArgs<'p>,
    ) -> PyResult<Bound<'p, PyAny>> {
        self.client.bind(py).call_method1(name, arguments)
    }
}

#[pymethods]
impl Node {
    /// The node ID, 1 to 127.
    #[getter]
    fn node_id(&self) -> u8 {
        self.id.raw()
    }

    /// The value of an object by SDO. Raises what `Client.upload` raises.
    fn __getitem__<'p>(
        &self,
        py: Python<'p>,
        object: Bound<'p, PyAny>,
    ) -> PyResult<Bound<'p, PyAny>> {
        self.call(py, "upload", (self.id.raw(), object))
    }

    /// Writes an object by SDO. Raises what `Client.download` raises.
    fn __setitem__<'p>(
        &self,
        py: Python<'p>,
        object: Bound<'p, PyAny>,
        value: Bound<'p, PyAny>,
    ) -> PyResult<()> {
        self.call(py, "download", (self.id.raw(), object, value))?;
        Ok(())
    }

    /// Sends an NMT command; see `Client.nmt`.
    #[pyo3(signature = (command, timeout=0.1))]
    fn nmt<'p>(&self, py: Python<'p>, command: &str, timeout: f64) -> PyResult<Bound<'p, PyAny>> {
        self.call(py, "nmt", (command, self.id.raw(), timeout))
    }

    /// The state in its last heartbeat; `None`: none was heard.
    #[getter]
    fn state<'p>(&self, py: Python<'p>) -> PyResult<Bound<'p, PyAny>> {
        self.call(py, "state", (self.id.raw(),))
    }

    /// Waits for its next heartbeat or boot-up message, at most `timeout` seconds, and returns its state.
    #[pyo3(signature = (timeout=1.0))]
    fn heartbeat<'p>(&self, py: Python<'p>, timeout: f64) -> PyResult<Bound<'p, PyAny>> {
        self.call(py, "heartbeat", (self.id.raw(), timeout))
    }

    /// Its oldest EMCY message that was not returned yet; waits for one at most `timeout` seconds.
    #[pyo3(signature = (timeout=1.0))]
    fn emcy<'p>(&self, py: Python<'p>, timeout: f64) -> PyResult<Bound<'p, PyAny>> {
        self.call(py, "emcy", (timeout, self.id.raw()))
    }

    /// Its oldest PDO that was not returned yet; waits for one at most `timeout` seconds.
    #[pyo3(signature = (timeout=1.0))]
    fn pdo<'p>(&self, py: Python<'p>, timeout: f64) -> PyResult<Bound<'p, PyAny>> {
        self.call(py, "pdo", (timeout, self.id.raw()))
    }

    /// Reads which of its TPDOs are valid and what is mapped now; see `Client.read_mapping`.
    fn read_mapping<'p>(&self, py: Python<'p>) -> PyResult<Bound<'p, PyAny>> {
        self.call(py, "read_mapping", (self.id.raw(),))
    }

    fn __repr__(&self) -> String {
        format!("<odkit.Node {}>", self.id)
    }
}
