//! A description as the `ObjectDictionary` of python-canopen.
//!
//! Attributes are those that its own reader sets.

use od_eds::{Description, EntryDescription, ObjectDescription, Spanned, Value};
use od_model::{Access, DataType, ObjectCode};
use pyo3::exceptions::PyImportError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyString};
use pyo3::{IntoPyObjectExt, intern};

use crate::faults::Fault;
use crate::files::description::Description as Described;
use crate::files::source::Source;
use crate::files::value;

/// Reads a description into an `ObjectDictionary` of python-canopen, as `canopen.import_od` does: for
/// `canopen.Network.add_node`, `canopen.RemoteNode` and `canopen.LocalNode`.
///
/// `source` is a path (EDS, DCF, XDD, XDC), a built-in device, `base.eds+variant.overlay`, a text with line
/// ends, `bytes`, or the result of `read`. `node_id` (1 to 127) resolves values such as
/// `$NODEID+0x180`; without it that of a DCF is used, and without both such a default is `None`. It reads
/// files that python-canopen rejects; docs/DIFFERENCES.md explains the differences.
///
/// Raises `OSError` if the file cannot be read, `ValueError` if it does not define any object,
/// `ImportError` if python-canopen is not installed.
#[pyfunction]
#[pyo3(signature = (source, node_id=None))]
pub(crate) fn to_canopen<'p>(
    py: Python<'p>,
    source: &Bound<'p, PyAny>,
    node_id: Option<u8>,
) -> PyResult<Bound<'p, PyAny>> {
    if node_id.is_some_and(|id| !(1..=127).contains(&id)) {
        return Err(Fault::value("`node_id` must be 1 to 127").into());
    }
    if let Ok(read) = source.cast::<Described>() {
        let read = &read.get().read;
        read.has_objects()?;
        let node_id = node_id.or(read.node_id);
        return dictionary(py, read.source.document.text(), &read.description, node_id);
    }
    let source = Source::of(source)?;
    // The rules are not needed here.
    let description = py.detach(|| source.document.parse().description);
    if description.objects.is_empty() {
        let name = source.shown();
        let why = format!("{name} does not define any object; is it an EDS, DCF or XDD file?");
        return Err(Fault::Value(why).into());
    }
    let node_id = node_id.or_else(|| description.commissioned_node_id());
    dictionary(py, source.document.text(), &description, node_id)
}

fn dictionary<'p>(
    py: Python<'p>,
    text: &str,
    description: &Description,
    node_id: Option<u8>,
) -> PyResult<Bound<'p, PyAny>> {
    let module = py.import("canopen.objectdictionary").map_err(|_| {
        PyImportError::new_err("python-canopen is not installed; `pip install canopen`")
    })?;
    let _waiting = Waiting::new(py)?;
    let od = module.getattr("ObjectDictionary")?.call0()?;
    let maker = Maker::new(&module, text, node_id)?;
    about(&od, description, node_id)?;
    let (indices, names) = (dict(&od, "indices")?, dict(&od, "names")?);
    let add = |index: u16, name: &Bound<'p, PyAny>, object: Bound<'p, PyAny>| {
        indices.set_item(index, &object)?;
        names.set_item(name, object)
    };
    for index in 1..8_u16 {
        let key = format!("Dummy{index:04}");
        let section = description.section("DummyUsage");
        let used = section.and_then(|section| section.get(&key));
        if used.is_some_and(|used| number(used) == Some(1)) {
            let name = PyString::new(py, &key).into_any();
            add(index, &name, maker.dummy(&od, &name, index)?)?;
        }
    }
    // Of two objects with one name python-canopen keeps the last.
    let mut objects: Vec<_> = description.objects.iter().collect();
    objects.sort_by_key(|(_, object)| object.span.start);
    for (index, object) in objects {
        let (name, made) = maker.object(&od, *index, object)?;
        add(*index, &name, made)?;
    }
    Ok(od)
}

/// Suspends the collection of cyclic garbage: a dictionary that is being made contains none,
/// and searching it repeatedly would take a third of the time.
struct Waiting<'p>(Option<Bound<'p, PyModule>>);

impl<'p> Waiting<'p> {
    fn new(py: Python<'p>) -> PyResult<Self> {
        let gc = py.import("gc")?;
        if !gc.call_method0("isenabled")?.is_truthy()? {
            return Ok(Self(None));
        }
        gc.call_method0("disable")?;
        Ok(Self(Some(gc)))
    }
}

impl Drop for Waiting<'_> {
    fn drop(&mut self) {
        if let Some(gc) = &self.0 {
            // A failure here need not be reported.
            _ = gc.call_method0("enable");
        }
    }
}

fn dict<'p>(object: &Bound<'p, PyAny>, name: &str) -> PyResult<Bound<'p, PyDict>> {
    Ok(object.getattr(name)?.cast_into::<PyDict>()?)
}

fn number(text: &Spanned<String>) -> Option<i128> {
    od_model::values::integer(text.value.trim())
}

/// Comments, node ID, bit rate, and the content of `[FileInfo]` and `[DeviceInfo]`.
fn about(od: &Bound<'_, PyAny>, description: &Description, node_id: Option<u8>) -> PyResult<()> {
    let py = od.py();
    if let Some(section) = description.section("FileInfo") {
        let pairs = PyDict::new(py);
        for (key, value) in section.pairs.iter().rev() {
            pairs.set_item(&key.value, &value.value)?;
        }
        od.setattr("__edsFileInfo", pairs)?;
    }
    if let Some(section) = description.section("Comments") {
        let count = section.get("Lines").and_then(number).unwrap_or(0);
        let line = |at| section.get(&format!("Line{at}"));
        let lines = (1..=count.clamp(0, 0xFFFF)).filter_map(line);
        let lines: Vec<&str> = lines.map(|line| line.value.as_str()).collect();
        od.setattr("comments", lines.join("\n"))?;
    }
    if let Some(node) = description.commissioning() {
        if let Some(rate) = node.bit_rate.filter(|rate| *rate > 0) {
            od.setattr("bitrate", u32::from(rate) * 1000)?;
        }
        od.setattr("node_id", node_id)?;
    }
    let Some(section) = description.section("DeviceInfo") else {
        return Ok(());
    };
    let info = od.getattr("device_information")?;
    for rate in [10, 20, 50, 125, 250, 500, 800, 1000] {
        if description.info_is_set(&format!("BaudRate_{rate}")) {
            let rates = info.getattr("allowed_baudrates")?;
            rates.call_method1("add", (rate * 1000,))?;
        }
    }
    for (key, attribute) in [
        ("VendorName", "vendor_name"),
        ("ProductName", "product_name"),
        ("OrderCode", "order_code"),
    ] {
        if let Some(text) = section.get(key) {
            info.setattr(attribute, &text.value)?;
        }
    }
    for (key, attribute) in [
        ("VendorNumber", "vendor_number"),
        ("ProductNumber", "product_number"),
        ("RevisionNumber", "revision_number"),
        ("NrOfRXPDO", "nr_of_RXPDO"),
        ("NrOfTXPDO", "nr_of_TXPDO"),
    ] {
        if let Some(number) = section.get(key).and_then(number) {
            info.setattr(attribute, number)?;
        }
    }
    for (key, attribute) in [
        ("SimpleBootUpMaster", "simple_boot_up_master"),
        ("SimpleBootUpSlave", "simple_boot_up_slave"),
        ("Granularity", "granularity"),
        ("DynamicChannelsSupported", "dynamic_channels_supported"),
        ("GroupMessaging", "group_messaging"),
        ("LSS_Supported", "LSS_supported"),
    ] {
        if let Some(number) = section.get(key).and_then(number) {
            info.setattr(attribute, number != 0)?;
        }
    }
    Ok(())
}

/// The classes of python-canopen, and the attributes of new objects.
struct Maker<'p, 't> {
    py: Python<'p>,
    variable: Bound<'p, PyAny>,
    record: Bound<'p, PyAny>,
    array: Bound<'p, PyAny>,
    text: &'t str,
    node_id: Option<u8>,
}

impl<'p, 't> Maker<'p, 't> {
    fn new(module: &Bound<'p, PyModule>, text: &'t str, node_id: Option<u8>) -> PyResult<Self> {
        let py = module.py();
        Ok(Self {
            py,
            variable: module.getattr("ODVariable")?,
            record: module.getattr("ODRecord")?,
            array: module.getattr("ODArray")?,
            text,
            node_id,
        })
    }

    /// A data type that fills a gap in a mapping.
    fn dummy(
        &self,
        parent: &Bound<'p, PyAny>,
        name: &Bound<'p, PyAny>,
        index: u16,
    ) -> PyResult<Bound<'p, PyAny>> {
        let made = self.variable.call1((name, index, 0))?;
        made.setattr("data_type", index)?;
        made.setattr("access_type", "const")?;
        made.setattr("parent", parent)?;
        Ok(made)
    }

    /// The name of an object, and its counterpart in python-canopen.
    fn object(
        &self,
        od: &Bound<'p, PyAny>,
        index: u16,
        object: &ObjectDescription,
    ) -> PyResult<(Bound<'p, PyAny>, Bound<'p, PyAny>)> {
        let py = self.py;
        let is_one = object.entries.len() == 1 && object.entries.contains_key(&0);
        if is_one
            && !object.code.has_members()
            && let Some(entry) = object.entries.get(&0)
        {
            let name = PyString::new(py, &entry.name).into_any();
            let made = self.entry(od, index, 0, &name, entry)?;
            return Ok((name, made));
        }
        let class = match object.code.value {
            ObjectCode::Array => &self.array,
            _ => &self.record,
        };
        let name = PyString::new(py, &object.name).into_any();
        let made = class.call1((&name, index))?;
        made.setattr(intern!(py, "parent"), od)?;
        if let Some(location) = extra(&object.extra, "StorageLocation") {
            made.setattr("storage_location", location)?;
        }
        let (subs, names) = (dict(&made, "subindices")?, dict(&made, "names")?);
        let mut entries: Vec<_> = object.entries.iter().collect();
        entries.sort_by_key(|(_, entry)| entry.span.start);
        for (sub, entry) in entries {
            let name = PyString::new(py, &entry.name).into_any();
            let member = self.entry(&made, index, *sub, &name, entry)?;
            subs.set_item(sub, &member)?;
            names.set_item(name, member)?;
        }
        Ok((name, made))
    }

    fn entry(
        &self,
        parent: &Bound<'p, PyAny>,
        index: u16,
        sub: u8,
        name: &Bound<'p, PyAny>,
        entry: &EntryDescription,
    ) -> PyResult<Bound<'p, PyAny>> {
        let py = self.py;
        let made = self.variable.call1((name, index, sub))?;
        made.setattr(intern!(py, "parent"), parent)?;
        let known = entry.data_type.map(|one| one.value);
        // A type that is not one of a value: the application gets the bytes.
        let data_type = known.filter(|one| one.code() <= DataType::Unsigned64.code());
        let code = data_type.unwrap_or(DataType::Domain).code();
        made.setattr(intern!(py, "data_type"), code)?;
        if entry.access.value != Access::Rw {
            let access = PyString::intern(py, entry.access.name());
            made.setattr(intern!(py, "access_type"), access)?;
        }
        if entry.mappable.value {
            made.setattr(intern!(py, "pdo_mappable"), true)?;
        }
        for (key, limit) in [
            (intern!(py, "min"), &entry.low),
            (intern!(py, "max"), &entry.high),
        ] {
            if let Some(limit) = limit {
                made.setattr(key, self.value(known, &limit.value)?)?;
            }
        }
        if let Some(default) = &entry.default {
            made.setattr(intern!(py, "default"), self.value(known, &default.value)?)?;
            made.setattr(intern!(py, "default_raw"), self.raw(default))?;
            if matches!(default.value, Value::NodeId(_)) {
                made.setattr(intern!(py, "relative"), true)?;
            }
        }
        if let Some(value) = &entry.parameter {
            made.setattr(intern!(py, "value"), self.value(known, &value.value)?)?;
            made.setattr(intern!(py, "value_raw"), self.raw(value))?;
        }
        extras(&made, &entry.extra)?;
        Ok(made)
    }

    /// A value; `None` if it depends on a node ID that is not known.
    fn value(&self, data_type: Option<DataType>, given: &Value) -> PyResult<Bound<'p, PyAny>> {
        match given {
            // Including BOOLEAN: python-canopen reads `1`, not `True`.
            Value::Unsigned(number) => number.into_bound_py_any(self.py),
            Value::NodeId(_) if self.node_id.is_none() => Ok(self.py.None().into_bound(self.py)),
            given => value::to_python(self.py, data_type, given, self.node_id),
        }
    }

    /// The text of a value in the file, without a comment after a number.
    fn raw(&self, value: &Spanned<Value>) -> &'t str {
        let (start, end) = (value.span.start as usize, value.span.end as usize);
        let text = self.text.get(start..end).unwrap_or_default();
        match (&value.value, text.find(" ;").or_else(|| text.find("\t;"))) {
            (Value::Text(_), _) | (_, None) => text.trim(),
            (_, Some(comment)) => text[..comment].trim(),
        }
    }
}

fn extra<'e>(extras: &'e [(String, String)], key: &str) -> Option<&'e str> {
    let found = extras.iter().find(|(one, _)| one.eq_ignore_ascii_case(key));
    found.map(|(_, text)| text.as_str())
}

/// The keys that python-canopen reads besides those of CiA 306.
fn extras(made: &Bound<'_, PyAny>, extras: &[(String, String)]) -> PyResult<()> {
    if extras.is_empty() {
        return Ok(());
    }
    for (key, attribute) in [
        ("StorageLocation", "storage_location"),
        ("Description", "description"),
        ("Unit", "unit"),
    ] {
        if let Some(text) = extra(extras, key) {
            made.setattr(attribute, text)?;
        }
    }
    let factor = extra(extras, "Factor").and_then(|text| text.trim().parse::<f64>().ok());
    match factor {
        Some(factor) => made.setattr("factor", factor),
        None => Ok(()),
    }
}
