//! LSS master: finds slaves, and sets their node IDs and bit rates (CiA 305).

use od_client::lss::{Answer, Identity, Options, Task};
use od_client::{Client, Event, sdo, watch};
use od_wire::lss::Part;
use od_wire::nmt::State;
use od_wire::{CanId, Duration, Frame, Instant, NodeId, lss};

use crate::error::Error;
use crate::link::Link;

/// Maximum time to wait for a response; storing takes the longest.
const PATIENCE: Duration = Duration::from_secs(5);
/// Longest time until a slave with a new node ID boots.
const BOOT: Duration = Duration::from_secs(3);
/// Time in which a second slave would respond, in ms.
const SECOND: u64 = 50;
/// Times that a step of fastscan waits for a response, in ms. A missing response is a result, too,
/// so a late response makes the search wrong; it then begins again with the next time.
const PACES: [u64; 3] = [50, 200, 800];

/// Maximum number of slaves: one for each node ID.
const SLAVES: usize = 127;
/// Value of `bit` in the first request of a fastscan.
const BEGIN: u8 = 0x80;
/// Error text for a slave that fastscan cannot find.
const CONFIRMS_ALL: &str = "an LSS slave confirms each request of the fastscan, also with a vendor-ID that no device has; \
    connect the devices one after the other to find it";
/// Error text for slaves without end.
const TOO_MANY: &str = "the fastscan finds more than 127 LSS slaves; one of them shows another LSS address in each search";

/// An LSS master on a link. When it is dropped, it switches all slaves to LSS waiting state.
#[derive(Debug)]
pub struct Lss<L: Link> {
    link: L,
    client: Client,
}

/// The slaves that a service addresses.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Slaves {
    /// The slave with this LSS address.
    One(Identity),
    /// All slaves on the bus.
    All,
}

impl<L: Link> Lss<L> {
    /// A master on `link`.
    pub fn new(link: L) -> Self {
        Self {
            link,
            client: master(PACES[0]),
        }
    }

    /// Finds the slaves without a node ID by fastscan; `found` is called with each at once.
    ///
    /// If a response is late, the search begins again and waits longer. A search that found a late response
    /// ends with one more search that waits as long.
    ///
    /// # Errors
    /// The link is lost, a slave responds but never confirms its LSS address, or one confirms each request.
    pub fn scan(&mut self, mut found: impl FnMut(&Identity)) -> Result<Vec<Identity>, Error> {
        let mut told = Vec::new();
        let mut all = Vec::new();
        let mut paces = PACES.into_iter().peekable();
        while let Some(pace) = paces.next() {
            self.client = master(pace);
            if all.is_empty() {
                self.wait_all()?;
            }
            let spoilt = loop {
                match self.ask(Task::Fastscan)? {
                    Ok(Answer::Found(Some(identity))) => {
                        if self.confirms_another(identity, pace)? {
                            if paces.peek().is_some() {
                                break true;
                            }
                            return Err(Error::Node(CONFIRMS_ALL.into()));
                        }
                        if all.contains(&identity) {
                            return Err(Error::Node(twice(identity)));
                        }
                        if all.len() == SLAVES {
                            return Err(Error::Node(TOO_MANY.into()));
                        }
                        if !told.contains(&identity) {
                            found(&identity);
                            told.push(identity);
                        }
                        all.push(identity);
                    }
                    Err(od_client::Error::ScanFailed) if paces.peek().is_some() => break true,
                    Err(error) => return Err(Error::Node(words(Task::Fastscan, error))),
                    Ok(_) => break false,
                }
            };
            if spoilt {
                all.clear();
            } else if pace > PACES[0] {
                break;
            }
        }
        self.client = master(PACES[0]);
        self.wait_all()?;
        Ok(all)
    }

    /// Returns whether a slave confirms a vendor-ID that no slave has: the opposite of the one that was found. Such a slave
    /// confirms everything, and a fastscan would find LSS addresses without end.
    fn confirms_another(&mut self, found: Identity, pace: u64) -> Result<bool, Error> {
        let mut is_confirmed = false;
        for (number, bit) in [(0, BEGIN), (!found.vendor, 0)] {
            let (part, next) = (0, 0);
            let request = lss::Request::Fastscan {
                number,
                bit,
                part,
                next,
            };
            let id = CanId::standard(lss::MASTER);
            self.link.send(&Frame::full(id, request.emit()))?;
            // Slaves without a node ID respond to the first request.
            is_confirmed = false;
            let until = self.link.now().plus_millis(pace);
            while let Some(heard) = self.link.receive(until)? {
                is_confirmed |= heard.frame.id().as_standard() == Some(lss::SLAVE);
                if heard.at > until {
                    break;
                }
            }
        }
        Ok(is_confirmed)
    }

    /// Sets the node ID of a slave, stores it if `store`, and waits for the boot-up message. A slave that had a node ID
    /// before uses the new one after its next reset; the result is then `false`.
    ///
    /// # Errors
    /// No slave has the LSS address, the slave refuses, or the link is lost.
    pub fn set_node_id(
        &mut self,
        identity: Identity,
        node: NodeId,
        store: bool,
    ) -> Result<bool, Error> {
        self.select(Slaves::One(identity))?;
        self.run(Task::ConfigureNodeId(Some(node)))?;
        if store {
            self.run(Task::Store)?;
        }
        self.wait_all()?;
        let until = self.link.now() + BOOT;
        while let Some(heard) = self.link.receive(until)? {
            if watch::parse(&heard.frame) == Some((node, State::Initialising)) {
                return Ok(true);
            }
            if heard.at > until {
                break;
            }
        }
        Ok(false)
    }

    /// Sets the bit rate of these slaves in kbit/s, and stores it if `store`. With `activate` they change to it after
    /// this time and send nothing for the same time again; the caller changes the bit rate of the link.
    ///
    /// # Errors
    /// [`Error::Usage`] for a bit rate that CiA 301 does not define; a slave refuses, none responds, or
    /// the link is lost.
    pub fn set_bit_rate(
        &mut self,
        slaves: Slaves,
        kbit: u16,
        store: bool,
        activate: Option<u16>,
    ) -> Result<(), Error> {
        let mut table = 0..=8;
        let index = table.find(|index| lss::kbit(*index) == Some(kbit));
        let index = index.ok_or_else(|| {
            let rates = (0..=8).filter_map(lss::kbit);
            let rates: Vec<_> = rates.map(|rate| rate.to_string()).collect();
            let rates = rates.join(", ");
            Error::Usage(format!(
                "CiA 301 does not define {kbit} kbit/s; write one of {rates}"
            ))
        })?;
        self.select(slaves)?;
        self.run(Task::ConfigureBitTiming { table: 0, index })?;
        if store {
            self.run(Task::Store)?;
        }
        match activate {
            Some(delay_ms) => self.run(Task::ActivateBitTiming { delay_ms }).map(drop),
            None => self.wait_all(),
        }
    }

    /// Stores node ID and bit rate in these slaves.
    ///
    /// # Errors
    /// A slave refuses, none responds, or the link is lost.
    pub fn store(&mut self, slaves: Slaves) -> Result<(), Error> {
        self.select(slaves)?;
        self.run(Task::Store)?;
        self.wait_all()
    }

    /// Reads LSS address and node ID of a slave; `None` if it has no node ID.
    ///
    /// # Errors
    /// No slave responds, several do, or the link is lost.
    pub fn inquire(&mut self, slaves: Slaves) -> Result<(Identity, Option<NodeId>), Error> {
        self.select(slaves)?;
        let mut parts = [0; 4];
        for (number, part) in parts.iter_mut().zip(Part::ALL) {
            if let Answer::Number(answer) = self.only(Task::Inquire(part))? {
                *number = answer;
            }
        }
        let node = match self.only(Task::InquireNodeId)? {
            Answer::NodeId(node) => node,
            _ => None,
        };
        self.wait_all()?;
        Ok((Identity::new(parts), node))
    }

    /// Runs a service to which only one slave may respond.
    fn only(&mut self, task: Task) -> Result<Answer, Error> {
        let answer = self.run(task)?;
        let until = self.link.now().plus_millis(SECOND);
        while let Some(heard) = self.link.receive(until)? {
            if heard.frame.id().as_standard() == Some(lss::SLAVE) {
                return Err(Error::Node(
                    "several LSS slaves respond; name one with `--of`, `--serial` or `--address`"
                        .into(),
                ));
            }
            if heard.at > until {
                break;
            }
        }
        Ok(answer)
    }

    fn select(&mut self, slaves: Slaves) -> Result<(), Error> {
        self.wait_all()?;
        match slaves {
            Slaves::One(identity) => self.run(Task::SwitchSelective(identity)),
            Slaves::All => self.run(Task::SwitchGlobal {
                configuration: true,
            }),
        }
        .map(drop)
    }

    fn wait_all(&mut self) -> Result<(), Error> {
        let configuration = false;
        self.run(Task::SwitchGlobal { configuration }).map(drop)
    }

    /// Runs a service. It fails if one of several slaves refuses.
    fn run(&mut self, task: Task) -> Result<Answer, Error> {
        self.ask(task)?
            .map_err(|error| Error::Node(words(task, error)))
    }

    /// Runs a service: the inner result is that of the slaves, the outer one that of the link.
    fn ask(&mut self, task: Task) -> Result<Result<Answer, od_client::Error>, Error> {
        self.client.lss(task);
        let mut refused = None;
        loop {
            while let Some(frame) = self.client.poll_transmit(self.link.now()) {
                self.link.send(&frame)?;
            }
            if let Some(Event::Lss(_, answer)) = self.client.poll_event() {
                if answer.is_ok() && matches!(task, Task::ConfigureBitTiming { .. } | Task::Store) {
                    self.others(&mut refused)?;
                }
                return Ok(refused.map_or(answer, Err));
            }
            let until = self.client.poll_timeout().unwrap_or(Instant::ZERO);
            match self.link.receive(until)? {
                Some(heard) => self.client.handle_frame(heard.at, &heard.frame),
                None => self.client.handle_timeout(self.link.now()),
            }
        }
    }

    /// Receives the responses of further slaves.
    fn others(&mut self, refused: &mut Option<od_client::Error>) -> Result<(), Error> {
        let until = self.link.now().plus_millis(100);
        while let Some(heard) = self.link.receive(until)? {
            if heard.frame.id().as_standard() == Some(lss::SLAVE)
                && let Some(lss::Response::Configured { error, .. }) =
                    lss::Response::parse(heard.frame.data())
                && error != 0
            {
                let specific = heard.frame.bytes()[2];
                *refused = Some(od_client::Error::Refused { error, specific });
            }
            if heard.at > until {
                break;
            }
        }
        Ok(())
    }
}

impl<L: Link> Drop for Lss<L> {
    fn drop(&mut self) {
        // No slave is left in configuration state, whatever failed. If the link is lost, this is
        // impossible.
        let configuration = false;
        let request = lss::Request::SwitchGlobal { configuration };
        let id = CanId::standard(lss::MASTER);
        let _ = self.link.send(&Frame::full(id, request.emit()));
    }
}

/// A master whose fastscan waits `pace` ms for a response, and a fifth of that for further ones.
fn master(pace: u64) -> Client {
    let mut options = Options::DEFAULT;
    options.timeout = PATIENCE;
    options.scan = Duration::from_millis(pace);
    options.settle = Duration::from_millis(pace / 5);
    Client::with(sdo::Options::DEFAULT, options)
}

/// Error text for two slaves with the same LSS address.
fn twice(identity: Identity) -> String {
    format!(
        "two LSS slaves have the same LSS address (serial number {}), so no master can address one of \
         them; connect them one after the other",
        identity.serial
    )
}

/// Error text for a failed service, with a correction if there is one.
fn words(task: Task, error: od_client::Error) -> String {
    match (task, error) {
        (Task::SwitchSelective(identity), od_client::Error::Silent) => format!(
            "no LSS slave has the LSS address with serial number {}; `odkit lss scan` lists those \
             without a node ID",
            identity.serial
        ),
        (Task::ConfigureNodeId(_), od_client::Error::Refused { error: 1, .. }) => {
            "the LSS slave does not accept the node ID".into()
        }
        (Task::ConfigureBitTiming { .. }, od_client::Error::Refused { error: 1, .. }) => {
            "an LSS slave does not support the bit rate".into()
        }
        (Task::Store, od_client::Error::Refused { error: 1, .. }) => {
            "an LSS slave does not support storing".into()
        }
        (Task::Store, od_client::Error::Refused { error: 2, .. }) => {
            "an LSS slave cannot write its memory".into()
        }
        (_, od_client::Error::Silent) => "no LSS slave responds in time".into(),
        (_, error) => error.to_string(),
    }
}
