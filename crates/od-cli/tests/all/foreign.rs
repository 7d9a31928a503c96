//! Text of a file, a device or a peer never acts on a terminal, a page or a table, in any command and format.

use std::fs;

use od_model::is_hidden;

use crate::support::quiet::Sim;
use crate::support::{file, odkit, repository};

/// Sets a title, rings, clears the screen in two ways, turns the direction, and is a script, a cell, code
/// and a formula.
const EVIL: &str =
    "=HYPERLINK(1) \x1b]0;PWNED\x07\x1b[31mRED\x1b[2J\u{9b}2J\u{202e}\u{85}\x7f<script>|`x`";

/// An EDS with this text wherever an EDS has text, and with findings about it.
fn eds() -> String {
    let text = fs::read_to_string(repository("devices/eds/GXMM.eds")).expect("an EDS");
    let mut out = String::new();
    for line in text.lines() {
        let key = line.split('=').next().unwrap_or_default();
        match key {
            "Description" | "VendorName" | "ProductName" | "OrderCode" | "ParameterName" => {
                out.push_str(&format!("{key}={EVIL}\n"));
            }
            "DefaultValue" if line == "DefaultValue=GXMM" => {
                out.push_str(&format!("DefaultValue={EVIL}\n"));
            }
            "Line1" => out.push_str(&format!("Line1={EVIL}\n{EVIL}=1\n")),
            "EDSVersion" => out.push_str(&format!("EDSVersion={EVIL}\n")),
            _ => out.push_str(&format!("{line}\n")),
        }
    }
    out.push_str(&format!(
        "\n[{EVIL}]\nOwn={EVIL}\n[6005]\nParameterName={EVIL}\nDataType={EVIL}\nAccessType={EVIL}\n"
    ));
    out
}

/// An XDD with the same text; in XML, a name can contain line ends.
fn xdd(folder: &str) -> String {
    let (from, to) = (
        file(&format!("{folder}.eds"), &eds()),
        file(&format!("{folder}.xdd"), ""),
    );
    let (from, to) = (from.display().to_string(), to.display().to_string());
    odkit(&["convert", &from, "-o", &to, "--lossy"], "");
    let text = fs::read_to_string(&to).expect("an XDD");
    assert!(text.contains("=HYPERLINK"), "{text}");
    fs::write(
        &to,
        text.replace("=HYPERLINK(1)", "=HYPERLINK(1)&#10;::error::&#13;"),
    )
    .expect("a file");
    to
}

/// Checks that a text contains no control character and no hidden one.
#[track_caller]
fn harmless(what: &str, text: &str) {
    let hidden = |c: &char| is_hidden(*c) && !matches!(c, '\n' | '\t');
    if let Some(at) = text.find(|c| hidden(&c)) {
        let around: String = text[at..].chars().take(40).collect();
        panic!("{what}: {around:?}");
    }
}

#[track_caller]
fn no_markup(what: &str, text: &str) {
    assert!(!text.contains("<script>"), "{what}: {text}");
    // The text does not end a code span or a fence of the page.
    assert!(!text.contains("|`x`"), "{what}: {text}");
}

/// No cell of a CSV begins as a formula.
#[track_caller]
fn no_formula(what: &str, text: &str) {
    for line in text.lines() {
        for cell in line.split(',').map(|cell| cell.trim_start_matches('"')) {
            let is_formula = cell.starts_with(['=', '+', '-', '@']) && cell.parse::<f64>().is_err();
            assert!(!is_formula, "{what}: {line}");
        }
    }
}

/// Runs a command and checks what it prints and writes.
#[track_caller]
fn run(line: &str) -> String {
    let args: Vec<&str> = line.split_whitespace().collect();
    let done = odkit(&args, "");
    assert!(done.code <= 2, "{line}");
    for (place, text) in [
        ("standard output", &done.out),
        ("standard error", &done.err),
    ] {
        harmless(&format!("{line}: {place}"), text);
        assert!(!text.contains("\n::error::"), "{line}: {place}: {text}");
    }
    if line.contains("format json") && !line.contains("watch") && !line.contains("monitor") {
        let json: Result<serde_json::Value, _> = serde_json::from_str(&done.out);
        assert!(json.is_ok() || done.out.is_empty(), "{line}: {}", done.out);
    }
    done.out
}

#[test]
fn files_show_it_in_every_format() {
    let eds = file("foreign.eds", &eds()).display().to_string();
    let xdd = xdd("foreign-xml");
    for path in [eds.as_str(), xdd.as_str()] {
        for format in ["full", "concise", "grouped", "json", "sarif", "github"] {
            let said = run(&format!("check {path} --remarks --format {format}"));
            assert!(said.contains("E0402"), "{said}");
        }
        run(&format!("check {path} --diff"));
        run(&format!("check {path} --statistics"));
        run(&format!("check {path} --for all"));
        let table = run(&format!("dump {path}"));
        assert!(table.contains("\\u{1b}"), "{table}");
        no_markup("dump", &run(&format!("dump {path} --format md")));
        for format in ["text", "json"] {
            run(&format!("diff gxmm {path} --format {format}"));
        }
        no_markup("diff", &run(&format!("diff gxmm {path} --format markdown")));
        run(&format!("export {path} --lossy"));
        for form in ["eds", "dcf --node-id 5", "xdd", "c", "dbc", "json"] {
            run(&format!("convert {path} --lossy --to {form}"));
        }
        no_markup("convert", &run(&format!("convert {path} --lossy --to md")));
        for ending in ["eds", "xdd", "h", "md", "dbc", "json", "c"] {
            let to = file("foreign-out", "")
                .with_extension(ending)
                .display()
                .to_string();
            let kind = if ending == "c" {
                "--to canopennode"
            } else {
                ""
            };
            run(&format!("convert {path} --lossy {kind} -o {to}"));
            let written = fs::read_to_string(&to).unwrap_or_default();
            harmless(&to, &written);
            if ending == "md" {
                no_markup(&to, &written);
            }
        }
        for format in ["text", "json"] {
            run(&format!("conform {path} --only nmt* --format {format}"));
        }
        for ending in ["txt", "json", "xml", "md", "html"] {
            let report = file("foreign-report", "").with_extension(ending);
            run(&format!(
                "conform {path} --only sdo* --report {}",
                report.display()
            ));
            let written = fs::read_to_string(&report).expect("a report");
            harmless(ending, &written);
            if matches!(ending, "md" | "html") {
                assert!(!written.contains("<script>"), "{written}");
            }
        }
    }
}

#[test]
fn logs_show_it_in_every_format() {
    let eds = file("foreign-log.eds", &eds()).display().to_string();
    let mut log =
        String::from("(0.1) can0 601#4008100000000000\n(0.2) can0 181#0102030405060708\n");
    log.push_str("(0.3) can0 601#4004600000000000\n(0.4) can0 581#4304600092950700\n");
    log.push_str("(0.5) can0 581#4F08100\u{9b}\x1b[2J\n");
    let log = file("foreign.log", &log).display().to_string();
    for format in ["text", "json"] {
        run(&format!("decode {log} --eds {eds} --format {format}"));
    }
    let table = run(&format!("decode {log} --eds {eds} --format csv"));
    no_formula("decode", &table);
    for format in ["text", "json", "md"] {
        let said = run(&format!("diagnose {log} --eds {eds} --format {format}"));
        if format == "md" {
            // Between two fences the text is code.
            let outside: String = said.split("```").step_by(2).collect();
            no_markup("diagnose", &outside);
        }
    }
    let script = format!("device {eds}\nstart\nexpect 6004h = 5\n{EVIL}\n");
    run(&format!(
        "run {}",
        file("foreign.script", &script).display()
    ));
}

#[test]
fn networks_show_it() {
    let eds = file("foreign-net.eds", &eds()).display().to_string();
    let yaml =
        "master:\n  node_id: 127\n  baudrate: 500\n\"a\\n\\e[2J\\x9b=1\":\n  node_id: 2\n  dcf: ";
    let project = file("foreign.yml", &format!("{yaml}{eds}\n"))
        .display()
        .to_string();
    let said = run(&format!("network {project}"));
    assert!(said.contains("a\\n\\u{1b}[2J"), "{said}");
    let folder = file("foreign-net", "")
        .with_extension("d")
        .display()
        .to_string();
    run(&format!("network {project} -o {folder}"));
    let list = format!(
        "[Topology]\nNodes=1\nNetName={EVIL}\nNode1Present=1\nNode1Name={EVIL}\nNode1DCFName={eds}\n"
    );
    run(&format!("network {}", file("foreign.cpj", &list).display()));
    // Findings quote keys and values; a fix writes the file again.
    let keys = format!(
        "master:\n  node_id: 127\n  baudrate: 500\n  sync_periods: 5\n  \"{}\": 1\nslave:\n  node_id: 200\n  dcf: {eds}\n",
        EVIL.escape_debug()
    );
    let nodes = format!(
        "defaults:\n  dcf: {eds}\n  \"\\e[2J\": 1\nnodes:\n  - \"\\e]0;x\\a\":\n      node_id: \"\\x9b\"\n"
    );
    for (name, text) in [("keys", &keys), ("nodes", &nodes), ("list", &list)] {
        let ending = if name == "list" { "cpj" } else { "yml" };
        let path = file(&format!("foreign-{name}.{ending}"), text);
        for option in ["", "--fix", "--unsafe-fixes"] {
            run(&format!("network {} {option}", path.display()));
        }
    }
}

#[cfg(unix)]
#[test]
fn a_bus_shows_it_in_every_format() {
    let eds = file("foreign-bus.eds", &eds()).display().to_string();
    let mut sim = Sim::start(&[&eds, "--node-id", "5", "--control", "tcp:127.0.0.1:0"]);
    harmless("ready", &sim.ready.to_string());
    let address = sim.ready["links"][0]["address"].as_str().expect("a port");
    let link = format!("--link slcan:{address}");
    for format in ["text", "json"] {
        let scan = run(&format!(
            "scan {link} --listen 0 --answer 100 --format {format}"
        ));
        assert!(scan.contains("HYPERLINK"), "{scan}");
        run(&format!("get 5 * {link} --eds {eds} --format {format}"));
        run(&format!("get 5 1008h {link} --format {format}"));
        run(&format!(
            "watch 5 1008h 6004h {link} --eds {eds} --count 2 --format {format}"
        ));
        run(&format!(
            "monitor {link} --eds {eds} --for 0.2 --format {format}"
        ));
        run(&format!("lss scan {link} --format {format}"));
        run(&format!(
            "set 5 6001h=5000 {link} --eds {eds} --format {format}"
        ));
    }
    let csv = file("foreign.csv", "").display().to_string();
    run(&format!(
        "watch 5 1008h 6004h {link} --eds {eds} --count 4 --csv {csv}"
    ));
    let written = fs::read_to_string(&csv).expect("a CSV");
    harmless(&csv, &written);
    no_formula(&csv, &written);
    let learned = file("foreign-learned.eds", "").display().to_string();
    run(&format!("learn 5 {link} -o {learned}"));
    harmless(&learned, &fs::read_to_string(&learned).expect("an EDS"));
    let dcf = file("foreign-backup.dcf", "").display().to_string();
    run(&format!("backup 5 {link} --eds {eds} -o {dcf}"));
    harmless(&dcf, &fs::read_to_string(&dcf).expect("a DCF"));
    run(&format!("diff {eds} {link} --node-id 5"));
    for format in ["text", "json"] {
        run(&format!("apply 5 {dcf} {link} --force --format {format}"));
        run(&format!("apply 5 {eds} {link} --force --format {format}"));
    }
    for line in ["stats", "state", "get 1008h", EVIL] {
        let done = sim.ctl(&[line]);
        harmless(line, &done.out);
        harmless(line, &done.err);
    }
    harmless("sim", &sim.end("-TERM"));
}

#[test]
fn scripts_lessons_and_new_devices_show_it() {
    let eds = file("foreign-new.eds", &eds()).display().to_string();
    let script = format!("device {eds} node 5\nstart\nrandom 10\nexpect 1008h = \"{EVIL}\"\n");
    let script = file("foreign-random.script", &script).display().to_string();
    run(&format!("campaign {script} --seeds 0..2"));
    let lesson = format!("# {EVIL}\n## {EVIL}\n{EVIL}\n```checkpoint\n{EVIL}\n```\n");
    let lesson = file("foreign-lesson.md", &lesson).display().to_string();
    run(&format!("lesson check {lesson}"));
    run(&format!("lesson show {lesson}"));
    let progress = serde_json::json!({ "name": EVIL, "lessons": [{ "lesson": EVIL }] });
    let progress = file("foreign-progress.json", &progress.to_string());
    run(&format!("lesson progress {}", progress.display()));
    let folder = crate::support::temporary();
    let made = folder.path().join("made");
    let repaired = file("foreign-name.eds", &named()).display().to_string();
    run(&format!(
        "new {repaired} --name made --path {}",
        made.display()
    ));
    for path in ["README.md", "src/lib.rs", "src/main.rs", "Cargo.toml"] {
        let written = fs::read_to_string(made.join(path)).expect("a file of the crate");
        harmless(path, &written);
        // In a Rust string the text is what it is; a page of documentation shows it.
        let shown: Vec<&str> = written
            .lines()
            .filter(|line| !line.starts_with("const "))
            .collect();
        no_markup(path, &shown.join("\n"));
    }
}

/// A valid EDS whose product has this name.
fn named() -> String {
    let text = fs::read_to_string(repository("devices/eds/GXMM.eds")).expect("an EDS");
    let line = |line: &str| match line.split_once('=') {
        Some(("ProductName", _)) => format!("ProductName={EVIL}\n"),
        _ => format!("{line}\n"),
    };
    text.lines().map(line).collect()
}

/// The parser of the command line quotes arguments, which may be names of files of others.
#[test]
fn a_wrong_argument_is_shown_escaped() {
    for args in [
        &[EVIL][..],
        &["scan", EVIL],
        &["scan", "--format", EVIL],
        &["nmt", EVIL, "start"],
        &["backup", "5", "--link", EVIL, "-o", EVIL],
        &["conform", "gxmm", "--only", EVIL],
        &["sim", EVIL],
        &["bridge", EVIL],
        &["class", "--port", EVIL],
        &["explain", EVIL],
        &["ctl", EVIL, EVIL],
    ] {
        let done = odkit(args, "");
        assert!(done.code == 1 || done.code == 2, "{args:?}");
        harmless(args[0], &done.out);
        harmless(args[0], &done.err);
    }
}

/// A new command gets its lines here.
#[test]
fn each_command_shows_foreign_text_in_a_test() {
    const HERE: &str = include_str!("foreign.rs");
    // Text of others reaches these as a frame, a number or a message of another program only, or tests of their own read
    // it: `class.rs` what students send, `lsp` in od-lsp. The last four write to a node, and say no text of it.
    let other = [
        "bridge", "class", "lsp", "explain", "record", "replay", "nmt", "save", "restore",
    ];
    let help = odkit(&["--help"], "").out;
    let (list, _) = help.split_once("\nOptions:").expect("options");
    let commands = list.lines().filter_map(|line| line.strip_prefix("  "));
    let commands: Vec<&str> = commands
        .filter_map(|line| line.split_whitespace().next())
        .collect();
    assert!(commands.len() > 25, "{commands:?}");
    let without: Vec<&&str> = commands
        .iter()
        .filter(|name| !other.contains(*name))
        .filter(|name| !HERE.contains(&format!("\"{name} ")) && !["sim", "ctl"].contains(*name))
        .collect();
    assert!(
        without.is_empty(),
        "without a test of foreign text: {without:?}"
    );
}
