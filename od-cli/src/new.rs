//! `odkit new`: a crate with a device of an EDS file, that builds, runs and is tested at once.

mod files;
mod mend;

use std::fs;
use std::path::{Path, PathBuf};

use od_eds::{Finding, Parsed};

use crate::failure::Failure;
use crate::source::Source;
use crate::{output, report};
use files::DeviceFile;

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
    for (path, content) in project.files() {
        let path = folder.join(path);
        if let Some(folder) = path.parent() {
            // What is wrong with the folder, writing the file says.
            let _ = fs::create_dir_all(folder);
        }
        output::write(&path, &content)?;
    }
    for note in &notes {
        output::note!("note: {note}");
    }
    let folder = folder.display();
    output::print(&format!(
        "{folder}: {} objects of {}\n\n  cd {folder}\n  cargo test    # its script and its types\n  \
         cargo run     # on slcan; `cargo run -- --help` has the other links",
        device.description.objects.len(),
        args.file
    ))
}

/// The file as it is, if it is sound; else what could be mended of it, and how.
fn device(name: &str) -> Result<(DeviceFile, mend::Notes), Failure> {
    let source = Source::find(name)?;
    let Parsed {
        mut description,
        diagnostics,
    } = source.load()?;
    let path = Path::new(&source.path);
    let is_dcf = path
        .extension()
        .is_some_and(|ending| ending.eq_ignore_ascii_case("dcf"));
    let ending = if is_dcf { "dcf" } else { "eds" };
    let mut notes = mend::Notes::new();
    let is_sound = !diagnostics.iter().any(Finding::is_error);
    if !is_sound {
        notes = mend::mend(&mut description).map_err(|left| {
            let text = od_eds::canonical(&description);
            let colours = output::error_colours();
            output::note_text(&report::render(&source.path, &text, &left, colours));
            Failure::Failed(format!(
                "{} cannot be made sound by itself; mend it (`odkit check` shows everything)",
                source.path
            ))
        })?;
    }
    // The macro reads one EDS or DCF. Anything else is written as one.
    let bytes = match is_sound && source.is_plain() {
        true => source.document().bytes().to_vec(),
        false => od_eds::canonical(&description).into_bytes(),
    };
    let device = DeviceFile {
        ending,
        bytes,
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
