//! `odkit network`: a project or a node list, its files and its report.

mod project;
mod table;
mod yaml;

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use od_eds::network::{self, Node};
use od_eds::{Description, Document, Finding};
use od_model::{Visible, is_hidden};

use crate::config::Config;
use crate::failure::{Failure, read_error};
use crate::network::project::Network;
use crate::report::{self, Names};
use crate::{files, output};

/// Check a network: concise DCF of each node, DCF of the master, clashes, bus load
#[derive(clap::Args)]
#[command(
    long_about = "Check a network: clashes, consumers without producers, heartbeat times, bus load\n\n\
    FILE is a project of dcfgen (YAML, dcf-tools), also with the `nodes` and `defaults` of ros2_canopen, or a node list (nodelist.cpj, CiA 306-3). With `-o` \
    odkit writes the concise DCF of each node (NAME.bin, 1F22h) and, for a project, master.dcf and \
    master.bin. Exit code 1 if an error is found."
)]
pub(crate) struct Args {
    /// Project (.yml, .yaml) or node list (.cpj)
    #[arg(value_name = "FILE")]
    file: String,
    /// Folder for the output files [default: no files are written]
    #[arg(long, short, value_name = "DIR")]
    output: Option<PathBuf>,
    /// Add the PDOs of the nodes to master.dcf (5800h to 5FFFh), for drivers of Lely core and ros2_canopen
    #[arg(long, short)]
    remote_pdo: bool,
}

pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    let path = Path::new(&args.file);
    let bytes = files::read(path).map_err(|error| {
        let why = read_error(&error);
        Failure::Failed(format!("{}: {why}", args.file))
    })?;
    let document = Document::new(bytes);
    let folder = path.parent().unwrap_or(Path::new(""));
    let known = RefCell::new(Files::default());
    let load = |name: &str| known.borrow_mut().load(folder, name);
    let is_list = path
        .extension()
        .is_some_and(|ending| ending.eq_ignore_ascii_case("cpj"));
    let networks = if is_list {
        network::node_lists(document.text(), &load)
            .map(|lists| lists.into_iter().map(Network::from).collect())
    } else {
        project::read(document.text(), &load).map(|network| vec![network])
    };
    let networks = networks.map_err(|why| Failure::Failed(format!("{}: {why}", args.file)))?;
    let several = networks.len() > 1;
    let mut errors = 0;
    for (number, network) in (1..).zip(networks) {
        let folder = match (&args.output, several) {
            (Some(folder), true) => Some(folder.join(format!("network{number}"))),
            (folder, _) => folder.clone(),
        };
        errors += one(args, document.text(), network, folder.as_deref())?;
    }
    match errors {
        0 => Ok(()),
        _ => Err(Failure::Reported(1)),
    }
}

/// Writes the files and the report of a network, which is in this text, and counts its errors.
fn one(
    args: &Args,
    text: &str,
    mut network: Network,
    folder: Option<&Path>,
) -> Result<usize, Failure> {
    let mut outputs = Vec::new();
    for node in &network.nodes {
        if !node.writes.is_empty() {
            outputs.push((format!("{}.bin", node.name), network::bytes(&node.writes)));
        }
    }
    for node in &mut network.nodes {
        node.apply();
    }
    let bit_rate = network
        .master
        .as_ref()
        .map(|master| master.bit_rate)
        .or(network.bit_rate);
    let mut position = None;
    let mut sync_period = 0;
    if let Some(master) = &network.master {
        let writes = network::writes(master, &network.nodes);
        if !writes.is_empty() {
            outputs.push(("master.bin".into(), network::bytes(&writes)));
        }
        let description = network::dcf(master, &network.nodes, args.remote_pdo);
        outputs.push((
            "master.dcf".into(),
            od_eds::canonical(&description).into_bytes(),
        ));
        sync_period = master.sync_period;
        position = Some(network.nodes.len());
        let mut own = Node::new("master".into(), master.node_id, description);
        own.writes = writes;
        (own.place, own.places) = std::mem::take(&mut network.master_places);
        network.nodes.push(own);
    }
    if let Some(folder) = folder {
        for (name, _) in &outputs {
            // A name in the file must not lead out of the folder.
            if name.contains(['/', '\\']) || name.contains(is_hidden) {
                let name = Visible(name);
                return Err(Failure::Failed(format!(
                    "`{name}` is not valid as the name of a file"
                )));
            }
            files::claim(&folder.join(name))?;
        }
        for (name, bytes) in &outputs {
            fs::create_dir_all(folder).map_err(|error| {
                Failure::Failed(format!("{} cannot be written: {error}", folder.display()))
            })?;
            output::write(&folder.join(name), bytes)?;
        }
    }
    let rate = bit_rate.unwrap_or(1000);
    let mut findings = std::mem::take(&mut network.findings);
    findings.extend(network::check(&network.nodes, position, rate, sync_period));
    Config::of(&args.file)?.apply(&args.file, &mut findings);
    let colours = output::error_colours();
    let text = report::render(&args.file, text, &findings, &Names::new(), colours);
    output::note_coloured(&text);
    output::print(&table::table(&network, bit_rate, sync_period, &outputs))?;
    Ok(findings
        .iter()
        .filter(|finding| Finding::is_error(finding))
        .count())
}

/// Limit of values in the files of all nodes together, which each node has for itself.
const MAX_VALUES: usize = 500_000;

/// The files that the nodes name; many nodes have the same.
#[derive(Default)]
struct Files {
    read: BTreeMap<String, Result<Description, String>>,
    values: usize,
}

impl Files {
    /// The description of a node.
    fn load(&mut self, folder: &Path, name: &str) -> Result<Description, String> {
        let found = self.read.entry(name.into());
        let description = found.or_insert_with(|| load(folder, name)).as_ref();
        let description = description.map_err(Clone::clone)?;
        self.values += description.entries().count();
        if self.values > MAX_VALUES {
            return Err(format!(
                "the files of all nodes have more than {MAX_VALUES} values; check the nodes in parts"
            ));
        }
        Ok(description.clone())
    }
}

/// Reads the description of a node. A relative path begins in the folder of the project, otherwise in the current folder.
fn load(folder: &Path, name: &str) -> Result<Description, String> {
    let beside = folder.join(name);
    let path = if beside.exists() {
        beside
    } else {
        PathBuf::from(name)
    };
    let bytes = files::read(&path).map_err(|error| read_error(&error))?;
    let description = od_eds::parse(Document::new(bytes).text()).description;
    if description.objects.is_empty() {
        Err("no object is defined; is it an EDS, DCF or XDD file?".into())
    } else {
        Ok(description)
    }
}
