//! Content of the binary, and changes that cause a new build.

use std::path::Path;
use std::process::Command;

use odkit::object_dictionary;

object_dictionary! {
    pub mod small {
        eds = "../eds/small.eds";
        warnings = off;
    }
}

fn contains(bytes: &[u8], text: &str) -> bool {
    bytes
        .windows(text.len())
        .any(|part| part == text.as_bytes())
}

/// The names are found, so the search works. The text of the file is not in the binary.
#[test]
fn no_text_of_the_file_is_in_the_binary() {
    // Reversed; otherwise the test would find itself.
    let backwards = |text: &str| text.chars().rev().collect::<String>();
    let comment = backwards("YRANIB EHT HCAER TON TSUM TNEMMOC SIHT");
    let key = backwards("sde.llams=emaNeliF");
    let file = std::fs::read("eds/small.eds").unwrap();
    assert!(contains(&file, &comment) && contains(&file, &key));

    let entry = small::DICTIONARY.entry(0x6004, 0).unwrap();
    assert_eq!(small::DICTIONARY.text(entry.name), "Position value");
    let binary = std::fs::read(std::env::current_exe().unwrap()).unwrap();
    assert!(contains(&binary, "Manufacturer device name"));
    assert!(!contains(&binary, &comment));
    assert!(!contains(&binary, &key));
}

/// Builds a crate twice with different defaults in its EDS: the second build contains the new one.
#[test]
fn a_change_of_the_file_rebuilds() {
    let package = Path::new(env!("CARGO_MANIFEST_DIR"));
    let workspace = package.parent().unwrap();
    let scratch = Path::new(env!("CARGO_TARGET_TMPDIR")).join("rebuild");
    // Crates that trybuild has already built are not built again.
    let target = Path::new(env!("CARGO_TARGET_TMPDIR")).join("../tests/trybuild");
    std::fs::create_dir_all(scratch.join("src")).unwrap();
    std::fs::create_dir_all(scratch.join("eds")).unwrap();
    let manifest = format!(
        "[package]\nname = \"rebuild\"\nedition = \"2024\"\n[dependencies]\nodkit = {{ path = {:?} }}\n[workspace]\n",
        workspace.join("crates/odkit")
    );
    std::fs::write(scratch.join("Cargo.toml"), manifest).unwrap();
    std::fs::copy(workspace.join("Cargo.lock"), scratch.join("Cargo.lock")).unwrap();
    std::fs::write(
        scratch.join("src/main.rs"),
        "odkit::object_dictionary! { mod device { eds = \"../eds/device.eds\"; } }
        fn main() { println!(\"{:?}\", device::DICTIONARY.entry(0x2000, 1).map(|e| e.default)); }",
    )
    .unwrap();

    let text = std::fs::read_to_string(package.join("eds/small.eds")).unwrap();
    let run = |text: &str| {
        std::fs::write(scratch.join("eds/device.eds"), text).unwrap();
        let output = Command::new(std::env::var_os("CARGO").unwrap())
            .args(["run", "--quiet", "--offline"])
            .current_dir(&scratch)
            .env("CARGO_TARGET_DIR", &target)
            .output()
            .unwrap();
        let errors = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{errors}");
        String::from_utf8_lossy(&output.stdout).trim().to_string()
    };
    assert_eq!(run(&text), "Some(Unsigned(1))");
    let edited = text.replacen(
        "DefaultValue=1\nLowLimit=0",
        "DefaultValue=42\nLowLimit=0",
        1,
    );
    assert_ne!(edited, text);
    assert_eq!(run(&edited), "Some(Unsigned(42))");
}
