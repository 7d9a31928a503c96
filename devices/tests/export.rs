//! The exported EDS describes the same device.
#![cfg(feature = "text")]

use od_devices::DEVICES;
use od_eds::{Tables, check};

#[test]
fn an_exported_eds_gives_the_same_dictionary_without_findings() {
    for kind in DEVICES {
        let text = od_devices::text::eds(kind);
        let loaded = od_eds::load(&text);
        assert_eq!(loaded.findings, [], "{}", kind.name);
        assert_eq!(check::check(&loaded.description), [], "{}", kind.name);
        let tables = Tables::new(&loaded.description);
        assert!(tables.dictionary() == kind.dictionary, "{}", kind.name);
        assert_eq!(od_eds::write(&loaded.description), text, "{}", kind.name);
    }
}

#[test]
fn facts_about_the_device_agree_with_its_objects() {
    for kind in DEVICES {
        let description = od_eds::parse(&od_devices::text::eds(kind)).description;
        let info = description.section("DeviceInfo").unwrap();
        let value = |key| info.get(key).unwrap().value.clone();
        let number = |sub| {
            let entry = kind.dictionary.entry(0x1018, sub).unwrap();
            entry.default.integer(0).unwrap()
        };
        for (key, sub) in [
            ("VendorNumber", 1),
            ("ProductNumber", 2),
            ("RevisionNumber", 3),
        ] {
            assert_eq!(
                value(key),
                format!("0x{:08X}", number(sub)),
                "{}",
                kind.name
            );
        }
        let pdos = match kind.name {
            "io" => ("2", "2"),
            "drive" => ("4", "4"),
            _ => ("2", "0"),
        };
        let (sent, received) = (value("NrOfTXPDO"), value("NrOfRXPDO"));
        assert_eq!((&*sent, &*received), pdos, "{}", kind.name);
        assert_eq!(value("LSS_Supported"), "1");
        assert_eq!(value("SimpleBootUpSlave"), "1");
        // 10 kbit/s is code 0 of 2100h, which the EN580C does not support.
        let slow = if kind.name == "en580c" { "0" } else { "1" };
        assert_eq!(value("BaudRate_10"), slow, "{}", kind.name);
    }
}

#[test]
fn the_files_of_the_project_equal_their_exports() {
    for (name, text) in [
        ("gxmm", include_str!("../eds/GXMM.eds")),
        ("eam_mt", include_str!("../eds/EAM_MT.eds")),
        ("en580c", include_str!("../eds/EN580C.eds")),
        ("drive", include_str!("../eds/DRIVE.eds")),
        ("io", include_str!("../eds/IO.eds")),
    ] {
        let exported =
            od_eds::parse(&od_devices::text::eds(od_devices::find(name).unwrap())).description;
        let written = od_eds::load(text);
        assert_eq!(written.findings, [], "{name}");
        for key in ["DeviceInfo", "DummyUsage"] {
            let pairs = |d: &od_eds::Description| {
                let section = d.section(key).unwrap();
                let same = section
                    .pairs
                    .iter()
                    .filter(|(key, _)| **key != *"Granularity");
                same.map(|(k, v)| (k.value.clone(), v.value.clone()))
                    .collect::<Vec<_>>()
            };
            assert_eq!(pairs(&exported), pairs(&written.description), "{name}");
        }
    }
}
