//! Diagnosis of logs that the bench recorded: faults with the right cause first, healthy logs without an incident.

use od_eds::Tables;
use od_model::{Dictionary, Refused};
use od_sim::EdsOptions;
use od_sim::VirtualDevice;
use od_sim::bus::Bus;
use od_sim::diagnose::{BusFacts, Incident, diagnose, rules};
use od_sim::logs::candump::parse_frame;
use od_sim::logs::{BusError, Record, What};
use od_sim::script::{Host, Origin, Script, run};
use od_wire::{Frame, Instant, NodeId};

use crate::support::odkit;

const FAULTS: &str = include_str!("../diagnose/faults.txt");
const HEALTHY: &str = include_str!("../diagnose/healthy.txt");
const DS301: &str = include_str!("../../../../firmware/eds/ds301.eds");
const SERVICES: &str = include_str!("../../../../tests/eds/services.eds");

/// A log with its title.
struct Case<'t> {
    title: &'t str,
    script: String,
    /// Frames of foreign nodes.
    also: Vec<Record>,
    /// Node and built-in device of `eds 5=gxmm`.
    eds: Option<(u8, &'t str)>,
}

fn cases(text: &str) -> Vec<Case<'_>> {
    let parts = text.split("\n## ").skip(1);
    parts.map(case).collect()
}

fn case(text: &str) -> Case<'_> {
    let (title, lines) = text.split_once('\n').expect("a title");
    let mut case = Case {
        title,
        script: String::new(),
        also: Vec::new(),
        eds: None,
    };
    for line in lines.lines() {
        if let Some(rest) = line.strip_prefix("also ") {
            case.also.extend(foreign(rest));
        } else if let Some(rest) = line.strip_prefix("eds ") {
            let (node, name) = rest.split_once('=').expect("a node and a name");
            case.eds = Some((node.parse().expect("a node ID"), name));
        } else {
            case.script += line;
            case.script.push('\n');
        }
    }
    case
}

/// `FRAME FROM TO PERIOD JITTER` (`error`: an error frame), in ms with or without a decimal point. Each frame is late by a random time of up to two jitters.
fn foreign(text: &str) -> Vec<Record> {
    let words: Vec<&str> = text.split(' ').collect();
    let [frame, from, to, period, jitter] = words[..] else {
        panic!("{text}");
    };
    let number = |word: &str| (word.parse::<f64>().expect("a number") * 1000.0) as u64;
    let (from, to, period, jitter) = (number(from), number(to), number(period), number(jitter));
    let what = match frame {
        "error" => What::Error(BusError::Frame),
        frame => What::Frame(parse_frame(frame).expect("a frame")),
    };
    let mut all = Vec::new();
    let mut seed = 7u64;
    for at in (from..to).step_by(period as usize) {
        seed = seed
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        let off = if jitter == 0 {
            0
        } else {
            (seed >> 33) % (2 * jitter)
        };
        all.push(record(at + off, what));
    }
    all
}

fn record(micros: u64, what: What) -> Record {
    Record {
        at: Instant::from_micros(micros),
        sent: false,
        what,
    }
}

/// Records what is on the bus.
#[derive(Default)]
struct Recorder(Vec<Record>);

impl Host for Recorder {
    fn device(
        &mut self,
        name: Option<&str>,
        node: Option<NodeId>,
    ) -> Result<VirtualDevice, Refused> {
        let name = name.unwrap_or("gxmm");
        let text = match name {
            "ds301" => DS301,
            "services" => SERVICES,
            _ => {
                let kind = od_devices::find(name).ok_or_else(|| Refused::from(name.to_owned()))?;
                return Ok(VirtualDevice::new(kind, node.unwrap_or(NodeId::ONE)));
            }
        };
        let options = EdsOptions {
            node_id: node,
            lenient: true,
        };
        let (device, _) = VirtualDevice::read_eds(text, options);
        device.ok_or_else(|| Refused::from(name.to_owned()))
    }

    fn frame(&mut self, at: Instant, _: Origin, frame: &Frame) {
        self.0.push(record(at.as_micros(), What::Frame(*frame)));
    }

    fn look(&mut self, bus: &mut Bus) {
        while let Some(one) = bus.line.poll() {
            self.0
                .push(record(one.at.as_micros(), What::Error(BusError::Frame)));
        }
    }
}

/// The log of a case.
fn log(case: &Case<'_>) -> Vec<Record> {
    let mut recorder = Recorder::default();
    if !case.script.trim().is_empty() {
        let script = Script::parse(&case.script)
            .unwrap_or_else(|problems| panic!("{}: {problems:?}", case.title));
        if let Err(stop) = run(&script, &mut recorder) {
            panic!("{}: {stop:?}", case.title);
        }
    }
    let mut all = recorder.0;
    all.extend(&case.also);
    all.sort_by_key(|record| record.at);
    all
}

fn diagnosed(case: &Case<'_>) -> (Vec<Record>, Vec<Incident>) {
    let records = log(case);
    let tables = case.eds.map(|(node, name)| {
        let text = od_devices::text::eds(od_devices::find(name).expect("a device"));
        (node, Tables::new(&od_eds::parse(&text).description))
    });
    let incidents = {
        let of = |node: u8| -> Option<Dictionary<'_>> {
            let (own, tables) = tables.as_ref()?;
            (*own == node).then(|| tables.dictionary())
        };
        let known = BusFacts {
            bit_rate: None,
            dictionary: Some(&of),
        };
        diagnose(&records, known)
    };
    (records, incidents)
}

#[test]
fn the_cause_of_a_fault_is_named_first() {
    let all = cases(FAULTS);
    assert!(all.len() >= 40, "{} faults", all.len());
    let mut missed = Vec::new();
    let mut shown = std::collections::BTreeSet::new();
    for case in &all {
        let (wanted, _) = case.title.split_once(": ").expect("a cause");
        let (records, incidents) = diagnosed(case);
        shown.extend(incidents.iter().map(|incident| incident.rule));
        // The fault is one incident, and its cause the first.
        let is_found = matches!(&incidents[..], [only] if only.causes.first().is_some_and(|cause| cause.id == wanted));
        let is_shown = incidents
            .iter()
            .all(|one| !one.records.is_empty() && one.begin <= one.end);
        assert!(is_shown, "{}: {incidents:#?}", case.title);
        if !is_found {
            let lines: Vec<String> = incidents
                .iter()
                .map(|one| {
                    let ids: Vec<&str> = one.causes.iter().map(|cause| cause.id).collect();
                    format!("    {}: {} {ids:?}", one.rule, one.text)
                })
                .collect();
            missed.push(format!(
                "{} ({} records)\n{}",
                case.title,
                records.len(),
                lines.join("\n")
            ));
        }
    }
    let found = all.len() - missed.len();
    assert!(
        found == all.len(),
        "{found} of {} causes first:\n{}",
        all.len(),
        missed.join("\n")
    );
    let unseen: Vec<&str> = rules()
        .map(|(name, _)| name)
        .filter(|name| !shown.contains(name))
        .collect();
    assert!(
        unseen.is_empty(),
        "rules without a log that shows them: {unseen:?}"
    );
}

/// Each rule has a healthy log that looks like its fault.
#[test]
fn each_rule_has_a_log_that_looks_like_its_fault() {
    let healthy = cases(HEALTHY);
    let names: Vec<&str> = rules().map(|(name, _)| name).collect();
    let like = |name: &str| {
        healthy
            .iter()
            .any(|case| case.title.split(": ").next() == Some(name))
    };
    let missing: Vec<&&str> = names.iter().filter(|name| !like(name)).collect();
    assert!(missing.is_empty(), "{missing:?}");
    for case in &healthy {
        if let Some((name, _)) = case.title.split_once(": ") {
            assert!(names.contains(&name), "{name} is not a rule");
        }
    }
}

/// The cause names what the log knows of it.
#[test]
fn a_cause_names_what_the_log_shows() {
    let all = cases(FAULTS);
    let told = |title: &str| {
        let case = all
            .iter()
            .find(|case| case.title.ends_with(title))
            .expect("a case");
        diagnosed(case).1[0].causes[0].text.clone()
    };
    for (title, part) in [
        (
            "how many of its bytes are used",
            "announces 10 bytes, and its segments have 14",
        ),
        ("the error history with FFh", "1003h:00 accepts only 0"),
        ("requests a segment with 50h", "the command byte 50h"),
        (
            "insists on a block transfer",
            "does not support block transfer",
        ),
        ("leaves Operational after an EMCY", "4310h, temperature"),
        (
            "its client aborts",
            "the SDO server of node 5 does not alternate",
        ),
    ] {
        assert!(told(title).contains(part), "{}", told(title));
    }
}

/// The formats of the command, its exit code, and a log without times.
#[test]
fn the_command_shows_causes_and_sets_the_exit_code() {
    let path = std::path::Path::new(env!("CARGO_TARGET_TMPDIR")).join("diagnose.log");
    let all = cases(FAULTS);
    let case = all
        .iter()
        .find(|case| case.title.starts_with("watchdog: a node restarts"));
    let lines = log(case.expect("a case"))
        .into_iter()
        .filter_map(|record| match record.what {
            What::Frame(frame) => Some(format!("({:?}) can0 {frame}\n", record.at)),
            What::Error(_) => None,
        });
    std::fs::write(&path, lines.collect::<String>()).expect("a log");
    let path = path.display().to_string();
    let run = |more: &[&str]| odkit(&[&["diagnose", &path], more].concat(), "");
    let text = run(&[]);
    assert_eq!(text.code, 0, "{}", text.err);
    for part in [
        "1 incident in 113 records",
        "1. node 5 restarts 4 times without a command",
        "cause 1: the firmware of node 5 fails, and its watchdog restarts it, every\n            2000 ms\n",
        "705  00                       NMT EC node 5: boot-up",
    ] {
        assert!(text.out.contains(part), "{part}\n{}", text.out);
    }
    let own = text.out.lines().filter(|line| !line.contains("NMT"));
    assert!(own.clone().all(|line| line.len() <= 80), "{}", text.out);
    assert_eq!(run(&["--check"]).code, 1);
    let json = run(&["--format", "json"]);
    let json: serde_json::Value = serde_json::from_str(&json.out).expect("JSON");
    let incident = &json["logs"][0]["incidents"][0];
    assert_eq!(incident["causes"][0]["id"], "watchdog");
    assert_eq!(incident["recovered"], true);
    let markdown = run(&["--format", "md"]);
    assert!(
        markdown.out.contains("## 1. node 5 restarts 4 times"),
        "{}",
        markdown.out
    );
    let untimed = "  can0  602   [8]  40 00 10 00 00 00 00 00\n\
                   \x20 can0  582   [8]  80 00 10 00 00 00 02 06\n\
                   \x20 can0  082   [8]  10 42 09 00 00 00 00 00\n";
    let run = |more: &[&str]| odkit(&[&["diagnose", "-"], more].concat(), untimed);
    let text = run(&[]);
    assert_eq!(text.code, 0, "{}", text.err);
    for part in [
        "1 incident in 3 records\n",
        "node 2 reports 4210h",
        "   not recovered\n",
    ] {
        assert!(text.out.contains(part), "{part}\n{}", text.out);
    }
    for part in ["the log has no times", "bus-load", "`candump -L` records"] {
        assert!(text.err.contains(part), "{part}\n{}", text.err);
    }
    let json = run(&["--format", "json"]);
    let json: serde_json::Value = serde_json::from_str(&json.out).expect("JSON");
    assert!(
        json["logs"][0]["incidents"][0]["begin_us"].is_null(),
        "{json}"
    );
}

#[test]
fn a_log_of_another_protocol_is_named() {
    let log = "(0.1) can0 0CF00400#F07D7D0020000000\n(0.2) can0 18FEF100#FF\n";
    for command in ["diagnose", "decode"] {
        let one = odkit(&[command, "-"], log);
        assert_eq!(one.code, 0, "{}", one.err);
        assert!(
            one.err
                .contains("this is not CANopen: all CAN-IDs have 29 bits"),
            "{}",
            one.err
        );
    }
    let json = odkit(&["diagnose", "-", "--format", "json"], log).out;
    let json: serde_json::Value = serde_json::from_str(&json).expect("JSON");
    assert!(json["logs"][0]["other_protocol"].is_string(), "{json}");
}

/// A node ID on two buses is two nodes.
#[test]
fn each_channel_of_a_log_is_a_bus_of_its_own() {
    let mut log = String::new();
    for beat in 0..20 {
        log += &format!("({}.000) can0 705#05\n({}.300) can1 705#05\n", beat, beat);
    }
    let both = odkit(&["diagnose", "-", "--check"], &log);
    assert_eq!(both.code, 0, "{}", both.out);
    for part in [
        "-, channel can0: 0 incidents in 20 records",
        "-, channel can1: 0 incidents",
    ] {
        assert!(both.out.contains(part), "{}", both.out);
    }
    let one = odkit(&["diagnose", "-", "--check"], &log.replace("can1", "can0"));
    assert!(
        one.out.contains("two devices have node ID 5"),
        "{}",
        one.out
    );
    let words = odkit(&["decode", "-"], &log);
    assert!(
        words
            .err
            .contains("the frames of 2 channels (can0 to can1)"),
        "{}",
        words.err
    );
}

/// The log of a case as `candump` prints it without an option: frames in their order, without times.
fn without_times(case: &Case<'_>) -> Vec<Incident> {
    let mut records = log(case);
    for record in &mut records {
        record.at = Instant::ZERO;
    }
    diagnose(&records, BusFacts::default())
}

/// A fault that only times show stays unseen; a fault that is found has its cause.
#[test]
fn without_times_the_order_of_the_frames_shows_a_fault_or_nothing() {
    let (mut found, mut wrong) = (0, Vec::new());
    let all = cases(FAULTS);
    for case in &all {
        let (wanted, _) = case.title.split_once(": ").expect("a cause");
        let incidents = without_times(case);
        found += usize::from(!incidents.is_empty());
        for incident in incidents {
            let ids: Vec<&str> = incident.causes.iter().map(|cause| cause.id).collect();
            // The sign of a fault that needs times, without its cause.
            let is_sign = matches!(
                ids[0],
                "error-control" | "error-behaviour" | "other-response" | "overrun"
            );
            if !is_sign && !ids[..ids.len().min(2)].contains(&wanted) {
                wrong.push(format!("{}: {} {ids:?}", case.title, incident.text));
            }
            assert!(!incident.span().contains(" to "), "{}", incident.span());
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert!(found * 10 >= all.len() * 6, "{found} of {}", all.len());
    let healthy = cases(HEALTHY).into_iter();
    let wrong: Vec<(&str, String)> = healthy
        .flat_map(|case| {
            without_times(&case)
                .into_iter()
                .map(move |one| (case.title, one.text))
        })
        .collect();
    assert!(wrong.is_empty(), "{wrong:#?}");
}

/// A client that repeats its request gets two responses, and the node is one.
#[test]
fn a_repeated_request_with_two_responses_has_a_late_response() {
    let late = [
        (0, "605#4000100000000000"),
        (200_000, "605#4000100000000000"),
        (250_000, "585#4300100096010200"),
        (260_000, "585#4300100096010200"),
    ];
    for has_times in [true, false] {
        let records = late.map(|(at, text)| {
            let frame = parse_frame(text).expect("a frame");
            record(at * u64::from(has_times), What::Frame(frame))
        });
        let found = diagnose(&records, BusFacts::default());
        let causes = found.iter().flat_map(|one| &one.causes);
        let causes: Vec<(&str, &str)> = causes.map(|one| (one.id, &*one.text)).collect();
        let after = if has_times {
            "node 5 responds after 250 ms, and the client waits for 200 ms"
        } else {
            "node 5 responds only after the client has given up"
        };
        assert_eq!(causes, [("late-response", after)]);
    }
}

/// SocketCAN says what went wrong: without it, error frames between frames look like a missing terminator.
#[test]
fn an_adapter_without_an_acknowledge_is_alone() {
    let log = |error: &str| {
        let mut text = String::new();
        for number in 0..40 {
            text += &format!("({number}.0) can0 705#05\n({number}.1) can0 {error}\n");
        }
        let log = od_sim::logs::read(text.as_bytes()).expect("a log");
        let found = diagnose(&log.records, BusFacts::default());
        found
            .into_iter()
            .map(|one| (one.text, one.causes[0].id))
            .collect::<Vec<_>>()
    };
    let frames = "40 error frames and 39 frames between them".to_owned();
    assert_eq!(
        log("20000020#0000000000000000"),
        [(frames.clone(), "no-acknowledge")]
    );
    assert_eq!(log("20000088#0000040000000000"), [(frames, "terminator")]);
    let passive = "the adapter is error passive".to_owned();
    assert_eq!(log("20000004#0030000000008080"), [(passive, "terminator")]);
    assert_eq!(log("20000002#0500000000000000"), []);
}

/// A probe reads each object once. A client that reads a missing object again and again needs it.
#[test]
fn a_missing_object_that_is_read_again_and_again_is_a_fault() {
    let log = |times: u64| {
        let records = (0..times).flat_map(|number| {
            let at = number * 100_000;
            let frame = |text| What::Frame(parse_frame(text).expect("a frame"));
            [
                record(at, frame("601#4002650000000000")),
                record(at + 1000, frame("581#8002650000000206")),
            ]
        });
        let found = diagnose(&records.collect::<Vec<_>>(), BusFacts::default());
        found
            .into_iter()
            .map(|one| (one.text, one.causes[0].id))
            .collect::<Vec<_>>()
    };
    assert_eq!(log(2), []);
    let text = "node 1 refuses to read 6502h:00 3 times: 06020000h, object does not exist";
    assert_eq!(log(3), [(text.to_owned(), "refused")]);
}

/// Heartbeats and PDOs in an even order are no two senders: without times their distance is not known.
#[test]
fn without_times_an_uneven_order_of_frames_is_no_fault() {
    let frames = ["705#05", "185#0102", "705#05", "186#01", "187#01", "188#01"];
    let records = frames.iter().cycle().take(600);
    let records: Vec<Record> = records
        .map(|text| record(0, What::Frame(parse_frame(text).expect("a frame"))))
        .collect();
    assert_eq!(diagnose(&records, BusFacts::default()), []);
}

#[test]
fn a_healthy_log_has_no_incident() {
    let all = cases(HEALTHY);
    assert!(all.len() >= 20, "{} logs", all.len());
    let mut wrong = Vec::new();
    for case in &all {
        let (_, incidents) = diagnosed(case);
        if !incidents.is_empty() {
            let lines: Vec<String> = incidents
                .iter()
                .map(|one| format!("    {}: {}", one.rule, one.text))
                .collect();
            wrong.push(format!("{}\n{}", case.title, lines.join("\n")));
        }
    }
    assert!(
        wrong.is_empty(),
        "{} of {}:\n{}",
        wrong.len(),
        all.len(),
        wrong.join("\n")
    );
}

/// The same signs for hours: each rule takes time in proportion to the log. One that looks at each pair of frames would take
/// minutes.
#[test]
fn a_long_log_takes_no_longer_for_each_frame() {
    const FRAMES: u64 = 40_000;
    let signs = [
        ("boots", "705#00"),
        ("EMCY", "085#1081110000000000"),
        ("SYNC", "080# 185#0102"),
        ("two nodes", "705#05 705#7F"),
        ("refused", "605#4000200000000000 585#8000200000000206"),
        ("unanswered", "605#4000200000000000"),
    ];
    let from = std::time::Instant::now();
    for (title, frames) in signs {
        let records: Vec<Record> = (0..FRAMES)
            .zip(frames.split(' ').cycle())
            .map(|(number, text)| {
                let frame = parse_frame(text).expect("a frame");
                record(number * 20_000, What::Frame(frame))
            })
            .collect();
        let known = BusFacts {
            bit_rate: None,
            dictionary: None,
        };
        let incidents = diagnose(&records, known);
        assert!(incidents.len() < 1000, "{title}: {}", incidents.len());
    }
    // Some seconds on a busy computer.
    assert!(from.elapsed().as_secs() < 60, "{:?}", from.elapsed());
}
