//! `odkit set`: values for a node.

use std::path::PathBuf;

use od_model::{Address, Dictionary, Entry, Refused, values};
use od_runtime::{AbortCode, NodeId};
use od_tools::Error;
use od_tools::master::Master;
use od_tools::objects;
use od_tools::tap::Tap;

use crate::bus::value::{self, NoValue, Shown};
use crate::bus::{self, Bus, Format};
use crate::failure::{Failure, read_error};
use crate::output::{self, Bar};
use crate::source;

/// Write objects of a node
///
/// A value is a number (4096, 0x1000, -5, 1.5), true, "a text" or bytes ([01 02 03]). Type, access and
/// limits come from the file of --eds or the built-in device that matches 1018h; all values are checked
/// before the first is sent. Without either, odkit uses the size of the object.
///
/// Exit code 0: all values were written; 1: an SDO abort, or the node is silent; 2: a value does not
/// fit, and none was sent.
#[derive(clap::Args)]
pub(crate) struct Args {
    /// Node ID
    #[arg(value_name = "NODE", value_parser = source::node_id)]
    node: NodeId,
    /// Objects by index or name, each with its value; with --file one without
    #[arg(value_name = "OBJECT=VALUE", required = true)]
    values: Vec<String>,
    /// File with the bytes of the value, such as those of a DOMAIN
    #[arg(long, value_name = "FILE")]
    file: Option<PathBuf>,
    #[command(flatten)]
    bus: bus::Args,
}

/// A value that is ready to send.
struct Ready {
    address: Address,
    entry: Option<Entry>,
    bytes: Vec<u8>,
}

pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    let names = args.bus.names()?;
    let pairs = pairs(args)?;
    let given = names.given(args.node).map(|known| known.dictionary);
    let mut ready = match given {
        Some(dictionary) => checked(dictionary, args.node, &pairs)?,
        None => Vec::new(),
    };
    let mut bar = Bar::new("writing");
    let total = match pairs.as_slice() {
        [(_, Value::Bytes(bytes))] => bytes.len(),
        _ => 0,
    };
    let link: Bus = args.bus.open()?;
    let link = Tap::new(link, |frame| {
        if total > 0 {
            bar.transfer_of(frame, total);
        }
    });
    let mut master = Master::new(link, args.node);
    let dictionary = names.of(&mut master)?.map(|known| known.dictionary);
    if given.is_none() {
        ready = match dictionary {
            Some(dictionary) => checked(dictionary, args.node, &pairs)?,
            None => sized(&mut master, &pairs)?,
        };
    }
    let mut shown = Vec::new();
    for one in &ready {
        let written = Error::or_abort(master.download(one.address, &one.bytes))?;
        let failed = written.is_err();
        let about = (one.address, one.entry.as_ref());
        let written = written.map(|()| one.bytes.clone());
        let written = written.map_err(NoValue::Abort);
        shown.push(Shown::new(dictionary, about, written));
        if failed {
            break;
        }
    }
    drop(master);
    bar.clear();
    if args.file.is_some()
        && args.bus.format == Format::Text
        && shown.iter().all(|one| one.result.is_ok())
    {
        return output::print(&format!("{} written", crate::report::plural(total, "byte")));
    }
    output::print(&match args.bus.format {
        Format::Text => value::lines(&shown),
        Format::Json => value::json(args.node.raw(), &shown),
    })?;
    if shown.iter().all(|one| one.result.is_ok()) {
        return Ok(());
    }
    match ready.len() - shown.len() {
        0 => Err(Failure::Reported(1)),
        rest => Err(Failure::Failed(format!(
            "{} not written",
            crate::report::plural(rest, "further value")
        ))),
    }
}

enum Value {
    Text(String),
    Bytes(Vec<u8>),
}

/// Objects with their values, as given.
fn pairs(args: &Args) -> Result<Vec<(String, Value)>, Failure> {
    if let Some(path) = &args.file {
        let [object] = args.values.as_slice() else {
            let why = "`--file` has the value of one object; name one";
            return Err(Failure::Usage(why.into()));
        };
        let bytes = crate::files::read(path).map_err(|error| {
            Failure::Failed(format!("{}: {}", path.display(), read_error(&error)))
        })?;
        let object = object.strip_suffix('=').unwrap_or(object);
        return Ok(vec![(object.to_owned(), Value::Bytes(bytes))]);
    }
    let pairs = args.values.iter().map(|text| match text.split_once('=') {
        Some((object, value)) => Ok((object.to_owned(), Value::Text(value.to_owned()))),
        None => Err(Failure::Usage(format!(
            "`{text}` has no value; write `{text}=4096`"
        ))),
    });
    pairs.collect()
}

fn checked(
    dictionary: Dictionary<'_>,
    node: NodeId,
    pairs: &[(String, Value)],
) -> Result<Vec<Ready>, Failure> {
    let ready = pairs.iter().map(|(object, value)| {
        let wrong = |why: Refused| Failure::Usage(format!("{object}: {why}"));
        let entry = values::find(dictionary, object)?;
        let bytes = match value {
            Value::Text(text) => objects::encode(&entry, node.raw(), text).map_err(wrong)?,
            Value::Bytes(_) if !entry.access.writable() => {
                return Err(wrong(
                    format!("it is `{}` and cannot be written", entry.access).into(),
                ));
            }
            Value::Bytes(bytes) => bytes.clone(),
        };
        Ok(Ready {
            address: entry.address,
            entry: Some(entry),
            bytes,
        })
    });
    ready.collect()
}

/// Values for a node without a dictionary: with the sizes that the node reports.
fn sized(
    master: &mut Master<impl od_tools::link::Link>,
    pairs: &[(String, Value)],
) -> Result<Vec<Ready>, Failure> {
    let mut ready = Vec::new();
    for (object, value) in pairs {
        let wrong = |why: Refused| Failure::Usage(format!("{object}: {why}"));
        let address = values::address(object)
            .ok_or_else(|| wrong("it is not an address; add `--eds FILE` for names".into()))?;
        let bytes = match value {
            Value::Bytes(bytes) => bytes.clone(),
            Value::Text(text) if text.trim_start().starts_with(['[', '"']) => {
                objects::encode_by_size(0, text).map_err(wrong)?
            }
            Value::Text(text) => {
                let size = match Error::or_abort(master.upload(address))? {
                    Ok(bytes) => bytes.len(),
                    Err(code) if code == AbortCode::WriteOnly.code() => {
                        return Err(wrong(
                            "it cannot be read, so its size is not known; add `--eds FILE`, or write \
                             bytes, such as [01 00]"
                                .into(),
                        ));
                    }
                    Err(code) => {
                        return Err(Failure::Failed(format!("{object}: {}", value::abort(code))));
                    }
                };
                objects::encode_by_size(size, text).map_err(wrong)?
            }
        };
        ready.push(Ready {
            address,
            entry: None,
            bytes,
        });
    }
    Ok(ready)
}
