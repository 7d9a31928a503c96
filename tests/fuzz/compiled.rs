//! Made devices through the macro: a crate of them is compiled, and each compiled dictionary must
//! equal the one that is loaded from the same EDS at run time.
//!
//! A compiler takes seconds where a target takes microseconds, so this is not one of them:
//! `cargo test -p od-tests --test compiled`, and `cargo xtask test --long`.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Instant;

use od_fuzz::choices::Choices;
use od_fuzz::files::{self, repository};
use od_fuzz::generate::Device;
use od_fuzz::harness;
use od_fuzz::random::Random;

/// The folder of its findings.
const NAME: &str = "compiled";

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

#[test]
fn a_compiled_dictionary_is_that_of_the_reader() {
    let (start, seed) = (Instant::now(), harness::seed());
    println!("ODKIT_FUZZ_SEED={seed} makes the same devices");
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(NAME);
    let known = files::inputs("found", NAME).into_iter();
    let known = known.map(|text| String::from_utf8_lossy(&text).into_owned());
    let new = (0..).map(|number| {
        let mut random = Random::of(seed, number);
        let bytes: Vec<u8> = (0..random.size(10)).map(|_| random.next() as u8).collect();
        Device::of(&mut Choices(&bytes)).text
    });
    let mut devices = known.chain(new);
    loop {
        let batch: Vec<String> = devices.by_ref().take(BATCH as usize).collect();
        if let Err(output) = compile(&folder, &batch) {
            panic!("{}", blamed(&batch, &output));
        }
        if start.elapsed() >= harness::time() {
            return;
        }
    }
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
    let rooms: [PathBuf; 3] = ["crates/odkit", "crates/od-eds", "od-model"].map(room);
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
fn blamed(batch: &[String], output: &str) -> String {
    let shown: Vec<&str> = output.lines().take(30).collect();
    let is_named = |number: &usize| output.contains(&format!("/{number}.eds"));
    let kept = match (0..batch.len()).find(is_named) {
        Some(number) => {
            files::keep(NAME, batch[number].as_bytes()).unwrap_or_else(|error| error.to_string())
        }
        None => "no file is named".to_string(),
    };
    format!("{}\n  kept, commit it: {kept}", shown.join("\n  "))
}
