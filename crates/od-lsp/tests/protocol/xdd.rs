//! An XDD in an editor: hover, outline and quick fixes.

use serde_json::{Value, json};

use crate::support::{Client, Files, TEXT, edited, place};

const URI: &str = "file:///w/a.xdd";

/// The device of the tests as an XDD.
fn text() -> String {
    let mut description = od_eds::parse(TEXT).description;
    // A name with a character that XML escapes.
    let gain = description.objects.get_mut(&0x2001).unwrap();
    gain.name.value = "Gain & more".into();
    od_eds::xdd::write(&description)
}

fn client(text: &str) -> Client {
    let mut client = Client::new(Files::default(), json!({}));
    client.open(URI, text);
    client
}

fn hover(client: &mut Client, text: &str, mark: &str) -> String {
    let params = json!({ "textDocument": { "uri": URI }, "position": place(text, mark) });
    let found = client.request("textDocument/hover", params);
    found["contents"]["value"].as_str().unwrap_or("").to_owned()
}

#[test]
fn a_hover_explains_objects_and_attributes() {
    let text = text();
    let mut client = client(&text);
    let tag = |index: &str| {
        let at = text.find(&format!("index=\"{index}\"")).unwrap();
        let start = text[..at].rfind('<').unwrap();
        text[start..start + text[start..].find('>').unwrap()].to_owned()
    };
    let own = tag("6000");
    let said = hover(
        &mut client,
        &text,
        &own.replacen("CANopenObject", "CANopen|Object", 1),
    );
    for part in [
        "**6000h**",
        "Operating parameters (CiA 406)",
        "UNSIGNED16, rw",
        "mappable",
    ] {
        assert!(said.contains(part), "{part}: {said}");
    }
    // The value between the quotation marks of an attribute, in the tag or in its parameter.
    let value = |attribute: &str| {
        let at = own
            .find(&format!(" {attribute}=\""))
            .unwrap_or_else(|| panic!("{own}"));
        let start = at + attribute.len() + 3;
        format!("{}|{}", &own[..start], &own[start..])
    };
    for (attribute, expected) in [
        ("dataType", "UNSIGNED16, 0 to 65535"),
        ("accessType", "a master can read and write the value"),
        ("highLimit", "255 (FFh)"),
        ("objectType", "VAR: a single value"),
    ] {
        if own.contains(&format!(" {attribute}=\"")) {
            let said = hover(&mut client, &text, &value(attribute));
            assert!(said.contains(expected), "{attribute}: {said}");
        }
    }
    let mapping = text.find("0x60040020").unwrap();
    let line = text[..mapping].rfind('<').unwrap();
    let mark = format!("{}|{}", &text[line..mapping], &text[mapping..mapping + 10]);
    let said = hover(&mut client, &text, &mark);
    assert!(
        said.contains("maps 6004h:00, 32 bits (Position value)"),
        "{said}"
    );
    assert!(hover(&mut client, &text, "<?x|ml").is_empty());
}

#[test]
fn the_outline_has_the_objects_with_their_sub_objects() {
    let text = text();
    let mut client = client(&text);
    let params = json!({ "textDocument": { "uri": URI } });
    let found = client.request("textDocument/documentSymbol", params);
    let found = found.as_array().unwrap();
    let names = |all: &[Value]| -> Vec<String> {
        let names = all
            .iter()
            .map(|one| one["name"].as_str().unwrap().to_owned());
        names.collect()
    };
    let all = names(found);
    assert_eq!(all.len(), 12, "{all:?}");
    assert!(all.contains(&"2001h Gain & more".to_owned()), "{all:?}");
    let identity = found
        .iter()
        .find(|one| one["name"] == "1018h Identity object");
    let identity = identity.unwrap();
    assert_eq!(identity["detail"], "RECORD");
    let members = names(identity["children"].as_array().unwrap());
    assert_eq!(members[1], "1018h:01 Vendor-ID");
    for one in found {
        let (range, own) = (&one["range"], &one["selectionRange"]);
        assert_eq!(range["start"], own["start"]);
        assert!(range["end"]["line"].as_u64() >= own["end"]["line"].as_u64());
    }
}

#[test]
fn a_finding_has_a_quick_fix() {
    // A sub-object is missing from the count.
    let text = text().replacen("subNumber=\"2\"", "subNumber=\"9\"", 1);
    let mut client = client(&text);
    let found = client.diagnostics(URI);
    let finding = found.iter().find(|one| one["code"] == "W0308").unwrap();
    for only in ["quickfix", "source.fixAll"] {
        let params = json!({
            "textDocument": { "uri": URI },
            "range": finding["range"],
            "context": { "diagnostics": [], "only": [only] },
        });
        let found = client.request("textDocument/codeAction", params);
        let fix = &found[0]["edit"]["changes"][URI];
        let fixed = edited(&text, fix);
        assert!(!fixed.contains("subNumber=\"9\""), "{only}: {found}");
        let again = od_eds::load(&fixed).findings;
        assert!(again.iter().all(|one| one.code() != "W0308"), "{only}");
    }
}
