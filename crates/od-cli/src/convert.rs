//! `odkit convert`: a device description in another format.

use std::path::{Path, PathBuf};

use od_devices::text::datasheet;
use od_eds::convert::{c_header, canopennode, dbc, dcf, json, markdown};
use od_eds::{Description, Tables, xdd};
use od_runtime::NodeId;

use crate::failure::Failure;
use crate::output;
use crate::source::{self, Lost, Source};

/// Convert a device description: EDS, DCF, XDD, Markdown, C header, CANopenNode, DBC, JSON
#[derive(clap::Args)]
pub(crate) struct Args {
    /// Built-in device, or EDS or DCF file
    #[arg(value_name = "DEVICE|FILE")]
    input: String,
    /// Target format [default: by the extension of the output file]
    #[arg(long, value_enum, required_unless_present = "output")]
    to: Option<Form>,
    /// Output file [default: standard output]
    #[arg(long, short, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Node ID of the device (DCF and DBC; OD.c, if it is for one device)
    #[arg(long, value_name = "ID", value_parser = source::node_id)]
    node_id: Option<NodeId>,
    /// Bit rate of the configured device in kbit/s (DCF only)
    #[arg(long, value_name = "KBIT")]
    bit_rate: Option<u16>,
    /// Value of an object of the configured device (DCF only); may be repeated
    #[arg(long = "set", value_name = "OBJECT=VALUE")]
    values: Vec<String>,
    /// Accept that the target lacks objects of the source
    #[arg(long)]
    lossy: bool,
}

#[derive(Clone, Copy, PartialEq, Eq, Debug, clap::ValueEnum)]
enum Form {
    /// CiA 306 device description, in canonical form
    Eds,
    /// CiA 306 device configuration: EDS with node ID, bit rate and values of one device
    Dcf,
    /// CiA 311 device description in XML; an XDC if the input is a DCF
    #[value(alias = "xdc")]
    Xdd,
    /// Datasheet in Markdown
    Md,
    /// C header with a macro for each index, sub-index, default and limit
    #[value(alias = "h")]
    C,
    /// OD.c and OD.h of CANopenNode 4; needs `-o OD.c`
    #[value(name = "canopennode")]
    CanopenNode,
    /// Frames of a node for bus analysers: PDOs as mapped, EMCY, heartbeat, SDO, NMT
    Dbc,
    /// Everything as JSON (docs/odkit-dictionary-2.schema.json)
    Json,
}

impl Form {
    /// The format for a file extension.
    fn of(path: &Path) -> Option<Self> {
        let ending = path.extension()?.to_str()?.to_ascii_lowercase();
        match ending.as_str() {
            "eds" => Some(Self::Eds),
            "dcf" => Some(Self::Dcf),
            "xdd" | "xdc" => Some(Self::Xdd),
            "md" => Some(Self::Md),
            "h" => Some(Self::C),
            "dbc" => Some(Self::Dbc),
            "json" => Some(Self::Json),
            _ => None,
        }
    }
}

pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    let form = args
        .to
        .or_else(|| Form::of(args.output.as_deref()?))
        .ok_or_else(|| {
            Failure::Usage(
                "the target format is missing; add `--to eds`, dcf, xdd, md, c, canopennode, dbc or json".into(),
            )
        })?;
    if form != Form::Dcf && (args.bit_rate.is_some() || !args.values.is_empty()) {
        return Err(Failure::Usage(
            "`--bit-rate` and `--set` need `--to dcf`".into(),
        ));
    }
    if !matches!(form, Form::Dcf | Form::CanopenNode | Form::Dbc) && args.node_id.is_some() {
        return Err(Failure::Usage(
            "`--node-id` needs `--to dcf`, dbc or canopennode".into(),
        ));
    }
    let source = Source::find(&args.input)?;
    // A datasheet and C variables need the type of each value.
    let typed = matches!(form, Form::Md | Form::CanopenNode);
    let (mut description, mut lost) = source.complete(typed)?;
    if form == Form::Dcf {
        configure(&mut description, args)?;
    }
    if form == Form::CanopenNode {
        return canopen_node(args, &source, &description, lost);
    }
    let text = match form {
        Form::Eds | Form::Dcf => od_eds::canonical(&description),
        Form::Xdd => xdd::write(&description),
        Form::Md => match source.kind {
            Some(kind) => datasheet::page(kind),
            None => markdown::page(&args.input, Tables::new(&description).dictionary()),
        },
        Form::C => {
            let stem = Path::new(&args.input).file_stem();
            let stem = stem.and_then(|stem| stem.to_str()).unwrap_or("device");
            c_header::write(&description, stem, &args.input)
        }
        // Written above, as two files.
        Form::CanopenNode => return Ok(()),
        Form::Dbc => {
            let commissioned = description.commissioned_node_id();
            let node_id = args.node_id.map(NodeId::raw).or(commissioned);
            let (text, findings) = dbc::write(&description, node_id.unwrap_or(1));
            lost = source.unexpressed(&description, findings, lost)?;
            text
        }
        Form::Json => json::write(&description, &args.input),
    };
    output::save(args.output.as_deref(), &text)?;
    lost.judge(args.lossy)
}

/// Writes the two files of CANopenNode: the file of `-o`, and the header beside it.
fn canopen_node(
    args: &Args,
    source: &Source,
    description: &Description,
    lost: Lost,
) -> Result<(), Failure> {
    let output = args.output.as_deref();
    let stem = output.and_then(|path| path.file_stem()?.to_str());
    let (Some(output), Some(stem)) = (output, stem) else {
        return Err(Failure::Usage(
            "CANopenNode needs two files, OD.c and OD.h; add `-o OD.c`".into(),
        ));
    };
    let commissioned = description.commissioned_node_id();
    let node_id = args.node_id.map(NodeId::raw).or(commissioned);
    let files = canopennode::write(description, stem, &args.input, node_id);
    crate::files::write(&[
        (&output.with_extension("c"), files.source.as_bytes()),
        (&output.with_extension("h"), files.header.as_bytes()),
    ])?;
    let lost = source.unexpressed(description, files.findings, lost)?;
    lost.judge(args.lossy)
}

/// Node ID, bit rate and values of the arguments. Without an argument the value of the file stays.
fn configure(description: &mut Description, args: &Args) -> Result<(), Failure> {
    if let Some(node_id) = args.node_id {
        description.commission("NodeID", &node_id.raw().to_string());
    } else if description.commissioned_node_id().is_none() {
        return Err(Failure::Usage(
            "a DCF needs a node ID; add `--node-id 5`".into(),
        ));
    }
    if let Some(rate) = args.bit_rate {
        description.commission("Baudrate", &rate.to_string());
    }
    for setting in &args.values {
        let (object, text) = setting.split_once('=').ok_or_else(|| {
            Failure::Usage(format!(
                "`--set {setting}` has no value; write `--set 6001h=4096`"
            ))
        })?;
        dcf::set(description, object.trim(), text.trim())?;
    }
    Ok(())
}
