//! `odkit backup` and `odkit apply`: the configuration of a node as a DCF.

use std::path::PathBuf;

use od_eds::{Description, Value};
use od_model::{Address, DataType, Dictionary, values};
use od_runtime::{AbortCode, NodeId};
use od_tools::Error;
use od_tools::configure::{self, Applied, Setting};
use od_tools::master::Master;
use serde_json::json;

use crate::bus::{self, Format, value};
use crate::failure::Failure;
use crate::output::{self, Bar, note};
use crate::report::plural;
use crate::source::{self, Source};

/// Write the configuration of a node into a DCF
///
/// The DCF contains the values that can be read and written, except commands, logs and DOMAINs. Names
/// and types come from the file of --eds or the built-in device that matches 1018h.
///
/// Exit code 0: the file has all values that the node does not refuse; 1: the node does not respond, or violates the
/// protocol in the transfer of a value, which is left out.
#[derive(clap::Args)]
pub(crate) struct Args {
    /// Node ID
    #[arg(value_name = "NODE", value_parser = source::node_id)]
    node: NodeId,
    /// DCF to write
    #[arg(long, short, value_name = "FILE")]
    output: PathBuf,
    #[command(flatten)]
    bus: bus::Args,
}

/// Write the values of a DCF into a node: all, or none
///
/// Writes the values that differ, PDOs while they are not valid, and reads them back. If the node aborts
/// a download, the values before it are restored. Nothing is saved without --save.
///
/// Exit code 0: the node has all values; 1: it does not; 2: wrong usage, nothing was written.
#[derive(clap::Args)]
pub(crate) struct Apply {
    /// Node ID
    #[arg(value_name = "NODE", value_parser = source::node_id)]
    node: NodeId,
    /// DCF with the values
    #[arg(value_name = "FILE")]
    file: String,
    /// Save the values in the node afterwards (1010h)
    #[arg(long)]
    save: bool,
    /// Accept a DCF of another device, and of another node ID with COB-IDs of its own
    #[arg(long)]
    force: bool,
    #[command(flatten)]
    bus: bus::Args,
}

pub(crate) fn backup(args: &Args) -> Result<(), Failure> {
    let names = args.bus.names()?;
    let mut master = Master::new(args.bus.open()?, args.node);
    let Some(known) = names.of(&mut master)? else {
        // A node that violates the protocol has no identity.
        Error::or_abort(master.upload(Address::new(0x1018, 1)))?.ok();
        let node = args.node.raw();
        return Err(Failure::Failed(format!(
            "no built-in device fits node {node}; add its file with `--eds FILE`"
        )));
    };
    let mut description = Source::find(known.name)?.parse()?.description;
    master.know(known.dictionary);
    let mut bar = Bar::new("reading");
    let addresses = configure::addresses(known.dictionary);
    let found = configure::read(&mut master, &addresses, |percent| bar.show(percent))?;
    let serial = Error::or_abort(master.upload(Address::new(0x1018, 4)))?;
    drop(master);
    bar.clear();
    description.commission("NodeID", &args.node.raw().to_string());
    if let Some(rate) = args.bus.bit_rate {
        description.commission("Baudrate", &rate.to_string());
    }
    if let Ok(Ok(serial)) = serial.as_deref().map(<[u8; 4]>::try_from) {
        let serial = u32::from_le_bytes(serial);
        description.commission("LSS_SerialNumber", &serial.to_string());
    }
    let mut missing = Vec::new();
    let mut count = 0;
    for (address, read) in found {
        match (read, entry(&mut description, address)) {
            (Ok(bytes), Some((entry, data_type))) => {
                let value = Value::from_wire(data_type, bytes);
                // A value that depends on the node ID does so on the next node, too.
                let follows = entry.default.as_ref().filter(|default| {
                    let is_relative = matches!(default.value, Value::NodeId(_));
                    let number = value.integer(args.node.raw());
                    is_relative && default.integer(args.node.raw()) == number
                });
                let follows = follows.map(|default| default.value.clone());
                entry.parameter = Some(follows.unwrap_or(value).into());
                count += 1;
            }
            // An empty error history.
            (Err(Error::Abort(code)), _) if code == AbortCode::NoData.code() => {}
            (Err(failed), _) => missing.push((address, failed)),
            (Ok(_), None) => {}
        }
    }
    let text = od_eds::canonical(&description);
    output::save(Some(&args.output), &text)?;
    for (address, failed) in &missing {
        note!("{address} is left out: {failed}");
    }
    let is_whole = missing
        .iter()
        .all(|(_, failed)| matches!(failed, Error::Abort(_)));
    let path = args.output.display();
    output::print(&match args.bus.format {
        Format::Text => format!("{path}: {}", plural(count, "value")),
        Format::Json => {
            let missing = missing.iter().map(|(address, _)| address.to_string());
            let missing: Vec<_> = missing.collect();
            format!(
                "{:#}",
                json!({ "file": path.to_string(), "values": count, "missing": missing })
            )
        }
    })?;
    if is_whole {
        Ok(())
    } else {
        Err(Failure::Reported(1))
    }
}

fn entry(
    description: &mut Description,
    address: Address,
) -> Option<(&mut od_eds::EntryDescription, DataType)> {
    let object = description.objects.get_mut(&address.index)?;
    let entry = object.entries.get_mut(&address.sub)?;
    let data_type = entry.data_type.as_ref()?.value;
    Some((entry, data_type))
}

pub(crate) fn apply(args: &Apply) -> Result<(), Failure> {
    let description = Source::find(&args.file)?.parse()?.description;
    let file = &args.file;
    let commissioned = description.commissioned_node_id();
    let fixed = description.entries().find(|(_, entry)| {
        let is_relative = |value: &Value| matches!(value, Value::NodeId(_));
        let default = entry.default.as_ref();
        let own = entry.parameter.as_ref().filter(|value| !is_relative(value));
        own.is_some() && default.is_some_and(|value| is_relative(value))
    });
    if let Some(other) = commissioned.filter(|other| *other != args.node.raw() && !args.force)
        && let Some((address, _)) = fixed
    {
        return Err(Failure::Usage(format!(
            "{file} is of node {other}, and its {address} does not follow the node ID; add `--force` to \
             write it to node {} all the same",
            args.node.raw()
        )));
    }
    let tables = od_eds::Tables::new(&description);
    let dictionary = tables.dictionary();
    let settings = settings(&description, dictionary, args.node);
    if settings.is_empty() {
        return Err(Failure::Usage(format!(
            "{file} has no ParameterValue of an object that can be written; `odkit backup` makes such a file"
        )));
    }
    let mut master = Master::new(args.bus.open()?, args.node);
    if !args.force {
        fits(&mut master, dictionary, file)?;
    }
    master.know(dictionary);
    let mut bar = Bar::new("applying");
    let applied = configure::apply(&mut master, &settings, |percent| bar.show(percent))?;
    bar.clear();
    let is_right = applied.wrong.is_empty() && applied.left.is_empty() && applied.ended.is_none();
    let mut saved = None;
    if args.save && is_right {
        let mut master = Master::patient(master.link(), args.node, crate::save::PATIENCE);
        saved = Some(Error::or_abort(
            master.download(Address::new(0x1010, 1), b"save"),
        )?);
    }
    drop(master);
    report(args, dictionary, &applied)?;
    if let Some(Err(code)) = saved {
        return Err(Failure::Failed(format!("1010h:01: {}", value::abort(code))));
    }
    match applied.ended {
        Some(ended) => Err(ended.into()),
        None if is_right => Ok(()),
        None => Err(Failure::Reported(1)),
    }
}

/// The ParameterValues of all objects that can be written.
fn settings(description: &Description, dictionary: Dictionary<'_>, node: NodeId) -> Vec<Setting> {
    let own = configure::addresses(dictionary);
    let own = own.into_iter().filter_map(|address| {
        description.entry(address)?.parameter.as_ref()?;
        // The tables have a ParameterValue as the default value.
        let entry = dictionary.find(address).ok()?;
        let bytes = match entry.default.integer(node.raw()) {
            Some(number) => {
                let size = entry.data_type.size()?;
                number.to_le_bytes().get(..size)?.to_vec()
            }
            None => match entry.default {
                od_model::Literal::Real(real) if entry.data_type == DataType::Real32 => {
                    (real as f32).to_le_bytes().to_vec()
                }
                od_model::Literal::Real(real) => real.to_le_bytes().to_vec(),
                other => dictionary.literal_bytes(other).to_vec(),
            },
        };
        Some(Setting { address, bytes })
    });
    own.collect()
}

/// Checks that the file describes such a device.
fn fits(
    master: &mut Master<bus::Bus>,
    dictionary: Dictionary<'_>,
    file: &str,
) -> Result<(), Failure> {
    for (sub, what) in [(1, "vendor-ID"), (2, "product code")] {
        let wanted = dictionary.entry(0x1018, sub);
        let wanted = wanted.and_then(|entry| entry.default.integer(0));
        let read = Error::or_abort(master.upload(Address::new(0x1018, sub)))?;
        let bytes = read.ok().and_then(|bytes| bytes.as_slice().try_into().ok());
        let found = bytes.map(|bytes| i128::from(u32::from_le_bytes(bytes)));
        if let (Some(wanted), Some(found)) = (wanted, found)
            && wanted != found
        {
            return Err(Failure::Failed(format!(
                "{file} is of another device: its {what} is {wanted:X}h, that of node {} is {found:X}h; \
                 add `--force` to write it nevertheless",
                master.node().raw()
            )));
        }
    }
    Ok(())
}

fn report(args: &Apply, dictionary: Dictionary<'_>, applied: &Applied) -> Result<(), Failure> {
    let show = |address, bytes: &[u8]| match dictionary.find(address) {
        Ok(entry) => value::words(Some(dictionary), address, entry.data_type, bytes),
        Err(_) => values::hex(bytes),
    };
    let found = |address, found: &Result<Vec<u8>, Error>| match found {
        Ok(bytes) => show(address, bytes),
        Err(failed) => failed.to_string(),
    };
    if args.bus.format == Format::Json {
        let wrong = applied.wrong.iter().map(|one| {
            json!({
                "object": one.setting.address.to_string(),
                "wanted": show(one.setting.address, &one.setting.bytes),
                "found": found(one.setting.address, &one.found),
            })
        });
        let left: Vec<String> = applied.left.iter().map(Address::to_string).collect();
        let report = json!({
            "node": args.node.raw(),
            "equal": applied.equal,
            "written": applied.written,
            "wrong": wrong.collect::<Vec<_>>(),
            "put_back": applied.is_put_back,
            "not_put_back": left,
            "ended": applied.ended.as_ref().map(Error::to_string),
        });
        return output::print(&format!("{report:#}"));
    }
    let mut lines = Vec::new();
    for one in &applied.wrong {
        let address = one.setting.address;
        lines.push(format!(
            "{}: wanted {}, found {}",
            values::label(dictionary, address),
            show(address, &one.setting.bytes),
            found(address, &one.found)
        ));
    }
    for address in &applied.left {
        lines.push(format!(
            "{} may have its new value: it could not be restored",
            values::label(dictionary, *address)
        ));
    }
    let equal = plural(applied.equal, "value");
    let written = plural(applied.written, "value");
    let is_right = applied.wrong.is_empty() && applied.ended.is_none();
    lines.push(match (is_right, applied.is_put_back) {
        (true, _) => format!("{written} written and read back, {equal} unchanged"),
        (false, true) => "the node has its earlier values".into(),
        (false, false) if applied.left.is_empty() => {
            format!("{written} written; see above for what differs")
        }
        (false, false) => "the node has its other earlier values".into(),
    });
    output::print(&lines.join("\n"))
}
