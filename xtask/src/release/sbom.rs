//! Bills of material, a CycloneDX 1.5 file for each part.
//!
//! Existing tools write into the folders of the crates, or add a time and a random number.

use std::path::Path;

use serde_json::{Value, json};

use super::bill::{self, Bill, Component};
use super::dist::Dist;
use crate::error::Result;
use crate::files;

pub(super) fn make(dist: &Dist<'_>, folder: &Path) -> Result<()> {
    for part in bill::PARTS {
        write(dist, part, &folder.join(format!("{part}.cdx.json")))?;
    }
    Ok(())
}

/// Writes the bill of a part into a file.
pub(super) fn write(dist: &Dist<'_>, part: &str, file: &Path) -> Result<()> {
    files::write(file, &text(&bill::of(dist, part)?))
}

fn text(bill: &Bill) -> String {
    let product = bill
        .components
        .first()
        .map(|one| component(one, "application"));
    let mut others = Vec::from_iter(bill.components.iter().skip(1));
    others.sort_by_key(|one| one.purl());
    let others = others.into_iter().map(|one| component(one, "library"));
    let needs = bill
        .needs
        .iter()
        .map(|(user, used)| json!({ "ref": user, "dependsOn": used }));
    let bill = json!({
        "bomFormat": "CycloneDX",
        "specVersion": "1.5",
        "version": 1,
        "metadata": { "component": product },
        "components": Vec::from_iter(others),
        "dependencies": Vec::from_iter(needs),
    });
    format!("{bill:#}\n")
}

fn component(one: &Component, kind: &str) -> Value {
    let purl = one.purl();
    let mut component = json!({
        "type": kind, "bom-ref": purl, "name": one.name, "version": one.version, "purl": purl,
    });
    if let Some((kind, hash)) = &one.hash {
        component["hashes"] = json!([{ "alg": kind, "content": hash }]);
    }
    if !one.expression.is_empty() {
        component["licenses"] = json!([{ "expression": one.expression }]);
    }
    component
}

#[cfg(test)]
mod tests {
    use serde_json::{Value, json};

    use super::text;
    use crate::release::bill::{Bill, Component};

    #[test]
    fn a_bill_is_json() {
        let one = |name: &str, hash| Component {
            name: String::from(name),
            version: String::from("1.2.3"),
            registry: "npm",
            expression: String::from("MIT"),
            hash,
            ..Component::default()
        };
        let (product, part) = ("pkg:npm/a@1.2.3", "pkg:npm/%40b/\"c@1.2.3");
        let text = text(&Bill {
            components: vec![
                one("a", None),
                one("@b/\"c", Some(("SHA-256", String::from("00ff")))),
            ],
            needs: [(String::from(product), [String::from(part)].into())].into(),
        });
        let bill: Value = serde_json::from_str(&text).expect("it is JSON");
        assert_eq!(bill["metadata"]["component"]["bom-ref"], product);
        assert_eq!(bill["metadata"]["component"]["type"], "application");
        let library = &bill["components"][0];
        assert_eq!(
            (&library["name"], &library["purl"]),
            (&json!("@b/\"c"), &json!(part))
        );
        assert_eq!(library["hashes"][0]["content"], "00ff");
        assert_eq!(library["licenses"][0]["expression"], "MIT");
        assert_eq!(
            bill["dependencies"],
            json!([{ "ref": product, "dependsOn": [part] }])
        );
    }
}
