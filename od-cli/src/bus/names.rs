//! Names and types of the nodes on a bus.

use od_bus::fault::Fault;
use od_bus::link::Link;
use od_bus::master::Master;
use od_devices::DEVICES;
use od_eds::Tables;
use od_model::{Address, Dictionary};
use od_runtime::NodeId;

use crate::failure::Failure;
use crate::source::{self, Source};

/// Files of `--eds`.
pub(crate) struct Names(Vec<File>);

struct File {
    /// The node that it is of; `None`: any that it fits.
    node: Option<NodeId>,
    source: Source,
    tables: Tables,
}

/// How well a dictionary fits a node by 1018h.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub(crate) enum Fit {
    /// Vendor-ID and product code.
    Product,
    /// The revision number, too.
    Revision,
}

impl Names {
    /// Reads `[ID=]FILE`.
    pub(crate) fn read(texts: &[String]) -> Result<Self, Failure> {
        let mut files = Vec::new();
        for text in texts {
            let named = text.split_once('=');
            let named = named.and_then(|(id, path)| Some((source::node_id(id).ok()?, path)));
            let (node, path) = match named {
                Some((node, path)) => (Some(node), path),
                None => (None, text.as_str()),
            };
            let source = Source::find(path)?;
            let tables = Tables::new(&source.parse()?.description);
            files.push(File {
                node,
                source,
                tables,
            });
        }
        Ok(Self(files))
    }

    /// The dictionary that is known without asking the node: the file of its ID, or the only file.
    pub(crate) fn given(&self, node: NodeId) -> Option<Dictionary<'_>> {
        let own = self.0.iter().find(|file| file.node == Some(node));
        let only = || match self.0.as_slice() {
            [file] if file.node.is_none() => Some(file),
            _ => None,
        };
        own.or_else(only).map(|file| file.tables.dictionary())
    }

    /// The dictionary of a node: the file given for it, else the file or built-in device that its
    /// identity (1018h) fits.
    pub(crate) fn of<L: Link>(
        &self,
        master: &mut Master<L>,
    ) -> Result<Option<Dictionary<'_>>, Fault> {
        if let Some(dictionary) = self.given(master.node()) {
            return Ok(Some(dictionary));
        }
        let mut identity = [None; 4];
        for (part, sub) in identity.iter_mut().zip(1..=3) {
            // A node without 1018h has no names, and one that is silent says so with the first.
            let read = master.upload(Address::new(0x1018, sub))?;
            let bytes = read.ok().and_then(|bytes| bytes.as_slice().try_into().ok());
            *part = bytes.map(u32::from_le_bytes);
            if part.is_none() {
                break;
            }
        }
        Ok(self.fitting(master.node(), identity).map(|(_, fit)| fit))
    }

    /// What fits an identity best: its name and its dictionary.
    pub(crate) fn fitting(
        &self,
        node: NodeId,
        identity: [Option<u32>; 4],
    ) -> Option<(&str, Dictionary<'_>)> {
        let files = self
            .0
            .iter()
            .filter(|file| file.node.is_none_or(|one| one == node));
        let files = files.map(|file| (file.source.path.as_str(), file.tables.dictionary()));
        let known = DEVICES.iter().map(|kind| (kind.name, kind.dictionary));
        let mut best = None;
        for (name, dictionary) in files.chain(known) {
            let fit = fit(dictionary, identity);
            if fit > best.and_then(|(fit, _, _)| fit) {
                best = Some((fit, name, dictionary));
            }
        }
        best.map(|(_, name, dictionary)| (name, dictionary))
    }
}

/// How well a dictionary fits; `None`: not at all.
pub(crate) fn fit(dictionary: Dictionary<'_>, identity: [Option<u32>; 4]) -> Option<Fit> {
    let default = |sub| {
        let entry = dictionary.entry(0x1018, sub)?;
        entry.default.integer(0)
    };
    let [vendor, product, revision, _] = identity.map(|part| part.map(i128::from));
    let is_product = vendor.is_some() && vendor == default(1) && product == default(2);
    match is_product {
        false => None,
        true if revision.is_some() && revision == default(3) => Some(Fit::Revision),
        true => Some(Fit::Product),
    }
}
