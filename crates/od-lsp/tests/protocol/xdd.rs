//! An XDD in an editor: hover, outline, quick fixes, jumps, hints.

use serde_json::{Value, json};

use crate::support::{Client, Files, TEXT, covered, edited, place};

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
fn completion_offers_the_words_of_an_attribute() {
    let text = text();
    let mut client = client(&text);
    let mut of = |attribute: &str| {
        let start = text.find("index=\"6000\"").unwrap();
        let at = start + text[start..].find(attribute).unwrap() + attribute.len();
        let mark = format!("{}|{}", &text[start..at], &text[at..at + 4]);
        let params = json!({ "textDocument": { "uri": URI }, "position": place(&text, &mark) });
        let found = client.request("textDocument/completion", params);
        crate::support::labels(&found)
            .into_iter()
            .map(String::from)
            .collect::<Vec<_>>()
    };
    assert_eq!(
        of(" PDOmapping=\""),
        ["no", "default", "optional", "TPDO", "RPDO"]
    );
    assert!(of(" dataType=\"").contains(&"001B".into()));
    assert_eq!(of(" objectType=\"")[..2], ["7", "8"]);
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

/// The response to a request about the place of the `|` in a mark.
fn asked(client: &mut Client, method: &str, text: &str, mark: &str) -> Value {
    let params = json!({ "textDocument": { "uri": URI }, "position": place(text, mark) });
    client.request(method, params)
}

#[test]
fn a_mapping_leads_to_its_object_and_a_reference_to_its_parameter() {
    let text = text();
    let mut client = client(&text);
    let object = asked(&mut client, "textDocument/definition", &text, "0x6004|0020");
    let tag = covered(&text, &object[0]["range"]);
    assert!(tag.starts_with("<CANopenObject index=\"6004\""), "{tag}");
    // From a sub-object to its object.
    let whole = asked(
        &mut client,
        "textDocument/definition",
        &text,
        "subIndex=\"01\" name=\"Vendor|-ID",
    );
    let tag = covered(&text, &whole[0]["range"]);
    assert!(tag.contains("index=\"1018\""), "{tag}");
    let referred = text.replacen(
        "<CANopenObject index=\"6004\"",
        "<CANopenObject index=\"6004\" uniqueIDRef=\"P_1\"",
        1,
    );
    let referred = referred.replacen(
        "</ProfileBody>",
        "<parameterList><parameter access=\"read\" uniqueID=\"P_1\"><UDINT/></parameter></parameterList></ProfileBody>",
        1,
    );
    client.change(URI, json!({ "text": referred }));
    let found = asked(
        &mut client,
        "textDocument/definition",
        &referred,
        "uniqueIDRef=\"P|_1",
    );
    let tag = covered(&referred, &found[0]["range"]);
    assert_eq!(tag, "<parameter access=\"read\" uniqueID=\"P_1\">");
    let mut found = client.request(
        "textDocument/references",
        json!({
            "textDocument": { "uri": URI }, "position": place(&referred, "0x6004|0020"),
            "context": { "includeDeclaration": true },
        }),
    );
    let found = found.as_array_mut().unwrap().iter();
    let found: Vec<&str> = found.map(|one| covered(&referred, &one["range"])).collect();
    assert_eq!(found, ["0x60040020", "6004"]);
}

#[test]
fn an_object_gets_another_index_with_its_mappings_and_counts() {
    let text = text();
    let mut client = client(&text);
    let params = json!({
        "textDocument": { "uri": URI }, "position": place(&text, "0x6004|0020"), "newName": "2500",
    });
    let found = client.request("textDocument/rename", params);
    let renamed = edited(&text, &found["changes"][URI]);
    assert!(renamed.contains("defaultValue=\"0x25000020\""), "{renamed}");
    assert!(renamed.contains("<CANopenObject index=\"2500\"") && !renamed.contains("6004"));
    let before = od_eds::load(&text).findings;
    let after = od_eds::load(&renamed).findings;
    let counts = |all: &[od_eds::Finding]| all.iter().filter(|one| one.code() == "W0204").count();
    assert_eq!((counts(&before), counts(&after)), (0, 0), "{renamed}");
}

#[test]
fn numbers_have_hints() {
    let text = text();
    let mut client = client(&text);
    let lines = text.lines().count();
    let params = json!({
        "textDocument": { "uri": URI },
        "range": { "start": { "line": 0, "character": 0 }, "end": { "line": lines, "character": 0 } },
    });
    let found = client.request("textDocument/inlayHint", params);
    let found = found.as_array().unwrap();
    let hints: Vec<(&str, &str)> = found
        .iter()
        .map(|hint| {
            let at = json!({ "start": hint["position"], "end": hint["position"] });
            let line = text
                .lines()
                .nth(at["start"]["line"].as_u64().unwrap() as usize);
            let column = at["start"]["character"].as_u64().unwrap() as usize;
            let before = &line.unwrap()[..column];
            (
                &before[before.rfind(' ').unwrap() + 1..],
                hint["label"].as_str().unwrap(),
            )
        })
        .collect();
    for expected in [
        ("objectType=\"9\"", "RECORD"),
        ("dataType=\"0007\"", "UNSIGNED32"),
        ("defaultValue=\"0x60040020\"", "6004h:00, 32 bits"),
    ] {
        assert!(hints.contains(&expected), "{expected:?}: {hints:?}");
    }
    assert!(
        hints.iter().any(|(_, label)| *label == "180h + node ID"),
        "{hints:?}"
    );
}

#[test]
fn attributes_and_bit_rates_are_completed() {
    let text = text().replacen(
        "</ProfileBody>",
        "<dynamicChannel bitAlignment=\"8\" /><supportedBaudRate value=\"1 Kbps\"/></ProfileBody>",
        1,
    );
    let mut client = client(&text);
    let mut labels = |mark: &str| {
        let found = asked(&mut client, "textDocument/completion", &text, mark);
        let items = found["items"].as_array().unwrap().iter();
        let labels: Vec<String> = items
            .map(|item| item["label"].as_str().unwrap().to_owned())
            .collect();
        labels
    };
    let names = labels("bitAlignment=\"8\" |/>");
    assert!(names.iter().any(|name| name == "startIndex"), "{names:?}");
    assert!(
        !names.iter().any(|name| name == "bitAlignment"),
        "{names:?}"
    );
    let rates = labels("<supportedBaudRate value=\"|");
    assert_eq!(rates.first().map(String::as_str), Some("10 Kbps"));
    assert_eq!(rates.len(), 8);
}

#[test]
fn a_hover_shows_the_texts_of_a_parameter() {
    let text = text().replacen(
        "</ProfileBody>",
        "<ApplicationProcess><parameterList><parameter uniqueID=\"P_1\" access=\"read\">\
         <label lang=\"en\">Speed</label><label lang=\"de\">Drehzahl &amp; Richtung</label>\
         <description lang=\"en\">Of the\n shaft</description><INT/></parameter>\
         </parameterList></ApplicationProcess></ProfileBody>",
        1,
    );
    let text = text.replacen(
        "<CANopenObject index=\"6000\"",
        "<CANopenObject index=\"6000\" uniqueIDRef=\"P_1\"",
        1,
    );
    let mut client = client(&text);
    let found = hover(&mut client, &text, "index=\"60|00\"");
    for expected in [
        "Speed (en)",
        "Drehzahl \\& Richtung (de)",
        "Of the shaft (en)",
    ] {
        assert!(found.contains(expected), "{expected}: {found}");
    }
    let other = hover(&mut client, &text, "index=\"10|00\"");
    assert!(!other.contains("Speed"), "{other}");
}
