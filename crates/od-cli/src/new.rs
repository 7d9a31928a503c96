//! `odkit new`: a crate or a firmware for the device of an EDS file, which builds, runs and passes
//! its tests.

mod device;
mod firmware;
mod folder;
mod memory;
mod name;
mod origin;
mod plain;
mod repair;
mod template;

use std::path::{Path, PathBuf};

use od_eds::{Finding, Parsed};

use crate::failure::Failure;
use crate::source::Source;
use crate::{output, report};
use device::DeviceFile;
use origin::Origin;

/// Make a device from an EDS file: a crate for the host, or a firmware with its simulation
///
/// Errors in the file are fixed in the copy; each change is listed. The new folder contains the
/// sources of odkit, so it builds without anything else.
#[derive(clap::Args)]
pub(crate) struct Args {
    /// EDS or DCF file, or a built-in device to start from
    #[arg(value_name = "FILE|DEVICE")]
    file: String,
    /// Name of the crate: letters, digits, `-` and `_` [default: the name of the file]
    #[arg(long)]
    name: Option<String>,
    /// Folder to create [default: the name of the crate]
    #[arg(long, value_name = "FOLDER")]
    path: Option<PathBuf>,
    /// Make a workspace with firmware for this board, its simulation and tests
    #[arg(long, value_name = "BOARD")]
    firmware: Option<firmware::Board>,
    /// Depend on the published crates, instead of copies in the folder `vendor`
    #[arg(long, conflicts_with = "odkit")]
    registry: bool,
    /// Depend on a checkout of odkit, instead of copies in the folder `vendor`
    #[arg(long, value_name = "FOLDER")]
    odkit: Option<PathBuf>,
    /// Accept that the crate lacks objects of the file
    #[arg(long)]
    lossy: bool,
    /// Make nothing if the copy of the file still has errors that you have to decide about
    #[arg(long)]
    strict: bool,
}

pub(crate) fn run(args: &Args) -> Result<(), Failure> {
    let name = match &args.name {
        Some(name) => name::check(name).map(|()| name.clone()),
        None => name::of(&args.file),
    };
    let name = name.map_err(Failure::Usage)?;
    let folder = args.path.clone().unwrap_or_else(|| PathBuf::from(&name));
    folder::check(&folder)?;
    let origin = Origin::new(args.registry, args.odkit.as_deref(), &folder)?;
    let (device, removed) = device(&args.file)?;
    if removed > 0 && !args.lossy {
        for note in &device.notes {
            output::note!("note: {note}");
        }
        let count = report::plural(removed, "object");
        return Err(Failure::Failed(format!(
            "the crate would lack {count} of {}; correct them, or add `--lossy` to accept that",
            args.file
        )));
    }
    if args.strict && !device.left.is_empty() {
        for left in &device.left {
            output::note!("note: {left}");
        }
        let count = report::plural(device.left.len(), "error");
        return Err(Failure::Failed(format!(
            "the copy of {} would still have {count}; correct the file, or leave out `--strict`",
            args.file
        )));
    }
    let files = match args.firmware {
        Some(board) => firmware::files(&name, &device, &origin, board).map_err(Failure::Failed)?,
        None => plain::files(&name, &device, &origin),
    };
    folder::write(&folder, &files)?;
    for note in &device.notes {
        output::note!("note: {note}");
    }
    for left in &device.left {
        output::note!("still wrong: {left}");
    }
    let folder = folder.display();
    let next = match args.firmware {
        Some(board) => board.next(),
        None => "cargo run     # opens an slcan port; `cargo run -- --help` lists the other links",
    };
    output::print(&format!(
        "{folder}: {} of {}\n\n  cd {folder}\n  cargo test    # runs its script and checks its types\n  \
         {next}",
        report::plural(device.description.objects.len(), "object"),
        args.file
    ))
}

/// The file unchanged if it has no errors, otherwise a fixed copy and the number of objects that it
/// lacks.
fn device(name: &str) -> Result<(DeviceFile, usize), Failure> {
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
    let is_sound = !findings.iter().any(Finding::is_unsound);
    // Only the user knows which of the two versions is right.
    let marks: Vec<Finding> = findings
        .iter()
        .filter(|one| one.code() == "E0118")
        .cloned()
        .collect();
    if !marks.is_empty() {
        let (names, colours) = (report::names(&description, &marks), output::error_colours());
        output::note_text(&source.render(&marks, &names, colours));
        let text = format!(
            "{} has marks of a merge conflict; resolve the conflict",
            source.path
        );
        return Err(Failure::Failed(text));
    }
    if !is_sound {
        notes = repair::fix(&mut description).map_err(|left| {
            let text = od_eds::canonical(&description);
            let (names, colours) = (report::names(&description, &left), output::error_colours());
            output::note_coloured(&report::render(&source.path, &text, &left, &names, colours));
            Failure::Failed(format!(
                "{} has errors that odkit cannot fix; correct them (`odkit check` shows all findings)",
                source.path
            ))
        })?;
    }
    // The macro reads one EDS or DCF, so anything else is written as one.
    let bytes = if is_sound && source.is_plain() {
        source.document().bytes().to_vec()
    } else {
        od_eds::canonical(&description).into_bytes()
    };
    let left = od_eds::load(od_eds::decode(&bytes).as_ref()).findings;
    let left = left.iter().filter(|finding| finding.is_error());
    let left = left.map(repair::left).collect();
    let device = DeviceFile {
        ending,
        bytes,
        description,
        notes: notes.all,
        left,
    };
    Ok((device, notes.removed.len()))
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    /// Files of the corpus that a board has no room for: 127 configurations of 1 KiB that a master keeps.
    const TOO_LARGE: [&str; 1] = ["master-302.eds"];

    /// Each file of the corpus fits each board, with its saved values beside the program, or is refused with numbers.
    #[test]
    fn every_file_fits_every_board_or_is_refused() {
        let corpus = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/corpus");
        let files = fs::read_dir(corpus)
            .expect("the corpus")
            .map(|file| file.expect("a file").path());
        let mut count = 0;
        for path in files {
            let name = path
                .file_name()
                .unwrap_or_default()
                .to_string_lossy()
                .into_owned();
            let Ok((device, _)) = device(&path.display().to_string()) else {
                panic!("{name} makes no device");
            };
            let refused = firmware::check(&device);
            assert_eq!(
                !refused.is_empty(),
                TOO_LARGE.contains(&&*name),
                "{name}: {refused:?}"
            );
            for why in refused {
                let numbers = why
                    .split(|c: char| !c.is_ascii_digit())
                    .filter(|number| number.len() > 3)
                    .count();
                assert!(numbers >= 2 && why.contains("RAM"), "{name}: {why}");
            }
            count += 1;
        }
        assert!(count > 90, "{count}");
    }
}
