//! `odkit class`: the page of odkit for a class, and a page for its trainer.

mod desk;
mod http;
mod room;
mod site;

use std::io::{self, Read};
use std::net::{IpAddr, Ipv4Addr, Shutdown, SocketAddr, TcpListener, TcpStream, UdpSocket};
use std::path::PathBuf;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, mpsc};
use std::thread;
use std::time::{Duration, Instant};

use od_sim::lesson::prove;

use crate::failure::Failure;
use crate::lesson::builtin::Language;
use crate::lesson::file::{Texts, texts};
use crate::output::{self, note};
use crate::report;
use crate::terminal::Terminal;
use desk::Desk;
use http::Answer;
use room::Room;
use site::Site;

/// Maximum number of connections at the same time: a browser opens six, for one request each.
const CONNECTIONS: usize = 40 * 6 + 16;
/// Stack of the thread of a connection, in bytes.
const STACK: usize = 256 * 1024;

/// Serve the page to a class, with a page that shows the trainer who is where
///
/// Students open the printed address in a browser of the same network and give a name; their benches run in their own
/// browsers. The trainer's page shows the lesson, step and time of each student and who is stuck, offers a lesson to one
/// or all of them, and resets the class for the next group. Nothing leaves this network. Press Ctrl-C to stop.
#[derive(clap::Args)]
pub(crate) struct Args {
    /// Lessons of your own, or folders with lessons, as a group of their own
    #[arg(long, value_name = "FILE|FOLDER")]
    lessons: Vec<PathBuf>,
    /// Address to listen at; 127.0.0.1 for this computer only
    #[arg(long, value_name = "ADDRESS", default_value_t = IpAddr::V4(Ipv4Addr::UNSPECIFIED))]
    host: IpAddr,
    /// Port to listen at; 0 for any free one
    #[arg(long, value_name = "N", default_value_t = 8301)]
    port: u16,
    /// Language of the pages [default: that of each browser]
    #[arg(long, value_enum, value_name = "CODE")]
    lang: Option<Language>,
    /// Minutes without progress after which a student is stuck
    #[arg(long, value_name = "MINUTES", default_value_t = 5, value_parser = clap::value_parser!(u16).range(1..=600))]
    stuck: u16,
    /// Folder with the page, if this program does not contain it
    #[arg(long, value_name = "FOLDER")]
    page: Option<PathBuf>,
}

pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    let mut site = Site::read(args.page.as_deref(), args.lang)?;
    let lessons = texts(&args.lessons)?;
    let count = lessons.len();
    warn(&lessons);
    site.add_lessons(lessons)?;
    let listener = TcpListener::bind((args.host, args.port)).map_err(|error| {
        let place = SocketAddr::new(args.host, args.port);
        Failure::Failed(match error.kind() {
            io::ErrorKind::AddrInUse => {
                format!("another program uses {place}; give another port with --port")
            }
            io::ErrorKind::AddrNotAvailable => format!(
                "{} is not an address of this computer; leave out --host to listen at all of its addresses",
                args.host
            ),
            io::ErrorKind::PermissionDenied => {
                format!("this user may not listen at {place}; give a port above 1023 with --port")
            }
            _ => format!("cannot listen at {place}: {error}"),
        })
    })?;
    let port = listener.local_addr()?.port();
    let place = if args.host.is_unspecified() {
        Ipv4Addr::LOCALHOST.into()
    } else {
        args.host
    };
    let own = SocketAddr::new(place, port);
    let reachable = reachable(args.host);
    if reachable.is_none() {
        note!(
            "warning: no network leads out of this computer, so its address is not known; give it with --host"
        );
    }
    let students = SocketAddr::new(reachable.unwrap_or(place), port);
    let desk = Desk {
        site,
        room: Mutex::new(Room::new(
            random()?,
            Duration::from_secs(60) * u32::from(args.stuck),
        )),
        token: random()?,
        address: format!("http://{students}/"),
        random,
    };
    let lessons = match count {
        0 => String::new(),
        _ => format!(
            "\n{} of your own in the list.",
            report::plural(count, "lesson")
        ),
    };
    output::print(&format!(
        "Students open this address in a browser of the same network:\n  http://{students}/\n\
         The trainer opens this address, which is a secret:\n  http://{own}/trainer.html#{}{lessons}\n\
         Press Ctrl-C to end the class.",
        desk.token
    ))?;
    let desk = Arc::new(desk);
    let (stopped, stop) = mpsc::channel();
    ctrlc::set_handler(move || {
        let _ = stopped.send(());
    })
    .map_err(|error| Failure::Failed(format!("cannot handle Ctrl-C: {error}")))?;
    let served = Arc::clone(&desk);
    thread::spawn(move || serve(&listener, &served));
    // The handler lives as long as this program, so this is its signal.
    let _ = stop.recv();
    let count = desk.room().rows(Instant::now()).len();
    note!(
        "\nodkit: the class has ended with {}",
        report::plural(count, "student")
    );
    Ok(())
}

/// Warns of lessons that `odkit lesson check` would report: a student may get stuck there.
fn warn(lessons: &[Texts]) {
    for Texts { path, own, .. } in lessons {
        for problem in prove(&own.0, &mut Terminal::beside(path, ("gxmm", None))) {
            note!("warning: {}:{problem}", path.display());
        }
    }
}

/// Answers each connection in a thread of its own, for ever.
fn serve(listener: &TcpListener, desk: &Arc<Desk>) {
    let open = Arc::new(AtomicUsize::new(0));
    loop {
        let Ok((stream, _)) = listener.accept() else {
            // The system has no free socket at the moment.
            thread::sleep(Duration::from_millis(50));
            continue;
        };
        if open.load(Ordering::Relaxed) >= CONNECTIONS {
            let _ = Answer::text(503, "the class is busy; try again").write(&mut &stream, false);
            continue;
        }
        open.fetch_add(1, Ordering::Relaxed);
        let (desk, count) = (Arc::clone(desk), Arc::clone(&open));
        let work = move || {
            attend(&stream, &desk);
            count.fetch_sub(1, Ordering::Relaxed);
        };
        if thread::Builder::new()
            .stack_size(STACK)
            .spawn(work)
            .is_err()
        {
            open.fetch_sub(1, Ordering::Relaxed);
        }
    }
}

/// Answers one request. A client that leaves before the end is not an error.
fn attend(stream: &TcpStream, desk: &Desk) {
    let (answer, is_head) = match http::receive(stream) {
        Ok(request) => (
            desk.answer(&request, Instant::now()),
            request.method == "HEAD",
        ),
        Err(Some(refused)) => (refused, false),
        Err(None) => return,
    };
    let _ = answer.write(&mut &*stream, is_head);
    // Unread bytes of a client would make the system drop the answer.
    let _ = stream.shutdown(Shutdown::Write);
    let _ = stream.set_read_timeout(Some(Duration::from_millis(200)));
    let mut rest = [0; 4096];
    for _ in 0..16 {
        if !(&*stream).read(&mut rest).is_ok_and(|count| count > 0) {
            break;
        }
    }
}

/// The address under which other computers reach this one: of the network that leads out. `None`: no network leads out, as
/// in a room without a router. No packet is sent.
fn reachable(host: IpAddr) -> Option<IpAddr> {
    if !host.is_unspecified() {
        return Some(host);
    }
    let socket = UdpSocket::bind((Ipv4Addr::UNSPECIFIED, 0)).ok()?;
    // An address for documentation (RFC 5737).
    socket.connect((Ipv4Addr::new(192, 0, 2, 1), 9)).ok()?;
    Some(socket.local_addr().ok()?.ip())
}

/// 128 random bits in hexadecimal.
fn random() -> Result<String, Failure> {
    let mut bytes = [0; 16];
    getrandom::fill(&mut bytes)
        .map_err(|error| Failure::Failed(format!("no random numbers: {error}")))?;
    Ok(bytes.iter().map(|byte| format!("{byte:02x}")).collect())
}
