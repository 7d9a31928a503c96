//! `scan`, `get`, `set`, `nmt`, `save`, `restore`.

use serde_json::Value;

use super::{done, fails, link};
use crate::support::odkit;
use crate::support::quiet::Sim;

#[track_caller]
fn json(text: &str) -> Value {
    serde_json::from_str(text).unwrap_or_else(|why| panic!("{text}: {why}"))
}

#[test]
fn a_scan_names_the_nodes() {
    let sim = Sim::start(&["gxmm", "eam_mt", "--node-id", "5"]);
    let link = link(&sim);
    let scan = ["scan", "--link", &link, "--listen", "0", "--answer", "100"];
    let text = done(&scan);
    assert!(
        text.contains("node 5") && text.contains("fits gxmm"),
        "{text}"
    );
    assert!(
        text.lines().all(|line| line.chars().count() <= 80),
        "{text}"
    );
    let report = json(&done(&[&scan[..], &["--format", "json"]].concat()));
    let nodes: Vec<_> = report["nodes"]
        .as_array()
        .expect("nodes")
        .iter()
        .map(|one| {
            (
                one["node"].as_u64(),
                one["fits"].as_str(),
                one["serial_number"].as_u64(),
            )
        })
        .collect();
    assert_eq!(
        nodes,
        [
            (Some(5), Some("gxmm"), Some(1)),
            (Some(6), Some("eam_mt"), Some(1))
        ]
    );
    let eds = crate::support::repository("devices/eds/GXMM.eds");
    let named = done(&[&scan[..], &["--eds", &eds]].concat());
    assert!(named.contains("GXMM.eds"), "{named}");
}

#[test]
fn values_are_read_by_index_name_and_glob() {
    let sim = Sim::start(&["gxmm", "--node-id", "5"]);
    let link = link(&sim);
    let at = ["--link", &link];
    let get = |objects: &[&str]| done(&[&["get", "5"], objects, &at].concat());
    assert!(get(&["6001h"]).contains("8192 (2000h)"));
    assert!(get(&["position value"]).starts_with("6004h"));
    let glob = get(&["60*"]);
    assert!(
        glob.lines().count() >= 5 && glob.contains("6000h"),
        "{glob}"
    );
    let report = json(&get(&["1018h", "1008h", "--format", "json"]));
    assert_eq!(report["node"], 5);
    let values = report["values"].as_array().expect("values");
    assert_eq!((values.len(), &values[1]["value"]), (6, &Value::from(236)));
    assert_eq!(values[5]["value"], "GXMM");
    let missing = odkit(&[&["get", "5", "1000h:7"], &at[..]].concat(), "");
    assert_eq!(missing.code, 1);
    assert!(missing.out.contains("06090011h"), "{}", missing.out);
    let said = fails(2, &[&["get", "5", "nonsense"], &at[..]].concat());
    assert!(said.contains("nonsense"), "{said}");
    let said = fails(1, &[&["get", "6", "1000h"], &at[..]].concat());
    assert!(said.contains("node 6 does not respond"), "{said}");
}

#[test]
fn values_are_checked_then_written() {
    let sim = Sim::start(&["gxmm", "--node-id", "5"]);
    let link = link(&sim);
    let at = ["--link", &link];
    fn set<'a>(values: &[&'a str], at: &[&'a str]) -> Vec<&'a str> {
        [&["set", "5"], values, at].concat()
    }
    done(&set(&["6001h=0x1000", "Producer heartbeat time=100"], &at));
    // The first value is valid, the second is not: neither is sent.
    let said = fails(2, &set(&["6001h=2048", "6000h=65536"], &at));
    assert!(said.contains("6000h"), "{said}");
    assert!(fails(2, &set(&["6004h=1"], &at)).contains("cannot be written"));
    assert!(fails(2, &set(&["6001h"], &at)).contains("has no value"));
    let got = done(&[&["get", "5", "6001h", "1017h"], &at[..]].concat());
    assert!(
        got.contains("4096 (1000h)") && got.contains("100 (64h)"),
        "{got}"
    );
    let said = done(&[&["nmt", "5", "start"], &at[..]].concat());
    assert!(said.contains("Operational"), "{said}");
    let said = fails(2, &[&["nmt", "start", "5"], &at[..]].concat());
    assert!(said.contains("`odkit nmt NODE start`"), "{said}");
    assert!(done(&[&["save", "5"], &at[..]].concat()).contains("saved"));
    done(&[&["restore", "5", "--group", "all"], &at[..]].concat());
    let said = done(
        &[
            &["nmt", "all", "reset", "--wait", "5000"],
            &at[..],
            &["--format", "json"],
        ]
        .concat(),
    );
    assert_eq!(
        json(&said)["states"][0]["state"],
        "boot-up message",
        "{said}"
    );
    let got = done(&[&["get", "5", "6001h"], &at[..]].concat());
    assert!(got.contains("8192 (2000h)"), "{got}");
}

#[test]
fn without_a_file_types_come_from_sizes() {
    let eds = "[DeviceInfo]\nVendorName=x\n[1000]\nParameterName=Device type\nDataType=7\n\
               AccessType=ro\nDefaultValue=0\n[2000]\nParameterName=Image\nObjectType=2\nDataType=15\n\
               AccessType=rw\n[2001]\nParameterName=Speed\nDataType=3\nAccessType=rw\nDefaultValue=-5\n\
               [2002]\nParameterName=Key\nDataType=6\nAccessType=wo\n";
    let path = crate::support::file("bus-sizes.eds", eds)
        .display()
        .to_string();
    let sim = Sim::start(&[&path, "--node-id", "5"]);
    let link = link(&sim);
    let at = ["--link", &link];
    let by_size = done(&[&["get", "5", "200*"], &at[..]].concat());
    assert!(by_size.contains("2001h  65531 (FFFBh)"), "{by_size}");
    let typed = done(&[&["get", "5", "Speed", "--eds", &path], &at[..]].concat());
    assert!(typed.contains("-5"), "{typed}");
    done(&[&["set", "5", "2001h=-7"], &at[..]].concat());
    let named = format!("5={path}");
    let typed = done(&[&["get", "5", "2001h", "--eds", &named], &at[..]].concat());
    assert!(typed.contains("-7"), "{typed}");
    assert!(fails(2, &[&["set", "5", "2001h=70000"], &at[..]].concat()).contains("2 bytes"));
    assert!(fails(2, &[&["set", "5", "2002h=1"], &at[..]].concat()).contains("cannot be read"));
    done(&[&["set", "5", "2002h=[01 00]"], &at[..]].concat());
    // A DOMAIN is written and read by block transfer.
    let image: Vec<u8> = (0..20_000_u32).map(|byte| (byte * 7) as u8).collect();
    let (there, back) = (
        path.replace("bus-sizes.eds", "bus-there.bin"),
        path.replace("bus-sizes.eds", "bus-back.bin"),
    );
    std::fs::write(&there, &image).expect("a file");
    done(&[&["set", "5", "2000h", "--file", &there], &at[..]].concat());
    let said = done(&[&["get", "5", "2000h", "--file", &back], &at[..]].concat());
    assert!(said.contains("20000 bytes"), "{said}");
    assert!(std::fs::read(&back).expect("a file") == image);
}

#[test]
fn a_text_in_place_of_a_number_is_refused_in_words() {
    for (args, right) in [
        (
            &["scan", "--listen", "abc"][..],
            "write a whole number, such as 100",
        ),
        (
            &["scan", "--answer", "99999999999999999999999"],
            "the number is too large",
        ),
        (
            &["scan", "--bit-rate", "1x"],
            "write a whole number, such as 100",
        ),
        (
            &["class", "--port", "x"],
            "write a whole number, such as 100",
        ),
        (&["run", "--seed", "-"], "write a whole number, such as 100"),
    ] {
        let said = fails(2, args);
        assert!(said.contains(right), "{args:?}: {said}");
        assert!(
            said.contains(&format!("invalid value '{}' for '{}", args[2], args[1])),
            "{said}"
        );
    }
}
