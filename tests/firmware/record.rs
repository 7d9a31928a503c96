//! Plays a script or an input of the fuzz target `node` on the bench, and logs the calls of its
//! devices.

use od_model::Refused;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex};

use od_fuzz::random::Random;
use od_fuzz::targets;
use od_runtime::{Instant, NodeId};
use od_sim::bus::Bus;
use od_sim::script::{Bare, Bench, Host, Script, run_on};
use od_sim::twin::Call;
use od_sim::{EdsOptions, VirtualDevice};
use od_tests::scripts::Header;
use od_tools::bench::OnBench;
use od_tools::conform::case::built_in;
use od_tools::conform::eds::Eds;
use od_tools::conform::session::{Permissions, Session};

use crate::log::{Log, Writer};

/// Host of a script that logs the devices with this name, for their twins.
struct Twins<'a> {
    folder: PathBuf,
    name: &'a str,
    /// Log of each device on the bus; `None` for one with another name.
    logs: Vec<Option<Arc<Mutex<Log>>>>,
}

impl Host for Twins<'_> {
    fn device(
        &mut self,
        name: Option<&str>,
        node_id: Option<NodeId>,
    ) -> Result<VirtualDevice, Refused> {
        let name = name.unwrap_or(self.name);
        if name.contains('.') {
            let path = self.folder.join(name);
            let bytes = std::fs::read(&path).map_err(|e| format!("{}: {e}", path.display()))?;
            let options = EdsOptions {
                node_id,
                ..EdsOptions::default()
            };
            self.logs.push(None);
            let device = VirtualDevice::from_eds(&od_eds::decode(&bytes), options);
            return device.map_err(|found| format!("{}: {found:?}", path.display()).into());
        }
        let device = Bare(od_devices::DEVICES).device(Some(name), node_id)?;
        if !name.eq_ignore_ascii_case(self.name) {
            self.logs.push(None);
            return Ok(device);
        }
        let log = Arc::default();
        self.logs.push(Some(Arc::clone(&log)));
        Ok(device.with_twin(Box::new(Writer(log))))
    }
}

/// Returns whether the script is for this device.
pub(crate) fn is_of(text: &str, name: &str) -> bool {
    let header = Header::parse(text).unwrap_or_default();
    let mut named = text.lines().filter_map(|line| line.strip_prefix("device "));
    header.devices.iter().any(|one| one == name)
        || named.any(|line| line.split_whitespace().next() == Some(name))
}

/// Plays a script; returns a log of each device of this name.
///
/// # Errors
/// Reason why the bench cannot play it.
pub(crate) fn record(path: &Path, text: &str, name: &str) -> Result<Vec<Log>, String> {
    let script = Script::parse(text).map_err(|problems| format!("{problems:?}"))?;
    let mut twins = Twins {
        folder: path.parent().map(Path::to_path_buf).unwrap_or_default(),
        name,
        logs: Vec::new(),
    };
    let mut bench = Bench::default();
    run_on(&script, &mut bench, &mut twins).map_err(|stop| stop.to_string())?;
    for (at, log) in twins.logs.iter().enumerate() {
        if let Some(log) = log {
            bench.bus.with(at, |device, now| end(log, device, now));
        }
    }
    drop(bench);
    let logs = twins.logs.into_iter().flatten();
    Ok(logs
        .map(|log| std::mem::take(&mut *log.lock().expect("nobody panicked")))
        .collect())
}

/// Ends a log with the values and the EEPROM of the device.
fn end(log: &Mutex<Log>, device: &mut VirtualDevice, now: Instant) {
    device.forward(now, Call::End);
    log.lock().expect("nobody panicked").end(device, now);
}

/// The log of the whole conformance test, which the bench passes.
pub(crate) fn conform(name: &str) -> Result<Log, String> {
    let kind = od_devices::find(name).expect("it is built in");
    let log: Arc<Mutex<Log>> = Arc::default();
    let device =
        VirtualDevice::new(kind, NodeId::ONE).with_twin(Box::new(Writer(Arc::clone(&log))));
    let mut bus = Bus::new();
    let number = bus.add(device);
    bus.start(number);
    let eds = Eds::read(&od_devices::text::eds(kind));
    let mut rig = OnBench(&mut bus);
    let mut session = Session::new(&mut rig, &eds, NodeId::ONE, Permissions::ALL);
    for case in built_in() {
        let record = session.run(case);
        if record.verdict.is_fail() {
            return Err(format!("{}: {:?}", record.id, record.verdict));
        }
    }
    bus.with(number, |device, now| end(&log, device, now));
    Ok(std::mem::take(&mut *log.lock().expect("nobody panicked")))
}

/// The log of a made input: frames that are valid more often than not, time, power, switches
/// and faults. The shaft does not turn, since only the bench knows a speed exactly, and no fault is set
/// twice, since the bench does not report it again.
pub(crate) fn made(number: u64, name: &str) -> Log {
    const STEP: usize = 10;
    let make = targets::of("node").and_then(|target| target.make);
    let mut input = make.expect("it makes its inputs")(&mut Random::of(0, number));
    let kind = od_devices::find(name).expect("it is built in");
    let log: Arc<Mutex<Log>> = Arc::default();
    let device =
        VirtualDevice::new(kind, NodeId::ONE).with_twin(Box::new(Writer(Arc::clone(&log))));
    let mut broken = vec![false; device.faults().len()];
    for [act, how, fault, ..] in input.as_chunks_mut::<STEP>().0 {
        let fault = usize::from(*fault) % broken.len();
        let is_news = match *act % 40 {
            38.. => false,
            37 => std::mem::replace(&mut broken[fault], *how % 3 == 0) != (*how % 3 == 0),
            _ => true,
        };
        if !is_news {
            // Time passes instead.
            *act = 31;
        }
    }
    let mut bus = targets::node::play(&input, device);
    bus.with(0, |device, now| end(&log, device, now));
    std::mem::take(&mut *log.lock().expect("nobody panicked"))
}
