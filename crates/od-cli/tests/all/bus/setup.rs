//! `lss`, `backup`, `apply`.

use super::{done, fails, link};
use crate::support::quiet::Sim;
use crate::support::{file, odkit, repository};

#[test]
fn the_wizard_sets_up_new_encoders_one_after_the_other() {
    let eds = std::fs::read_to_string(repository("devices/eds/GXMM.eds")).expect("an EDS");
    let new = file("bus-new.eds", &eds).display().to_string();
    let ids = ["--node-id", "none", "--node-id", "none", "--node-id", "5"];
    let serials = ["--serial", "4711", "--serial", "4712"];
    let sim = Sim::start(&[&[new.as_str(), &new, "gdam"], &ids[..], &serials].concat());
    let link = link(&sim);
    let at = ["--link", &link];
    // The first slave gets the proposed node ID, which is not 5; 5 is in use, so 9 is proposed next.
    let wizard = [&["lss", "set", "--first", "5"], &at[..]].concat();
    // Fastscan takes seconds in real time, so only one is tested here; the others are in od-tools.
    let set_up = odkit(&wizard, "\n5\n9\n");
    assert_eq!(set_up.code, 0, "{}", set_up.err);
    assert!(
        set_up
            .err
            .contains("look at the device with serial number 4711"),
        "{}",
        set_up.err
    );
    assert!(set_up.err.contains("node ID 5 is in use"), "{}", set_up.err);
    assert!(
        set_up.out.contains("node 6    serial number 4711"),
        "{}",
        set_up.out
    );
    assert!(
        set_up.out.contains("node 9    serial number 4712"),
        "{}",
        set_up.out
    );
    let got = done(&[&["get", "9", "1018h:04"], &at[..]].concat());
    assert!(got.contains("4712"), "{got}");
    assert!(fails(1, &[&["lss", "set", "--yes"], &at[..]].concat()).contains("without a node ID"));
    let moved = done(&[&["lss", "set", "7", "--of", "6"], &at[..]].concat());
    assert!(moved.contains("odkit nmt 6 reset-comm"), "{moved}");
    done(&[&["nmt", "6", "reset-comm"], &at[..]].concat());
    done(&[&["get", "7", "1018h:04"], &at[..]].concat());
    done(&[&["lss", "bitrate", "250", "--of", "7"], &at[..]].concat());
    done(&[&["lss", "store", "--of", "7"], &at[..]].concat());
    let asked = done(&[&["lss", "inquire", "--of", "7"], &at[..]].concat());
    assert!(
        asked.contains("node 7") && asked.contains("4711"),
        "{asked}"
    );
    let several = fails(1, &[&["lss", "inquire"], &at[..]].concat());
    assert!(several.contains("several LSS slaves respond"), "{several}");
    let none = fails(1, &[&["lss", "scan"], &at[..]].concat());
    assert!(
        none.contains("3 nodes with a node ID") && none.contains("--of 5"),
        "{none}"
    );
    fails(2, &[&["lss", "bitrate", "33"], &at[..]].concat());
    fails(
        2,
        &[&["lss", "set", "7", "--address", "1:2"], &at[..]].concat(),
    );
}

#[test]
fn a_backup_is_applied_to_a_node_that_was_changed() {
    let sim = Sim::start(&["eam_mt", "--node-id", "5"]);
    let link = link(&sim);
    let at = ["--link", &link];
    let path = file("bus-backup.dcf", "").display().to_string();
    done(&[&["set", "5", "1017h=250", "6001h=1000"], &at[..]].concat());
    let said = done(&[&["backup", "5", "-o", &path], &at[..]].concat());
    assert!(said.contains("values"), "{said}");
    // odkit itself finds no error in the DCF, and a simulation of it equals the node.
    let check = odkit(&["check", &path], "");
    assert_eq!(check.code, 0, "{}", check.out);
    done(
        &[
            &["set", "5", "1017h=0", "6001h=4096", "1800h:05=77"],
            &at[..],
        ]
        .concat(),
    );
    let applied = done(&[&["apply", "5", &path], &at[..]].concat());
    assert!(
        applied.contains("values written and read back"),
        "{applied}"
    );
    let got = done(&[&["get", "5", "1017h", "6001h"], &at[..]].concat());
    assert!(got.contains("250") && got.contains("1000"), "{got}");
    let again = done(
        &[
            &["apply", "5", &path, "--save", "--format", "json"],
            &at[..],
        ]
        .concat(),
    );
    assert!(again.contains("\"written\": 0"), "{again}");
    // A COB-ID that depends on the node ID follows that of another node; a constant one does not.
    let dcf = std::fs::read_to_string(&path).expect("a DCF");
    assert!(dcf.contains("ParameterValue=$NODEID+0x180"), "{dcf}");
    let own = dcf.replace("ParameterValue=$NODEID+0x180", "ParameterValue=0x181");
    let own = file("bus-own.dcf", &own).display().to_string();
    let said = fails(2, &[&["apply", "6", &own], &at[..]].concat());
    assert!(
        said.contains("of node 5") && said.contains("1800h:01"),
        "{said}"
    );
    // A file of another device is refused.
    let dcf = std::fs::read_to_string(&path).expect("a DCF");
    let dcf = dcf.replace("DefaultValue=0x70\n", "DefaultValue=0x71\n");
    let other = file("bus-other.dcf", &dcf);
    let other = other.display().to_string();
    let said = odkit(&[&["apply", "5", &other], &at[..]].concat(), "");
    assert!(
        said.code == 1 && said.err.contains("of another device"),
        "{}{}",
        said.out,
        said.err
    );
    fails(
        2,
        &[
            &["apply", "5", &repository("devices/eds/GXMM.eds")],
            &at[..],
        ]
        .concat(),
    );
}
