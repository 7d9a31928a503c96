//! Values of a node over time: from its TPDOs where they are mapped, else polled by SDO.

use od_client::{Client, Event, Job, pdo};
use od_model::typed::MapEntry;
use od_model::{Address, DataType, TransmissionType};
use od_wire::{CanId, Duration, Frame, Instant, NodeId};

use crate::error::Error;
use crate::link::Link;
use crate::master::{Master, TRIES, is_for_another};
use crate::tpdos;

/// A value that is mapped into a TPDO is polled if no TPDO arrives for this time: the node may not be Operational.
const GRACE: Duration = Duration::from_secs(1);

/// Origin of a value.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum By {
    /// A TPDO.
    Pdo {
        /// Its number, from 1.
        number: u16,
        /// Its CAN-ID.
        id: CanId,
        /// The first bit of the value.
        first: u8,
        /// Its length in bits.
        bits: u8,
    },
    /// SDO requests.
    Poll,
}

/// A value that is watched.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Source {
    /// Its address.
    pub address: Address,
    /// Its origin.
    pub by: By,
    /// Its data type, if known; it gives the size of a response that contains none.
    pub data_type: Option<DataType>,
}

/// A value with its time.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Sample {
    /// Time of arrival, by the link's clock.
    pub at: Instant,
    /// Index of its source.
    pub source: usize,
    /// The value, or the reason why it is missing.
    pub value: Result<Vec<u8>, od_client::Error>,
}

/// Finds the source of each value: a valid TPDO of the node that maps it, else SDO.
///
/// # Errors
/// The node does not respond, or the link is lost.
pub fn sources(
    master: &mut Master<impl Link>,
    addresses: &[Address],
) -> Result<Vec<Source>, Error> {
    let polled = |address: &Address| Source {
        address: *address,
        by: By::Poll,
        data_type: None,
    };
    let mut found: Vec<Source> = addresses.iter().map(polled).collect();
    for tpdo in tpdos::read(|address| number(master, address))? {
        if tpdo.transmission.is_some_and(TransmissionType::is_rtr_only) {
            // The TPDO is sent on request only.
            continue;
        }
        let mut first = 0_u32;
        for raw in tpdo.mapping {
            let MapEntry { address, bits } = MapEntry::parse(raw);
            let here = found
                .iter_mut()
                .find(|one| one.address == address && one.by == By::Poll);
            if let Some(source) = here
                && first + u32::from(bits) <= 64
            {
                source.by = By::Pdo {
                    number: tpdo.number,
                    id: tpdo.id,
                    first: first as u8,
                    bits,
                };
            }
            first += u32::from(bits);
        }
    }
    Ok(found)
}

/// A parameter of a TPDO. One in whose transfer the node violates the protocol is not known: the value is then read by SDO.
fn number(master: &mut Master<impl Link>, address: Address) -> Result<Option<u32>, Error> {
    let bytes = match master.upload(address) {
        Err(Error::Protocol(_) | Error::Abort(_)) => return Ok(None),
        read => read?,
    };
    let number = |bytes: &[u8]| {
        bytes
            .iter()
            .rev()
            .fold(0, |number, byte| number << 8 | u32::from(*byte))
    };
    Ok((bytes.len() <= 4).then(|| number(&bytes)))
}

/// The value in the data of its TPDO; `None` if the frame is too short.
fn mapped(frame: &Frame, first: u8, bits: u8) -> Option<Vec<u8>> {
    let value = pdo::bits(frame.data(), first, bits).filter(|_| !frame.is_remote())?;
    Some(value.to_le_bytes()[..usize::from(bits).div_ceil(8)].to_vec())
}

/// Calls `tell` with each value as it arrives, until `tell` returns `false` or the time is `until`. Values without a
/// TPDO are polled at intervals of `every`. A node that does not respond is asked again.
///
/// # Errors
/// The link is lost, or the user stops it.
pub fn watch(
    link: &mut impl Link,
    node: NodeId,
    sources: &[Source],
    every: Duration,
    until: Instant,
    mut tell: impl FnMut(Sample) -> bool,
) -> Result<(), Error> {
    let mut client = Client::new();
    let mut jobs: Vec<(Job, usize)> = Vec::new();
    let times = (every, until);
    let ended = follow(
        link,
        (&mut client, &mut jobs),
        node,
        sources,
        times,
        &mut tell,
    );
    // The open transfers at the node are aborted.
    for (job, _) in jobs {
        client.cancel(link.now(), job);
    }
    while let Some(frame) = client.poll_transmit(link.now()) {
        link.send(&frame)?;
    }
    ended
}

fn follow(
    link: &mut impl Link,
    (client, jobs): (&mut Client, &mut Vec<(Job, usize)>),
    node: NodeId,
    sources: &[Source],
    (every, until): (Duration, Instant),
    tell: &mut impl FnMut(Sample) -> bool,
) -> Result<(), Error> {
    // Time of the next request for the value; `None` while a response is due.
    let mut due = vec![Some(link.now()); sources.len()];
    // Number of attempts to read the value.
    let mut tries = vec![0; sources.len()];
    loop {
        let now = link.now();
        if now > until {
            return Ok(());
        }
        for (at, source) in sources.iter().enumerate() {
            if due[at].is_some_and(|due| due <= now) {
                due[at] = None;
                let job = match source.data_type {
                    Some(data_type) => client.read_as(node, source.address, data_type),
                    None => client.read(node, source.address),
                };
                jobs.push((job, at));
            }
        }
        while let Some(frame) = client.poll_transmit(link.now()) {
            link.send(&frame)?;
        }
        while let Some(event) = client.poll_event() {
            let Event::Read(job, value) = event else {
                continue;
            };
            let Some(place) = jobs.iter().position(|(one, _)| *one == job) else {
                continue;
            };
            let (_, source) = jobs.swap_remove(place);
            let at = link.now();
            tries[source] += 1;
            if is_for_another(&value) && tries[source] < TRIES {
                due[source] = Some(at);
                continue;
            }
            tries[source] = 0;
            let pause = match sources[source].by {
                By::Poll => every,
                By::Pdo { .. } => every.max(GRACE),
            };
            // From the request on, so that response times do not add up.
            due[source] = Some((now + pause).max(at));
            if !tell(Sample { at, source, value }) {
                return Ok(());
            }
        }
        let next = due
            .iter()
            .flatten()
            .copied()
            .chain(client.poll_timeout())
            .min();
        // A little after the end, so that the loop ends.
        let next = next.unwrap_or(now).min(until + Duration::from_micros(1));
        let Some(heard) = link.receive(next)? else {
            client.handle_timeout(link.now());
            continue;
        };
        client.handle_frame(heard.at, &heard.frame);
        for (at, source) in sources.iter().enumerate() {
            let By::Pdo {
                id, first, bits, ..
            } = source.by
            else {
                continue;
            };
            if id != heard.frame.id() {
                continue;
            }
            let Some(bytes) = mapped(&heard.frame, first, bits) else {
                continue;
            };
            if let Some(due) = &mut due[at] {
                *due = heard.at + every.max(GRACE);
            }
            let value = Ok(bytes);
            if !tell(Sample {
                at: heard.at,
                source: at,
                value,
            }) {
                return Ok(());
            }
        }
    }
}
