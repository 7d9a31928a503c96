//! Bills of material of the parts, as CycloneDX 1.5: a file for each, from the lock files.
//!
//! `cargo tree` and the lock files say all that is needed; the tools that make such a file write into
//! the folders of the crates, or give it a time and a random number.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use super::binaries::SYSTEMS;
use super::dist::Dist;
use crate::console::ask_in;
use crate::error::{Error, Result};
use crate::files;
use crate::packages::{CLI, PAGE, PYTHON};
use crate::setup::target;

/// A component: what it is fetched as, and what is known of it.
#[derive(Debug, Default, Clone, PartialEq, Eq, PartialOrd, Ord)]
struct Component {
    name: String,
    version: String,
    /// `cargo` or `npm`.
    registry: &'static str,
    licence: String,
    /// SHA-256 of the package, if the lock file has it.
    hash: Option<String>,
}

impl Component {
    /// Its address as a package URL.
    fn purl(&self) -> String {
        let name = self.name.replace('@', "%40");
        format!("pkg:{}/{name}@{}", self.registry, self.version)
    }
}

/// The components of a product, the product first, and who needs whom, by package URL.
#[derive(Debug, Default)]
struct Bill {
    components: Vec<Component>,
    needs: BTreeMap<String, BTreeSet<String>>,
}

pub(super) fn make(dist: &Dist<'_>, folder: &Path) -> Result<()> {
    let systems = SYSTEMS.map(|system| system.triple);
    let lock = files::read(&dist.repo.root.join("Cargo.lock"))?;
    for (file, package, targets) in [
        ("bin", CLI.0, &systems[..]),
        ("python", PYTHON, &["x86_64-unknown-linux-gnu"]),
        ("npm", PAGE.0, &[target::WASM]),
    ] {
        let mut args = vec![
            "tree",
            "--locked",
            "--package",
            package,
            "--edges",
            "normal",
        ];
        args.extend(["--prefix", "depth", "--format", "\t{p}\t{l}"]);
        args.extend(targets.iter().flat_map(|target| ["--target", target]));
        let tree = ask_in(&dist.repo.root, "cargo", &args);
        let silent = || Error::Failed(format!("`cargo tree` did not list {package}"));
        let bill = of_cargo(&tree.ok_or_else(silent)?, &lock);
        files::write(&folder.join(format!("{file}.cdx.json")), &bill.json())?;
    }
    for (file, name, package) in [
        ("site", "odkit-playground-page", "playground/web"),
        ("vscode", "odkit", "editors/vscode"),
    ] {
        let lock = files::read(&dist.repo.root.join(package).join("package-lock.json"))?;
        let bill = of_npm(name, &dist.version, &lock);
        files::write(&folder.join(format!("{file}.cdx.json")), &bill.json())?;
    }
    Ok(())
}

/// The bill of what `cargo tree` prints with the depth of each line.
fn of_cargo(tree: &str, lock: &str) -> Bill {
    let hashes = hashes(lock);
    let (mut bill, mut above): (Bill, Vec<String>) = Default::default();
    for line in tree.lines() {
        let mut fields = line.split('\t');
        let (Some(depth), Some(package), Some(licence)) =
            (fields.next(), fields.next(), fields.next())
        else {
            continue;
        };
        let mut words = package.split(' ');
        let name = String::from(words.next().unwrap_or_default());
        let version = words.next().unwrap_or_default().trim_start_matches('v');
        let hash = hashes
            .get(&(name.as_str(), version))
            .map(|hash| String::from(*hash));
        let component = Component {
            name,
            version: String::from(version),
            registry: "cargo",
            // An old way to write it; `(*)` marks what was listed before.
            licence: licence.trim_end_matches(" (*)").replace('/', " OR "),
            hash,
        };
        let purl = component.purl();
        above.truncate(depth.parse().unwrap_or(0));
        if let Some(user) = above.last() {
            bill.needs
                .entry(user.clone())
                .or_default()
                .insert(purl.clone());
        }
        above.push(purl);
        if !bill.components.contains(&component) {
            bill.components.push(component);
        }
    }
    bill
}

/// The checksums in a Cargo.lock, by name and version.
fn hashes(lock: &str) -> BTreeMap<(&str, &str), &str> {
    let mut found = BTreeMap::new();
    for package in lock.split("[[package]]") {
        let field = |key: &str| {
            let line = package.lines().find_map(|line| line.strip_prefix(key));
            line.map(|value| value.trim_matches([' ', '=', '"']))
        };
        if let (Some(name), Some(version), Some(hash)) =
            (field("name"), field("version"), field("checksum"))
        {
            found.insert((name, version), hash);
        }
    }
    found
}

/// The bill of a package-lock.json, as npm lays it out: what is for developers alone is no part of it.
fn of_npm(name: &str, version: &str, lock: &str) -> Bill {
    let product = Component {
        name: String::from(name),
        version: String::from(version),
        registry: "npm",
        ..Component::default()
    };
    let mut bill = Bill::default();
    let root = product.purl();
    bill.components.push(product);
    let (_, packages) = lock.split_once("\"node_modules/").unwrap_or_default();
    for package in packages.split("\n    \"node_modules/") {
        let (path, fields) = package.split_once("\": {\n").unwrap_or_default();
        let field = |key: &str| {
            let mark = format!("      \"{key}\": ");
            let line = fields.lines().find_map(|line| line.strip_prefix(&mark))?;
            Some(line.trim_matches(['"', ',']))
        };
        let is_used = field("dev").is_none() && field("devOptional").is_none();
        if let Some(version) = field("version").filter(|_| is_used) {
            let name = path.rsplit("node_modules/").next().unwrap_or(path);
            let component = Component {
                name: String::from(name),
                version: String::from(version),
                registry: "npm",
                licence: String::from(field("license").unwrap_or_default()),
                hash: None,
            };
            bill.needs
                .entry(root.clone())
                .or_default()
                .insert(component.purl());
            bill.components.push(component);
        }
    }
    bill
}

impl Bill {
    fn json(&self) -> String {
        let component = |one: &Component| {
            let kind = if self.components.first() == Some(one) {
                "application"
            } else {
                "library"
            };
            let purl = text(&one.purl());
            let mut line = format!(
                "{{\"type\": \"{kind}\", \"bom-ref\": {purl}, \"name\": {}, \"version\": {}",
                text(&one.name),
                text(&one.version)
            );
            if let Some(hash) = &one.hash {
                line.push_str(&format!(
                    ", \"hashes\": [{{\"alg\": \"SHA-256\", \"content\": {}}}]",
                    text(hash)
                ));
            }
            if !one.licence.is_empty() {
                line.push_str(&format!(
                    ", \"licenses\": [{{\"expression\": {}}}]",
                    text(&one.licence)
                ));
            }
            line + &format!(", \"purl\": {purl}}}")
        };
        let product = self.components.first().map(component).unwrap_or_default();
        let mut rest: Vec<String> = self.components.iter().skip(1).map(component).collect();
        rest.sort();
        let needs = self.needs.iter().map(|(user, used)| {
            let used: Vec<String> = used.iter().map(|purl| text(purl)).collect();
            format!(
                "{{\"ref\": {}, \"dependsOn\": [{}]}}",
                text(user),
                used.join(", ")
            )
        });
        let needs: Vec<String> = needs.collect();
        format!(
            "{{\n  \"bomFormat\": \"CycloneDX\",\n  \"specVersion\": \"1.5\",\n  \"version\": 1,\n  \
             \"metadata\": {{\"component\": {product}}},\n  \"components\": [\n    {}\n  ],\n  \
             \"dependencies\": [\n    {}\n  ]\n}}\n",
            rest.join(",\n    "),
            needs.join(",\n    ")
        )
    }
}

/// A text in JSON.
fn text(text: &str) -> String {
    let mut out = String::from('"');
    for sign in text.chars() {
        match sign {
            '"' | '\\' => out.extend(['\\', sign]),
            sign if sign.is_control() => {}
            sign => out.push(sign),
        }
    }
    out.push('"');
    out
}

#[cfg(test)]
mod tests {
    use super::{of_cargo, of_npm};

    #[test]
    fn a_tree_of_cargo_becomes_a_bill() {
        let tree = "0\ta v0.1.0 (/x)\tMIT\n1\tb v1.2.3\tMIT/Apache-2.0\n2\tc v3.0.0\tZlib\n1\tc v3.0.0\tZlib (*)\n";
        let lock =
            "[[package]]\nname = \"b\"\nversion = \"1.2.3\"\nsource = \"s\"\nchecksum = \"abc\"\n";
        let json = of_cargo(tree, lock).json();
        let b = "{\"type\": \"library\", \"bom-ref\": \"pkg:cargo/b@1.2.3\", \"name\": \"b\", \"version\": \"1.2.3\", \
                 \"hashes\": [{\"alg\": \"SHA-256\", \"content\": \"abc\"}], \
                 \"licenses\": [{\"expression\": \"MIT OR Apache-2.0\"}], \"purl\": \"pkg:cargo/b@1.2.3\"},\n";
        assert!(json.contains(b), "{json}");
        assert!(json.contains("\"metadata\": {\"component\": {\"type\": \"application\", \"bom-ref\": \"pkg:cargo/a@0.1.0\""));
        assert!(json.contains("{\"ref\": \"pkg:cargo/a@0.1.0\", \"dependsOn\": [\"pkg:cargo/b@1.2.3\", \"pkg:cargo/c@3.0.0\"]}"));
        assert!(
            json.contains(
                "{\"ref\": \"pkg:cargo/b@1.2.3\", \"dependsOn\": [\"pkg:cargo/c@3.0.0\"]}"
            )
        );
        assert_eq!(json.matches("\"name\": \"c\"").count(), 1, "{json}");
        assert!(!json.contains("/x"), "no path of this computer: {json}");
    }

    #[test]
    fn a_lock_of_npm_becomes_a_bill() {
        let lock = "{\n  \"packages\": {\n    \"\": {\n      \"version\": \"9\"\n    },\n    \"node_modules/@a/b\": {\n      \
                    \"version\": \"1.0.0\",\n      \"license\": \"ISC\",\n      \"dependencies\": {\n        \"c\": \"2\"\n      }\n    },\n    \
                    \"node_modules/@a/b/node_modules/c\": {\n      \"version\": \"2.0.0\"\n    },\n    \
                    \"node_modules/d\": {\n      \"version\": \"3.0.0\",\n      \"dev\": true\n    }\n  }\n}\n";
        let json = of_npm("page", "0.1.0", lock).json();
        let needs = "{\"ref\": \"pkg:npm/page@0.1.0\", \"dependsOn\": [\"pkg:npm/%40a/b@1.0.0\", \"pkg:npm/c@2.0.0\"]}";
        assert!(json.contains(needs), "{json}");
        assert!(
            json.contains("\"expression\": \"ISC\"") && !json.contains("3.0.0"),
            "{json}"
        );
    }
}
