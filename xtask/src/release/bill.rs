//! The components of each part: from the lock files, and from lists for components that no package manager knows.

use std::collections::{BTreeMap, BTreeSet};
use std::path::PathBuf;

use data_encoding::{BASE64, HEXLOWER};
use serde_json::Value;

use super::dist::Dist;
use super::systems::{SYSTEMS, WHEELS};
use crate::console::ask_in;
use crate::error::{Error, Result};
use crate::files;
use crate::packages::{CLI, PAGE, PYTHON};
use crate::setup::{mdbook, target};

/// Components that cargo does not know: of the programs and of the site.
const OF_PROGRAMS: &str = "xtask/tools/notices.txt";
const OF_SITE: &str = "docs/site/notices.txt";

/// The place where a component's licence is.
#[derive(Debug, Default, Clone, PartialEq, Eq)]
pub(super) enum Licence {
    /// odkit's own licence, which is beside every part.
    #[default]
    Own,
    /// The licence is in the files of this folder.
    Folder(PathBuf),
    Text(String),
}

/// A component: its package and its known facts.
#[derive(Debug, Default, Clone, PartialEq, Eq)]
pub(super) struct Component {
    pub(super) name: String,
    pub(super) version: String,
    /// `cargo`, `npm` or `generic`.
    pub(super) registry: &'static str,
    /// Licence as an SPDX expression.
    pub(super) expression: String,
    /// The algorithm and the checksum of the package, if the lock file has it.
    pub(super) hash: Option<(&'static str, String)>,
    pub(super) licence: Licence,
}

impl Component {
    /// Package URL.
    pub(super) fn purl(&self) -> String {
        let name = self.name.replace('@', "%40").replace(' ', "%20");
        format!("pkg:{}/{name}@{}", self.registry, self.version)
    }
}

/// The components of a product, the product first, and their dependencies, by package URL.
#[derive(Debug, Default)]
pub(super) struct Bill {
    pub(super) components: Vec<Component>,
    pub(super) needs: BTreeMap<String, BTreeSet<String>>,
}

impl Bill {
    fn new(name: &str, version: &str) -> Bill {
        let product = Component {
            name: String::from(name),
            version: String::from(version),
            registry: "generic",
            expression: String::from("MIT OR Apache-2.0"),
            ..Component::default()
        };
        Bill {
            components: vec![product],
            needs: BTreeMap::new(),
        }
    }

    /// Adds a component that the product needs.
    fn add(&mut self, component: Component) {
        if let Some(product) = self.components.first() {
            let users = self.needs.entry(product.purl()).or_default();
            users.insert(component.purl());
        }
        if !self.components.contains(&component) {
            self.components.push(component);
        }
    }

    /// Adds a product with all that it needs.
    fn join(&mut self, other: Bill) {
        let mut components = other.components.into_iter();
        if let Some(product) = components.next() {
            self.add(product);
        }
        for component in components {
            if !self.components.contains(&component) {
                self.components.push(component);
            }
        }
        for (user, used) in other.needs {
            self.needs.entry(user).or_default().extend(used);
        }
    }
}

/// The parts that contain components of others.
pub(super) const PARTS: [&str; 5] = ["bin", "python", "npm", "site", "vscode"];

/// The components of a part.
pub(super) fn of(dist: &Dist<'_>, part: &str) -> Result<Bill> {
    let root = &dist.repo.root;
    match part {
        "bin" => {
            let mut bill = cargo(dist, CLI.0, &SYSTEMS.map(|system| system.triple))?;
            let listed = of_list(&files::read(&root.join(OF_PROGRAMS))?, "");
            listed.into_iter().for_each(|one| bill.add(one));
            Ok(bill)
        }
        "python" => cargo(dist, PYTHON, &WHEELS.map(|(triple, _)| triple)),
        "npm" => cargo(dist, PAGE.0, &[target::WASM]),
        "site" => {
            let mut bill = Bill::new("odkit-site", &dist.version);
            bill.join(npm(dist, "playground/web")?);
            bill.join(cargo(dist, PAGE.0, &[target::WASM])?);
            let list = files::read(&root.join(OF_SITE))?;
            let listed = of_list(&list, mdbook::VERSION);
            listed.into_iter().for_each(|one| bill.add(one));
            Ok(bill)
        }
        _ => npm(dist, "editors/vscode"),
    }
}

/// The bill of a package of this workspace for these systems, including the standard library.
fn cargo(dist: &Dist<'_>, package: &str, targets: &[&str]) -> Result<Bill> {
    let root = &dist.repo.root;
    let mut tree = vec!["tree", "--locked", "--package", package];
    tree.extend(["--edges", "normal", "--prefix", "depth"]);
    tree.extend(["--format", "\t{p}\t{l}"]);
    tree.extend(targets.iter().flat_map(|target| ["--target", target]));
    let silent = || Error::Failed(format!("`cargo tree` did not list {package}"));
    let tree = ask_in(root, "cargo", &tree).ok_or_else(silent)?;
    let metadata = ["metadata", "--locked", "--format-version", "1"];
    let metadata = ask_in(root, "cargo", &metadata).ok_or_else(silent)?;
    let metadata = json(&metadata, "cargo metadata")?;
    let lock = files::read(&root.join("Cargo.lock"))?;
    let mut bill = of_cargo(&tree, &lock, &metadata);
    let version = ask_in(root, "rustc", &["--version"]).unwrap_or_default();
    bill.add(Component {
        name: String::from("rust-std"),
        version: String::from(version.split(' ').nth(1).unwrap_or_default()),
        registry: "generic",
        expression: String::from("MIT OR Apache-2.0"),
        hash: None,
        // `notices` reads these licences from the toolchain.
        licence: Licence::Own,
    });
    Ok(bill)
}

/// Parses the output of a tool, or a file.
fn json(text: &str, place: &str) -> Result<Value> {
    serde_json::from_str(text).map_err(|e| Error::Failed(format!("{place}: {e}")))
}

/// The bill of the output of `cargo tree`, in which each line has its depth.
fn of_cargo(tree: &str, lock: &str, metadata: &Value) -> Bill {
    let (hashes, folders) = (hashes(lock), folders(metadata));
    let (mut bill, mut above): (Bill, Vec<String>) = Default::default();
    for line in tree.lines() {
        let mut fields = line.split('\t');
        let (Some(depth), Some(package), Some(expression)) =
            (fields.next(), fields.next(), fields.next())
        else {
            continue;
        };
        let mut words = package.split(' ');
        let name = words.next().unwrap_or_default();
        let version = words.next().unwrap_or_default().trim_start_matches('v');
        let hash = hashes.get(&(name, version));
        let folder = folders.get(&(name, version)).filter(|_| hash.is_some());
        let component = Component {
            name: String::from(name),
            version: String::from(version),
            registry: "cargo",
            // Older form of a licence expression; `(*)` marks a component that was listed before.
            expression: expression.trim_end_matches(" (*)").replace('/', " OR "),
            hash: hash.map(|hash| ("SHA-256", String::from(*hash))),
            licence: folder.map_or(Licence::Own, |folder| Licence::Folder(folder.clone())),
        };
        let purl = component.purl();
        above.truncate(depth.parse().unwrap_or(0));
        if let Some(user) = above.last() {
            let used = bill.needs.entry(user.clone()).or_default();
            used.insert(purl.clone());
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

/// The folders of the packages in the output of `cargo metadata`, by name and version.
fn folders(metadata: &Value) -> BTreeMap<(&str, &str), PathBuf> {
    let packages = metadata["packages"].as_array().into_iter().flatten();
    let folder = |package: &'_ Value| {
        let manifest = PathBuf::from(package["manifest_path"].as_str()?);
        Some(manifest.parent()?.to_path_buf())
    };
    let named = packages.filter_map(|package| {
        let key = (package["name"].as_str()?, package["version"].as_str()?);
        Some((key, folder(package)?))
    });
    named.collect()
}

fn npm(dist: &Dist<'_>, package: &str) -> Result<Bill> {
    let folder = dist.repo.root.join(package);
    let lock = folder.join("package-lock.json");
    let lock = json(&files::read(&lock)?, &lock.display().to_string())?;
    let name = format!("odkit-{}", package.rsplit('/').next().unwrap_or(package));
    let mut bill = Bill::new(&name, &dist.version);
    for mut component in of_npm(&lock) {
        if let Licence::Folder(path) = &mut component.licence {
            *path = folder.join(&path);
        }
        bill.add(component);
    }
    Ok(bill)
}

/// The packages of a package-lock.json without those for development, as npm installs them.
fn of_npm(lock: &Value) -> Vec<Component> {
    let mut found = Vec::new();
    for (path, package) in lock["packages"].as_object().into_iter().flatten() {
        let field = |key: &str| package[key].as_str();
        let is_used = package["dev"].is_null() && package["devOptional"].is_null();
        // The package itself has no path.
        let name = path.rsplit_once("node_modules/").map(|(_, name)| name);
        if let (Some(name), Some(version), true) = (name, field("version"), is_used) {
            let hash = field("integrity").and_then(|text| text.strip_prefix("sha512-"));
            let bytes = hash.and_then(|hash| BASE64.decode(hash.as_bytes()).ok());
            found.push(Component {
                name: String::from(name),
                version: String::from(version),
                registry: "npm",
                expression: String::from(field("license").unwrap_or_default()),
                hash: bytes.map(|bytes| ("SHA-512", HEXLOWER.encode(&bytes))),
                licence: Licence::Folder(PathBuf::from(path)),
            });
        }
    }
    found
}

/// The components of a list: `== NAME VERSION (LICENCE)`, then the text of the licence. `*` stands for the version of odkit.
fn of_list(list: &str, this: &str) -> Vec<Component> {
    let mut found = Vec::new();
    for one in format!("\n{list}").split("\n== ").skip(1) {
        let (head, text) = one.split_once('\n').unwrap_or((one, ""));
        let (name, expression) = head.split_once(" (").unwrap_or((head, ""));
        let (name, version) = name.rsplit_once(' ').unwrap_or((name, ""));
        found.push(Component {
            name: String::from(name),
            version: String::from(if version == "*" { this } else { version }),
            registry: "generic",
            expression: String::from(expression.trim_end_matches(')')),
            hash: None,
            licence: Licence::Text(String::from(text)),
        });
    }
    found
}

#[cfg(test)]
mod tests {
    use std::path::PathBuf;

    use serde_json::json;

    use super::{Licence, folders, of_cargo, of_list, of_npm};

    #[test]
    fn a_tree_of_cargo_becomes_a_bill() {
        let tree = "0\ta v0.1.0 (/x)\tMIT\n1\tb v1.2.3\tMIT/Apache-2.0\n2\tc v3.0.0\tZlib\n1\tc v3.0.0\tZlib (*)\n";
        let lock =
            "[[package]]\nname = \"b\"\nversion = \"1.2.3\"\nsource = \"s\"\nchecksum = \"abc\"\n";
        let metadata = json!({ "packages": [{
            "name": "b", "version": "1.2.3", "dependencies": [{ "name": "c", "source": null }],
            "manifest_path": "/r/b-1.2.3/Cargo.toml",
        }] });
        let bill = of_cargo(tree, lock, &metadata);
        let purls: Vec<String> = bill.components.iter().map(|one| one.purl()).collect();
        let wanted = [
            "pkg:cargo/a@0.1.0",
            "pkg:cargo/b@1.2.3",
            "pkg:cargo/c@3.0.0",
        ];
        assert_eq!(purls, wanted);
        let b = &bill.components[1];
        assert_eq!(b.expression, "MIT OR Apache-2.0");
        assert_eq!(b.hash, Some(("SHA-256", String::from("abc"))));
        assert_eq!(b.licence, Licence::Folder(PathBuf::from("/r/b-1.2.3")));
        assert_eq!(bill.components[0].licence, Licence::Own);
        assert!(bill.needs[wanted[0]].iter().eq(&wanted[1..]));
        assert!(bill.needs[wanted[1]].iter().eq(&wanted[2..]));
        assert_eq!(folders(&metadata).len(), 1);
    }

    #[test]
    fn a_lock_of_npm_becomes_components() {
        let lock = json!({ "packages": {
            "": { "version": "9" },
            "node_modules/@a/b": {
                "version": "1.0.0", "integrity": "sha512-AP8Q", "license": "ISC", "dependencies": { "c": "2" },
            },
            "node_modules/@a/b/node_modules/c": { "version": "2.0.0" },
            "node_modules/d": { "version": "3.0.0", "dev": true },
        } });
        let found = of_npm(&lock);
        let purls: Vec<String> = found.iter().map(|one| one.purl()).collect();
        assert_eq!(purls, ["pkg:npm/%40a/b@1.0.0", "pkg:npm/c@2.0.0"]);
        assert_eq!(found[0].expression, "ISC");
        assert_eq!(found[0].hash, Some(("SHA-512", String::from("00ff10"))));
        let folder = PathBuf::from("node_modules/@a/b/node_modules/c");
        assert_eq!(found[1].licence, Licence::Folder(folder));
    }

    #[test]
    fn a_list_becomes_components() {
        let found = of_list(
            "== musl 1.2.5 (MIT)\nCopyright\n\n== a b * (MPL-2.0)\nText\n",
            "7.0",
        );
        assert_eq!(found.len(), 2);
        assert_eq!(found[0].licence, Licence::Text(String::from("Copyright\n")));
        assert_eq!(found[1].purl(), "pkg:generic/a%20b@7.0");
        assert_eq!(found[1].expression, "MPL-2.0");
    }
}
