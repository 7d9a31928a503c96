//! `odkit new`: a crate with a device of an EDS file, that builds, runs and is tested at once.

mod files;
mod mend;

use std::fs;
use std::path::{Path, PathBuf};

use od_eds::{Description, Finding};

use crate::output::{self, Output};
use crate::source::Source;
use crate::{Failure, report};

/// Make a crate of an EDS file: device, program, script, tests
///
/// What a device cannot be built of is mended in the copy of the file, and told.
#[derive(clap::Args)]
pub(crate) struct Args {
    /// EDS or DCF file, or a built-in device to start from
    #[arg(value_name = "FILE|DEVICE")]
    file: String,
    /// Name of the crate: letters, digits, `-` and `_`
    #[arg(long)]
    name: String,
    /// Folder to make [default: the name]
    #[arg(long, value_name = "FOLDER")]
    path: Option<PathBuf>,
    /// Checkout of odkit to depend on, instead of the published crates
    #[arg(long, value_name = "FOLDER")]
    odkit: Option<PathBuf>,
}

pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    files::check_name(&args.name).map_err(Failure::Usage)?;
    let folder = args
        .path
        .clone()
        .unwrap_or_else(|| PathBuf::from(&args.name));
    if fs::read_dir(&folder).is_ok_and(|mut entries| entries.next().is_some()) {
        return Err(Failure::Failed(format!(
            "{} is there already, and not empty; take another --name or --path",
            folder.display()
        )));
    }
    let (device, notes) = device(&args.file)?;
    let project = files::Project {
        name: &args.name,
        device: &device,
        notes: &notes,
        odkit: args.odkit.clone().or_else(checkout),
    };
    let mut output = Output::new();
    for (path, content) in project.files() {
        let path = folder.join(path);
        let made = path.parent().map_or(Ok(()), fs::create_dir_all);
        made.and_then(|()| fs::write(&path, content))
            .map_err(|error| {
                Failure::Failed(format!("{} cannot be written: {error}", path.display()))
            })?;
    }
    for note in &notes {
        output::note!("note: {note}");
    }
    let folder = folder.display();
    output.line(&format!(
        "{folder}: {} objects of {}\n\n  cd {folder}\n  cargo test    # its script and its types\n  \
         cargo run     # on slcan; `cargo run -- --help` has the other links",
        device.description.objects.len(),
        args.file
    ))?;
    output.flush().map(|_| ())
}

/// What the crate is made of.
struct DeviceFile {
    /// `eds` or `dcf`.
    ending: &'static str,
    /// The file that goes into the crate.
    bytes: Vec<u8>,
    description: Description,
}

/// The file as it is, if it is sound; else what could be mended of it, and how.
fn device(name: &str) -> Result<(DeviceFile, mend::Notes), Failure> {
    let (path, text, bytes) = match Source::find(name)? {
        Source::BuiltIn(kind) => {
            let text = od_devices::text::eds(kind);
            let bytes = text.clone().into_bytes();
            (name.to_owned(), text, Some(bytes))
        }
        // The macro reads one EDS or DCF. Anything else is written as one.
        Source::File(file) if !file.is_plain() => (file.path, file.text, None),
        Source::File(file) => {
            let bytes = fs::read(&file.path).map_err(|error| {
                Failure::Failed(format!("{} cannot be read: {error}", file.path))
            })?;
            (file.path, file.text, Some(bytes))
        }
    };
    let loaded = od_eds::load(&text);
    let mut description = loaded.description;
    if description.objects.is_empty() {
        return Err(Failure::Failed(format!(
            "{path} describes no object; is it an EDS, DCF or XDD file?"
        )));
    }
    let is_dcf = Path::new(&path)
        .extension()
        .is_some_and(|ending| ending.eq_ignore_ascii_case("dcf"));
    let ending = if is_dcf { "dcf" } else { "eds" };
    if !loaded.diagnostics.iter().any(Finding::is_error) {
        let device = DeviceFile {
            ending,
            bytes: bytes.unwrap_or_else(|| od_eds::canonical(&description).into_bytes()),
            description,
        };
        return Ok((device, Vec::new()));
    }
    let notes = mend::mend(&mut description).map_err(|left| {
        let text = od_eds::canonical(&description);
        output::note_text(&report::render(
            &path,
            &text,
            &left,
            output::error_colours(),
        ));
        Failure::Failed(format!(
            "{path} cannot be made sound by itself; mend it (`odkit check` shows everything)"
        ))
    })?;
    let device = DeviceFile {
        ending,
        bytes: od_eds::canonical(&description).into_bytes(),
        description,
    };
    Ok((device, notes))
}

/// The checkout that this program was built in, if it still stands there.
fn checkout() -> Option<PathBuf> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent()?;
    let stands = root.join("od-model/Cargo.toml").is_file() && root.join("xtask").is_dir();
    stands.then(|| root.to_path_buf())
}
