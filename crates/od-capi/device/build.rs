//! Makes modules for the compiler and a header for C from the EDS files.

use std::fs;
use std::path::{Path, PathBuf};

use od_eds::Description;
use od_eds::convert::c_header;

/// The file if `ODKIT_EDS` names none.
const EXAMPLE: &str = "../../../firmware/eds/ds301.eds";

type Result<T> = std::result::Result<T, Box<dyn std::error::Error>>;

/// A node of the library.
struct Node {
    /// `None` if the library has one node, and `ODKIT_EDS` gives it no name.
    name: Option<String>,
    /// An EDS, and an overlay that may follow it.
    paths: Vec<PathBuf>,
    /// The files as `ODKIT_EDS` has them.
    files: String,
}

fn main() {
    // Cargo shows this line, and not all that the program printed.
    if let Err(error) = run() {
        println!("cargo::error={error}");
    }
}

fn run() -> Result<()> {
    println!("cargo::rerun-if-env-changed=ODKIT_EDS");
    println!("cargo::rerun-if-env-changed=ODKIT_WITHOUT");
    let nodes = nodes(&std::env::var("ODKIT_EDS").unwrap_or_else(|_| String::from(EXAMPLE)))?;
    // Nodes with the same files are the same device.
    let mut devices: Vec<&[PathBuf]> = Vec::new();
    let (mut modules, mut exports) = (String::new(), String::new());
    let (mut handles, mut objects) = (String::new(), String::new());
    for (handle, node) in nodes.iter().enumerate() {
        let description = description(&node.paths)?;
        let device = devices.iter().position(|paths| *paths == node.paths);
        let device = device.unwrap_or_else(|| {
            modules += &module(devices.len(), &node.paths, &description);
            devices.push(&node.paths);
            devices.len() - 1
        });
        let name = node.name.as_deref().unwrap_or("NODE");
        exports += &format!("{handle} = ODKIT_{name}: device_{device}, ");
        handles += &format!(
            "#define ODKIT_{name} {handle}u /* {} */\n",
            comment(&node.files)
        );
        let prefix = match &node.name {
            Some(name) => format!("OD_{name}"),
            None => String::from("OD"),
        };
        objects += &c_header::addresses(&description, &prefix, &node.files);
    }
    let out = PathBuf::from(std::env::var("OUT_DIR")?);
    fs::write(
        out.join("device.rs"),
        format!("{modules}od_capi::export! {{ {exports} }}\n"),
    )?;
    // OUT_DIR is target/…/release/build/odkit-node-…/out.
    let beside = out
        .ancestors()
        .nth(3)
        .ok_or("OUT_DIR has no folder above")?;
    fs::write(
        beside.join("odkit_objects.h"),
        format!(
            "/* Handles of the nodes. */\n#ifndef ODKIT_NODES_H\n#define ODKIT_NODES_H\n\n{handles}\n\
             #endif /* ODKIT_NODES_H */\n\n{objects}"
        ),
    )?;
    println!("cargo::rerun-if-changed=../include/odkit.h");
    fs::copy("../include/odkit.h", beside.join("odkit.h"))?;
    Ok(())
}

/// Reads `FILE`, `FILE+OVERLAY`, or a list `NAME=FILE,NAME=FILE+OVERLAY`.
fn nodes(list: &str) -> Result<Vec<Node>> {
    let node = |name, files: &str| {
        // A file name may contain this character.
        let paths = if find(files).is_file() {
            vec![find(files)]
        } else {
            files.split('+').map(find).collect()
        };
        for path in &paths {
            println!("cargo::rerun-if-changed={}", path.display());
        }
        Node {
            name,
            paths,
            files: files.to_owned(),
        }
    };
    if find(list).is_file() || !list.contains(['=', ',']) {
        return Ok(vec![node(None, list)]);
    }
    let mut nodes: Vec<Node> = Vec::new();
    for part in list.split(',') {
        let (name, files) = part.split_once('=').ok_or_else(|| {
            format!("ODKIT_EDS: `{part}` has no name; write `left=axis.eds,right=axis.eds`")
        })?;
        let name = name.trim().to_ascii_uppercase();
        let is_word = |c: char| c.is_ascii_alphanumeric() || c == '_';
        if name.is_empty() || !name.chars().all(is_word) {
            return Err(format!(
                "ODKIT_EDS: `{name}` is not a name of a node; use letters, digits and `_`"
            )
            .into());
        }
        if nodes.iter().any(|node| node.name.as_ref() == Some(&name)) {
            return Err(format!("ODKIT_EDS: two nodes have the name `{name}`").into());
        }
        nodes.push(node(Some(name), files.trim()));
    }
    Ok(nodes)
}

/// A relative path starts at the folder in which cargo was called, or here.
fn find(name: &str) -> PathBuf {
    let called = std::env::var_os("PWD").map(|folder| Path::new(&folder).join(name));
    let path = called.filter(|path| path.is_file());
    let path = path.unwrap_or_else(|| PathBuf::from(name));
    std::path::absolute(&path).unwrap_or(path)
}

/// The description of an EDS with its overlay. The macro reports errors in both.
fn description(paths: &[PathBuf]) -> Result<Description> {
    let mut texts = paths.iter().map(|path| match fs::read(path) {
        Ok(bytes) => Ok(od_eds::decode(&bytes).into_owned()),
        Err(error) => Err(format!("ODKIT_EDS: {}: {error}", path.display())),
    });
    let base = texts.next().unwrap_or_else(|| Ok(String::new()))?;
    let text = match texts.next().transpose()? {
        Some(overlay) => od_eds::overlay(&base, &overlay).map_or(base, |made| made.text),
        None => base,
    };
    Ok(od_eds::parse(&text).description)
}

/// The call of `object_dictionary!`, and the profile: CiA 301 without deviations, with LSS if the
/// file supports it.
fn module(number: usize, paths: &[PathBuf], description: &Description) -> String {
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
    let files = paths.iter().take(2).map(|path| format!("{path:?}"));
    let files: Vec<String> = files.collect();
    let files = files.join(" + ");
    format!(
        "static PROFILE_{number}: ::odkit::Profile =
    ::odkit::Profile {{ lss: {lss}, ..::odkit::Profile::CIA301 }};
::odkit::object_dictionary! {{ mod device_{number} {{ eds = {files}; behaves = PROFILE_{number}; {without} }} }}
"
    )
}

/// Text for a comment of C.
fn comment(text: &str) -> String {
    let text: String = text.chars().filter(|c| !c.is_control()).collect();
    text.replace("*/", "* /").replace("/*", "/ *")
}
