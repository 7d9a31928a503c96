//! Commands at a node that violates the protocol: the exit code, and what the output still has.

use std::fs;
use std::io::{Read, Write};
use std::net::{TcpListener, TcpStream};
use std::thread;

use serde_json::Value;

use super::fails;
use crate::support::{file, odkit};

/// An slcan adapter with node 5: 1000h is 402, a segment of 1017h has the wrong toggle bit, A100h has no end, and
/// the node has no other object. Serves one connection after the other.
fn adapter() -> String {
    let listener = TcpListener::bind("127.0.0.1:0").expect("a port");
    let port = listener.local_addr().expect("an address").port();
    thread::spawn(move || {
        while let Ok((client, _)) = listener.accept() {
            serve(client);
        }
    });
    format!("slcan:127.0.0.1:{port}")
}

fn serve(mut client: TcpStream) {
    let (mut rest, mut bytes) = (String::new(), [0; 4096]);
    let mut is_endless = false;
    while let Ok(count @ 1..) = client.read(&mut bytes) {
        rest.push_str(&String::from_utf8_lossy(&bytes[..count]));
        while let Some((line, others)) = rest.split_once('\r') {
            let mut said = String::from(if line.starts_with('t') { "z\r" } else { "\r" });
            let object = line.get(7..13).unwrap_or_default();
            if line.starts_with("t605840") {
                is_endless = object == "00A100";
            }
            match (line.get(..7), object) {
                (Some("t605840"), "00A100") => said += "t58584000A10000000000\r",
                (Some("t605860"), _) if is_endless => said += "t58580061616161616161\r",
                (Some("t605870"), _) if is_endless => said += "t58581061616161616161\r",
                (Some("t605840"), "001000") => said += "t5858430010009201000 0\r",
                (Some("t605840"), "171000") => said += "t58584117100002000000\r",
                (Some("t605860"), _) => said += "t58581B01000000000000\r",
                // The other objects, also by block.
                (Some("t605840" | "t6058A4" | "t6058A0"), _) => {
                    said += &format!("t585880{object}00000206\r");
                }
                _ => {}
            }
            if client.write_all(said.replace(' ', "").as_bytes()).is_err() {
                return;
            }
            rest = others.to_owned();
        }
    }
}

#[test]
fn an_object_whose_transfer_fails_is_in_the_output_and_in_the_exit_code() {
    let link = adapter();
    let get = [
        "get", "5", "1000h", "1017h", "--eds", "gxmm", "--link", &link,
    ];
    let text = odkit(&get, "");
    assert_eq!(text.code, 1, "{}", text.err);
    let lines: Vec<&str> = text.out.lines().collect();
    assert!(
        matches!(lines[..], [_, heartbeat] if heartbeat.contains("1017h")),
        "{}",
        text.out
    );
    let json = odkit(&[&get[..], &["--format", "json"]].concat(), "");
    assert_eq!(json.code, 1, "{}", json.err);
    let report: Value = serde_json::from_str(&json.out).expect("JSON");
    assert_eq!(report["values"][0]["value"], 402, "{report}");
    assert_eq!(report["values"][1]["index"], 0x1017, "{report}");
    let error = report["values"][1]["error"].as_str().expect("a text");
    assert!(error.contains("toggle"), "{error}");
    // One object alone, too.
    let one = odkit(
        &["get", "5", "1017h", "--link", &link, "--format", "json"],
        "",
    );
    assert_eq!(one.code, 1, "{}", one.err);
    assert!(one.out.contains("toggle"), "{}{}", one.out, one.err);
    let eds = "[DeviceInfo]\nProductName=Short\n[1000]\nParameterName=Device type\nDataType=7\nAccessType=ro\n\
        [1017]\nParameterName=Producer heartbeat time\nDataType=6\nAccessType=rw\n";
    let eds = file("wrong.eds", eds).display().to_string();
    let diff = odkit(&["diff", &eds, "--node-id", "5", "--link", &link], "");
    assert_eq!(diff.code, 1, "{}", diff.err);
    assert!(diff.out.contains("toggle"), "{}", diff.out);
}

#[test]
fn a_value_without_end_ends_at_the_limit_of_its_type() {
    let link = adapter();
    let eds = "[DeviceInfo]\nProductName=Endless\n[1000]\nParameterName=Device type\nDataType=7\nAccessType=ro\n\
        [A100]\nParameterName=Counter\nDataType=7\nAccessType=ro\n";
    let eds = file("endless.eds", eds).display().to_string();
    let get = ["get", "5", "1000h", "A100h", "--eds", &eds, "--link", &link];
    let text = odkit(&get, "");
    assert_eq!(text.code, 1, "{}", text.err);
    let lines: Vec<&str> = text.out.lines().collect();
    assert!(
        matches!(lines[..], [_, counter] if counter.contains("A100h") && counter.contains("longer than its type, UNSIGNED32")),
        "{}",
        text.out
    );
}

#[test]
fn a_learned_file_says_which_transfer_failed() {
    let link = adapter();
    let learned = file("wrong-learned.eds", "").display().to_string();
    let said = fails(1, &["learn", "5", "--link", &link, "-o", &learned]);
    let text = fs::read_to_string(&learned).expect("an EDS");
    let (_, comments) = text.split_once("[Comments]").expect("comments");
    let comments = comments.split("\n[").next().unwrap_or_default();
    for text in [said.as_str(), comments] {
        assert!(text.contains("1017h") && text.contains("toggle"), "{text}");
    }
    assert!(comments.contains("Lines=4"), "{comments}");
}

/// 1017h is read again and again, and the node never responds correctly: one line, and exit code 1.
#[test]
fn a_watch_says_once_why_a_value_cannot_be_read_and_fails() {
    let link = adapter();
    let watch = [
        "watch", "5", "1000h", "1017h", "--eds", "gxmm", "--every", "10", "--count", "8", "--link",
        &link,
    ];
    let text = odkit(&watch, "");
    assert_eq!(text.code, 1, "{}", text.err);
    let about = |index: &str| {
        let lines = text.out.lines().filter(|line| line.contains(index));
        lines.collect::<Vec<_>>()
    };
    let wrong = about("1017h");
    assert!(
        matches!(wrong[..], [line] if line.contains("toggle")),
        "{}",
        text.out
    );
    assert!(about("1000h").len() > 1, "{}", text.out);
    let json = odkit(&[&watch[..], &["--format", "json"]].concat(), "");
    assert_eq!(json.code, 1, "{}", json.err);
    let all = json.out.lines().filter(|line| line.contains("toggle"));
    assert!(all.count() > 1, "{}", json.out);
}
