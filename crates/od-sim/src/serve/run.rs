//! Devices on a bus in real time, until Ctrl-C.

use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use od_model::Refused;

use super::clients::Clients;
use super::control::address::ControlAddress;
use super::error::Error;
use super::events::Events;
use super::files::{self, Files};
use super::fleet::Maker;
use super::links::opened::{Opened, Protocol};
use super::links::{LINKS, Link};
use super::live::Live;
use super::log::Log;
use super::options::Options;
use super::ready::{self, Ready};
use super::stats::Stats;
use super::{control, fleet, greeting, process, running, terminal};

/// Puts the devices on a bus and runs it until Ctrl-C, or until its last link has ended.
///
/// # Errors
/// Options that do not fit together, an error of the system, or the loss of the last link.
pub fn run(makers: &[Maker<'_>], options: &Options) -> Result<(), Error> {
    // Set this before any thread starts, because threads inherit it.
    process::respect_nohup();
    files::survive_limit();
    if options.quiet {
        terminal::be_quiet();
    }
    check_files(makers, options).map_err(|refused| Error::Usage(refused.into()))?;
    let mut ready = match &options.ready_file {
        Some(path) if !is_output(path) => Some(Ready::at(path)?),
        _ => None,
    };
    let devices = fleet::make(makers, options)?;
    let control = options.control.as_ref().map(control::open::listen);
    let control = control.transpose()?;
    let opened = open(options)?;
    let log = options.log.as_deref().map(Log::create).transpose()?;
    let events = Events::new()?;
    let (waker, stopped) = (Arc::clone(events.waker()), Arc::new(AtomicBool::new(false)));
    let stop = Arc::clone(&stopped);
    ctrlc::set_handler(move || {
        stop.store(true, Ordering::Relaxed);
        // A bus that has ended ends the program.
        let _ = waker.wake();
    })
    .map_err(|error| Error::Failed(format!("cannot handle Ctrl-C: {error}")))?;
    let mut clients = Clients::new(events, options.max_clients);
    let (address, _file) = match control {
        Some(control) => {
            clients.open(Protocol::Control, control.listener)?;
            (Some(control.address), control.file)
        }
        None => (None, None),
    };
    let stats = Stats::new(options.bitrate);
    let mut live = Live::new(devices, clients, stats, stopped);
    live.log = log;
    let report =
        |with_tokens| ready::report(&opened, &live.bench.bus, address.as_ref(), with_tokens);
    let (open, secret) = (report(false), report(true));
    greeting::print(
        makers.first(),
        options,
        &live.bench.bus,
        &opened,
        address.as_ref(),
    )?;
    for link in opened {
        live.add(link)?;
    }
    let _enrolled = running::enrol(&open);
    match &mut ready {
        Some(ready) => ready.write(&open)?,
        None if options.ready_file.is_none() => {}
        None if options.links.contains(&Link::Console) => terminal::note(&secret),
        None => terminal::print(&secret)?,
    }
    live.run()
}

/// Refuses an output file that another option or a device uses.
fn check_files(makers: &[Maker<'_>], options: &Options) -> Result<(), Refused> {
    let mut files = Files::new();
    for path in makers.iter().flat_map(|maker| &maker.files) {
        files.read(format!("the device file `{}`", path.display()), path)?;
    }
    let control = match &options.control {
        Some(ControlAddress::Unix(path)) => Some(path),
        _ => None,
    };
    let ready_file = options.ready_file.as_ref().filter(|path| !is_output(path));
    let eeproms = options.eeproms.iter().map(|path| ("eeprom", path));
    let others = [
        ("control", control),
        ("log", options.log.as_ref()),
        ("ready-file", ready_file),
    ];
    let others = others
        .into_iter()
        .filter_map(|(option, path)| Some((option, path?)));
    for (option, path) in eeproms.chain(others) {
        files.write(format!("`--{option} {}`", path.display()), path)?;
    }
    Ok(())
}

/// Returns whether a path means standard output.
fn is_output(path: &Path) -> bool {
    path.as_os_str() == "-"
}

fn open(options: &Options) -> Result<Vec<Opened>, Error> {
    let links = match options.links.as_slice() {
        [] => &[Link::slcan("127.0.0.1:29536")],
        links => links,
    };
    let consoles = links.iter().filter(|link| **link == Link::Console).count();
    if consoles > 1 || links.len() > LINKS {
        let why = "`--link -` can be given only once; the limit is 64 links";
        return Err(Error::Usage(why.into()));
    }
    let opened = links.iter().map(|link| link.open(&options.origins));
    opened.collect()
}
