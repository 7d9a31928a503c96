//! `cargo bench -p od-lsp [-- FILE]`: 1,000 keystrokes in a file of 530 kB, with the requests of an editor after each.
//!
//! A keystroke is a `didChange` of one character; it ends when its diagnostics are there. After
//! it an editor requests the changed tokens, the hints of the visible lines, and a hover. Messages are
//! JSON text, as in a pipe.

use std::env;
use std::fmt::Write as _;
use std::time::{Duration, Instant};

use od_lsp::{NoHost, Server};
use serde_json::{Value, json};

const KEYSTROKES: usize = 1000;
const SIZE: usize = 530_000;
const URI: &str = "file:///bench/large.eds";

fn main() {
    let file = env::args()
        .skip(1)
        .find(|argument| !argument.starts_with("--"));
    let text = match file {
        Some(path) => od_eds::Document::new(std::fs::read(path).expect("a file"))
            .text()
            .to_owned(),
        None => large(),
    };
    let lines: Vec<&str> = text.lines().collect();
    let mut bench = Bench {
        server: Server::new(Box::new(NoHost)),
        result: json!("0"),
    };
    bench.send(json!({ "id": 0, "method": "initialize", "params": { "capabilities": {} } }));
    let opened = json!({ "uri": URI, "languageId": "eds", "version": 0, "text": text });
    let (opening, _) = bench
        .send(json!({ "method": "textDocument/didOpen", "params": { "textDocument": opened } }));
    println!(
        "{} bytes, {} lines; opened in {:.2} ms",
        text.len(),
        lines.len(),
        milliseconds(opening)
    );
    let asked = [
        "keystroke to diagnostics",
        "tokens, difference",
        "hints of 60 lines",
        "hover",
        "all four",
    ];
    let mut times: [Vec<Duration>; 5] = Default::default();
    let mut seed = 1usize;
    for number in 0..KEYSTROKES {
        seed = seed
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        let line = (seed >> 33) % lines.len();
        // Append a digit to the line, and remove it the next time.
        let end = lines[line].encode_utf16().count();
        let at = |character| json!({ "line": line, "character": character });
        let mut all = Duration::ZERO;
        for (typed, from) in [("7", end), ("", end + 1)] {
            let range = json!({ "start": at(end), "end": at(from) });
            let document = json!({ "uri": URI, "version": number });
            let change = json!({ "range": range, "text": typed });
            let params = json!({ "textDocument": document, "contentChanges": [change] });
            let (took, answers) =
                bench.send(json!({ "method": "textDocument/didChange", "params": params }));
            assert!(answers[0].contains("publishDiagnostics"), "{}", answers[0]);
            if typed.is_empty() {
                break;
            }
            all += took;
            times[0].push(took);
            all += bench.after(line, &mut times);
        }
        times[4].push(all);
    }
    println!("| {KEYSTROKES} times | median | 99 % | longest |\n|---|---|---|---|");
    for (name, times) in asked.iter().zip(&mut times) {
        times.sort();
        let [median, most, longest] = [times.len() / 2, times.len() * 99 / 100, times.len() - 1]
            .map(|at| format!("{:.2} ms", milliseconds(times[at])));
        println!("| {name} | {median} | {most} | {longest} |");
    }
}

fn milliseconds(time: Duration) -> f64 {
    time.as_secs_f64() * 1000.0
}

struct Bench {
    server: Server,
    /// The number of the editor's tokens.
    result: Value,
}

impl Bench {
    /// Sends a message, and returns the time until all answers are there.
    fn send(&mut self, mut message: Value) -> (Duration, Vec<String>) {
        message["jsonrpc"] = json!("2.0");
        let text = message.to_string();
        let start = Instant::now();
        self.server.receive(&text);
        while self.server.step() {}
        let answers = std::iter::from_fn(|| self.server.poll()).collect();
        (start.elapsed(), answers)
    }

    /// Sends the requests of an editor after a keystroke.
    fn after(&mut self, line: usize, times: &mut [Vec<Duration>; 5]) -> Duration {
        let document = json!({ "uri": URI });
        let from = json!({ "line": line.saturating_sub(30), "character": 0 });
        let range = json!({ "start": from, "end": { "line": line + 30, "character": 0 } });
        let here = json!({ "line": line, "character": 1 });
        let asked = [
            (
                "semanticTokens/full/delta",
                json!({ "textDocument": document, "previousResultId": self.result }),
            ),
            (
                "inlayHint",
                json!({ "textDocument": document, "range": range }),
            ),
            (
                "hover",
                json!({ "textDocument": document, "position": here }),
            ),
        ];
        let mut all = Duration::ZERO;
        for (number, (method, params)) in asked.into_iter().enumerate() {
            let method = format!("textDocument/{method}");
            let (took, answers) = self.send(json!({ "id": 1, "method": method, "params": params }));
            if number == 0 {
                let answer: Value = serde_json::from_str(&answers[0]).expect("an answer");
                self.result = answer["result"]["resultId"].clone();
            }
            times[number + 1].push(took);
            all += took;
        }
        all
    }
}

/// A device with VARs and RECORDs, as large as the largest file of the corpus.
fn large() -> String {
    let mut text = String::from(
        "[FileInfo]\nFileName=large.eds\nFileVersion=1\nFileRevision=0\nEDSVersion=4.0\n\n[DeviceInfo]\nVendorName=none\n\n",
    );
    let value = |text: &mut String, name: &str, number: usize| {
        let _ = write!(
            text,
            "[{name}]\nParameterName=Parameter {name}\nObjectType=0x7\nDataType=0x0006\nAccessType=rww\n\
             LowLimit=0\nHighLimit=0x{:04X}\nDefaultValue=0x{number:04X}\nPDOMapping=1\n\n",
            0x8000
        );
    };
    let mut listed = Vec::new();
    for index in 0x2000..0x5FFFusize {
        if text.len() > SIZE - 16 * listed.len() {
            break;
        }
        listed.push(index);
        let number = index - 0x2000;
        match number % 4 {
            0 => {
                let _ = write!(
                    text,
                    "[{index:04X}]\nParameterName=Group {number}\nObjectType=0x9\nSubNumber=3\n\n"
                );
                let _ = write!(
                    text,
                    "[{index:04X}sub0]\nParameterName=Number\nDataType=0x0005\nAccessType=const\nDefaultValue=2\n\n"
                );
                value(&mut text, &format!("{index:04X}sub1"), number);
                value(&mut text, &format!("{index:04X}sub2"), number);
            }
            _ => value(&mut text, &format!("{index:04X}"), number),
        }
    }
    let _ = writeln!(
        text,
        "[ManufacturerObjects]\nSupportedObjects={}",
        listed.len()
    );
    for (number, index) in (1..).zip(&listed) {
        let _ = writeln!(text, "{number}=0x{index:04X}");
    }
    text
}
