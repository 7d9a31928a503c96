//! `odkit network`: a project or a node list, its files and its report.

mod project;
mod table;
mod yaml;

use std::cell::{Cell, RefCell};
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use od_eds::fix::{self, Applicability};
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
    /// Apply safe fixes to FILE (its meaning does not change)
    #[arg(long)]
    fix: bool,
    /// Also apply unsafe fixes; review the result
    #[arg(long)]
    unsafe_fixes: bool,
}

pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    let path = Path::new(&args.file);
    let bytes = files::read(path).map_err(|error| {
        let why = read_error(&error);
        Failure::Failed(format!("{}: {why}", args.file))
    })?;
    let mut document = Document::new(bytes);
    if args.fix || args.unsafe_fixes {
        fix_all(args, &mut document)?;
    }
    let networks = Files::default().networks(&args.file, document.text(), &of_disk);
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

/// Applies the fixes of a network file, and writes it.
fn fix_all(args: &Args, document: &mut Document) -> Result<(), Failure> {
    let level = if args.unsafe_fixes {
        Applicability::Unsafe
    } else {
        Applicability::Safe
    };
    let config = Config::of(&args.file)?;
    let files = Files::default();
    let done = fix::fix(document, level, |document| {
        let mut findings = files.findings(&args.file, document.text(), &of_disk);
        config.apply(&args.file, &mut findings);
        findings
    });
    if done.edits > 0 {
        let failed = |why| Failure::Failed(format!("{}: {why}", args.file));
        files::rewrite(&args.file, done.document.bytes()).map_err(failed)?;
        let places = report::plural(done.edits, "place");
        output::note!("{places} fixed");
        *document = done.document;
    }
    Ok(())
}

/// Reads a file that a project or node list names.
pub(crate) type Open<'a> = &'a dyn Fn(&Path) -> Result<Vec<u8>, String>;

fn of_disk(path: &Path) -> Result<Vec<u8>, String> {
    files::read(path).map_err(|error| read_error(&error))
}

/// The results of a network.
struct Prepared {
    /// Names and bytes of the files to write.
    outputs: Vec<(String, Vec<u8>)>,
    findings: Vec<Finding>,
    bit_rate: Option<u32>,
    sync_period: u32,
}

/// Configures the nodes of a network, adds its master as a node, and checks it. The nodes of a network that is not complete are
/// not compared: the others may need those that are missing.
fn prepare(network: &mut Network, remote_pdo: bool) -> Prepared {
    let mut outputs = Vec::new();
    if !network.is_complete {
        return Prepared {
            outputs,
            findings: std::mem::take(&mut network.findings),
            bit_rate: None,
            sync_period: 0,
        };
    }
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
        let description = network::dcf(master, &network.nodes, remote_pdo);
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
    let rate = bit_rate.unwrap_or(1000);
    let mut findings = std::mem::take(&mut network.findings);
    findings.extend(network::check(&network.nodes, position, rate, sync_period));
    Prepared {
        outputs,
        findings,
        bit_rate,
        sync_period,
    }
}

/// Writes the files and the report of a network, which is in this text, and counts its errors.
fn one(
    args: &Args,
    text: &str,
    mut network: Network,
    folder: Option<&Path>,
) -> Result<usize, Failure> {
    let Prepared {
        outputs,
        mut findings,
        bit_rate,
        sync_period,
    } = prepare(&mut network, args.remote_pdo);
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
        if !outputs.is_empty() {
            fs::create_dir_all(folder).map_err(|error| {
                Failure::Failed(format!("{} cannot be written: {error}", folder.display()))
            })?;
        }
        let paths: Vec<_> = outputs.iter().map(|(name, _)| folder.join(name)).collect();
        let contents = outputs.iter().map(|(_, bytes)| bytes.as_slice());
        let all: Vec<(&Path, &[u8])> = paths.iter().map(PathBuf::as_path).zip(contents).collect();
        files::write(&all)?;
    }
    Config::of(&args.file)?.apply(&args.file, &mut findings);
    let colours = output::error_colours();
    let text = report::render(&args.file, text, &findings, &Names::new(), colours);
    output::note_coloured(&text);
    if network.is_complete {
        output::print(&table::table(&network, bit_rate, sync_period, &outputs))?;
    }
    Ok(findings
        .iter()
        .filter(|finding| Finding::is_error(finding))
        .count())
}

/// Limit of values in the files of all nodes together, which each node has for itself.
const MAX_VALUES: usize = 500_000;

/// The files that the nodes name, each read once: many nodes have the same, and fixes are tried with the same files.
#[derive(Default)]
pub(crate) struct Files {
    read: RefCell<BTreeMap<String, Result<Description, String>>>,
}

impl Files {
    /// Returns the findings about a project or node list with this text; `open` reads the files that it names.
    pub(crate) fn findings(&self, path: &str, text: &str, open: Open<'_>) -> Vec<Finding> {
        let networks = self.networks(path, text, open).into_iter();
        networks
            .flat_map(|mut network| prepare(&mut network, false).findings)
            .collect()
    }

    /// Reads the networks of a project or node list.
    fn networks(&self, path: &str, text: &str, open: Open<'_>) -> Vec<Network> {
        let path = Path::new(path);
        let folder = path.parent().unwrap_or(Path::new(""));
        let values = Cell::new(0);
        let load = |name: &str| self.load(folder, name, open, &values);
        let is_list = path
            .extension()
            .is_some_and(|ending| ending.eq_ignore_ascii_case("cpj"));
        if is_list {
            let lists = network::node_lists(text, &load);
            lists.into_iter().map(Network::from).collect()
        } else {
            vec![project::read(text, &load)]
        }
    }

    /// The description of a node; `values` counts those of all nodes.
    fn load(
        &self,
        folder: &Path,
        name: &str,
        open: Open<'_>,
        values: &Cell<usize>,
    ) -> Result<Description, String> {
        let mut read = self.read.borrow_mut();
        let found = read.entry(name.into());
        let description = found.or_insert_with(|| load(folder, name, open)).as_ref();
        let description = description.map_err(Clone::clone)?;
        values.set(values.get() + description.entries().count());
        if values.get() > MAX_VALUES {
            return Err(format!(
                "the files of all nodes have more than {MAX_VALUES} values; check the nodes in parts"
            ));
        }
        Ok(description.clone())
    }
}

/// Reads the description of a node. A relative path begins in the folder of the project, otherwise in the current folder.
fn load(folder: &Path, name: &str, open: Open<'_>) -> Result<Description, String> {
    let beside = folder.join(name);
    let path = if beside.exists() {
        beside
    } else {
        PathBuf::from(name)
    };
    let description = od_eds::parse(Document::new(open(&path)?).text()).description;
    if description.objects.is_empty() {
        Err("no object is defined; is it an EDS, DCF or XDD file?".into())
    } else {
        Ok(description)
    }
}
