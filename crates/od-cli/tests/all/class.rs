//! `odkit class`: its page with lessons of the trainer, reports of students, and what only the trainer may do.

use std::fs;
use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::path::Path;
use std::process::{Child, Command, Stdio};

use crate::support::{command, folder, odkit, read, repository};

/// A small page in a folder of its own.
fn page(name: &str) -> String {
    let files = [
        ("index.html", "<!doctype html>\n<html lang=\"en\">"),
        ("trainer.html", "<!doctype html>\n<html lang=\"en\">"),
        ("lessons.json", r#"[{"name":"nmt"}]"#),
        ("main.js", "let it;"),
        ("sw.js", "never"),
    ];
    folder(name, &files).display().to_string()
}

/// A folder of lessons: one lesson with its translation, and a file that is not a lesson.
fn lessons(name: &str) -> String {
    let lesson = |name| read(Path::new(&repository("playground/lessons")), name);
    let files = [
        ("our nmt.md", &*lesson("02-nmt.md")),
        ("de/our nmt.md", &*lesson("de/02-nmt.md")),
        ("README.md", "# Our lessons\n"),
    ];
    folder(name, &files).display().to_string()
}

/// A class on a port of its own; it ends when this is dropped.
struct Class {
    child: Child,
    port: u16,
    token: String,
}

impl Class {
    fn start(args: &[&str]) -> Self {
        let mut child = command()
            .args(["class", "--host", "127.0.0.1", "--port", "0"])
            .args(args)
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .expect("odkit starts");
        let mut lines = BufReader::new(child.stdout.take().expect("a pipe"));
        let mut greeting = String::new();
        while !greeting.contains("Ctrl-C") {
            let len = lines.read_line(&mut greeting).expect("a greeting");
            assert_ne!(len, 0, "{greeting}");
        }
        let after = |text: &str| greeting.split(text).nth(1).expect("it is printed");
        let port = after("http://127.0.0.1:");
        let token = after("/trainer.html#").lines().next();
        Self {
            child,
            port: port[..port.find('/').expect("an end")]
                .parse()
                .expect("a port"),
            token: token.expect("a token").into(),
        }
    }

    /// Sends a request with these header fields and this body; status, head and body of the answer.
    fn ask(&self, request: &str, fields: &str, body: &str) -> (u16, String, String) {
        let mut stream = TcpStream::connect(("127.0.0.1", self.port)).expect("it listens");
        let (port, length) = (self.port, body.len());
        let text = format!(
            "{request} HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nContent-Type: application/json\r\n\
             Content-Length: {length}\r\n{fields}\r\n{body}"
        );
        stream.write_all(text.as_bytes()).expect("it reads");
        let mut answer = String::new();
        stream.read_to_string(&mut answer).expect("an answer");
        let (head, body) = answer.split_once("\r\n\r\n").expect("a head");
        let status = head[9..12].parse().expect("a status");
        (status, head.into(), body.into())
    }

    fn get(&self, path: &str) -> (u16, String) {
        let (status, _, body) = self.ask(&format!("GET {path}"), "", "");
        (status, body)
    }

    fn post(&self, path: &str, body: &str) -> (u16, String) {
        let (status, _, body) = self.ask(&format!("POST /class/{path}"), "", body);
        (status, body)
    }

    /// The same with the token of the trainer.
    fn trainer(&self, request: &str, body: &str) -> (u16, serde_json::Value) {
        let field = format!("X-Odkit-Trainer: {}\r\n", self.token);
        let (status, _, body) = self.ask(request, &field, body);
        let value = serde_json::from_str(&body);
        (
            status,
            value.unwrap_or_else(|error| panic!("{error}: {body}")),
        )
    }

    /// Joins, and returns key and group.
    fn join(&self, name: &str) -> (String, String) {
        let (status, body) = self.post("join", &format!(r#"{{"name":"{name}"}}"#));
        assert_eq!(status, 200, "{body}");
        let joined: serde_json::Value = serde_json::from_str(&body).expect("JSON");
        let text = |key: &str| joined[key].as_str().expect("a text").to_owned();
        (text("key"), text("group"))
    }

    fn report(&self, key: &str, group: &str, step: u32, answered: u32) -> (u16, String) {
        let lesson =
            format!(r#"{{"name":"nmt","step":{step},"of":4,"wrong":3,"hints":1,"shown":0}}"#);
        let body = format!(
            r#"{{"key":"{key}","group":"{group}","hidden":false,"lesson":{lesson},"finished":["sdo"],"answered":{answered}}}"#
        );
        self.post("report", &body)
    }
}

impl Drop for Class {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

#[test]
fn the_page_has_the_lessons_of_the_trainer_and_no_other_file() {
    let (page, lessons) = (page("class-page"), lessons("class-lessons"));
    let class = Class::start(&["--page", &page, "--lessons", &lessons, "--lang", "de"]);
    let (status, head, _) = class.ask("GET /", "", "");
    assert!(
        status == 302 && head.contains("Location: /?lang=de"),
        "{head}"
    );
    let (status, text) = class.get("/?lang=de");
    assert!(
        status == 200 && text.contains("<html data-class lang"),
        "{text}"
    );
    let (_, head, text) = class.ask("GET /main.js", "", "");
    assert!(
        text == "let it;" && head.contains("text/javascript"),
        "{head}"
    );
    let version = head.lines().find_map(|line| line.strip_prefix("ETag: "));
    let known = format!("If-None-Match: {}\r\n", version.expect("a version"));
    assert_eq!(class.ask("GET /main.js", &known, "").0, 304);
    for none in [
        "/sw.js",
        "/../Cargo.toml",
        "/%2e%2e/x",
        "/de/x",
        "/class",
        "//",
    ] {
        assert_eq!(class.get(none).0, 404, "{none}");
    }
    assert_eq!(class.ask("PUT /", "", "").0, 405);
    assert_eq!(
        class.ask("GET /", "Origin: http://evil.example\r\n", "").0,
        403
    );
    let (_, list) = class.get("/lessons.json");
    let list: serde_json::Value = serde_json::from_str(&list).expect("JSON");
    assert_eq!(list.as_array().map(Vec::len), Some(2), "{list}");
    let own = &list[1];
    assert_eq!(
        (&own["name"], &own["isOwn"]),
        (&"our nmt.md".into(), &true.into())
    );
    assert_ne!(own["title"], own["de"]["title"]);
    assert!(class.get("/lesson-our%20nmt.md.md").1.starts_with("+++"));
    let german = class.get("/lesson-our%20nmt.md.de.md").1;
    assert!(
        german.contains("language = \"de\"") && german.contains("```solution"),
        "{german}"
    );
}

#[test]
fn the_trainer_sees_students_and_offers_lessons_and_nobody_else_does() {
    let class = Class::start(&["--page", &page("class-room")]);
    let (key, group) = class.join("Anna");
    assert_eq!(
        class.post("join", r#"{"name":"anna"}"#),
        (409, r#"{"why":"taken"}"#.into())
    );
    assert_eq!(
        class.post("join", r#"{"name":"\u001b[2J"}"#),
        (409, r#"{"why":"name"}"#.into())
    );
    assert_eq!(
        class.report(&key, &group, 1, 0),
        (200, r#"{"offer":null}"#.into())
    );
    let (_, seen) = class.trainer("GET /class/rows", "");
    let row = &seen["rows"][0];
    let expected = [
        ("name", "Anna".into()),
        ("presence", "here".into()),
        ("stuck", "wrong".into()),
        ("finished", vec!["sdo"].into()),
        ("offer", serde_json::Value::Null),
    ];
    for (field, value) in expected {
        assert_eq!(row[field], value, "{field} of {row}");
    }
    assert_eq!(
        (&row["at"]["step"], &row["at"]["hints"]),
        (&1.into(), &1.into())
    );
    assert_eq!(seen["address"], format!("http://127.0.0.1:{}/", class.port));

    for (request, body) in [
        ("GET /class/rows", ""),
        ("POST /class/offer", r#"{"lesson":"sdo"}"#),
        ("POST /class/remove", r#"{"row":1}"#),
        ("POST /class/reset", ""),
    ] {
        for field in ["", "X-Odkit-Trainer: \r\n", "X-Odkit-Trainer: 0000\r\n"] {
            assert_eq!(class.ask(request, field, body).0, 403, "{request} {field}");
        }
    }
    assert_eq!(
        class.trainer("POST /class/offer", r#"{"lesson":"sdo"}"#).1["found"],
        true
    );
    let offered = r#"{"offer":{"lesson":"sdo","number":1}}"#;
    assert_eq!(class.report(&key, &group, 1, 0), (200, offered.into()));
    assert_eq!(
        class.report(&key, &group, 2, 1),
        (200, r#"{"offer":null}"#.into())
    );

    let (other, _) = class.join("Ben");
    assert_eq!(
        class.trainer("POST /class/remove", r#"{"row":2}"#).1["found"],
        true
    );
    assert_eq!(
        class.report(&other, &group, 0, 0),
        (410, r#"{"why":"removed"}"#.into())
    );
    class.trainer("POST /class/reset", "");
    assert_eq!(
        class.report(&key, &group, 2, 1),
        (410, r#"{"why":"reset"}"#.into())
    );
    assert_eq!(
        class.trainer("GET /class/rows", "").1["rows"]
            .as_array()
            .map(Vec::len),
        Some(0)
    );
    class.join("Anna");
    // Reports that are not valid change nothing.
    for bad in ["", "{}", "[]", r#"{"name":5}"#] {
        assert_eq!(class.post("report", bad).0, 400, "{bad}");
    }
}

#[test]
fn a_class_that_cannot_start_says_why() {
    let page = page("class-wrong");
    let lessons = lessons("class-wrong-lessons");
    let nmt = fs::read_to_string(repository("playground/lessons/02-nmt.md")).expect("a lesson");
    let bad = format!("{lessons}/bad.md");
    fs::write(&bad, nmt.replace("level = ", "levle = ")).expect("a file");
    let wrong = odkit(&["class", "--page", &page, "--lessons", &bad], "");
    assert_eq!((wrong.code, wrong.out.as_str()), (2, ""));
    assert!(
        wrong.err.contains("bad.md:3:1: ") || wrong.err.contains("bad.md:"),
        "{}",
        wrong.err
    );
    assert!(
        wrong.err.contains("1 lesson with mistakes"),
        "{}",
        wrong.err
    );
    let wrong = odkit(&["class", "--page", &lessons], "");
    assert_eq!(wrong.code, 2);
    assert!(wrong.err.contains("index.html is missing"), "{}", wrong.err);
    let class = Class::start(&["--page", &page]);
    let port = class.port.to_string();
    let args = [
        "class",
        "--page",
        &page,
        "--host",
        "127.0.0.1",
        "--port",
        &port,
    ];
    let wrong = odkit(&args, "");
    assert_eq!(wrong.code, 1);
    assert!(
        wrong.err.contains("give another port with --port"),
        "{}",
        wrong.err
    );
    // An address for documentation (RFC 5737).
    let wrong = odkit(&["class", "--page", &page, "--host", "203.0.113.5"], "");
    assert_eq!(wrong.code, 1);
    assert!(wrong.err.contains("leave out --host"), "{}", wrong.err);
}

#[test]
fn a_class_ends_at_the_signal() {
    let page = page("class-end");
    let mut class = Class::start(&["--page", &page]);
    class.join("Anna");
    // A browser that has not sent its request yet does not hold the class.
    let waiting = TcpStream::connect(("127.0.0.1", class.port)).expect("it listens");
    let process = class.child.id().to_string();
    let kill = Command::new("kill").args(["-INT", &process]).status();
    assert!(kill.expect("kill").success());
    let mut said = String::new();
    let mut errors = class.child.stderr.take().expect("a pipe");
    errors.read_to_string(&mut said).expect("text");
    assert_eq!(said, "\nodkit: the class has ended with 1 student\n");
    assert_eq!(class.child.wait().expect("it ends").code(), Some(0));
    drop(waiting);
}
