//! Devices on a bus in real time, until Ctrl-C.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, SyncSender, sync_channel};
use std::time::Duration;

use super::client::Client;
use super::failure::Failure;
use super::links::opened::{Ends, Opened};
use super::links::{LINKS, Link};
use super::live::Live;
use super::maker::Maker;
use super::options::Options;
use super::threads::{self, Input};
use super::{fleet, greeting};

/// Inputs that may wait for the bus; more make their senders wait.
const INPUTS: usize = 1024;

/// Puts the devices on a bus and runs it until Ctrl-C, or until its last link has ended.
///
/// # Errors
/// Options that cannot be met, or what the system refuses.
pub fn run(makers: &[Maker<'_>], options: &Options) -> Result<(), Failure> {
    let devices = fleet::make(makers, options)?;
    let opened = open(options)?;
    let (inputs, waiting) = sync_channel(INPUTS);
    let (wake, stop) = (inputs.clone(), Arc::new(AtomicBool::new(false)));
    let stopped = Arc::clone(&stop);
    ctrlc::set_handler(move || {
        stop.store(true, Ordering::Relaxed);
        // Where this finds no room the bus is awake, and where the bus has ended already,
        // so has the program.
        let _ = wake.try_send(Input::Stop);
    })
    .map_err(|error| Failure::Failed(format!("cannot handle Ctrl-C: {error}")))?;
    let ends = opened.iter().filter(|link| matches!(link, Opened::Ends(_)));
    let ends = ends.count();
    let mut live = Live::new(devices, ends, ends < opened.len());
    greeting::print(makers.first(), options, &live.bench.bus, &opened)?;
    let clients = Arc::new(AtomicUsize::new(LINKS));
    let mut outputs = Vec::new();
    for (number, link) in (0..).zip(opened) {
        match link {
            Opened::Listener(protocol, listener, _) => {
                threads::accept(listener, protocol, Arc::clone(&clients), inputs.clone());
            }
            Opened::Ends(ends) => outputs.push(join(number, ends, &inputs)?),
        }
    }
    drop(inputs);
    live.run(&waiting, &stopped);
    for output in outputs {
        finish(&output, &stopped);
    }
    Ok(())
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

/// A link that is a client itself.
fn join(number: u64, ends: Ends, inputs: &SyncSender<Input>) -> Result<Receiver<()>, Failure> {
    let gone = inputs.clone();
    // Nothing else wakes up a reader of standard input when standard output closes.
    let close = move || drop(gone.send(Input::Gone(number)));
    let (client, waiting) = Client::new(number, ends.name, ends.protocol);
    let (reading, writing) = (ends.reading, ends.writing);
    let done = threads::join(client, waiting, reading, writing, close, inputs)?;
    Ok(done)
}

/// Waits until all that was said is written, or Ctrl-C.
fn finish(output: &Receiver<()>, stopped: &AtomicBool) {
    let patience = Duration::from_millis(100);
    while let Err(RecvTimeoutError::Timeout) = output.recv_timeout(patience) {
        if stopped.load(Ordering::Relaxed) {
            return;
        }
    }
}
