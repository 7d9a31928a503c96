//! `odkit lss`: node IDs and bit rates by the layer setting services (CiA 305).

mod wizard;

use od_client::lss::Identity;
use od_model::{Address, values};
use od_runtime::NodeId;
use od_tools::Error;
use od_tools::lss::{Lss, Slaves};
use od_tools::master::Master;
use od_tools::scan::ScanTimes;
use od_wire::Duration;
use serde_json::json;

use crate::bus::{self, Bus, Format};
use crate::failure::Failure;
use crate::output::{self, note};
use crate::report::plural;
use crate::source;

/// Find, number and set up LSS slaves: node IDs and bit rates
#[derive(clap::Args)]
pub(crate) struct Args {
    #[command(subcommand)]
    what: What,
}

#[derive(clap::Subcommand)]
enum What {
    /// Find the slaves without a node ID, by fastscan
    Scan {
        #[command(flatten)]
        bus: bus::Args,
    },
    /// Give a node ID to one slave, or to all that have none, one after the other
    ///
    /// Without NODE a wizard asks for the node ID of each slave without one, and names the serial
    /// number of the device that it asks about.
    Set {
        /// Node ID for the slave [default: the wizard asks]
        #[arg(value_name = "NODE", value_parser = source::node_id)]
        node: Option<NodeId>,
        #[command(flatten)]
        slave: Slave,
        /// Wizard: accept the proposed node IDs without asking
        #[arg(long, conflicts_with = "node")]
        yes: bool,
        /// Wizard: first node ID that is proposed
        #[arg(long, value_name = "ID", default_value = "1", value_parser = source::node_id)]
        first: NodeId,
        /// Do not store the node ID; it is lost with the power
        #[arg(long)]
        no_store: bool,
        #[command(flatten)]
        bus: bus::Args,
    },
    /// Set the bit rate of one slave, or of all
    Bitrate {
        /// Bit rate in kbit/s: 10, 20, 50, 125, 250, 500, 800 or 1000
        #[arg(value_name = "KBIT")]
        kbit: u16,
        #[command(flatten)]
        slave: Slave,
        /// Do not store the bit rate; it is lost with the power
        #[arg(long)]
        no_store: bool,
        /// Switch all slaves on the bus to the new bit rate, after this time in ms
        #[arg(long, value_name = "MS", num_args = 0..=1, default_missing_value = "1000")]
        activate: Option<u16>,
        #[command(flatten)]
        bus: bus::Args,
    },
    /// Ask a slave for its LSS address and its node ID
    ///
    /// Without an option the slave has to be the only one on the bus.
    Inquire {
        #[command(flatten)]
        slave: Slave,
        #[command(flatten)]
        bus: bus::Args,
    },
    /// Store node ID and bit rate in one slave, or in all
    Store {
        #[command(flatten)]
        slave: Slave,
        #[command(flatten)]
        bus: bus::Args,
    },
}

/// The slave that a service addresses.
#[derive(clap::Args)]
struct Slave {
    /// The slave that has this node ID
    #[arg(long, value_name = "ID", value_parser = source::node_id, conflicts_with_all = ["serial", "address"])]
    of: Option<NodeId>,
    /// The slave without a node ID that has this serial number
    #[arg(long, value_name = "NUMBER", value_parser = serial, conflicts_with = "address")]
    serial: Option<u32>,
    /// The slave with this LSS address: vendor-ID, product code, revision number, serial number
    #[arg(long, value_name = "V:P:R:S", value_parser = address)]
    address: Option<Identity>,
}

fn serial(text: &str) -> Result<u32, String> {
    let number = values::integer(text).and_then(|value| u32::try_from(value).ok());
    number.ok_or_else(|| "write a number of at most 32 bits, such as 4712 or 0x1268".into())
}

fn address(text: &str) -> Result<Identity, String> {
    let parts: Result<Vec<u32>, String> = text.split(':').map(serial).collect();
    let parts: Result<[u32; 4], _> = parts?.try_into();
    parts
        .map(Identity::new)
        .map_err(|_| "write four numbers, such as 0xEC:0xA:0x10000:4712".into())
}

impl Slave {
    /// Finds the slave; `None` if none was named.
    fn find(&self, bus: &mut Bus) -> Result<Option<Identity>, Failure> {
        if let Some(node) = self.of {
            let mut master = Master::new(bus, node);
            let mut parts = [0; 4];
            for (part, sub) in parts.iter_mut().zip(1..) {
                let read = Error::or_abort(master.upload(Address::new(0x1018, sub)))?;
                let bytes = read.ok().and_then(|bytes| bytes.as_slice().try_into().ok());
                *part = bytes.map(u32::from_le_bytes).ok_or_else(|| {
                    let why = "has no LSS address: 1018h lacks a number";
                    Failure::Failed(format!("node {} {why}", node.raw()))
                })?;
            }
            return Ok(Some(Identity::new(parts)));
        }
        let Some(serial) = self.serial else {
            return Ok(self.address);
        };
        let found = Lss::new(bus).scan(|_| {})?;
        let mut found = found.into_iter().filter(|one| one.serial == serial);
        match (found.next(), found.next()) {
            (Some(one), None) => Ok(Some(one)),
            (Some(_), Some(_)) => Err(Failure::Failed(format!(
                "several LSS slaves have the serial number {serial}; name one with `--address`"
            ))),
            (None, _) => Err(Failure::Failed(format!(
                "no LSS slave without a node ID has the serial number {serial}; `odkit lss scan` lists \
                 them"
            ))),
        }
    }

    fn slaves(&self, bus: &mut Bus) -> Result<Slaves, Failure> {
        Ok(self.find(bus)?.map_or(Slaves::All, Slaves::One))
    }
}

pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    match &args.what {
        What::Scan { bus } => scan(bus),
        What::Set {
            node: Some(node),
            slave,
            no_store,
            bus,
            ..
        } => set(*node, slave, !no_store, bus),
        What::Set {
            slave: Slave { of: Some(_), .. },
            ..
        } => Err(Failure::Usage(
            "`--of` needs the new node ID, such as `odkit lss set 7 --of 5`".into(),
        )),
        What::Set {
            yes,
            first,
            no_store,
            bus,
            ..
        } => wizard::run(bus, *first, *yes, !no_store),
        What::Bitrate {
            kbit,
            slave,
            no_store,
            activate,
            bus,
        } => bit_rate(*kbit, slave, (!no_store, *activate), bus),
        What::Inquire { slave, bus } => inquire(slave, bus),
        What::Store { slave, bus } => {
            let mut link = bus.open()?;
            let slaves = slave.slaves(&mut link)?;
            Lss::new(link).store(slaves)?;
            say(bus.format, &format!("{} stored", who(slaves)))
        }
    }
}

fn scan(args: &bus::Args) -> Result<(), Failure> {
    let names = args.names()?;
    let mut lss = Lss::new(args.open()?);
    let is_text = args.format == Format::Text;
    let found = lss.scan(|one| {
        if is_text {
            // Each search takes seconds, so each slave is printed at once.
            let _ = output::print(&names.slave_title(one));
        }
    })?;
    drop(lss);
    if found.is_empty() {
        note_configured(args)?;
    }
    if is_text {
        let count = plural(found.len(), "LSS slave");
        output::print(&format!("{count} without a node ID"))?;
    } else {
        let slaves = found.iter().map(|one| {
            json!({
                "vendor_id": one.vendor,
                "product_code": one.product,
                "revision_number": one.revision,
                "serial_number": one.serial,
                "fits": names.of_slave(one),
            })
        });
        let report = json!({ "slaves": slaves.collect::<Vec<_>>() });
        output::print(&format!("{report:#}"))?;
    }
    if found.is_empty() {
        Err(Failure::Reported(1))
    } else {
        Ok(())
    }
}

/// Names the nodes that have a node ID: they take no part in a fastscan.
fn note_configured(args: &bus::Args) -> Result<(), Failure> {
    let times = ScanTimes {
        listen: Duration::ZERO,
        ..ScanTimes::default()
    };
    let scan = od_tools::scan::scan(&mut args.open()?, times, |_| {})?;
    let nodes: Vec<String> = scan.nodes.iter().map(|one| one.node.to_string()).collect();
    if let Some(first) = nodes.first() {
        note!(
            "{} with a node ID on the bus ({}); such a node does not respond to a fastscan: `odkit scan` \
             shows it, `odkit lss set 12 --of {first}` changes its node ID",
            plural(nodes.len(), "node"),
            nodes.join(", ")
        );
    }
    Ok(())
}

fn inquire(slave: &Slave, args: &bus::Args) -> Result<(), Failure> {
    let names = args.names()?;
    let mut link = args.open()?;
    let slaves = slave.slaves(&mut link)?;
    let (identity, node) = Lss::new(link).inquire(slaves)?;
    output::print(&match args.format {
        Format::Text => match node {
            Some(node) => format!("node {node}  {}", names.slave_title(&identity)),
            None => format!("without a node ID  {}", names.slave_title(&identity)),
        },
        Format::Json => format!(
            "{:#}",
            json!({
                "node": node.map(NodeId::raw),
                "vendor_id": identity.vendor,
                "product_code": identity.product,
                "revision_number": identity.revision,
                "serial_number": identity.serial,
                "fits": names.of_slave(&identity),
            })
        ),
    })
}

fn set(node: NodeId, slave: &Slave, store: bool, args: &bus::Args) -> Result<(), Failure> {
    let mut link = args.open()?;
    let identity = match slave.find(&mut link)? {
        Some(identity) => identity,
        None => {
            let found = Lss::new(&mut link).scan(|_| {})?;
            match found.as_slice() {
                [one] => *one,
                [] => {
                    let why = "no LSS slave without a node ID is on the bus; name one with `--of`";
                    return Err(Failure::Failed(why.into()));
                }
                several => {
                    let serials = several.iter().map(|one| one.serial.to_string());
                    return Err(Failure::Failed(format!(
                        "{} LSS slaves have no node ID; name one with `--serial`: {}",
                        several.len(),
                        serials.collect::<Vec<_>>().join(", ")
                    )));
                }
            }
        }
    };
    let has_booted = Lss::new(link).set_node_id(identity, node, store)?;
    let serial = identity.serial;
    let node = node.raw();
    say(
        args.format,
        &match (has_booted, slave.of) {
            (true, _) => format!("node {node} boots: serial number {serial}"),
            (false, Some(before)) => format!(
                "serial number {serial} takes node ID {node} with its next reset: `odkit nmt {} \
                 reset-comm`",
                before.raw()
            ),
            (false, None) => format!(
                "serial number {serial} has node ID {node}, but no boot-up message came; switch its \
                 power off and on"
            ),
        },
    )
}

fn bit_rate(
    kbit: u16,
    slave: &Slave,
    (store, activate): (bool, Option<u16>),
    args: &bus::Args,
) -> Result<(), Failure> {
    let mut link = args.open()?;
    let slaves = slave.slaves(&mut link)?;
    // Slaves that change the bit rate no longer receive frames at the old one.
    Lss::new(link).set_bit_rate(slaves, kbit, store, activate)?;
    let who = who(slaves);
    say(
        args.format,
        &match activate {
            Some(delay) => format!(
                "{who} at {kbit} kbit/s in {delay} ms, and silent as long again; continue with \
                 `--bit-rate {kbit}`"
            ),
            None => format!("{who} at {kbit} kbit/s after the next power-on"),
        },
    )
}

fn who(slaves: Slaves) -> String {
    match slaves {
        Slaves::One(one) => format!("serial number {}:", one.serial),
        Slaves::All => "all LSS slaves:".into(),
    }
}

fn say(format: Format, text: &str) -> Result<(), Failure> {
    output::print(&match format {
        Format::Text => text.to_owned(),
        Format::Json => format!("{:#}", json!({ "done": true, "message": text })),
    })
}
