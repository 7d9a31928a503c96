//! Bills of material, a CycloneDX 1.5 file for each part.
//!
//! Existing tools write into the folders of the crates, or add a time and a random number.

use std::path::Path;

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
    files::write(file, &json(&bill::of(dist, part)?))
}

fn json(bill: &Bill) -> String {
    let product = bill.components.first().map(|one| line(one, "application"));
    let others = bill.components.iter().skip(1);
    let mut others: Vec<String> = others.map(|one| line(one, "library")).collect();
    others.sort();
    let needs = bill.needs.iter().map(|(user, used)| {
        let used: Vec<String> = used.iter().map(|purl| text(purl)).collect();
        let used = used.join(", ");
        format!("{{\"ref\": {}, \"dependsOn\": [{used}]}}", text(user))
    });
    let needs: Vec<String> = needs.collect();
    format!(
        "{{\n  \"bomFormat\": \"CycloneDX\",\n  \"specVersion\": \"1.5\",\n  \"version\": 1,\n  \
         \"metadata\": {{\"component\": {}}},\n  \"components\": [\n    {}\n  ],\n  \
         \"dependencies\": [\n    {}\n  ]\n}}\n",
        product.unwrap_or_default(),
        others.join(",\n    "),
        needs.join(",\n    ")
    )
}

/// A component as one line.
fn line(one: &Component, kind: &str) -> String {
    let purl = text(&one.purl());
    let mut line = format!(
        "{{\"type\": \"{kind}\", \"bom-ref\": {purl}, \"name\": {}, \"version\": {}",
        text(&one.name),
        text(&one.version)
    );
    if let Some((kind, hash)) = &one.hash {
        let hash = text(hash);
        line.push_str(&format!(
            ", \"hashes\": [{{\"alg\": \"{kind}\", \"content\": {hash}}}]"
        ));
    }
    if !one.expression.is_empty() {
        let expression = text(&one.expression);
        line.push_str(&format!(
            ", \"licenses\": [{{\"expression\": {expression}}}]"
        ));
    }
    line + &format!(", \"purl\": {purl}}}")
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
    use super::json;
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
        let json = json(&Bill {
            components: vec![
                one("a", None),
                one("@b/\"c", Some(("SHA-256", String::from("00ff")))),
            ],
            needs: [(String::from(product), [String::from(part)].into())].into(),
        });
        let wanted = [
            "\"metadata\": {\"component\": {\"type\": \"application\", \"bom-ref\": \"pkg:npm/a@1.2.3\"",
            "{\"type\": \"library\", \"bom-ref\": \"pkg:npm/%40b/\\\"c@1.2.3\", \"name\": \"@b/\\\"c\", \"version\": \"1.2.3\", \
             \"hashes\": [{\"alg\": \"SHA-256\", \"content\": \"00ff\"}], \"licenses\": [{\"expression\": \"MIT\"}], \"purl\":",
            "{\"ref\": \"pkg:npm/a@1.2.3\", \"dependsOn\": [\"pkg:npm/%40b/\\\"c@1.2.3\"]}",
        ];
        for wanted in wanted {
            assert!(json.contains(wanted), "{wanted}: {json}");
        }
    }
}
