//! `odkit get`: values of a node.

use std::path::PathBuf;

use od_runtime::NodeId;
use od_tools::Error;
use od_tools::master::Master;
use od_tools::objects::{self, Asked};
use od_tools::tap::Tap;
use od_wire::Duration;

use crate::bus::value::{self, NoValue, Shown};
use crate::bus::{self, Format};
use crate::failure::Failure;
use crate::output::{self, Bar};
use crate::source;

/// Read objects of a node
///
/// An object is an index (6004h, 1018h:01), a name, or a glob ('60*', '1018:*', '*position*'). The
/// index of an ARRAY or RECORD selects all its values. Types come from the file of --eds or the
/// built-in device that matches 1018h, otherwise from the size of the value.
///
/// A value that does not end within 60 s is reported as a fault of the node; with --file within a
/// day. In any case the limit is 1 MiB.
///
/// Exit code 0: all values were read; 1: an SDO abort, a violation of the protocol, or the node is silent.
#[derive(clap::Args)]
pub(crate) struct Args {
    /// Node ID
    #[arg(value_name = "NODE", value_parser = source::node_id)]
    node: NodeId,
    /// Objects: index, name or glob
    #[arg(value_name = "OBJECT", required = true)]
    objects: Vec<String>,
    /// File for the bytes of the value, such as a DOMAIN
    #[arg(long, value_name = "FILE")]
    file: Option<PathBuf>,
    #[command(flatten)]
    bus: bus::Args,
}

/// Time limit of a value that is shown, for a node that sends segments without end.
const VALUE: Duration = Duration::from_secs(60);

/// Time limit of a value for a file, which may be long.
const FILE: Duration = Duration::from_secs(86_400);

pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    let names = args.bus.names()?;
    // Wrong arguments are reported before anything is sent.
    let given = names.given(args.node).map(|known| known.dictionary);
    let mut asked: Vec<Vec<Asked>> = Vec::new();
    if let Some(dictionary) = given {
        for text in &args.objects {
            asked.push(objects::select(dictionary, text)?);
        }
    }
    let mut bar = Bar::new("reading");
    let link = args.bus.open()?;
    let is_file = args.file.is_some();
    let link = Tap::new(link, |frame| {
        if is_file {
            bar.transfer(frame);
        }
    });
    let mut master = Master::new(link, args.node).within(if is_file { FILE } else { VALUE });
    let dictionary = names.of(&mut master)?.map(|known| known.dictionary);
    if let Some(dictionary) = dictionary {
        master.know(dictionary);
    }
    if given.is_none() {
        for text in &args.objects {
            asked.push(match dictionary {
                Some(dictionary) => objects::select(dictionary, text)?,
                None => objects::probe(&mut master, text)?,
            });
        }
    }
    let asked: Vec<Asked> = asked.into_iter().flatten().collect();
    if args.file.is_some() && asked.len() > 1 {
        let why = "`--file` takes the value of one object; name one";
        return Err(Failure::Usage(why.into()));
    }
    let mut shown = Vec::new();
    for one in &asked {
        let object = (one.address, one.entry.as_ref());
        shown.push(match master.upload(one.address) {
            // The other objects may be read all the same.
            Err(Error::Protocol(why)) => Shown::new(dictionary, object, Err(NoValue::Fault(why))),
            read => {
                let read = Error::or_abort(read)?.map_err(NoValue::Abort);
                Shown::new(dictionary, object, read)
            }
        });
    }
    drop(master);
    bar.clear();
    if let (Some(path), [one]) = (&args.file, shown.as_slice())
        && let Ok((_, bytes)) = &one.result
    {
        output::write(path, bytes)?;
        return output::print(&match args.bus.format {
            Format::Text => {
                let count = crate::report::plural(bytes.len(), "byte");
                format!("{}: {count} written", path.display())
            }
            Format::Json => {
                let file = path.display().to_string();
                format!(
                    "{:#}",
                    serde_json::json!({ "file": file, "bytes": bytes.len() })
                )
            }
        });
    }
    output::print(&match args.bus.format {
        Format::Text => value::lines(&shown),
        Format::Json => value::json(args.node.raw(), &shown),
    })?;
    if shown
        .iter()
        .any(|one| one.result.is_err() && !one.has_no_data())
    {
        Err(Failure::Reported(1))
    } else {
        Ok(())
    }
}
