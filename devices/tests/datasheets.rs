//! The pages under docs/datasheets agree with the devices.
//!
//! `ODKIT_ACCEPT=1 cargo test -p od-devices --all-features --test datasheets` writes them again.
#![cfg(feature = "text")]

use std::collections::BTreeSet;
use std::fs;
use std::path::PathBuf;

use od_devices::DEVICES;
use od_devices::text::datasheet;

fn folder() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../docs/datasheets")
}

#[test]
fn every_page_is_current_and_no_page_is_left_over() {
    let accept = std::env::var_os("ODKIT_ACCEPT").is_some();
    for kind in DEVICES {
        let path = folder().join(format!("{}.md", kind.name));
        let page = datasheet::page(kind);
        if accept {
            fs::create_dir_all(folder()).unwrap();
            fs::write(&path, &page).unwrap();
        }
        let written = fs::read_to_string(&path).unwrap_or_default();
        assert!(
            written == page,
            "docs/datasheets/{}.md differs from the device; ODKIT_ACCEPT=1 writes it again",
            kind.name
        );
    }
    let expected: BTreeSet<_> = DEVICES
        .iter()
        .map(|kind| format!("{}.md", kind.name))
        .collect();
    let found: BTreeSet<_> = fs::read_dir(folder())
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    assert_eq!(found, expected);
}

#[test]
fn a_page_has_every_value_and_the_special_features() {
    for kind in DEVICES {
        let page = datasheet::page(kind);
        let is_row = |line: &&str| line.contains(" | r") || line.contains(" | const");
        let rows = page.lines().filter(is_row).count();
        assert!(rows >= kind.dictionary.entries().len(), "{}", kind.name);
        for (word, is_there) in [
            (
                "Electronic gear",
                kind.encoder().is_some() && kind.dictionary.entry(0x2001, 1).is_some(),
            ),
            (
                "Repeat counters",
                kind.dictionary.entry(0x2800, 0).is_some(),
            ),
            (
                "rotary for the node ID",
                kind.encoder()
                    .is_some_and(|encoder| !encoder.switch_rates.is_empty()),
            ),
            ("2 nodes with one shaft", kind.name == "eam_red"),
            ("| injected by |", kind.family == "eam"),
            (
                "`battery-low`",
                !matches!(kind.name, "gxam" | "gcam" | "gdam" | "gbam") && kind.encoder().is_some(),
            ),
        ] {
            assert_eq!(page.contains(word), is_there, "{}: {word}", kind.name);
        }
    }
}

#[test]
fn names_in_a_file_cannot_break_the_table() {
    let text = "[DeviceInfo]\nProductName=a|b\n[2000]\nParameterName=x | *y*\nDataType=0x0005\n";
    let tables = od_eds::Tables::new(&od_eds::parse(text).description);
    let page = od_eds::convert::markdown::page("a|b", tables.dictionary());
    assert!(page.starts_with("# a\\|b\n"), "{page}");
    assert!(page.contains("| x \\| \\*y\\* |"), "{page}");
}
