//! Devices on a bus in real time, until Ctrl-C.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use super::clients::Clients;
use super::events::Events;
use super::failure::Failure;
use super::links::opened::Opened;
use super::links::{LINKS, Link};
use super::live::Live;
use super::maker::Maker;
use super::options::Options;
use super::{fleet, greeting, hangup};

/// Puts the devices on a bus and runs it until Ctrl-C, or until its last link has ended.
///
/// # Errors
/// Options that cannot be met, what the system refuses, or a last link that is lost.
pub fn run(makers: &[Maker<'_>], options: &Options) -> Result<(), Failure> {
    // Before any thread: threads take it over.
    hangup::respect();
    let devices = fleet::make(makers, options)?;
    let opened = open(options)?;
    let events = Events::new()?;
    let (waker, stopped) = (Arc::clone(events.waker()), Arc::new(AtomicBool::new(false)));
    let stop = Arc::clone(&stopped);
    ctrlc::set_handler(move || {
        stop.store(true, Ordering::Relaxed);
        // If the bus has ended already, so has the program.
        let _ = waker.wake();
    })
    .map_err(|error| Failure::Failed(format!("cannot handle Ctrl-C: {error}")))?;
    let clients = Clients::new(events, options.max_clients);
    let mut live = Live::new(devices, clients, stopped);
    greeting::print(makers.first(), options, &live.bench.bus, &opened)?;
    for link in opened {
        live.add(link)?;
    }
    live.run()
}

fn open(options: &Options) -> Result<Vec<Opened>, Failure> {
    let links = match options.links.as_slice() {
        [] => &[Link::slcan("127.0.0.1:29536")],
        links => links,
    };
    let consoles = links.iter().filter(|link| **link == Link::Console).count();
    if consoles > 1 || links.len() > LINKS {
        let why = "there is one standard input, and room for 64 links";
        return Err(Failure::Usage(why.into()));
    }
    links.iter().map(Link::open).collect()
}
