//! `odkit sim`: a live node that masters reach over slcan on TCP.

mod clients;
pub(crate) mod slcan;

use std::collections::BTreeMap;
use std::io::ErrorKind;
use std::net::{SocketAddr, TcpListener, ToSocketAddrs};
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, sync_channel};
use std::time::{Duration, Instant as Clock};

use od_devices::sim::{Bus, VirtualDevice, values};
use od_runtime::storage::File;
use od_runtime::{Event, Frame, Instant, NodeId};

use crate::output::{Output, note};
use crate::source::{self, Source};
use crate::{Failure, report};
use clients::{Client, Input};
use slcan::Channel;

/// Run a live node; masters connect over slcan on TCP
///
/// Several clients share the bus: frames of one reach the others and the node. Ctrl-C ends it.
#[derive(clap::Args)]
pub(crate) struct Args {
    /// Built-in device, or EDS or DCF file
    #[arg(value_name = "DEVICE|FILE")]
    device: String,
    /// Node ID that the device starts with, 1 to 127
    #[arg(long, value_name = "N", value_parser = source::node_id)]
    node_id: Option<NodeId>,
    /// Where to listen; port 0 takes any free one
    #[arg(long, value_name = "HOST:PORT", default_value = "127.0.0.1:29536")]
    slcan: String,
    /// File that keeps what 1010h saves; in memory where none is given
    #[arg(long, value_name = "FILE")]
    eeprom: Option<PathBuf>,
    /// Raw position of the shaft at the start, in steps (497042 or 0x79592)
    #[arg(long, value_name = "STEPS", value_parser = position)]
    position: Option<u64>,
    /// How fast the shaft turns, revolutions a minute; negative: the other way
    #[arg(long, value_name = "RPM", allow_negative_numbers = true)]
    rpm: Option<f64>,
    /// Bit rate to show in the connection lines; this bus has none
    #[arg(long, value_name = "BIT/S", default_value_t = 500_000)]
    bitrate: u32,
}

fn position(text: &str) -> Result<u64, String> {
    let value = values::integer(text).and_then(|value| u64::try_from(value).ok());
    value.ok_or_else(|| String::from("a position is a number of steps, like 497042 or 0x79592"))
}

/// Inputs that may wait for the bus; more make their senders wait.
const INPUTS: usize = 1024;
/// Bytes of clients that the bus takes in one turn, before its answers go out.
const TURN: usize = 16 * 1024;
/// An input counts as so many bytes at least.
const INPUT: usize = 64;

pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    let mut device = Source::find(&args.device)?.device(args.node_id)?;
    if let Some(path) = &args.eeprom {
        let file = File::open(path, device.storage_needed());
        let file = file.map_err(|error| Failure::Failed(error.to_string()))?;
        device = device.with_storage(Box::new(file));
    }
    set_shaft(args, &mut device)?;
    let listener = listen(&args.slcan)?;
    let address = listener.local_addr()?;
    let (inputs, waiting) = sync_channel(INPUTS);
    let (wake, stop) = (inputs.clone(), Arc::new(AtomicBool::new(false)));
    let stopped = Arc::clone(&stop);
    ctrlc::set_handler(move || {
        stop.store(true, Ordering::Relaxed);
        // Where this finds no room the bus is awake, and where the bus has ended already,
        // so has the program.
        let _ = wake.try_send(Input::Stop);
    })
    .map_err(|error| Failure::Failed(format!("Ctrl-C cannot be watched: {error}")))?;
    let mut live = Live::new(device);
    live.greet(args, address)?;
    clients::accept(listener, inputs);
    live.run(&waiting, &stopped);
    Ok(())
}

fn set_shaft(args: &Args, device: &mut VirtualDevice) -> Result<(), Failure> {
    let now = Instant::ZERO;
    let placed = args
        .position
        .is_none_or(|raw| device.set_position(raw, now));
    let turns = args
        .rpm
        .is_none_or(|rpm| rpm.is_finite() && device.set_rpm(rpm, now));
    if placed && turns {
        return Ok(());
    }
    Err(Failure::Usage(format!(
        "{} has no shaft that could stand or turn so; leave --position and --rpm away",
        args.device
    )))
}

fn listen(wanted: &str) -> Result<TcpListener, Failure> {
    let full = match wanted.parse::<u16>() {
        Ok(port) => format!("127.0.0.1:{port}"),
        Err(_) => wanted.to_owned(),
    };
    let addresses: Vec<SocketAddr> = match full.to_socket_addrs() {
        Ok(addresses) => addresses.collect(),
        Err(_) => {
            return Err(Failure::Usage(format!(
                "`{wanted}` is no address to listen on; write --slcan 127.0.0.1:29536"
            )));
        }
    };
    TcpListener::bind(addresses.as_slice()).map_err(|error| {
        Failure::Failed(match error.kind() {
            ErrorKind::AddrInUse => format!(
                "{full} is in use, perhaps by another odkit; end that one, or take any free \
                 port with --slcan 127.0.0.1:0"
            ),
            _ => format!("{full}: {error}; choose another address with --slcan"),
        })
    })
}

/// A client with its adapter.
struct Seat {
    client: Client,
    channel: Channel,
}

/// The bus in real time.
struct Live {
    bus: Bus,
    start: Clock,
    seats: BTreeMap<u64, Seat>,
    frames: u64,
}

impl Live {
    fn new(device: VirtualDevice) -> Self {
        let mut bus = Bus::new();
        let number = bus.add(device);
        bus.with(number, VirtualDevice::power_on);
        // Nobody listens yet; a master that comes later asks for the state.
        while bus.poll().is_some() {}
        for event in bus.with(number, events).unwrap_or_default() {
            if event == Event::StorageDamaged {
                report_event(event);
            }
        }
        Self {
            bus,
            start: Clock::now(),
            seats: BTreeMap::new(),
            frames: 0,
        }
    }

    fn now(&self) -> Instant {
        Instant::ZERO + self.start.elapsed()
    }

    fn run(&mut self, waiting: &Receiver<Input>, stopped: &AtomicBool) {
        loop {
            self.catch_up();
            self.flush();
            let first = match self.bus.next_deadline() {
                Some(at) => waiting.recv_timeout(at - self.now()),
                None => waiting.recv_timeout(Duration::from_secs(3600)),
            };
            let first = match first {
                Ok(input) => Some(input),
                Err(RecvTimeoutError::Timeout) => None,
                Err(RecvTimeoutError::Disconnected) => break,
            };
            // What waits already belongs to this turn, as far as it has room.
            let mut room = TURN;
            for input in first.into_iter().chain(waiting.try_iter()) {
                if stopped.load(Ordering::Relaxed) {
                    break;
                }
                let size = match &input {
                    Input::Bytes(_, bytes) => bytes.len().max(INPUT),
                    _ => INPUT,
                };
                self.take(input);
                room = room.saturating_sub(size);
                if room == 0 {
                    break;
                }
            }
            if stopped.load(Ordering::Relaxed) {
                break;
            }
        }
        self.bus.with(0, VirtualDevice::power_off);
        note!(
            "\nodkit: ended; {} went over the bus",
            report::plural(self.frames as usize, "frame")
        );
    }

    /// The bus catches up with the clock, and what devices send goes out.
    fn catch_up(&mut self) {
        let now = self.now();
        self.bus.advance(now);
        self.deliver();
    }

    fn deliver(&mut self) {
        while let Some(sent) = self.bus.poll() {
            self.frames += 1;
            self.pass_on(&sent.frame, None);
        }
        for event in self.bus.with(0, events).unwrap_or_default() {
            report_event(event);
        }
    }

    /// What the turn has brought goes out, each client's share as one message.
    fn flush(&mut self) {
        for seat in self.seats.values_mut() {
            seat.client.flush();
        }
    }

    /// A frame for every client but the one it is from.
    fn pass_on(&mut self, frame: &Frame, from: Option<u64>) {
        let millis = self.bus.now().as_micros() / 1000;
        // Without and with a time stamp; clients of a kind get the same line.
        let mut lines = [Vec::new(), Vec::new()];
        for (number, seat) in &mut self.seats {
            if Some(*number) != from && seat.channel.is_open() {
                let line = &mut lines[usize::from(seat.channel.stamps())];
                if line.is_empty() {
                    seat.channel.encode(frame, millis, line);
                }
                seat.client.push(line);
            }
        }
    }

    fn take(&mut self, input: Input) {
        match input {
            Input::Connected(client) => {
                note!("{} connected", client.address);
                self.seats.insert(
                    client.number,
                    Seat {
                        client,
                        channel: Channel::default(),
                    },
                );
            }
            Input::Gone(number) => {
                if let Some(mut seat) = self.seats.remove(&number) {
                    // It may have ended its own side only, and read on.
                    seat.client.flush();
                    note!("{} left", seat.client.address);
                }
            }
            Input::Bytes(number, bytes) => self.bytes(number, &bytes),
            Input::Stop => {}
        }
    }

    fn bytes(&mut self, number: u64, bytes: &[u8]) {
        let Some(seat) = self.seats.get_mut(&number) else {
            return;
        };
        // A frame's own acknowledgement goes out before what it brings about.
        let mut steps = Vec::new();
        let mut reply = Vec::new();
        seat.channel.receive(bytes, &mut reply, |frame, reply| {
            steps.push((std::mem::take(reply), frame));
        });
        for (reply, frame) in steps {
            self.reply(number, &reply);
            self.frames += 1;
            self.catch_up();
            self.bus.receive(&frame);
            self.pass_on(&frame, Some(number));
            self.deliver();
        }
        self.reply(number, &reply);
    }

    fn reply(&mut self, number: u64, reply: &[u8]) {
        if let Some(seat) = self.seats.get_mut(&number) {
            seat.client.push(reply);
        }
    }

    fn greet(&self, args: &Args, address: SocketAddr) -> Result<(), Failure> {
        let Some(device) = self.bus.devices().first() else {
            return Ok(());
        };
        let (title, node) = (device.title(), device.node_id());
        if let Some(wanted) = args.node_id.filter(|wanted| *wanted != node) {
            note!("the EEPROM says node {node}; --node-id {wanted} is for an empty one");
        }
        let bitrate = args.bitrate;
        let speed = match bitrate {
            10_000 => 0,
            20_000 => 1,
            50_000 => 2,
            100_000 => 3,
            125_000 => 4,
            250_000 => 5,
            800_000 => 7,
            1_000_000 => 8,
            _ => 6,
        };
        let mut output = Output::new();
        let (description, read) = match od_devices::find(&args.device) {
            Some(_) => (
                "canopen.ObjectDictionary()".to_owned(),
                "sdo.upload(0x1000, 0).hex()",
            ),
            None => (format!("{:?}", args.device), "sdo[0x1000].raw"),
        };
        let eeprom = match &args.eeprom {
            Some(path) => path.display().to_string(),
            None => "in memory; --eeprom FILE keeps it".to_owned(),
        };
        let request = 0x600 + u16::from(node.raw());
        let text = format!(
            "{title}, node {node}; slcan on {address}
EEPROM {eeprom}

python-canopen (pip install canopen pyserial)
  import canopen
  network = canopen.Network()
  network.connect(interface='slcan', channel='socket://{address}',
                  bitrate={bitrate}, sleep_after_open=0)
  node = network.add_node({node}, {description})
  print(node.{read})

candump, as root on Linux
  socat pty,raw,echo=0,link=/dev/ttyodkit tcp:{address} &
  slcand -o -c -s{speed} ttyodkit can0
  ip link set can0 up
  candump can0 &
  cansend can0 {request:03X}#4000100000000000

Ctrl-C ends it."
        );
        output.line(&text)?;
        output.flush().map(|_| ())
    }
}

fn events(device: &mut VirtualDevice, _: Instant) -> Vec<Event> {
    std::iter::from_fn(|| device.poll_event()).collect()
}

/// What the person at the terminal may want to know.
fn report_event(event: Event) {
    match event {
        Event::State(state) => note!("state: {state}"),
        Event::Reset(_, node) => note!("reset, node {node}"),
        Event::Saved(_) => note!("parameters saved"),
        Event::Restored(_) => note!("defaults restored"),
        Event::StorageDamaged => {
            note!("the EEPROM is damaged or of another version; defaults were taken");
        }
        Event::BusOff { .. } => note!("bus-off"),
        Event::BusOn => note!("back from bus-off"),
        Event::Error(error) => note!("error {:04X}h", error.code),
        Event::ErrorCleared(code) => note!("error {code:04X}h is over"),
        Event::BitRate(code) => note!("LSS set bit rate {code}; this bus has none"),
        Event::Written(_) => {}
    }
}
