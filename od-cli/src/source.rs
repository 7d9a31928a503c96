//! From what somebody wrote on the command line to a device.

use std::fs;
use std::path::Path;

use od_bench::{EdsOptions, VirtualDevice};
use od_devices::DEVICES;
use od_runtime::DeviceKind;
use od_runtime::NodeId;

pub(crate) use od_bench::serve::options::node_id;

use crate::{Failure, output};

mod text;

pub(crate) use text::Text;

/// A built-in device, or the text of a file.
pub(crate) enum Source {
    BuiltIn(&'static DeviceKind),
    File(Text),
}

/// So many errors of a file are shown where a device is made of it.
const SHOWN: usize = 5;

impl Source {
    /// A name of a built-in device, or the path of an EDS or DCF file.
    pub(crate) fn find(name: &str) -> Result<Self, Failure> {
        Self::find_in(name, Path::new(""))
    }

    /// As [`find`](Self::find), with paths from `folder` on.
    pub(crate) fn find_in(name: &str, folder: &Path) -> Result<Self, Failure> {
        if let Some(kind) = od_devices::find(name) {
            return Ok(Self::BuiltIn(kind));
        }
        let path = folder.join(name);
        match fs::read(&path) {
            Ok(bytes) => Ok(Self::File(Text {
                path: path.display().to_string(),
                text: od_eds::decode(&bytes).into_owned(),
                overlay: None,
            })),
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => {
                match name.rsplit_once('+') {
                    Some((base, overlay)) => Self::overlaid(base, overlay, folder),
                    None => Err(unknown(name, &error)),
                }
            }
            Err(error) => Err(unknown(name, &error)),
        }
    }

    /// `base.eds+variant.eds`: a base with an overlay, which may be laid over another one.
    fn overlaid(base: &str, overlay: &str, folder: &Path) -> Result<Self, Failure> {
        let path = folder.join(overlay);
        let bytes = fs::read(&path).map_err(|error| {
            let why = read_error(&error);
            Failure::Failed(format!("the overlay {}: {why}", path.display()))
        })?;
        let base = match Self::find_in(base, folder)? {
            Self::BuiltIn(kind) => Text {
                path: kind.name.into(),
                text: od_devices::text::eds(kind),
                overlay: None,
            },
            Self::File(text) => text,
        };
        let overlay = (
            path.display().to_string(),
            od_eds::decode(&bytes).into_owned(),
        );
        Ok(Self::File(base.with_overlay(overlay)?))
    }

    /// The built-in device, if it is one.
    pub(crate) fn kind(&self) -> Option<&'static DeviceKind> {
        match self {
            Self::BuiltIn(kind) => Some(kind),
            Self::File(_) => None,
        }
    }

    /// A device with power off. Errors of a text are reported on standard error; what can
    /// run of it runs all the same, as masters take such files, too.
    pub(crate) fn device(&self, node_id: Option<NodeId>) -> Result<VirtualDevice, String> {
        let file = match self {
            Self::BuiltIn(kind) => {
                return Ok(VirtualDevice::new(kind, node_id.unwrap_or(NodeId::ONE)));
            }
            Self::File(file) => file,
        };
        let Text { path, text, .. } = file;
        let strict = EdsOptions {
            node_id,
            lenient: false,
        };
        let diagnostics = match VirtualDevice::from_eds(text, strict) {
            Ok(device) => return Ok(device),
            Err(diagnostics) => diagnostics,
        };
        let errors: Vec<_> = diagnostics.into_iter().filter(|d| d.is_error()).collect();
        let shown = &errors[..errors.len().min(SHOWN)];
        let colours = output::error_colours();
        output::note_text(&file.render(shown, colours));
        let count = crate::report::plural(errors.len(), "error");
        let lenient = EdsOptions {
            node_id,
            lenient: true,
        };
        match VirtualDevice::from_eds(text, lenient) {
            Ok(device) if !device.dictionary().objects().is_empty() => {
                output::error(&format!(
                    "{path} has {count} (`odkit check` shows everything); it runs without \
                     what cannot be used"
                ));
                Ok(device)
            }
            _ => Err(format!(
                "{path} describes no object that could run; is it an EDS or DCF file?"
            )),
        }
    }
}

fn unknown(name: &str, error: &std::io::Error) -> Failure {
    let names: Vec<_> = DEVICES.iter().map(|kind| kind.name).collect();
    let error = read_error(error);
    Failure::Failed(format!(
        "`{name}` is no built-in device ({}), and as a file {error}",
        names.join(", ")
    ))
}

/// What the operating system says of a file, in the middle of a sentence.
pub(crate) fn read_error(error: &std::io::Error) -> String {
    match error.kind() {
        std::io::ErrorKind::NotFound => "it does not exist".into(),
        std::io::ErrorKind::PermissionDenied => "it may not be read".into(),
        std::io::ErrorKind::IsADirectory => "it is a folder".into(),
        _ => format!("it cannot be read: {error}"),
    }
}

/// The built-in devices, for the end of `--help`.
pub(crate) fn device_list() -> String {
    let mut list = String::from("Built-in devices:\n");
    for kind in DEVICES {
        list.push_str(&format!("  {:<8} {}\n", kind.name, kind.title));
    }
    list.push_str("\nExit codes: 0 all is well, 1 something failed, 2 wrong usage\n");
    list
}
