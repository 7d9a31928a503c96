//! `odkit ctl`, and the control socket of `odkit sim`.

use std::fs;
use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::os::unix::fs::PermissionsExt;
use std::os::unix::net::UnixStream;
use std::time::Duration;

use crate::support::quiet::{Sim, unix, until};
use crate::support::sim::say;
use crate::support::{file, odkit, temporary};
use serde_json::Value;

#[test]
fn lines_act_on_a_running_bench_and_are_answered() {
    let eds = "[DeviceInfo]\nProductName=Inputs\n\
        [1000]\nParameterName=Device type\nDataType=7\nAccessType=const\nDefaultValue=0x191\n\
        [1001]\nParameterName=Error register\nDataType=5\nAccessType=ro\n\
        [1014]\nParameterName=COB-ID EMCY\nDataType=7\nAccessType=rw\nDefaultValue=$NODEID+0x80\n\
        [1018]\nParameterName=Identity object\nObjectType=9\nSubNumber=2\n\
        [1018sub0]\nParameterName=Highest\nDataType=5\nAccessType=const\nDefaultValue=1\n\
        [1018sub1]\nParameterName=Vendor-ID\nDataType=7\nAccessType=ro\nDefaultValue=0\n\
        [1800]\nParameterName=TPDO1\nObjectType=9\nSubNumber=3\n\
        [1800sub0]\nParameterName=Highest\nDataType=5\nAccessType=const\nDefaultValue=2\n\
        [1800sub1]\nParameterName=COB-ID\nDataType=7\nAccessType=rw\nDefaultValue=$NODEID+0x180\n\
        [1800sub2]\nParameterName=Type\nDataType=5\nAccessType=rw\nDefaultValue=255\n\
        [1A00]\nParameterName=Mapping\nObjectType=9\nSubNumber=2\n\
        [1A00sub0]\nParameterName=Count\nDataType=5\nAccessType=rw\nDefaultValue=1\n\
        [1A00sub1]\nParameterName=Entry\nDataType=7\nAccessType=rw\nDefaultValue=0x60000108\n\
        [6000]\nParameterName=Read input\nObjectType=8\nSubNumber=2\n\
        [6000sub0]\nParameterName=Highest\nDataType=5\nAccessType=const\nDefaultValue=1\n\
        [6000sub1]\nParameterName=Input 1\nDataType=5\nAccessType=ro\nHighLimit=9\nPDOMapping=1\n";
    let eds = file("control.eds", eds).display().to_string();
    let folder = temporary();
    let socket = folder.path().join("lines");
    let sim = Sim::start(&[&eds, "gxmm", "--node-id", "5", "--control", &unix(&socket)]);
    assert_eq!(sim.control(), unix(&socket));
    assert_eq!(sim.ready["nodes"][0]["node_id"], 5);
    assert_eq!(sim.ready["nodes"][1]["node_id"], 6);
    let mut client = sim.client();
    say(&mut client, "O\rt00020105\r", "\rz\rt185100\r");
    let done = sim.ctl(&["set 6000h:01 = 7", "emcy 4200h", "power cycle 20ms"]);
    assert_eq!(done.code, 0, "{}", done.err);
    assert_eq!(
        done.out,
        "node 5: 6000h:01 Read input.Input 1 = 7: on at bits 0, 1, 2\n\
         node 5: error 4200h (device temperature), error register 09h\n\
         node 5: power off for 20ms, then on\n"
    );
    say(&mut client, "", "t185107\rt08580042090000000000\rt705100\r");
    // Each client selects a device for its lines.
    let done = sim.ctl(&[
        "use 2",
        "set 6000h = 4",
        "switch node 12",
        "power cycle",
        "wait 1ms",
        "# nothing",
    ]);
    assert_eq!((done.code, done.err.as_str()), (0, ""));
    assert!(
        done.out.contains("node 6: rotary switches at 12"),
        "{}",
        done.out
    );
    say(&mut client, "", "t70C100\r");
    assert_eq!(sim.ctl(&["power off", "601#4000100000000000"]).code, 0);
    say(
        &mut client,
        "t60C84000100000000000\r",
        "t60184000100000000000\rz\rt58C84300100096010200\r",
    );
    for (lines, code, why) in [
        (
            &["power off", "hello", "nmt start"][..],
            2,
            "`hello` is not a verb or a frame",
        ),
        (&["sdo read 6004h"], 2, "this line works only in a script"),
        (
            &["set 6000h:01 = 5"],
            1,
            "the device has no power; write `power on`",
        ),
        (&["use 2", "set 6004h = 5"], 1, "is computed by the device"),
        (
            &["use 2", "set 6003h = fast"],
            1,
            "6003h Preset value: `fast` is not a number",
        ),
        (&["use 3"], 1, "device `3` does not exist"),
    ] {
        let done = sim.ctl(lines);
        assert_eq!(done.code, code, "{lines:?}: {}", done.err);
        assert!(done.err.contains(why), "{lines:?}: {}", done.err);
    }
    let gone = folder.path().join("nobody");
    let done = odkit(&["ctl", &unix(&gone), "power off"], "");
    assert_eq!(done.code, 1);
    assert!(done.err.contains("no `odkit sim --control"), "{}", done.err);
    assert_eq!(odkit(&["ctl", "tcp:nowhere", "power off"], "").code, 2);
}

/// CiA 301 leaves CAN to ISO 11898-1: a sender that sees 32 bit errors is bus-off, until its program restarts it.
#[test]
fn a_frame_that_the_line_does_not_carry_is_not_sent() {
    let folder = temporary();
    let socket = folder.path().join("line");
    let sim = Sim::start(&["gxmm", "--node-id", "5", "--control", &unix(&socket)]);
    let mut client = sim.client();
    say(&mut client, "O\r", "\r");
    let request = "605#4000100000000000";
    let short = sim.ctl(&["line real", "line short", request]);
    assert_eq!(short.code, 1, "{}", short.out);
    assert!(
        short.err.contains("is lost") && short.err.contains("`line restart`"),
        "{}",
        short.err
    );
    // Nobody has received it. A client that closes and opens its channel restarts the controller.
    say(&mut client, "F\rC\rO\rF\r", "FA4\r\r\rF00\r");
    let done = sim.ctl(&["line short off", request]);
    assert_eq!((done.code, done.err.as_str()), (0, ""));
    assert!(
        done.out.ends_with("605#4000100000000000 sent\n"),
        "{}",
        done.out
    );
    say(
        &mut client,
        "",
        "t60584000100000000000\rt58584300100096010200\r",
    );
    let alone = sim.ctl(&["line unplug", request]);
    assert_eq!(alone.code, 1, "{}", alone.out);
    assert!(alone.err.contains("no node acknowledges"), "{}", alone.err);
    say(&mut client, "F\r", "F24\r");
}

#[test]
fn a_frame_for_which_the_queue_has_no_room_is_not_sent() {
    let folder = temporary();
    let socket = folder.path().join("full");
    let sim = Sim::start(&["gxmm", "--node-id", "5", "--control", &unix(&socket)]);
    let alone = sim.ctl(&["line real", "line unplug"]);
    assert_eq!(alone.code, 0, "{}", alone.err);
    // Without another node no frame leaves the queue.
    let mut client = sim.client();
    // The error frames of the lone node keep a busy computer from its clients.
    let patience = Some(Duration::from_mins(2));
    client.set_read_timeout(patience).expect("a time limit");
    let frames = "t0010\r".repeat(1100);
    client
        .write_all(format!("O\r{frames}F\r").as_bytes())
        .expect("a client");
    let mut byte = [0];
    while byte != *b"F" {
        client.read_exact(&mut byte).expect("the answer to F");
    }
    let full = sim.ctl(&["605#4000100000000000"]);
    assert_eq!(full.code, 1, "{}", full.out);
    assert!(full.err.contains("their queue is full"), "{}", full.err);
    let twice = sim.ctl(&["send 605#4000100000000000 times 2"]);
    assert!(
        twice.code != 0 && !twice.out.contains("sent"),
        "{}{}",
        twice.out,
        twice.err
    );
}

#[test]
fn figures_are_text_and_json() {
    let folder = temporary();
    let socket = folder.path().join("stats");
    let sim = Sim::start(&["gxmm", "--control", &unix(&socket)]);
    let mut client = sim.client();
    let requests = "O\rt60184000100000000000\rt60184000200000000000\rt12310A\r";
    let answers = "\rz\rt58184300100096010200\rz\rt58188000200000000206\rz\r";
    say(&mut client, requests, answers);
    let done = sim.ctl(&["stats", "--format", "json"]);
    let stats: Value = serde_json::from_str(&done.out).expect("JSON");
    assert_eq!(stats["frames"], 6, "{stats}");
    assert_eq!(stats["dropped"], 0, "{stats}");
    assert!(
        stats["load"].as_f64().is_some_and(|load| load > 0.0),
        "{stats}"
    );
    let sent = &stats["clients"][0];
    assert_eq!(sent["protocol"], "slcan", "{stats}");
    assert_eq!(sent["frames"], 3, "{stats}");
    assert_eq!(
        (&sent["sdo_requests"], &sent["sdo_aborts"]),
        (&2.into(), &1.into()),
        "{stats}"
    );
    let text = sim.ctl(&["stats"]).out;
    assert!(text.contains("2 SDO requests, 1 abort"), "{text}");
    assert!(text.contains("node 1: Pre-operational"), "{text}");
}

#[test]
fn a_control_socket_has_one_owner() {
    let folder = temporary();
    let socket = folder.path().join("owner");
    let control = unix(&socket);
    let mut sim = Sim::start(&["gxmm", "--control", &control]);
    let mode = fs::metadata(&socket)
        .expect("a socket")
        .permissions()
        .mode();
    assert_eq!(mode & 0o777, 0o600);
    let second = odkit(
        &[
            "sim",
            "gxmm",
            "--slcan",
            "127.0.0.1:0",
            "--control",
            &control,
        ],
        "",
    );
    assert_eq!(second.code, 1);
    let owner = format!("is in use by process {} (odkit)", sim.child.id());
    assert!(
        !cfg!(target_os = "linux") || second.err.contains(&owner),
        "{}",
        second.err
    );
    // The socket of a killed process can be replaced; an orderly end removes it.
    sim.end("-KILL");
    assert!(socket.exists());
    let mut sim = Sim::start(&["gxmm", "--control", &control]);
    assert_eq!(sim.ctl(&["power off"]).code, 0);
    sim.end("-TERM");
    assert!(!socket.exists());
    // A control socket is not a link: when the last link is lost, the bench ends.
    let done = odkit(
        &["sim", "gxmm", "--link", "-", "--control", &control],
        "power off\n",
    );
    assert_eq!(done.code, 0, "{}", done.err);
    let not_mine = file("control.txt", "mine");
    let done = odkit(
        &[
            "sim",
            "gxmm",
            "--slcan",
            "127.0.0.1:0",
            "--control",
            &unix(&not_mine),
        ],
        "",
    );
    assert_eq!(done.code, 1);
    assert!(done.err.contains("is not a socket"), "{}", done.err);
    assert_eq!(fs::read_to_string(not_mine).expect("it is there"), "mine");
}

#[test]
fn tcp_is_for_this_computer_and_not_for_browsers() {
    let sim = Sim::start(&["gxmm", "--control", "tcp:127.0.0.1:0"]);
    let done = sim.ctl(&["power off"]);
    assert_eq!((done.code, done.out.as_str()), (0, "node 1: power off\n"));
    let place = sim.control().strip_prefix("tcp:").expect("a port");
    let mut browser = TcpStream::connect(place).expect("it listens");
    let request = b"POST / HTTP/1.1\r\nHost: x\r\n\r\npower on\n";
    browser.write_all(request).expect("it reads");
    let mut answer = String::new();
    // A connection that is reset gets no answer, either.
    let _ = browser.read_to_string(&mut answer);
    assert_eq!(answer, "");
    let text = sim.ctl(&["stats"]).out;
    assert!(text.contains("node 1: off"), "{text}");
    let wide = odkit(
        &[
            "sim",
            "gxmm",
            "--slcan",
            "127.0.0.1:0",
            "--control",
            "tcp:0.0.0.0:0",
        ],
        "",
    );
    assert_eq!(wide.code, 2);
    assert!(
        wide.err.contains("can be reached from other computers"),
        "{}",
        wide.err
    );
}

#[test]
fn no_client_of_the_control_socket_harms_another() {
    let folder = temporary();
    let socket = folder.path().join("flood");
    let sim = Sim::start(&["gxmm", "--control", &unix(&socket)]);
    let connect = || UnixStream::connect(&socket).expect("it listens");
    // Bytes that are not text, and a line without an end.
    let mut noise = connect();
    noise.write_all(b"\xFF\xFE\0\n").expect("it reads");
    let mut answer = [0; 6];
    noise.read_exact(&mut answer).expect("an answer");
    assert_eq!(&answer, b"wrong ");
    let _ = noise.write_all(&[b'x'; 100_000]);
    // Too many waiting lines end the connection.
    let mut flood = connect();
    let lines = format!("wait 1min\n{}", "nmt start\n".repeat(5000));
    let _ = flood.write_all(lines.as_bytes());
    let mut rest = Vec::new();
    let _ = flood.read_to_end(&mut rest);
    assert_eq!(rest, b"");
    let text = sim.ctl(&["stats"]).out;
    assert!(text.contains("node 1: Pre-operational"), "{text}");
    // All waiting answers are sent.
    let mut many = connect();
    many.write_all(format!("wait 10ms\n{}", "stats\n".repeat(900)).as_bytes())
        .expect("it reads");
    let mut answers = BufReader::new(many).lines();
    for _ in 0..901 {
        let ends = |line: &String| line.starts_with("ok");
        answers
            .by_ref()
            .map(|line| line.expect("a line"))
            .find(ends)
            .expect("an answer");
    }
    // Power that a line switched off returns, although its sender has disconnected.
    let mut client = sim.client();
    say(&mut client, "O\r", "\r");
    let mut leaver = connect();
    leaver
        .write_all(b"power cycle 50ms\nwait 1min\npower off\n")
        .expect("it reads");
    drop(leaver);
    say(&mut client, "", "t701100\r");
    drop(noise);
    let mut guests: Vec<_> = (0..16).map(|_| connect()).collect();
    let refused = until("a refusal", || {
        // A client that has just disconnected may have used one of these places.
        guests.push(connect());
        let done = sim.ctl(&["stats"]);
        (done.code == 1).then_some(done.err)
    });
    assert!(refused.contains("the limit is 16 clients"), "{refused}");
    drop(guests);
    until("room", || (sim.ctl(&["stats"]).code == 0).then_some(()));
}
