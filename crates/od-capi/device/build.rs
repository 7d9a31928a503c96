//! The EDS file becomes a module for the compiler and a header for C.

use std::fs;
use std::path::{Path, PathBuf};

use od_eds::Description;
use od_eds::convert::c_header;

/// The file if `ODKIT_EDS` names none.
const EXAMPLE: &str = "../../../firmware/eds/ds301.eds";

fn main() -> Result<(), Box<dyn std::error::Error>> {
    println!("cargo::rerun-if-env-changed=ODKIT_EDS");
    println!("cargo::rerun-if-env-changed=ODKIT_WITHOUT");
    let files = std::env::var("ODKIT_EDS").unwrap_or_else(|_| String::from(EXAMPLE));
    // An overlay may follow the file, as everywhere.
    let mut paths = if Path::new(&files).is_file() {
        vec![find(&files)]
    } else {
        files.split('+').map(find).collect()
    };
    for path in &paths {
        println!("cargo::rerun-if-changed={}", path.display());
    }
    let mut texts = paths.iter().map(|path| match fs::read(path) {
        Ok(bytes) => Ok(od_eds::decode(&bytes).into_owned()),
        Err(error) => Err(format!("ODKIT_EDS: {}: {error}", path.display())),
    });
    let base = texts.next().unwrap_or_else(|| Ok(String::new()))?;
    // The macro says what is wrong with either.
    let text = match texts.next().transpose()? {
        Some(overlay) => od_eds::overlay(&base, &overlay).map_or(base, |made| made.text),
        None => base,
    };
    paths.truncate(2);
    let description = od_eds::parse(&text).description;

    let out = PathBuf::from(std::env::var("OUT_DIR")?);
    fs::write(out.join("device.rs"), module(&paths, &description))?;
    // OUT_DIR is target/…/release/build/odkit-node-…/out.
    let beside = out
        .ancestors()
        .nth(3)
        .ok_or("OUT_DIR has no folder above")?;
    let objects = c_header::addresses(&description, "OD", &files);
    fs::write(beside.join("odkit_objects.h"), objects)?;
    println!("cargo::rerun-if-changed=../include/odkit.h");
    fs::copy("../include/odkit.h", beside.join("odkit.h"))?;
    Ok(())
}

/// A relative path begins where cargo was called, or here.
fn find(name: &str) -> PathBuf {
    let called = std::env::var_os("PWD").map(|folder| Path::new(&folder).join(name));
    let path = called.filter(|path| path.is_file());
    let path = path.unwrap_or_else(|| PathBuf::from(name));
    std::path::absolute(&path).unwrap_or(path)
}

/// The call of `object_dictionary!`, and the profile: CiA 301 to the letter, with LSS if the file
/// says so.
fn module(paths: &[PathBuf], description: &Description) -> String {
    let mut without = std::env::var("ODKIT_WITHOUT").unwrap_or_default();
    let lss = match description.lss_bit_rates() {
        Some(rates) => {
            let rates: Vec<String> = (0u8..)
                .zip(rates)
                .map(|(index, on)| on.then_some(index))
                .map(|rate| format!("{rate:?}"))
                .collect();
            let rates = rates.join(", ");
            format!(
                "Some(::odkit::LssProfile {{ bit_rates: [{rates}], ..::odkit::LssProfile::CIA305 }})"
            )
        }
        None => {
            let separator = if without.trim().is_empty() { "" } else { ", " };
            if !without.split(',').any(|service| service.trim() == "lss") {
                without = format!("lss{separator}{without}");
            }
            String::from("None")
        }
    };
    let without = match without.trim() {
        "" => String::new(),
        list => format!("without {list};"),
    };
    let files: Vec<String> = paths.iter().map(|path| format!("{path:?}")).collect();
    let files = files.join(" + ");
    format!(
        "static PROFILE: ::odkit::Profile =
    ::odkit::Profile {{ lss: {lss}, ..::odkit::Profile::CIA301 }};
::odkit::object_dictionary! {{ mod device {{ eds = {files}; behaves = PROFILE; {without} }} }}
"
    )
}
