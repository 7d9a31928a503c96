//! Names and types of the nodes on a bus.

use od_client::lss::Identity;
use od_devices::DEVICES;
use od_eds::Tables;
use od_model::{Address, Dictionary};
use od_runtime::NodeId;
use od_sim::VirtualDevice;
use od_tools::Error;
use od_tools::link::Link;
use od_tools::master::Master;

use crate::failure::Failure;
use crate::source::{self, Source};

/// Files of `--eds`.
pub(crate) struct Names(Vec<File>);

struct File {
    /// The node ID that the file was given for; `None`: any node that matches.
    node: Option<NodeId>,
    /// The node ID in a DCF.
    commissioned: Option<NodeId>,
    source: Source,
    tables: Tables,
}

/// A dictionary of a node, with the name of its file or built-in device.
#[derive(Clone, Copy)]
pub(crate) struct Known<'n> {
    pub(crate) name: &'n str,
    pub(crate) dictionary: Dictionary<'n>,
}

/// Quality of a match between a dictionary and a node by 1018h.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub(crate) enum Fit {
    /// Vendor-ID and product code.
    Product,
    /// The revision number as well.
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
            let description = source.parse()?.description;
            let tables = Tables::new(&description);
            files.push(File {
                node,
                commissioned: description.commissioned_node_id().and_then(NodeId::new),
                source,
                tables,
            });
        }
        Ok(Self(files))
    }

    /// Returns the dictionary that is known without asking the node: the file for its ID, or the only file.
    pub(crate) fn given(&self, node: NodeId) -> Option<Known<'_>> {
        let own = self.0.iter().find(|file| file.node == Some(node));
        let only = || match self.0.as_slice() {
            [file] if file.node.is_none() => Some(file),
            _ => None,
        };
        own.or_else(only).map(File::known)
    }

    /// Returns the dictionary of a node: the file for its ID, else the file or built-in device that matches its
    /// identity (1018h).
    pub(crate) fn of<L: Link>(&self, master: &mut Master<L>) -> Result<Option<Known<'_>>, Error> {
        if let Some(known) = self.given(master.node()) {
            return Ok(Some(known));
        }
        let mut identity = [None; 4];
        for (part, sub) in identity.iter_mut().zip(1..=3) {
            // A node without 1018h has no names. A silent node is reported at the first read; one that responds to that
            // and not to the others has only its vendor.
            let read = match Error::or_abort(master.upload(Address::new(0x1018, sub))) {
                Err(Error::Node(_)) if sub > 1 => break,
                Err(Error::Protocol(_)) => break,
                read => read?,
            };
            let bytes = read.ok().and_then(|bytes| bytes.as_slice().try_into().ok());
            *part = bytes.map(u32::from_le_bytes);
            if part.is_none() {
                break;
            }
        }
        Ok(self.fitting(Some(master.node()), identity))
    }

    /// The dictionary that matches an identity best. Files for another node ID are ignored; if there is no identity, so are
    /// files for any node ID.
    pub(crate) fn fitting(
        &self,
        node: Option<NodeId>,
        identity: [Option<u32>; 4],
    ) -> Option<Known<'_>> {
        let files = self.0.iter();
        let files = files.filter(|file| file.node.is_none() || file.node == node);
        let built_in = DEVICES.iter().map(|kind| Known {
            name: kind.name,
            dictionary: kind.dictionary,
        });
        let mut best = None;
        for known in files.map(File::known).chain(built_in) {
            let fit = fit(known.dictionary, identity);
            if fit > best.and_then(|(fit, _)| fit) {
                best = Some((fit, known));
            }
        }
        best.map(|(_, known)| known)
    }

    /// The name of the file or built-in device that describes an LSS slave.
    pub(crate) fn of_slave(&self, slave: &Identity) -> Option<&str> {
        // A file for a node ID does not describe a slave without one.
        let identity = slave.parts().map(Some);
        self.fitting(None, identity).map(|known| known.name)
    }

    /// An LSS slave in one line: its LSS address, and what describes it.
    pub(crate) fn slave_title(&self, slave: &Identity) -> String {
        let known = self
            .of_slave(slave)
            .map_or(String::new(), |name| format!("  {name}"));
        format!(
            "serial number {:<10}  vendor-ID {:X}h, product code {:X}h, revision {:X}h{known}",
            slave.serial, slave.vendor, slave.product, slave.revision
        )
    }

    /// The nodes that files were given for, by their node ID or as a DCF.
    pub(crate) fn nodes(&self) -> impl Iterator<Item = NodeId> {
        self.0
            .iter()
            .filter_map(|file| file.node.or(file.commissioned))
    }

    /// A device without a bus that supplies the names of a node: from the file for this node, or for any.
    pub(crate) fn device(&self, node: NodeId) -> Result<Option<VirtualDevice>, Failure> {
        let own = |file: &&File| file.node.or(file.commissioned) == Some(node);
        let any = |file: &&File| file.node.or(file.commissioned).is_none();
        let file = self.0.iter().find(own).or_else(|| self.0.iter().find(any));
        let device = file.map(|file| file.source.device(Some(node)));
        device
            .transpose()
            .map_err(|why| Failure::Failed(why.into()))
    }
}

impl File {
    fn known(&self) -> Known<'_> {
        Known {
            name: &self.source.path,
            dictionary: self.tables.dictionary(),
        }
    }
}

/// Quality of a match; `None`: the dictionary does not match.
pub(crate) fn fit(dictionary: Dictionary<'_>, identity: [Option<u32>; 4]) -> Option<Fit> {
    let default = |sub| {
        let entry = dictionary.entry(0x1018, sub)?;
        entry.default.integer(0)
    };
    let [vendor, product, revision, _] = identity.map(|part| part.map(i128::from));
    let is_product = vendor.is_some() && vendor == default(1) && product == default(2);
    if !is_product {
        None
    } else if revision.is_some() && revision == default(3) {
        Some(Fit::Revision)
    } else {
        Some(Fit::Product)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use od_runtime::{Frame, Instant};
    use od_sim::bus::Bus;
    use od_tools::bench::OnBench;
    use od_tools::link::Heard;

    /// A node that does not respond to requests for 1018h:02.
    struct Deaf(OnBench<Bus>);

    impl Link for Deaf {
        fn now(&self) -> Instant {
            self.0.now()
        }

        fn send(&mut self, frame: &Frame) -> Result<(), Error> {
            if frame.data().starts_with(&[0x40, 0x18, 0x10, 2]) {
                return Ok(());
            }
            self.0.send(frame)
        }

        fn receive(&mut self, until: Instant) -> Result<Option<Heard>, Error> {
            self.0.receive(until)
        }
    }

    #[test]
    fn a_node_that_does_not_respond_to_a_part_of_1018h_can_be_read() {
        let mut bus = Bus::new();
        let number = bus.add(VirtualDevice::new(&DEVICES[0], NodeId::ONE));
        bus.start(number);
        let mut master = Master::new(Deaf(OnBench(bus)), NodeId::ONE);
        assert!(Names(Vec::new()).of(&mut master).is_ok());
        let refused = master.upload(Address::new(0x1018, 2));
        let text = refused.expect_err("no response").to_string();
        assert!(text.contains("to that for 1018h:02"), "{text}");
    }
}
