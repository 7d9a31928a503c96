//! `odkit new`: a crate for the device of an EDS file, which builds, runs and passes its tests.

mod files;
mod repair;

use std::fs;
use std::path::{Path, PathBuf};

use od_eds::{Finding, Parsed};

use crate::failure::Failure;
use crate::source::Source;
use crate::{output, report};
use files::DeviceFile;

/// Make a crate from an EDS file: device, program, script, tests
///
/// Errors in the file are fixed in the crate's copy; each change is listed.
#[derive(clap::Args)]
pub(crate) struct Args {
    /// EDS or DCF file, or a built-in device to start from
    #[arg(value_name = "FILE|DEVICE")]
    file: String,
    /// Name of the crate: letters, digits, `-` and `_`
    #[arg(long)]
    name: String,
    /// Folder to create [default: the name of the crate]
    #[arg(long, value_name = "FOLDER")]
    path: Option<PathBuf>,
    /// Checkout of odkit to depend on, instead of the published crates
    #[arg(long, value_name = "FOLDER")]
    odkit: Option<PathBuf>,
    /// Accept that the crate lacks objects of the file
    #[arg(long)]
    lossy: bool,
}

pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    files::check_name(&args.name).map_err(Failure::Usage)?;
    let folder = args
        .path
        .clone()
        .unwrap_or_else(|| PathBuf::from(&args.name));
    if fs::read_dir(&folder).is_ok_and(|mut entries| entries.next().is_some()) {
        return Err(Failure::Failed(format!(
            "{} exists and is not empty; choose another `--name` or `--path`",
            folder.display()
        )));
    }
    let (
        device,
        repair::Notes {
            all: notes,
            removed,
        },
    ) = device(&args.file)?;
    if !removed.is_empty() && !args.lossy {
        for note in &notes {
            output::note!("note: {note}");
        }
        let count = report::plural(removed.len(), "object");
        return Err(Failure::Failed(format!(
            "the crate would lack {count} of {}; correct them, or add `--lossy` to accept that",
            args.file
        )));
    }
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
        "{folder}: {} of {}\n\n  cd {folder}\n  cargo test    # runs its script and checks its types\n  \
         cargo run     # opens an slcan port; `cargo run -- --help` lists the other links",
        report::plural(device.description.objects.len(), "object"),
        args.file
    ))
}

/// The file unchanged if it has no errors; else a fixed copy, and a list of the changes.
fn device(name: &str) -> Result<(DeviceFile, repair::Notes), Failure> {
    let source = Source::find(name)?;
    let Parsed {
        mut description,
        findings,
    } = source.load()?;
    let path = Path::new(&source.path);
    let is_dcf = path
        .extension()
        .is_some_and(|ending| ending.eq_ignore_ascii_case("dcf"));
    let ending = if is_dcf { "dcf" } else { "eds" };
    let mut notes = repair::Notes::default();
    let is_sound = !findings.iter().any(Finding::is_error);
    if !is_sound {
        notes = repair::fix(&mut description).map_err(|left| {
            let text = od_eds::canonical(&description);
            let colours = output::error_colours();
            output::note_text(&report::render(&source.path, &text, &left, colours));
            Failure::Failed(format!(
                "{} has errors that odkit cannot fix; correct them (`odkit check` shows all findings)",
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

/// The checkout in which this program was built, if it still exists.
fn checkout() -> Option<PathBuf> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent()?;
    let exists = root.join("od-model/Cargo.toml").is_file() && root.join("xtask").is_dir();
    exists.then(|| root.to_path_buf())
}
