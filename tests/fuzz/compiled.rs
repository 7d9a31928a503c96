//! Made devices through the macro: a crate of them is compiled, and each compiled dictionary has
//! to be the one that the reader makes of the same EDS at run time.
//!
//! A compiler takes seconds where a target takes microseconds, so this is not one: it runs with
//! `--long`, or by its name.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Instant;

use od_fuzz::choices::Choices;
use od_fuzz::files::repository;
use od_fuzz::found;
use od_fuzz::generate::Device;
use od_fuzz::plan::Plan;
use od_fuzz::random::Random;

/// Its name in commands, and the folder of its findings.
pub(crate) const NAME: &str = "compiled";

/// Devices of one crate.
const BATCH: u64 = 100;

const MAIN: &str = r#"
macro_rules! all {
    ($($name:ident: $path:literal,)*) => {
        $(odkit::object_dictionary! { mod $name { eds = $path; } })*
        fn main() {
            $(equal($path, $name::DICTIONARY, include_bytes!($path));)*
            println!("equal");
        }
    };
}

fn equal(path: &str, compiled: od_model::Dictionary<'_>, file: &[u8]) {
    let parsed = od_eds::parse(&od_eds::decode(file));
    let tables = od_eds::Tables::new(&parsed.description);
    assert!(compiled == tables.dictionary(), "{path} differs: {compiled:?}");
    assert_eq!(compiled.store_len(), tables.dictionary().store_len(), "{path}");
}

"#;

/// Compiles batches until the time of the plan is over.
///
/// # Errors
/// The output of the compiler or of the comparison, and the file that has the EDS now.
pub(crate) fn run(plan: &Plan) -> Result<u64, String> {
    let start = Instant::now();
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(NAME);
    let known = found::load(&plan.found, NAME);
    let known = known
        .iter()
        .map(|text| String::from_utf8_lossy(text).into_owned());
    let new = (plan.seed.first..).map(|number| {
        let mut random = Random::of(plan.seed.number, number);
        let bytes: Vec<u8> = (0..random.size(10)).map(|_| random.next() as u8).collect();
        Device::of(&mut Choices(&bytes)).text
    });
    let (mut devices, mut count) = (known.chain(new), 0);
    while count == 0 || start.elapsed() < plan.time {
        let batch: Vec<String> = devices.by_ref().take(BATCH as usize).collect();
        if let Err(output) = compile(&folder, &batch) {
            return Err(blamed(plan, &batch, &output));
        }
        count += BATCH;
    }
    Ok(count)
}

/// Builds and runs a crate with these files.
fn compile(folder: &Path, batch: &[String]) -> Result<(), String> {
    let told = |path: &Path, error| format!("{}: {error}", path.display());
    let write = |name: &str, text: &str| {
        let path = folder.join(name);
        let parent = path.parent().unwrap_or(folder);
        fs::create_dir_all(parent).map_err(|error| told(parent, error))?;
        fs::write(&path, text).map_err(|error| told(&path, error))
    };
    let mut main = format!("{MAIN}all! {{\n");
    for (number, text) in batch.iter().enumerate() {
        write(&format!("eds/{number}.eds"), text)?;
        main += &format!("    m{number}: \"../eds/{number}.eds\",\n");
    }
    write("src/main.rs", &(main + "}\n"))?;
    let room = |name: &str| repository(name).canonicalize().unwrap_or_default();
    let rooms: [PathBuf; 3] = ["odkit", "od-eds", "od-model"].map(room);
    let [odkit, eds, model] = &rooms;
    let manifest = format!(
        "[package]\nname = \"compiled\"\nedition = \"2024\"\n[workspace]\n[dependencies]\n\
         odkit = {{ path = {odkit:?} }}\nod-eds = {{ path = {eds:?} }}\n\
         od-model = {{ path = {model:?} }}\n"
    );
    write("Cargo.toml", &manifest)?;
    let lock = fs::read_to_string(repository("Cargo.lock")).unwrap_or_default();
    write("Cargo.lock", &lock)?;
    let cargo = std::env::var_os("CARGO").unwrap_or("cargo".into());
    let output = Command::new(cargo)
        .args(["run", "--quiet", "--offline"])
        .current_dir(folder)
        .env("CARGO_TARGET_DIR", folder.join("target"))
        .output()
        .map_err(|error| format!("cargo does not run: {error}"))?;
    if output.stdout == b"equal\n" {
        Ok(())
    } else {
        Err(String::from_utf8_lossy(&output.stderr).into_owned())
    }
}

/// Keeps the first file that the output names.
fn blamed(plan: &Plan, batch: &[String], output: &str) -> String {
    let shown: Vec<&str> = output.lines().take(30).collect();
    let is_named = |number: &usize| output.contains(&format!("/{number}.eds"));
    let kept = match (0..batch.len()).find(is_named) {
        Some(number) => found::keep(&plan.found, NAME, batch[number].as_bytes())
            .map_or_else(|error| error.to_string(), |path| path.display().to_string()),
        None => "no file is named".to_string(),
    };
    format!("{}\n  kept, commit it: {kept}", shown.join("\n  "))
}
