//! The files of a run. An output never replaces an input, another output, or another file of the user, and a file that
//! is replaced has its old content or the new one, never a part.

use std::fs::{self, OpenOptions};
use std::io::{self, Read, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU32, Ordering};

use od_model::Refused;

use crate::logs::Format;

/// Bytes of an existing file that show its format.
const HEAD: u64 = 256 * 1024;

/// Limit of what is read from a device or a pipe, some of which have no end.
const ENDLESS: u64 = 256 * 1024 * 1024;

/// The files that a run reads or writes.
#[derive(Debug, Default)]
pub struct Files(Vec<Used>);

#[derive(Debug)]
struct Used {
    /// The option or the role, with the path as it was given.
    title: String,
    path: PathBuf,
    is_written: bool,
}

/// Identity of a file: two paths to the same file have the same one.
#[derive(PartialEq, Eq, Debug)]
enum Identity {
    /// Device and inode: hard links are one file.
    #[cfg(unix)]
    Inode(u64, u64),
    /// The path without symlinks, for a file that does not exist yet or a system without inodes.
    Path(PathBuf),
}

impl Files {
    /// No files.
    pub const fn new() -> Self {
        Self(Vec::new())
    }

    /// Adds a file that the run reads; several inputs may be the same file.
    ///
    /// # Errors
    /// The run writes this file.
    pub fn read(&mut self, title: impl Into<String>, path: &Path) -> Result<(), Refused> {
        self.add(title.into(), path, false)
    }

    /// Adds a file that the run writes.
    ///
    /// # Errors
    /// The run reads or writes the same file already.
    pub fn write(&mut self, title: impl Into<String>, path: &Path) -> Result<(), Refused> {
        self.add(title.into(), path, true)
    }

    fn add(&mut self, title: String, path: &Path, is_written: bool) -> Result<(), Refused> {
        // A file that was created in the meantime has a new identity.
        if let Some(own) = identity(path) {
            let mut others = self.0.iter();
            let clash = others.find(|other| {
                (is_written || other.is_written) && identity(&other.path).as_ref() == Some(&own)
            });
            if let Some(other) = clash {
                let other = &other.title;
                return Err(format!(
                    "{title} and {other} are the same file; give one of them another name"
                )
                .into());
            }
        }
        self.0.push(Used {
            title,
            path: path.to_owned(),
            is_written,
        });
        Ok(())
    }
}

/// The identity of a regular file, or of a path that may become one. `None`: a device, a pipe or a folder.
fn identity(path: &Path) -> Option<Identity> {
    match path.metadata() {
        Ok(file) if !file.is_file() => None,
        #[cfg(unix)]
        Ok(file) => {
            use std::os::unix::fs::MetadataExt;
            Some(Identity::Inode(file.dev(), file.ino()))
        }
        #[cfg(not(unix))]
        Ok(_) => path.canonicalize().ok().map(Identity::Path),
        Err(_) => Some(Identity::Path(target(path))),
    }
}

/// The path of a file that would be created at `path`: without symlinks, as far as they exist.
fn target(path: &Path) -> PathBuf {
    let mut path = path.to_owned();
    // Linux follows 40 symlinks.
    for _ in 0..40 {
        let folder = path.parent().filter(|folder| *folder != Path::new(""));
        let folder = folder.unwrap_or(Path::new("."));
        let folder = folder.canonicalize().unwrap_or_else(|_| folder.to_owned());
        match fs::read_link(&path) {
            Ok(link) => path = folder.join(link),
            Err(_) => return folder.join(path.file_name().unwrap_or_default()),
        }
    }
    path
}

/// Reads a file, or at most 256 MiB of a device or a pipe.
///
/// # Errors
/// It cannot be read, or the device has no end.
pub fn read(path: &Path) -> io::Result<Vec<u8>> {
    let mut file = fs::File::open(path)?;
    let is_file = file.metadata()?.is_file();
    let limit = if is_file { u64::MAX } else { ENDLESS };
    let mut bytes = Vec::new();
    if (&mut file).take(limit).read_to_end(&mut bytes)? as u64 == limit {
        return Err(io::Error::other("it has no end within 256 MiB"));
    }
    Ok(bytes)
}

/// Writes files, each in one step: another program, or the next one after a power failure or `kill -9`, sees the old
/// content or the new one. No file is changed before all are written, so a full disk changes none. A device or a pipe
/// is written directly.
///
/// # Errors
/// The first path that cannot be written, and the reason.
pub fn replace(files: &[(&Path, &[u8])]) -> Result<(), (PathBuf, io::Error)> {
    let failed = |path: &Path| {
        let path = path.to_owned();
        move |error| (path, error)
    };
    let mut beside = Vec::new();
    for (path, bytes) in files {
        let is_direct = path.metadata().is_ok_and(|there| !there.is_file());
        if is_direct {
            // A folder is an error here.
            let file = OpenOptions::new().write(true).open(path);
            let written = file.and_then(|mut file| file.write_all(bytes));
            written.map_err(failed(path))?;
        } else {
            let one = Beside::write(path, bytes, false).map_err(failed(path))?;
            beside.push((path, one));
        }
    }
    for (path, one) in beside {
        one.put().map_err(failed(path))?;
    }
    Ok(())
}

/// New content of a file, in a file beside it; it is removed unless it is [put](Self::put) in its place.
pub(super) struct Beside {
    beside: PathBuf,
    place: PathBuf,
}

impl Beside {
    /// Writes the content. A file that exists keeps its permissions; a new one is `is_private`, or as the system says.
    ///
    /// # Errors
    /// It cannot be written, or the file that exists is read only.
    pub(super) fn write(path: &Path, bytes: &[u8], is_private: bool) -> io::Result<Self> {
        static COUNT: AtomicU32 = AtomicU32::new(0);
        let before = path.metadata().ok().map(|there| there.permissions());
        if before.as_ref().is_some_and(fs::Permissions::readonly) {
            let why = "it is read only";
            return Err(io::Error::new(io::ErrorKind::PermissionDenied, why));
        }
        // A link leads to the file to replace.
        let place = target(path);
        let count = COUNT.fetch_add(1, Ordering::Relaxed);
        let name = format!(".odkit-{}-{count}.tmp", std::process::id());
        let beside = place.with_file_name(name);
        // Left by an earlier process with this number.
        let _ = fs::remove_file(&beside);
        let mut options = OpenOptions::new();
        let options = options.write(true).create_new(true);
        #[cfg(unix)]
        if is_private {
            std::os::unix::fs::OpenOptionsExt::mode(options, 0o600);
        }
        #[cfg(not(unix))]
        let _ = is_private;
        let mut file = options.open(&beside)?;
        let one = Self { beside, place };
        file.write_all(bytes)?;
        // A power failure right after the replacement must not find an empty file.
        file.sync_all()?;
        if let Some(before) = before {
            file.set_permissions(before)?;
        }
        Ok(one)
    }

    /// Replaces the file in one step.
    ///
    /// # Errors
    /// The system refuses it.
    pub(super) fn put(self) -> io::Result<()> {
        fs::rename(&self.beside, &self.place)
    }
}

impl Drop for Beside {
    fn drop(&mut self) {
        // After it is put in its place, there is none.
        let _ = fs::remove_file(&self.beside);
    }
}

/// Turns a write beyond the limit of `ulimit -f` into an error with a message, instead of a signal
/// that ends the process. It applies to this thread and the threads that it starts.
#[cfg(unix)]
pub fn survive_limit() {
    use nix::sys::signal::{SigSet, Signal};

    let mut signals = SigSet::empty();
    signals.add(Signal::SIGXFSZ);
    let _ = signals.thread_block();
}

/// Other systems have no such limit.
#[cfg(not(unix))]
pub fn survive_limit() {}

/// Checks that a log may be written to a path: the file is new, empty, or a log of this format.
///
/// # Errors
/// The file is something else.
pub fn replaces_log(path: &Path, format: Format) -> Result<(), Refused> {
    match head(path) {
        Some(head) if !format.recognises(&head) => Err(format!(
            "the file exists and is not a {} log; write another name, or delete the file",
            format.name()
        )
        .into()),
        _ => Ok(()),
    }
}

/// The beginning of a regular file; `None`: it does not exist, is empty, or is a device.
pub(super) fn head(path: &Path) -> Option<Vec<u8>> {
    let is_file = path.metadata().is_ok_and(|file| file.is_file());
    let file = is_file.then(|| fs::File::open(path).ok()).flatten()?;
    let mut head = Vec::new();
    // Ignore read errors here: opening the file for writing reports the reason.
    let _ = file.take(HEAD).read_to_end(&mut head);
    (!head.is_empty()).then_some(head)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The names of the files in a folder.
    fn names(folder: &Path) -> Vec<String> {
        let all = fs::read_dir(folder).unwrap();
        let name = |entry: io::Result<fs::DirEntry>| entry.unwrap().file_name();
        let mut all: Vec<_> = all
            .map(|entry| name(entry).into_string().unwrap())
            .collect();
        all.sort();
        all
    }

    #[test]
    fn files_are_replaced_together_or_not_at_all() {
        let folder = folder("replace");
        let (old, new, none) = (
            folder.join("old"),
            folder.join("new"),
            folder.join("no/such"),
        );
        fs::write(&old, "before").unwrap();
        let (path, _) = replace(&[(&old, b"after"), (&new, b"1"), (&none, b"2")]).unwrap_err();
        assert_eq!(path, none);
        assert_eq!(fs::read(&old).unwrap(), b"before");
        assert_eq!(names(&folder), ["old"]);
        assert!(replace(&[(&old, b"after"), (&new, b"1")]).is_ok());
        assert_eq!(fs::read(&old).unwrap(), b"after");
        assert_eq!(names(&folder), ["new", "old"]);
        // A folder is not replaced.
        assert!(replace(&[(&folder, b"1")]).is_err());
        fs::remove_dir_all(folder).unwrap();
    }

    #[cfg(unix)]
    #[test]
    fn a_link_a_mode_and_a_device_stay_what_they_are() {
        use std::os::unix::fs::{PermissionsExt, symlink};

        let folder = folder("kept");
        let (real, link, device) = (
            folder.join("real"),
            folder.join("link"),
            folder.join("null"),
        );
        fs::write(&real, "before").unwrap();
        fs::set_permissions(&real, fs::Permissions::from_mode(0o640)).unwrap();
        symlink("real", &link).unwrap();
        symlink("/dev/null", &device).unwrap();
        assert!(replace(&[(&link, b"after"), (&device, b"nothing")]).is_ok());
        assert_eq!(fs::read(&real).unwrap(), b"after");
        assert!(link.is_symlink() && device.is_symlink());
        let mode = |path: &Path| path.metadata().unwrap().permissions().mode() & 0o777;
        assert_eq!(mode(&real), 0o640);
        fs::set_permissions(&real, fs::Permissions::from_mode(0o440)).unwrap();
        assert!(replace(&[(&link, b"again")]).is_err());
        assert_eq!(fs::read(&real).unwrap(), b"after");
        symlink("new", folder.join("dangling")).unwrap();
        assert!(replace(&[(&folder.join("dangling"), b"1")]).is_ok());
        assert_eq!(names(&folder), ["dangling", "link", "new", "null", "real"]);
        assert!(read(Path::new("/dev/zero")).is_err());
        fs::remove_dir_all(folder).unwrap();
    }

    fn folder(name: &str) -> PathBuf {
        let folder =
            std::env::temp_dir().join(format!("odkit-files-{name}-{}", std::process::id()));
        let _ = fs::remove_dir_all(&folder);
        fs::create_dir(&folder).unwrap();
        folder
    }

    #[test]
    fn an_output_is_compared_by_the_file_behind_its_path() {
        let folder = folder("same");
        let path = |name: &str| folder.join(name);
        fs::write(path("a.eds"), "text").unwrap();
        let mut outputs = vec![path("a.eds"), folder.join(".").join("a.eds")];
        #[cfg(unix)]
        {
            fs::hard_link(path("a.eds"), path("hard")).unwrap();
            std::os::unix::fs::symlink("a.eds", path("soft")).unwrap();
            outputs.extend([path("hard"), path("soft")]);
        }
        for output in outputs {
            let mut files = Files::new();
            files.read("the input", &path("a.eds")).unwrap();
            let refused = files.write("`--log`", &output).unwrap_err();
            let words = refused.to_string();
            assert!(words.contains("`--log` and the input"), "{words}");
        }
        let mut files = Files::new();
        files.read("the input", &path("a.eds")).unwrap();
        files.read("the input again", &path("a.eds")).unwrap();
        assert!(files.write("other", &path("b.eds")).is_ok());
        fs::remove_dir_all(folder).unwrap();
    }

    #[test]
    fn files_that_do_not_exist_yet_are_compared_by_path() {
        let folder = folder("new");
        let mut files = Files::new();
        files.write("`--eeprom`", &folder.join("x")).unwrap();
        assert!(files.write("`--log`", &folder.join("./x")).is_err());
        assert!(files.read("the input", &folder.join("x")).is_err());
        // It was created in the meantime.
        fs::write(folder.join("x"), "").unwrap();
        assert!(files.write("`--log`", &folder.join("x")).is_err());
        fs::remove_file(folder.join("x")).unwrap();
        #[cfg(unix)]
        {
            std::os::unix::fs::symlink("x", folder.join("soft")).unwrap();
            assert!(files.write("`--log`", &folder.join("soft")).is_err());
            std::os::unix::fs::symlink("loop", folder.join("loop")).unwrap();
            assert!(files.write("`--log`", &folder.join("loop")).is_ok());
        }
        assert!(files.write("`--log`", &folder.join("y")).is_ok());
        fs::remove_dir_all(folder).unwrap();
    }

    #[test]
    fn only_a_log_is_replaced_by_a_log() {
        let folder = folder("log");
        let path = folder.join("x");
        for (content, format, is_replaced) in [
            ("", Format::Candump, true),
            ("(0.5) can0 701#05\n(0.6) can0 ", Format::Candump, true),
            (
                "(0.5) can0 20000008#0000040000000000\n",
                Format::Candump,
                true,
            ),
            ("(0.5) can0 701#05\n", Format::Pcapng, false),
            ("\n\r\r\n....", Format::Pcapng, true),
            ("[FileInfo]\n", Format::Candump, false),
            ("701#05\n", Format::Candump, false),
            ("(0.5) can0 701#05\nshaft 3\n", Format::Candump, false),
            ("text", Format::Candump, false),
        ] {
            fs::write(&path, content).unwrap();
            let is_ok = replaces_log(&path, format).is_ok();
            assert_eq!(is_ok, is_replaced, "{content:?} {format:?}");
        }
        assert!(replaces_log(&folder.join("new"), Format::Candump).is_ok());
        fs::remove_dir_all(folder).unwrap();
    }
}
