//! Turns an EDS into a DCF: one configured device (CiA 306-1, chapter 5).

use alloc::format;
use alloc::string::{String, ToString};

use od_model::{Refused, values};

use crate::description::tables::Tables;
use crate::description::{Description, Value};
use crate::span::Spanned;

/// Sets the ParameterValue of one object, `6001h` or `1800sub1`, to a value typed by a user.
///
/// # Errors
///
/// The object does not exist or is not writable, or the value is invalid; in words.
pub fn set(description: &mut Description, object: &str, text: &str) -> Result<(), Refused> {
    let tables = Tables::new(description);
    let entry = values::find(tables.dictionary(), object)?;
    let (address, data_type) = (entry.address, entry.data_type);
    if !entry.access.writable() {
        return Err(format!("{object} is `{}` and cannot be set", entry.access).into());
    }
    let bytes = values::parse(data_type, text).map_err(|why| format!("{object}: {why}"))?;
    let value = Value::from_wire(data_type, bytes);
    let node_id = description.commissioned_node_id().unwrap_or(1);
    let described = description
        .objects
        .get_mut(&address.index)
        .and_then(|object| object.entries.get_mut(&address.sub))
        .ok_or_else(|| format!("object {object} does not exist"))?;
    if let Some(number) = value.integer(node_id) {
        let limit = |limit: &Option<Spanned<Value>>| limit.as_ref()?.integer(node_id);
        let (low, high) = (limit(&described.low), limit(&described.high));
        if low.is_some_and(|low| number < low) || high.is_some_and(|high| number > high) {
            let show = |limit: Option<i128>| limit.map_or(String::new(), |limit| limit.to_string());
            return Err(format!(
                "{object}: {number} is outside {}..{}",
                show(low),
                show(high)
            )
            .into());
        }
    }
    described.parameter = Some(Spanned::from(value));
    Ok(())
}
