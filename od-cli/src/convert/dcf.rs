//! What a DCF says more than an EDS: one device of the kind, configured (CiA 306-1, chapter 5).

use od_eds::{Description, Spanned, Tables, Value};
use od_model::values;

use super::Args;
use crate::Failure;

/// Node ID, bit rate and the values that were asked for. A value of the file stays where
/// nothing is said of it.
pub(super) fn configure(description: &mut Description, args: &Args) -> Result<(), Failure> {
    if let Some(node_id) = args.node_id {
        description.commission("NodeID", &node_id.raw().to_string());
    } else if description.commissioned_node_id().is_none() {
        return Err(Failure::Usage(
            "a DCF is of one device: say its node ID, --node-id 5".into(),
        ));
    }
    if let Some(rate) = args.bit_rate {
        description.commission("Baudrate", &rate.to_string());
    }
    for setting in &args.values {
        value(description, setting).map_err(Failure::Usage)?;
    }
    Ok(())
}

/// `6001h=4096`: the ParameterValue of one object.
fn value(description: &mut Description, setting: &str) -> Result<(), String> {
    let (object, text) = setting
        .split_once('=')
        .ok_or_else(|| format!("`{setting}` sets nothing; write --set 6001h=4096"))?;
    let (object, text) = (object.trim(), text.trim());
    let tables = Tables::new(description);
    let entry = values::find(tables.dictionary(), object)?;
    let (address, data_type) = (entry.address, entry.data_type);
    if !entry.access.writable() {
        return Err(format!(
            "{object} is {}: it has no value to set",
            entry.access
        ));
    }
    let bytes = values::parse(data_type, text).map_err(|why| format!("{object}: {why}"))?;
    let value = Value::from_wire(data_type, bytes);
    let node_id = description.commissioned_node_id().unwrap_or(1);
    let described = description
        .objects
        .get_mut(&address.index)
        .and_then(|object| object.entries.get_mut(&address.sub))
        .ok_or_else(|| format!("there is no object {object}"))?;
    if let Some(number) = value.integer(node_id) {
        let limit = |limit: &Option<Spanned<Value>>| limit.as_ref()?.integer(node_id);
        let (low, high) = (limit(&described.low), limit(&described.high));
        if low.is_some_and(|low| number < low) || high.is_some_and(|high| number > high) {
            let show = |limit: Option<i128>| limit.map_or(String::new(), |limit| limit.to_string());
            return Err(format!(
                "{object}: {number} is outside {}..{}",
                show(low),
                show(high)
            ));
        }
    }
    described.parameter = Some(Spanned::from(value));
    Ok(())
}
