//! Differences between two descriptions.

use od_eds::Tables;
use od_eds::diff::{Impact, compare};
use pyo3::prelude::*;

use crate::files::description::read_of;

/// One difference between two dictionaries.
#[pyclass(frozen, get_all, module = "odkit")]
pub(crate) struct Difference {
    /// Index.
    index: u16,
    /// Sub-index; `None` if the difference is about a whole object, as always for a VAR.
    sub: Option<u8>,
    /// `6001h`, or `1018h:02` if the object has several values.
    place: String,
    /// Name of the object or value; that of the second dictionary, if it has one.
    name: String,
    /// The kind of difference: `added`, `removed`, `object type`, `name`, `data type`, `access`, `PDO mapping`,
    /// `default`, `low limit`, `high limit`, `storage`.
    field: &'static str,
    /// Text in the first dictionary; empty if missing.
    before: String,
    /// Text in the second dictionary; empty if missing.
    after: String,
    /// Whether a master configured for the first device may fail with the second.
    breaking: bool,
}

#[pymethods]
impl Difference {
    fn __str__(&self) -> String {
        let (place, name, field) = (&self.place, &self.name, self.field);
        let change = match (self.before.as_str(), self.after.as_str()) {
            ("", after) => after.to_owned(),
            (before, "") => before.to_owned(),
            (before, after) => format!("{before} -> {after}"),
        };
        let breaking = if self.breaking { " (breaking)" } else { "" };
        format!("{place} {name:?}: {field}: {change}{breaking}")
    }

    fn __repr__(&self) -> String {
        format!("<odkit.Difference {}>", self.__str__())
    }
}

/// Compares two dictionaries, each a path, a built-in device, a text, or what `read` returned.
///
/// Returns the differences by address. Order, spelling and comments are ignored.
///
/// Raises `OSError` if a file cannot be read, `ValueError` if it does not define any object.
#[pyfunction]
pub(crate) fn diff(
    before: &Bound<'_, PyAny>,
    after: &Bound<'_, PyAny>,
) -> PyResult<Vec<Difference>> {
    let (before, after) = (read_of(before)?, read_of(after)?);
    before.has_objects()?;
    after.has_objects()?;
    let tables = [&before, &after].map(|one| Tables::new(&one.description));
    let found = compare(tables[0].dictionary(), tables[1].dictionary());
    let found = found.into_iter().map(|one| Difference {
        index: one.index,
        sub: one.sub,
        place: one.place(),
        field: one.field.name(),
        breaking: one.impact == Impact::Breaking,
        name: one.name,
        before: one.before,
        after: one.after,
    });
    Ok(found.collect())
}
