//! Owner, content and messages of a file.

use super::*;
use std::path::PathBuf;
use std::string::ToString;
use std::{env, format, fs};

const OWNER: Owner<'static> = Owner {
    name: "gxmm",
    identity: "vendor-ID ECh",
    device: 7,
};
const OTHER: Owner<'static> = Owner {
    name: "my.eds",
    identity: "vendor-ID EDh",
    device: 8,
};

fn path(name: &str) -> PathBuf {
    env::temp_dir().join(format!("odkit-{}-{name}", process::id()))
}

fn error(path: &Path, capacity: usize, owner: &Owner<'_>) -> String {
    let before = fs::read(path).unwrap();
    let error = File::open(path, capacity, owner).unwrap_err().to_string();
    assert_eq!(fs::read(path).unwrap(), before, "{error}");
    assert!(error.starts_with(path.to_str().unwrap()), "{error}");
    error
}

#[test]
fn written_bytes_are_there_after_reopening() {
    let path = path("again");
    let mut file = File::open(&path, 64, &OWNER).unwrap();
    let mut byte = [0];
    file.read(63, &mut byte).unwrap();
    assert_eq!(byte, [ERASED]);
    file.write(60, b"last").unwrap();
    file.flush().unwrap();
    assert_eq!(file.write(61, b"last"), Err(StorageError::OutOfRange));
    assert_eq!(
        file.read(usize::MAX, &mut byte),
        Err(StorageError::OutOfRange)
    );
    drop(file);

    let mut file = File::open(&path, 32, &OWNER).unwrap();
    assert_eq!(file.capacity(), 64, "a larger file keeps its size");
    assert_eq!(file.repaired(), None);
    let mut bytes = [0; 4];
    file.read(60, &mut bytes).unwrap();
    assert_eq!(&bytes, b"last");
    drop(file);
    let why = error(&path, 65, &OWNER);
    assert!(
        why.contains("64 bytes") && why.contains("needs 65"),
        "{why}"
    );
    fs::remove_file(path).unwrap();
}

#[test]
fn a_file_of_another_program_is_not_changed() {
    let path = path("letter");
    let long = "a letter to somebody, and longer than a header".repeat(20);
    for content in [&*long, "short", "odkit EEPROM\r\n"] {
        fs::write(&path, content).unwrap();
        let why = error(&path, 16, &OWNER);
        assert!(why.contains("left as it is"), "{why}");
        // Even an erase does not change it.
        let erased = File::open_erased(&path, 16, &OWNER);
        assert!(matches!(erased, Err(OpenError::NotEeprom(_))));
        assert_eq!(fs::read_to_string(&path).unwrap(), content);
    }
    let error = File::open(env::temp_dir(), 16, &OWNER).unwrap_err();
    assert!(matches!(error, OpenError::Io(..)), "{error}");
    fs::remove_file(path).unwrap();
}

#[test]
fn an_unfinished_file_is_new_and_says_so() {
    let path = path("unfinished");
    let whole = {
        drop(File::open(&path, 8, &OWNER).unwrap());
        fs::read(&path).unwrap()
    };
    assert_eq!(whole.len(), LEN + 8);
    for len in (0..whole.len()).filter(|len| len % 31 < 2 || *len > LEN - 2) {
        fs::write(&path, &whole[..len]).unwrap();
        let file = File::open(&path, 8, &OWNER).unwrap();
        assert_eq!(file.capacity(), 8);
        let said = file.repaired().unwrap_or_default();
        assert!(said.contains("no saved values"), "{len}: {said}");
        drop(file);
        assert_eq!(fs::read(&path).unwrap(), whole, "{len}");
    }
    fs::remove_file(path).unwrap();
}

#[test]
fn another_device_is_refused_with_both_names() {
    let path = path("foreign");
    let mut file = File::open(&path, 64, &OWNER).unwrap();
    drop(File::open(&path, 64, &OWNER).unwrap_err());
    file.write(0, b"values").unwrap();
    drop(file);
    let why = error(&path, 64, &OTHER);
    for named in ["gxmm", "vendor-ID ECh", "my.eds", "vendor-ID EDh"] {
        assert!(why.contains(named), "{named}: {why}");
    }
    let mut file = File::open_erased(&path, 64, &OTHER).unwrap();
    let mut bytes = [0; 6];
    file.read(0, &mut bytes).unwrap();
    assert_eq!(bytes, [ERASED; 6]);
    drop(file);
    // Without values it gets the size that its device needs, and still belongs to no other device.
    drop(File::open(&path, 80, &OTHER).unwrap());
    assert_eq!(fs::read(&path).unwrap().len(), LEN + 80);
    error(&path, 80, &OWNER);
    fs::remove_file(path).unwrap();
}

#[test]
fn a_file_of_an_older_odkit_is_refused_if_it_has_values() {
    let path = path("older");
    let mut old = b"odkit EEPROM 1\r\n".to_vec();
    old.resize(16 + 600, ERASED);
    fs::write(&path, &old).unwrap();
    drop(File::open(&path, 600, &OWNER).unwrap());
    for len in [16 + 600, 16 + 40] {
        old.truncate(len);
        old[16..20].copy_from_slice(b"iodk");
        fs::write(&path, &old).unwrap();
        let why = error(&path, 600, &OWNER);
        assert!(why.contains("an older odkit"), "{why}");
    }
    assert_eq!(
        File::open_erased(&path, 600, &OWNER).unwrap().capacity(),
        600
    );
    fs::remove_file(path).unwrap();
}

#[test]
fn a_file_in_use_names_the_process() {
    let path = path("lock");
    let file = File::open(&path, 64, &OWNER).unwrap();
    let why = error(&path, 64, &OWNER);
    assert!(why.contains("another device of this process"), "{why}");
    let other = OpenError::InUse {
        path: path.clone(),
        process: Some(process::id() + 1),
    };
    assert!(other.to_string().contains("uses the file"), "{other}");
    let erased = File::open_erased(&path, 64, &OWNER);
    assert!(
        matches!(erased, Err(OpenError::InUse { process: Some(own), .. }) if own == process::id())
    );
    drop(file);
    drop(File::open(&path, 64, &OWNER).unwrap());
    fs::remove_file(path).unwrap();
}

#[test]
fn a_damaged_header_costs_no_value() {
    let path = path("header");
    let mut file = File::open(&path, 64, &OWNER).unwrap();
    file.write(0, b"values").unwrap();
    drop(file);
    let whole = fs::read(&path).unwrap();
    for bit in 0..LEN * 8 {
        let mut bytes = whole.clone();
        bytes[bit / 8] ^= 1 << (bit % 8);
        assert_eq!(Header::read(&bytes[..LEN]), Seen::Damaged, "bit {bit}");
        // The time of a change has a coarse resolution in some file systems.
        if bit % 37 > 0 {
            continue;
        }
        fs::write(&path, &bytes).unwrap();
        let file = File::open(&path, 64, &OWNER).unwrap();
        assert!(file.repaired().is_some(), "bit {bit}");
        drop(file);
        assert_eq!(fs::read(&path).unwrap(), whole, "bit {bit}");
    }
    fs::remove_file(path).unwrap();
}

#[test]
fn a_file_with_another_length_keeps_its_bytes_in_place() {
    let path = path("length");
    let mut file = File::open(&path, 64, &OWNER).unwrap();
    file.write(0, &[1; 64]).unwrap();
    drop(file);
    let whole = fs::read(&path).unwrap();
    let mut longer = whole.clone();
    longer.extend([9; 100]);
    fs::write(&path, &longer).unwrap();
    assert_eq!(File::open(&path, 64, &OWNER).unwrap().capacity(), 64);
    fs::write(&path, &whole[..LEN + 20]).unwrap();
    let mut file = File::open(&path, 64, &OWNER).unwrap();
    let why = String::from(file.repaired().unwrap());
    assert!(why.contains("last 44 of 576 bytes"), "{why}");
    let mut bytes = [0; 64];
    file.read(0, &mut bytes).unwrap();
    assert_eq!(bytes[..20], [1; 20]);
    assert_eq!(bytes[20..], [LOST; 44]);
    fs::remove_file(path).unwrap();
}

#[test]
fn a_long_name_keeps_its_end() {
    let name = |text: &str| header::line(text);
    assert_eq!(name("a\r\nb\tc"), "a  b c");
    assert_eq!(name(&"x".repeat(200)), "x".repeat(200));
    assert_eq!(name(&"x".repeat(201)), "x".repeat(200));
    // 301 bytes: byte 101 is inside a character.
    let long = format!("{}x", "\u{E9}".repeat(150));
    assert_eq!(name(&long), format!("{}x", "\u{E9}".repeat(99)));
}

#[test]
fn some_files_can_be_erased() {
    let path = || PathBuf::from("eeprom");
    let two = || [String::new(), String::new()];
    let (has, needs, process) = (1, 2, None);
    for (error, can_be_erased) in [
        (OpenError::Io(path(), io::ErrorKind::NotFound.into()), false),
        (OpenError::NotEeprom(path()), false),
        (OpenError::Version(path(), '1'), true),
        (
            OpenError::Foreign {
                path: path(),
                of: two(),
                device: two(),
            },
            true,
        ),
        (
            OpenError::InUse {
                path: path(),
                process,
            },
            false,
        ),
        (
            OpenError::TooSmall {
                path: path(),
                has,
                needs,
            },
            true,
        ),
    ] {
        assert_eq!(error.can_be_erased(), can_be_erased, "{error}");
    }
    let version = |digit| OpenError::Version(path(), digit).to_string();
    assert!(version('1').contains("an older"));
    assert!(version('3').contains("a newer"));
}
