//! The list of the master: which slaves it boots, what it expects of them, and what it writes to them.

use std::format;
use std::prelude::v1::*;

use od_model::Address;
use od_wire::NodeId;

use crate::grammar::duration::duration;

/// Limit of downloads in the list of one slave.
pub(crate) const MOST_DOWNLOADS: usize = 1000;
/// Boot time without another order, in microseconds.
const BOOT_TIME: u64 = 2_000_000;

/// One entry of a configuration: the value of an object.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Download {
    /// The object.
    pub address: Address,
    /// The value as it is on the bus.
    pub bytes: Vec<u8>,
}

/// A line of the list, or what to do with it.
#[derive(Clone, PartialEq, Eq, Debug)]
pub enum Order {
    /// The node is in the network list (1F81h, bit 0).
    Slave(NodeId),
    /// Expected value of 1000h or of 1018h:01 to 04 (1F84h to 1F88h); 0: any value.
    Expect(NodeId, Address, u32),
    /// One more object to write (1F22h).
    Write(NodeId, Download),
    /// All objects to write, in the place of those so far (1F22h).
    Configuration(NodeId, Vec<Download>),
    /// Heartbeat consumer time in microseconds (1016h); 0: the heartbeat is not watched.
    Heartbeat(NodeId, u64),
    /// Longest time until the boot-up message, in microseconds (1F89h).
    BootTime(u64),
    /// SYNC period in microseconds (1006h); 0: no SYNC.
    Sync(u64),
    /// Boots a node, or all nodes of the network list.
    Boot(Option<NodeId>),
    /// Takes over a node that was started before: it is not booted again until it starts again or is lost.
    Adopt(NodeId),
    /// Forgets what the list says of a node; `None`: the whole list, and ends all work.
    Clear(Option<NodeId>),
}

/// Settings of one node in the list.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Slave {
    /// The node.
    pub node: NodeId,
    /// It is in the network list (1F81h, bit 0).
    pub is_listed: bool,
    /// Expected device type (1F84h); 0: any.
    pub device_type: u32,
    /// Expected vendor-ID, product code, revision number and serial number (1F85h to 1F88h); 0: any.
    pub identity: [u32; 4],
    /// Values to write to it, in this order (1F22h).
    pub downloads: Vec<Download>,
    /// Heartbeat consumer time in microseconds (1016h); 0: it is not watched.
    pub heartbeat: u64,
}

/// The list.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Plan {
    /// The nodes in the order of their first lines.
    pub slaves: Vec<Slave>,
    /// Longest time until the boot-up message, in microseconds (1F89h).
    pub boot_time: u64,
    /// SYNC period in microseconds (1006h); 0: no SYNC.
    pub sync: u64,
}

impl Default for Plan {
    fn default() -> Self {
        Self {
            slaves: Vec::new(),
            boot_time: BOOT_TIME,
            sync: 0,
        }
    }
}

impl Plan {
    /// Settings of a node in the list.
    pub fn slave(&self, node: NodeId) -> Option<&Slave> {
        self.slaves.iter().find(|slave| slave.node == node)
    }

    /// The list as lines of a script, without `master` before each.
    pub fn lines(&self) -> Vec<String> {
        let mut lines = Vec::new();
        for slave in &self.slaves {
            slave.add_lines(&mut lines);
        }
        if self.boot_time != BOOT_TIME {
            lines.push(format!("boot-time {}", duration(self.boot_time)));
        }
        if self.sync > 0 {
            lines.push(format!("sync {}", duration(self.sync)));
        }
        lines
    }

    /// Adds a line.
    pub(super) fn add(&mut self, order: &Order) {
        match order {
            Order::Slave(node) => self.at(*node).is_listed = true,
            Order::Expect(node, address, value) => {
                let slave = self.at(*node);
                match address.sub {
                    _ if address.index == 0x1000 => slave.device_type = *value,
                    sub => {
                        let place = usize::from(sub).checked_sub(1);
                        if let Some(field) = place.and_then(|at| slave.identity.get_mut(at)) {
                            *field = *value;
                        }
                    }
                }
            }
            Order::Write(node, download) => {
                let downloads = &mut self.at(*node).downloads;
                if downloads.len() < MOST_DOWNLOADS {
                    downloads.push(download.clone());
                }
            }
            Order::Configuration(node, downloads) => self.at(*node).downloads.clone_from(downloads),
            Order::Heartbeat(node, micros) => self.at(*node).heartbeat = *micros,
            Order::BootTime(micros) => self.boot_time = *micros,
            Order::Sync(micros) => self.sync = *micros,
            Order::Clear(Some(node)) => self.slaves.retain(|slave| slave.node != *node),
            Order::Boot(_) | Order::Adopt(_) | Order::Clear(None) => {}
        }
    }

    fn at(&mut self, node: NodeId) -> &mut Slave {
        let at = self.slaves.iter().position(|slave| slave.node == node);
        let at = at.unwrap_or_else(|| {
            self.slaves.push(Slave {
                node,
                is_listed: false,
                device_type: 0,
                identity: [0; 4],
                downloads: Vec::new(),
                heartbeat: 0,
            });
            self.slaves.len() - 1
        });
        &mut self.slaves[at]
    }
}

impl Slave {
    fn add_lines(&self, lines: &mut Vec<String>) {
        let node = self.node;
        if self.is_listed {
            lines.push(format!("slave {node}"));
        }
        let mut expect = |object: String, value: u32| {
            if value != 0 {
                lines.push(format!("expect {node} {object} = 0x{value:X}"));
            }
        };
        expect("1000h".into(), self.device_type);
        for (sub, value) in (1..).zip(self.identity) {
            expect(format!("1018h:{sub:02}"), value);
        }
        let writes: Option<Vec<String>> = self.downloads.iter().map(Download::line).collect();
        match writes {
            Some(writes) => {
                lines.extend(writes.iter().map(|line| format!("write {node} {line}")));
            }
            None => {
                let bytes = concise(&self.downloads);
                let bytes: Vec<String> = bytes.iter().map(|byte| format!("{byte:02X}")).collect();
                lines.push(format!("dcf {node} [{}]", bytes.join(" ")));
            }
        }
        if self.heartbeat > 0 {
            lines.push(format!("heartbeat {node} {}", duration(self.heartbeat)));
        }
    }
}

impl Download {
    /// `1017h = 0x64 as u16`; `None`: no integer has this length.
    fn line(&self) -> Option<String> {
        let bits = match self.bytes.len() {
            len @ (1 | 2 | 4 | 8) => len * 8,
            _ => return None,
        };
        let value = self
            .bytes
            .iter()
            .rev()
            .fold(0u64, |value, byte| value << 8 | u64::from(*byte));
        Some(format!("{} = 0x{value:X} as u{bits}", self.object()))
    }

    /// The object in words; one without sub-indices is only its index.
    pub fn object(&self) -> String {
        match self.address.sub {
            0 => format!("{:04X}h", self.address.index),
            _ => format!("{}", self.address),
        }
    }
}

/// Returns a configuration as a concise DCF, the content of 1F22h (CiA 302-3): the number of entries, then for each its
/// index, sub-index, length and bytes, low byte first.
pub fn concise(downloads: &[Download]) -> Vec<u8> {
    let mut all = Vec::from((downloads.len() as u32).to_le_bytes());
    for Download { address, bytes } in downloads {
        all.extend(address.index.to_le_bytes());
        all.push(address.sub);
        all.extend((bytes.len() as u32).to_le_bytes());
        all.extend(bytes);
    }
    all
}

/// Reads a concise DCF.
///
/// # Errors
/// A sentence with the entry that is not complete, or that the limit of entries is exceeded.
pub fn from_concise(bytes: &[u8]) -> Result<Vec<Download>, String> {
    let short = |entry: usize| format!("the concise DCF ends within entry {entry}");
    let Some((count, mut rest)) = bytes.split_first_chunk::<4>() else {
        return Err("a concise DCF begins with the number of its entries in 4 bytes".into());
    };
    let count = u32::from_le_bytes(*count) as usize;
    if count > MOST_DOWNLOADS {
        return Err(format!(
            "the limit is {MOST_DOWNLOADS} entries, not {count}"
        ));
    }
    let mut downloads = Vec::new();
    for entry in 1..=count {
        let Some((&[low, high, sub, a, b, c, d], after)) = rest.split_first_chunk::<7>() else {
            return Err(short(entry));
        };
        let len = u32::from_le_bytes([a, b, c, d]) as usize;
        let Some((value, after)) = after.split_at_checked(len) else {
            return Err(short(entry));
        };
        downloads.push(Download {
            address: Address::new(u16::from_le_bytes([low, high]), sub),
            bytes: value.to_vec(),
        });
        rest = after;
    }
    if rest.is_empty() {
        Ok(downloads)
    } else {
        let bytes = if rest.len() == 1 {
            "byte follows"
        } else {
            "bytes follow"
        };
        Err(format!(
            "{} {bytes} the last entry of the concise DCF",
            rest.len()
        ))
    }
}
