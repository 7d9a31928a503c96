//! An output never replaces a file that the run uses, nor a file of the user.

use std::fs;
use std::path::{Path, PathBuf};

use crate::support::{odkit, repository};

/// A folder of this test with a copy of an EDS, a hard link and a symlink to it, and other files of a user.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("outputs-{name}"));
        let _ = fs::remove_dir_all(&folder);
        fs::create_dir_all(folder.join("sub")).expect("a folder");
        let eds = fs::read(repository("devices/eds/GXMM.eds")).expect("an EDS");
        fs::write(folder.join("my.eds"), eds).expect("a file");
        fs::hard_link(folder.join("my.eds"), folder.join("hard.eds")).expect("a link");
        #[cfg(unix)]
        std::os::unix::fs::symlink("my.eds", folder.join("soft.eds")).expect("a link");
        fs::write(folder.join("small.overlay"), "[6001]\n").expect("a file");
        fs::write(folder.join("notes.log"), "what I saw\n").expect("a file");
        fs::write(folder.join("bus.log"), "(0.100000) can0 701#05\n").expect("a file");
        fs::write(folder.join("any.json"), "{\"version\": 1}\n").expect("a file");
        Self(folder)
    }

    fn path(&self, name: &str) -> String {
        self.0.join(name).display().to_string()
    }

    /// All files with their content.
    fn content(&self) -> Vec<(PathBuf, Vec<u8>)> {
        let entries = fs::read_dir(&self.0).expect("a folder");
        let paths = entries.map(|entry| entry.expect("an entry").path());
        let files = paths.filter(|path| path.is_file());
        let mut files: Vec<_> = files
            .map(|path| (path.clone(), fs::read(path).expect("a file")))
            .collect();
        files.sort();
        files
    }

    /// Runs a command with `$` for the folder; it is refused with these words, and no file has changed.
    #[track_caller]
    fn refuses(&self, line: &str, words: &str) {
        let before = self.content();
        let line = line.replace('$', &self.path(""));
        let args: Vec<&str> = line.split_whitespace().collect();
        let done = odkit(&args, "");
        assert!(
            matches!(done.code, 1 | 2),
            "{line}: {} {}",
            done.out,
            done.err
        );
        assert!(done.err.contains(words), "{line}: {}", done.err);
        assert!(before == self.content(), "{line}: a file was changed");
    }
}

const SAME: &str = "are the same file; give one of them another name";

#[test]
fn a_bench_refuses_an_output_that_is_another_file_of_the_run() {
    let folder = Folder::new("sim");
    for options in [
        "$my.eds --ready-file $my.eds",
        "$my.eds --ready-file $./sub/../my.eds",
        "$my.eds --log $my.eds",
        "$my.eds --log $hard.eds",
        #[cfg(unix)]
        "$my.eds --log $soft.eds",
        "$my.eds --eeprom $my.eds",
        "$my.eds --control unix:$my.eds",
        "$my.eds+$small.overlay --log $small.overlay",
        "$my.eds+$small.overlay --log $my.eds",
        "gxmm --device $my.eds --log $my.eds",
        "gxmm --eeprom $x --log $x",
        "gxmm --eeprom $x --log $sub/../x",
        "gxmm --eeprom $x --ready-file $x",
        "gxmm --log $x --ready-file $x",
        "gxmm --log $x --control unix:$x",
        "gxmm eam_mt --eeprom $x --eeprom $x",
    ] {
        folder.refuses(&format!("sim --slcan 127.0.0.1:0 --quiet {options}"), SAME);
    }
}

#[test]
fn a_bench_replaces_only_files_of_its_kind() {
    let folder = Folder::new("kind");
    let sim = "sim gxmm --slcan 127.0.0.1:0 --quiet";
    let not_ready = "is not a ready file of odkit; give another path, or delete the file";
    for name in ["my.eds", "any.json", "bus.log"] {
        folder.refuses(&format!("{sim} --ready-file ${name}"), not_ready);
    }
    let not_log = "is not a candump log; write another name, or delete the file";
    for name in ["my.eds", "any.json", "notes.log"] {
        folder.refuses(&format!("{sim} --log ${name}"), not_log);
    }
    folder.refuses("record $notes.log --link slcan:127.0.0.1:1", "127.0.0.1:1");
}

#[test]
fn a_command_refuses_an_output_that_is_its_input() {
    let folder = Folder::new("command");
    for line in [
        "convert $my.eds -o $my.eds",
        "convert $my.eds -o $hard.eds",
        "convert $my.eds+$small.overlay -o $my.eds",
        "export $my.eds -o $./my.eds",
        "conform gxmm --eds $my.eds --only nmt* --report $a.txt --report $./a.txt",
    ] {
        folder.refuses(line, SAME);
    }
}

#[test]
fn a_network_never_replaces_the_file_of_a_node() {
    let folder = Folder::new("network");
    fs::rename(folder.path("my.eds"), folder.path("master.dcf")).expect("a file");
    let project =
        "master:\n  node_id: 127\n  baudrate: 500\nslave:\n  dcf: master.dcf\n  node_id: 2\n";
    fs::write(folder.path("net.yml"), project).expect("a file");
    folder.refuses("network $net.yml -o $", SAME);
}

/// A limit of the file size stands for a full disk: the write fails in the middle.
#[cfg(unix)]
#[test]
fn an_output_that_cannot_be_written_leaves_the_old_files() {
    use std::process::Command;

    let folder = Folder::new("limit");
    for name in ["a.xdd", "a.c", "a.h", "a.md"] {
        fs::write(folder.path(name), "old\n").expect("a file");
    }
    for line in [
        "convert $my.eds --lossy -o $a.xdd",
        "convert $my.eds --lossy --to canopennode -o $a.c",
        "convert $my.eds --lossy -o $new.json",
        "conform gxmm --only nmt* --report $a.md",
        "learn 1 --link bench:gxmm -o $new.eds",
    ] {
        let before = folder.content();
        let line = line.replace('$', &folder.path(""));
        // 1 block is 512 or 1,024 bytes.
        let script = format!("ulimit -f 1; exec {} {line}", env!("CARGO_BIN_EXE_odkit"));
        let done = Command::new("sh").args(["-c", &script]).output();
        let done = done.expect("a shell");
        let err = String::from_utf8_lossy(&done.stderr);
        assert_eq!(done.status.code(), Some(1), "{line}: {err}");
        assert!(err.contains("cannot be written"), "{line}: {err}");
        assert!(before == folder.content(), "{line}: a file was changed");
    }
}
