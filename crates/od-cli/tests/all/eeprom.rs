//! EEPROM files of `odkit sim`: the device that a file is for, the process that uses it, and the
//! messages at the start.

use std::fs;
use std::path::Path;

use crate::support::sim::Sim;
use crate::support::{Done, file, fresh, odkit};

/// Saves all values of node 1, and waits as long as the slowest device needs.
const SAVE: &str = "601#2B17100064000000\nwait 20ms\n601#2310100173617665\nwait 700ms\n";
/// Bytes before those of the EEPROM.
const HEADER: usize = 512;

fn sim(device: &str, path: &Path, more: &[&str], input: &str) -> Done {
    let path = path.to_str().expect("UTF-8");
    let args = ["sim", device, "--eeprom", path, "--link", "-"];
    odkit(&[&args[..], more].concat(), input)
}

/// The heartbeat time after a start, from the response.
fn heartbeat(done: &Done) -> String {
    let answer = done
        .out
        .lines()
        .find_map(|line| line.split("581#4B171000").nth(1));
    answer
        .map(|bytes| bytes[..4].to_owned())
        .unwrap_or_default()
}

const READ: &str = "601#4017100000000000\nwait 20ms\n";

#[test]
fn the_file_of_another_device_is_refused_until_it_is_reset() {
    let path = fresh("of-gxmm.bin");
    assert_eq!(sim("gxmm", &path, &[], SAVE).code, 0);
    let whole = fs::read(&path).expect("a file");
    for other in ["gcam", "gxam", "eam_mt", "en580c"] {
        let refused = sim(other, &path, &[], "");
        assert_eq!(refused.code, 1, "{other}: {}", refused.err);
        for named in ["of-gxmm.bin", "gxmm", other, "--eeprom-reset"] {
            assert!(refused.err.contains(named), "{named}: {}", refused.err);
        }
        assert_eq!(refused.err.lines().count(), 1, "{}", refused.err);
        assert_eq!(fs::read(&path).expect("a file"), whole, "{other}");
    }
    let again = sim("gxmm", &path, &[], READ);
    assert_eq!(
        (again.code, &*heartbeat(&again)),
        (0, "6400"),
        "{}",
        again.err
    );
    assert_eq!(sim("eam_mt", &path, &["--eeprom-reset"], "").code, 0);
    let refused = sim("gxmm", &path, &[], "");
    assert_eq!(
        refused.code, 1,
        "erased, and now of eam_mt: {}",
        refused.err
    );
}

#[test]
fn the_same_identity_with_another_layout_is_another_device() {
    let text = odkit(&["export", "gxmm"], "").out;
    let one = file("one.eds", &text).display().to_string();
    // 2300h:01 gets another type.
    let (before, object) = text.split_once("[2300sub1]").expect("the object");
    let changed = format!(
        "{before}[2300sub1]{}",
        object.replacen("DataType=0x0006", "DataType=0x0005", 1)
    );
    assert_ne!(changed, text);
    let changed = file("changed.eds", &changed).display().to_string();
    let renamed = file("renamed.eds", &text).display().to_string();
    let path = fresh("of-one.bin");
    assert_eq!(sim(&one, &path, &[], SAVE).code, 0);
    let refused = sim(&changed, &path, &[], "");
    assert_eq!(refused.code, 1, "{}", refused.err);
    for named in ["one.eds", "changed.eds"] {
        assert!(refused.err.contains(named), "{named}: {}", refused.err);
    }
    let again = sim(&renamed, &path, &[], READ);
    assert_eq!(
        (again.code, &*heartbeat(&again)),
        (0, "6400"),
        "{}",
        again.err
    );
}

#[test]
fn a_file_in_use_is_refused_with_the_process_that_uses_it() {
    let path = fresh("in-use.bin");
    let name = path.to_str().expect("UTF-8");
    let first = Sim::start(&["gxmm", "--eeprom", name]);
    for more in [&[][..], &["--eeprom-reset"]] {
        let second = sim("gxmm", &path, more, "");
        assert_eq!(second.code, 1, "{}", second.err);
        let process = format!("process {}", first.child.id());
        assert!(second.err.contains(&process), "{process}: {}", second.err);
    }
    drop(first);
    assert_eq!(sim("gxmm", &path, &[], "").code, 0);
    let twice = sim("gxmm", &path, &["--device", "gxmm", "--eeprom", name], "");
    assert_eq!(twice.code, 2, "{}", twice.err);
    assert!(twice.err.contains("are the same file"), "{}", twice.err);
}

#[test]
fn a_file_of_an_older_odkit_is_refused_and_kept() {
    let mut bytes = b"odkit EEPROM 1\r\n\x69odk\x01\0\0\0".to_vec();
    bytes.resize(16 + 614, 0xFF);
    let path = fresh("older.bin");
    fs::write(&path, &bytes).expect("a file");
    let refused = sim("gxmm", &path, &[], "");
    assert_eq!(refused.code, 1, "{}", refused.err);
    assert!(refused.err.contains("an older odkit"), "{}", refused.err);
    assert_eq!(fs::read(&path).expect("a file"), bytes);
    assert_eq!(sim("gxmm", &path, &["--eeprom-reset"], "").code, 0);
}

#[test]
fn a_start_reports_which_set_it_loaded() {
    let path = fresh("damaged.bin");
    let other = SAVE.replace("6400", "C800");
    assert_eq!(sim("gxmm", &path, &[], &format!("{SAVE}{other}")).code, 0);
    let whole = fs::read(&path).expect("a file");
    let newest = HEADER + (whole.len() - HEADER) / 2;
    for (places, said, value) in [
        (&[][..], "", "C800"),
        // Length of the records, of the newest and of the older set.
        (&[newest + 6], "the older one before it", "6400"),
        (&[HEADER + 6], "the last save, which is whole", "C800"),
        (&[newest + 6, HEADER + 6], "loaded defaults", "0000"),
        // Commit word, end of the bank, and header of the file.
        (&[newest], "the last save, which is whole", "C800"),
        (&[whole.len() - 1], "the last save, which is whole", "C800"),
        (&[20], "the header was damaged", "C800"),
    ] {
        let mut bytes = whole.clone();
        for place in places {
            bytes[*place] ^= 2;
        }
        fs::write(&path, bytes).expect("a file");
        let again = sim("gxmm", &path, &[], READ);
        assert_eq!(again.code, 0, "{places:?}: {}", again.err);
        assert_eq!(heartbeat(&again), value, "{places:?}: {}", again.err);
        assert!(again.err.contains(said), "{places:?}: {}", again.err);
        let says_something = again.err.contains("is damaged;") || again.err.contains("header was");
        let says_something = says_something || again.err.contains("bits of the EEPROM");
        assert_eq!(says_something, !said.is_empty(), "{}", again.err);
    }
    for len in [0, 1, 15, 16, 100, 500, 511, 512] {
        fs::write(&path, &whole[..len]).expect("a file");
        let again = sim("gxmm", &path, &[], READ);
        assert!(
            again.err.contains("no saved values"),
            "{len}: {}",
            again.err
        );
    }
    fs::write(&path, &whole[..newest + 30]).expect("a file");
    let again = sim("gxmm", &path, &[], READ);
    assert!(again.err.contains("bytes were missing"), "{}", again.err);
    assert_eq!(heartbeat(&again), "6400", "{}", again.err);
}

#[test]
fn a_reset_needs_a_file() {
    let refused = odkit(&["sim", "gxmm", "--eeprom-reset"], "");
    assert_eq!(refused.code, 2, "{}", refused.err);
    assert!(refused.err.contains("`--eeprom FILE`"), "{}", refused.err);
}
