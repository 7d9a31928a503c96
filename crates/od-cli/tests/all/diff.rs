//! `odkit diff`: two dictionaries, and a dictionary with a device on a bus.

use crate::support::sim::Sim;
use crate::support::{file, odkit, repository};

#[test]
fn a_device_equals_its_own_file() {
    let eds = repository("devices/eds/GXMM.eds");
    let diff = odkit(&["diff", "gxmm", &eds, "--fail-on", "any"], "");
    assert_eq!(diff.code, 0, "{}{}", diff.out, diff.err);
    assert!(diff.out.ends_with(": no difference\n"), "{}", diff.out);
}

#[test]
fn breaking_differences_are_marked_and_can_fail() {
    let diff = odkit(&["diff", "gxmm", "gxam"], "");
    assert_eq!(diff.code, 0, "{}", diff.err);
    let first = diff.out.lines().next().unwrap_or_default();
    assert!(first.starts_with("!~ 1000h"), "{}", diff.out);
    assert!(
        diff.out.contains(" ~ 1008h") && diff.out.contains("\"GXMM\" -> \"GXAM\""),
        "{}",
        diff.out
    );
    assert_eq!(
        odkit(&["diff", "gxmm", "gxam", "--fail-on", "breaking"], "").code,
        1
    );
}

#[test]
fn added_objects_are_compatible_and_removed_ones_are_not() {
    let text = std::fs::read_to_string(repository("devices/eds/GXMM.eds")).expect("an EDS");
    let index = text.find("[2300]").expect("an object");
    let end = text[index..]
        .find("[2800]")
        .map_or(text.len(), |at| index + at);
    let shorter = format!("{}{}", &text[..index], &text[end..]);
    let path = file("shorter.eds", &shorter).display().to_string();
    let removed = odkit(&["diff", "gxmm", &path, "--fail-on", "breaking"], "");
    assert_eq!(removed.code, 1);
    assert!(removed.out.starts_with("!- 2300h"), "{}", removed.out);
    let added = odkit(&["diff", &path, "gxmm", "--fail-on", "breaking"], "");
    assert_eq!(added.code, 0, "{}", added.out);
    assert!(added.out.starts_with(" + 2300h"), "{}", added.out);
}

#[test]
fn json_and_markdown_have_the_same_content() {
    let json = odkit(&["diff", "gxmm", "gcmm", "--format", "json"], "");
    let value: serde_json::Value = serde_json::from_str(&json.out).expect("JSON");
    let found = value["differences"].as_array().expect("a list");
    assert!(!found.is_empty() && value["breaking"].as_u64() > Some(0));
    let markdown = odkit(&["diff", "gxmm", "gcmm", "--format", "markdown"], "").out;
    let rows = markdown
        .lines()
        .filter(|line| line.starts_with("| "))
        .count();
    assert_eq!(rows, found.len() + 1, "{markdown}");
}

#[test]
fn a_live_device_is_read_object_by_object() {
    let sim = Sim::start(&["gxam", "--node-id", "5"]);
    let link = format!("slcan:{}", sim.port);
    let live = ["--link", &link, "--node-id", "5", "--fail-on", "any"];
    let same = odkit(&[&["diff", "gxam"], &live[..]].concat(), "");
    assert_eq!(same.code, 0, "{}{}", same.out, same.err);
    let other = odkit(&[&["diff", "gxmm"], &live[..]].concat(), "");
    assert_eq!(other.code, 1);
    assert!(other.out.starts_with("!~ 1000h"), "{}", other.out);
    let text = std::fs::read_to_string(repository("devices/eds/GXMM.eds")).expect("an EDS");
    let more = text
        .replace("[2201]", "[2202]")
        .replace("[2201sub", "[2202sub");
    let path = file("more.eds", &more.replace("=0x2201", "=0x2202"));
    let path = path.display().to_string();
    let lacks = odkit(&[&["diff", &path], &live[..]].concat(), "");
    assert!(lacks.out.contains("!- 2202h"), "{}", lacks.out);
    let nobody = odkit(&["diff", "gxam", "--link", &link, "--node-id", "6"], "");
    assert_eq!(nobody.code, 1);
    assert!(
        nobody.err.contains("node 6 does not respond"),
        "{}",
        nobody.err
    );
}

#[test]
fn values_that_cannot_be_compared_are_reported() {
    assert_eq!(odkit(&["diff", "gxmm"], "").code, 2);
    let link = odkit(&["diff", "gxmm", "--live", "can0"], "");
    assert_eq!(link.code, 2);
    assert!(link.err.contains("slcan:HOST:PORT"), "{}", link.err);
    let closed = odkit(&["diff", "gxmm", "--live", "slcan:127.0.0.1:1"], "");
    assert_eq!(closed.code, 1);
    assert!(closed.err.contains("odkit sim"), "{}", closed.err);
    let empty = file("empty.eds", "").display().to_string();
    assert_eq!(odkit(&["diff", "gxmm", &empty], "").code, 1);
}
