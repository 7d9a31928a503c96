//! Reason why a file is not used.

use core::fmt;
use std::io;
use std::path::PathBuf;
use std::process;
use std::string::String;

/// Reason why a file is not used; it is unchanged.
#[derive(Debug)]
#[non_exhaustive]
pub enum OpenError {
    /// The operating system reported an error.
    Io(PathBuf, io::Error),
    /// The file is not an EEPROM file of odkit.
    NotEeprom(PathBuf),
    /// Another version of odkit wrote the file.
    Version(PathBuf, char),
    /// The file has the values of another device.
    Foreign {
        /// The file.
        path: PathBuf,
        /// Name and identity of the device that the file belongs to.
        of: [String; 2],
        /// Name and identity of the device that was to use the file.
        device: [String; 2],
    },
    /// Another device uses the file.
    InUse {
        /// The file.
        path: PathBuf,
        /// The process ID, if the file contains it.
        process: Option<u32>,
    },
    /// The file is too small for this device.
    TooSmall {
        /// The file.
        path: PathBuf,
        /// Number of bytes that it holds.
        has: usize,
        /// Number of bytes that the device needs.
        needs: usize,
    },
}

impl OpenError {
    /// Returns whether [`File::open_erased`](super::File::open_erased) opens the file.
    pub fn can_be_erased(&self) -> bool {
        matches!(
            self,
            Self::Version(..) | Self::Foreign { .. } | Self::TooSmall { .. }
        )
    }
}

impl fmt::Display for OpenError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Io(path, error) => write!(
                f,
                "{}: {error}; check the path and its permissions",
                path.display()
            ),
            Self::NotEeprom(path) => write!(
                f,
                "{}: not an EEPROM file of odkit, so it is left as it is; \
                 give another path, or remove the file to start with an empty EEPROM",
                path.display()
            ),
            Self::Version(path, version) => {
                let age = if *version < '2' {
                    "an older"
                } else {
                    "a newer"
                };
                write!(
                    f,
                    "{}: {age} odkit wrote this EEPROM file (version {version}; this odkit reads \
                     version 2)",
                    path.display()
                )
            }
            Self::Foreign { path, of, device } => write!(
                f,
                "{}: the values in this EEPROM file are those of {} ({}), and this device is {} ({})",
                path.display(),
                of[0],
                of[1],
                device[0],
                device[1]
            ),
            Self::InUse { path, process } => {
                let path = path.display();
                match process {
                    Some(process) if *process == process::id() => {
                        write!(f, "{path}: another device of this process uses the file; ")
                    }
                    Some(process) => write!(f, "{path}: process {process} uses the file; "),
                    None => write!(f, "{path}: another process uses the file; "),
                }?;
                f.write_str("give each device a file of its own")
            }
            Self::TooSmall { path, has, needs } => write!(
                f,
                "{}: an EEPROM of {has} bytes, and this device needs {needs}",
                path.display()
            ),
        }
    }
}

impl std::error::Error for OpenError {}
