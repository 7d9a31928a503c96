//! A master on a link: sends the frames of its client, and waits for responses.

use std::collections::BTreeMap;

use od_client::sdo::Options;
use od_client::{Client, Event, Job, lss};
use od_eds::outline;
use od_model::{Address, DataType, Dictionary};
use od_wire::{Duration, Instant, NodeId};

use crate::error::Error;
use crate::link::Link;

/// A response within 1 s, since devices that save or calibrate are slow; a value of at most 1 MiB, since a longer one
/// is a fault of the device.
const OPTIONS: Options = Options::DEFAULT;

/// Time limit of an upload, for a value without end. A text of 64 KiB takes 20 s at 125 kbit/s; a DOMAIN has no limit.
const WHOLE: Duration = Duration::from_secs(60);

/// Number of attempts of a read if a response to another request arrives.
pub(crate) const TRIES: u8 = 3;

/// Time in which frames that arrived before a request are discarded, in ms.
const DRAIN: u64 = 20;

/// A master of one node on a link.
#[derive(Debug)]
pub struct Master<L> {
    link: L,
    node: NodeId,
    client: Client,
    /// Maximum time to wait for a response.
    timeout: Duration,
    /// Data types of the node's objects, as far as they are known.
    types: BTreeMap<Address, DataType>,
    /// Time limit of each whole transfer; `None`: [`WHOLE`] for uploads, except of a DOMAIN.
    whole: Option<Duration>,
}

/// Returns whether the response is to an earlier request, or to another program: the read can be repeated.
pub(crate) fn is_for_another<T>(result: &Result<T, od_client::Error>) -> bool {
    matches!(result, Err(od_client::Error::OutOfTurn { .. }))
}

/// Returns whether an address is that of a VAR of the standard.
fn is_var(address: Address) -> bool {
    let known = outline::specified(address.index);
    address.sub == 0 && known.is_some_and(|known| !known.code.has_members())
}

impl<L: Link> Master<L> {
    /// A master of `node` on `link`.
    pub fn new(link: L, node: NodeId) -> Self {
        Self::patient(link, node, OPTIONS.timeout)
    }

    /// A master of `node` with another time limit for each response.
    pub fn patient(link: L, node: NodeId, timeout: Duration) -> Self {
        let mut options = OPTIONS;
        options.timeout = timeout;
        Self {
            link,
            node,
            client: Client::with(options, lss::Options::DEFAULT),
            timeout,
            types: BTreeMap::new(),
            whole: None,
        }
    }

    /// Sets the data types of the node's objects. The type gives the size of a value whose response does not contain
    /// one; a DOMAIN is read by block transfer.
    pub fn know(&mut self, dictionary: Dictionary<'_>) {
        let entries = dictionary.entries();
        self.types = entries
            .map(|entry| (entry.address, entry.data_type))
            .collect();
    }

    /// Limits the time of each whole transfer, for a node that sends segments without end. By default an upload ends
    /// after 60 s, unless the value is a DOMAIN.
    #[must_use]
    pub fn within(mut self, whole: Duration) -> Self {
        self.whole = Some(whole);
        self
    }

    /// Returns the node ID.
    pub const fn node(&self) -> NodeId {
        self.node
    }

    /// Returns the link, for frames that the client does not handle.
    pub const fn link(&mut self) -> &mut L {
        &mut self.link
    }

    /// Reads an object.
    ///
    /// # Errors
    /// The link is lost, or the node aborts the transfer, does not respond, or violates the protocol.
    pub fn upload(&mut self, address: Address) -> Result<Vec<u8>, Error> {
        let mut tries = TRIES;
        let standard = || outline::data_type(address.index, address.sub, is_var(address));
        let data_type = self.types.get(&address).copied().or_else(standard);
        let is_domain = data_type == Some(DataType::Domain);
        let whole = self.whole.or((!is_domain).then_some(WHOLE));
        loop {
            let job = match data_type {
                Some(data_type) => self.client.read_as(self.node, address, data_type),
                None => self.client.read(self.node, address),
            };
            let result = loop {
                if let Event::Read(_, result) = self.event(job, address, whole)? {
                    break result;
                }
            };
            tries -= 1;
            if !is_for_another(&result) || tries == 0 {
                return self.outcome(address, data_type, result);
            }
        }
    }

    /// Returns whether the node responds to a read of 1000h, if only with an abort or a wrong response: for a program
    /// that continues after an object without a response.
    ///
    /// # Errors
    /// The link is lost, or the user stops the program.
    pub fn is_alive(&mut self) -> Result<bool, Error> {
        match self.upload(Address::new(0x1000, 0)) {
            Ok(_) | Err(Error::Abort(_) | Error::Protocol(_)) => Ok(true),
            Err(Error::Node(_)) => Ok(false),
            Err(other) => Err(other),
        }
    }

    /// Writes an object.
    ///
    /// # Errors
    /// As [`upload`](Self::upload).
    pub fn download(&mut self, address: Address, bytes: &[u8]) -> Result<(), Error> {
        let job = self.client.write(self.node, address, bytes);
        loop {
            if let Event::Written(_, result) = self.event(job, address, self.whole)? {
                return self.outcome(address, None, result);
            }
        }
    }

    /// Waits for the client's next event; the client must have a job, which ends with an event. If the program is
    /// interrupted or the time is over, the transfer is aborted.
    fn event(
        &mut self,
        job: Job,
        address: Address,
        whole: Option<Duration>,
    ) -> Result<Event, Error> {
        let end = whole.map(|whole| (self.link.now() + whole, whole));
        let event = self.wait(address, end);
        if matches!(event, Err(Error::Interrupted | Error::Protocol(_))) {
            let now = self.link.now();
            self.client.cancel(now, job);
            while let Some(frame) = self.client.poll_transmit(now) {
                self.link.send(&frame)?;
            }
        }
        event
    }

    /// As [`event`](Self::event); `end` is the end of the transfer and its time limit.
    fn wait(&mut self, address: Address, end: Option<(Instant, Duration)>) -> Result<Event, Error> {
        loop {
            self.send()?;
            if let Some(event) = self.client.poll_event() {
                return Ok(event);
            }
            if let Some((end, whole)) = end
                && self.link.now() > end
            {
                let (node, seconds) = (self.node, whole.as_secs_f32());
                return Err(Error::Protocol(format!(
                    "node {node} does not finish the transfer of {address} within {seconds} s"
                )));
            }
            let until = self.client.poll_timeout().unwrap_or(Instant::ZERO);
            match self.link.receive(until)? {
                Some(heard) => self.client.handle_frame(heard.at, &heard.frame),
                None => self.client.handle_timeout(self.link.now()),
            }
        }
    }

    fn send(&mut self) -> Result<(), Error> {
        while let Some(frame) = self.client.poll_transmit(self.link.now()) {
            // A late response to an earlier request is not the response to this one. A bus that is
            // full does not delay the request.
            let until = self.link.now().plus_millis(DRAIN);
            while self.link.receive(Instant::ZERO)?.is_some() && self.link.now() < until {}
            self.link.send(&frame)?;
        }
        Ok(())
    }

    fn outcome<T>(
        &self,
        address: Address,
        data_type: Option<DataType>,
        result: Result<T, od_client::Error>,
    ) -> Result<T, Error> {
        let node = self.node;
        Err(Error::Protocol(match result {
            Ok(done) => return Ok(done),
            Err(od_client::Error::Abort(code)) => return Err(Error::Abort(code)),
            Err(od_client::Error::Silent) => {
                return Err(Error::Node(format!(
                    "node {node} does not respond to SDO requests within {} s (to that for {address}); check its \
                     power, its NMT state (not Stopped) and its node ID",
                    self.timeout.as_secs_f32()
                )));
            }
            Err(od_client::Error::Booted) => format!(
                "node {node} booted during the transfer of {address}; check its supply voltage, and its EMCY messages \
                 with `odkit monitor`"
            ),
            Err(error @ od_client::Error::OutOfTurn { .. }) => format!(
                "node {node}: {address}: {error}; does another program read or write this node?"
            ),
            Err(od_client::Error::TooLong) => {
                let limit = OPTIONS.limit;
                match data_type.filter(|data_type| data_type.size().is_some()) {
                    Some(fixed) => format!(
                        "node {node}: {address}: the value is much longer than its type, {}",
                        fixed.name()
                    ),
                    None => format!("node {node}: {address} is longer than {limit} bytes"),
                }
            }
            Err(other) => format!("node {node}: {address}: {other}"),
        }))
    }
}
