//! Small files for every form in which CiA 311 expresses content.

use alloc::format;
use alloc::string::String;
use alloc::vec::Vec;

use crate::description::Value;
use crate::load::Parsed;
use crate::load::parse;
use od_model::{Access, Address, DataType, Group, ObjectCode};

fn file(device: &str, network: &str) -> String {
    format!(
        "<?xml version=\"1.0\"?>\n<ISO15745ProfileContainer xmlns=\"http://www.canopen.org/xml/1.1\">\n\
         <ISO15745Profile><ProfileBody fileName=\"x.xpd\" fileCreationDate=\"2026-07-14\" \
         fileCreationTime=\"14:05:00\" fileVersion=\"3\">{device}</ProfileBody></ISO15745Profile>\n\
         <ISO15745Profile><ProfileBody>{network}</ProfileBody></ISO15745Profile>\n\
         </ISO15745ProfileContainer>\n"
    )
}

fn codes(parsed: &Parsed) -> Vec<&'static str> {
    parsed.findings.iter().map(|d| d.code()).collect()
}

#[test]
fn objects_with_their_own_attributes() {
    let text = file(
        "",
        "<CANopenObjectList>\n\
         <CANopenObject index=\"1017\" name=\"Heartbeat &amp; more\" objectType=\"7\" dataType=\"0006\" \
          accessType=\"rw\" PDOmapping=\"no\" defaultValue=\"0x10\" lowLimit=\"0\" highLimit=\"1000\" objFlags=\"0001\"/>\n\
         <CANopenObject index=\"2000\" name=\"Array\" objectType=\"8\" subNumber=\"2\">\n\
          <CANopenSubObject subIndex=\"00\" name=\"n\" objectType=\"7\" dataType=\"0005\" accessType=\"const\" defaultValue=\"1\"/>\n\
          <CANopenSubObject subIndex=\"0A\" name=\"Speed\" objectType=\"7\" dataType=\"0004\" accessType=\"rw\" \
           PDOmapping=\"RPDO\" actualValue=\"-5\" denotation=\"Left\"/>\n\
         </CANopenObject></CANopenObjectList>",
    );
    let parsed = parse(&text);
    assert!(codes(&parsed).is_empty(), "{:?}", parsed.findings);
    let description = &parsed.description;
    let heartbeat = &description.objects[&0x1017].entries[&0];
    assert_eq!(heartbeat.name.value, "Heartbeat & more");
    assert_eq!(heartbeat.default.as_deref(), Some(&Value::Unsigned(16)));
    assert_eq!(heartbeat.high.as_deref(), Some(&Value::Unsigned(1000)));
    assert_eq!(heartbeat.flags, 1);
    let span = heartbeat
        .default
        .as_ref()
        .map(|default| default.span)
        .unwrap_or_default();
    assert_eq!(&text[span.start as usize..span.end as usize], "0x10");
    let speed = description
        .entry(Address::new(0x2000, 10))
        .expect("it is there");
    assert_eq!((*speed.access, *speed.mappable), (Access::Rww, true));
    assert_eq!(speed.parameter.as_deref(), Some(&Value::Signed(-5)));
    assert_eq!(speed.extra, [("Denotation".into(), "Left".into())]);
}

#[test]
fn objects_with_parameters_templates_and_types() {
    let parsed = parse(&file(
        "<dataTypeList>\
          <array uniqueID=\"A\"><subrange lowerLimit=\"0\" upperLimit=\"1\"/><INT/></array>\
          <struct uniqueID=\"S\"><varDeclaration name=\"n\"><USINT/></varDeclaration>\
           <varDeclaration name=\"b\"><BOOL/></varDeclaration></struct>\
          <derived uniqueID=\"D\"><baseType><dataTypeIDRef uniqueIDRef=\"E\"/></baseType></derived>\
          <enum uniqueID=\"E\"><enumValue/><UINT/></enum>\
          <derived uniqueID=\"R\"><baseType><dataTypeIDRef uniqueIDRef=\"R\"/></baseType></derived>\
         </dataTypeList>\
         <templateList><parameterTemplate uniqueID=\"T\" access=\"readWrite\"><ULINT/>\
          <defaultValue value=\"7\"/></parameterTemplate></templateList>\
         <parameterList>\
          <parameter uniqueID=\"P1\" templateIDRef=\"T\"><label lang=\"en\">From its label</label>\
           <allowedValues><range><minValue value=\"1\"/><maxValue value=\"9\"/></range></allowedValues>\
           <property name=\"CO_storageGroup\" value=\"PERSIST_COMM\"/></parameter>\
          <parameter uniqueID=\"P2\" access=\"const\"><dataTypeIDRef uniqueIDRef=\"D\"/></parameter>\
          <parameter uniqueID=\"P3\" access=\"readWrite\"><dataTypeIDRef uniqueIDRef=\"A\"/></parameter>\
          <parameter uniqueID=\"P4\"><dataTypeIDRef uniqueIDRef=\"S\"/></parameter>\
          <parameter uniqueID=\"P5\"><BITSTRING/></parameter>\
          <parameter uniqueID=\"P6\"><BITSTRING/><defaultValue value=\"12 AB\"/></parameter>\
          <parameter uniqueID=\"P7\"><dataTypeIDRef uniqueIDRef=\"R\"/></parameter>\
         </parameterList>",
        "<CANopenObjectList>\
          <CANopenObject index=\"2001\" objectType=\"7\" uniqueIDRef=\"P1\" PDOmapping=\"TPDO\"/>\
          <CANopenObject index=\"2002\" name=\"a\" objectType=\"7\" uniqueIDRef=\"P2\"/>\
          <CANopenObject index=\"2003\" name=\"a\" objectType=\"8\" uniqueIDRef=\"P3\">\
           <CANopenSubObject subIndex=\"00\" name=\"n\" objectType=\"7\"/>\
           <CANopenSubObject subIndex=\"01\" name=\"v\" objectType=\"7\"/></CANopenObject>\
          <CANopenObject index=\"2004\" name=\"a\" objectType=\"9\" uniqueIDRef=\"P4\">\
           <CANopenSubObject subIndex=\"01\" name=\"v\" objectType=\"7\"/></CANopenObject>\
          <CANopenObject index=\"2005\" name=\"a\" objectType=\"7\" uniqueIDRef=\"P5\"/>\
          <CANopenObject index=\"2006\" name=\"a\" objectType=\"7\" uniqueIDRef=\"P6\"/>\
          <CANopenObject index=\"2007\" name=\"a\" objectType=\"7\" uniqueIDRef=\"P7\"/>\
         </CANopenObjectList>",
    ));
    let entry = |index, sub| {
        parsed
            .description
            .entry(Address::new(index, sub))
            .expect("it is there")
    };
    let data_type = |index, sub| entry(index, sub).data_type.map(|t| t.value);
    let first = entry(0x2001, 0);
    assert_eq!(first.name.value, "From its label");
    assert_eq!(
        (data_type(0x2001, 0), *first.access),
        (Some(DataType::Unsigned64), Access::Rwr)
    );
    assert_eq!(first.default.as_deref(), Some(&Value::Unsigned(7)));
    assert_eq!(first.low.as_deref(), Some(&Value::Unsigned(1)));
    assert_eq!(
        first.group.map(|group| group.value),
        Some(Group::Communication)
    );
    assert_eq!(data_type(0x2002, 0), Some(DataType::Unsigned16));
    assert_eq!(*entry(0x2002, 0).access, Access::Const);
    assert_eq!(data_type(0x2003, 0), Some(DataType::Unsigned8));
    assert_eq!(data_type(0x2003, 1), Some(DataType::Integer16));
    assert_eq!(data_type(0x2004, 1), Some(DataType::Boolean));
    assert_eq!(data_type(0x2005, 0), Some(DataType::Domain));
    assert_eq!(
        entry(0x2006, 0).default.as_deref(),
        Some(&Value::Bytes([0x12, 0xAB].into()))
    );
    // A type that refers to itself is not valid.
    assert_eq!(data_type(0x2007, 0), None);
    assert_eq!(
        *parsed.description.objects[&0x2004].code,
        ObjectCode::Record
    );
}

#[test]
fn content_besides_the_objects() {
    let parsed = parse(&file(
        "<DeviceIdentity><vendorName>odkit</vendorName><vendorID>0x5F</vendorID>\
         <productText><description lang=\"en\">Two\n lines</description></productText></DeviceIdentity>",
        "<PhysicalLayer><baudRate><supportedBaudRate value=\"500 Kbps\"/></baudRate></PhysicalLayer>\
         <dummyUsage><dummy entry=\"Dummy0005=1\"/></dummyUsage>\
         <CANopenGeneralFeatures granularity=\"8\" nrOfRxPDO=\"0\" bootUpSlave=\"true\"/>\
         <deviceCommissioning nodeID=\"17\" nodeName=\"n\" actualBaudRate=\"250 Kbps\" CANopenManager=\"false\"/>",
    ));
    let get = |section: &str, key: &str| {
        let section = parsed.description.section(section)?;
        section.get(key).map(|value| value.value.clone())
    };
    for (section, key, value) in [
        ("FileInfo", "FileName", "x.xpd"),
        ("FileInfo", "CreationDate", "07-14-2026"),
        ("FileInfo", "CreationTime", "02:05PM"),
        ("FileInfo", "Description", "Two lines"),
        ("DeviceInfo", "VendorNumber", "0x5F"),
        ("DeviceInfo", "BaudRate_500", "1"),
        ("DeviceInfo", "BaudRate_125", "0"),
        ("DeviceInfo", "SimpleBootUpSlave", "1"),
        ("DummyUsage", "Dummy0005", "1"),
        ("DeviceComissioning", "Baudrate", "250"),
        ("DeviceComissioning", "CANopenManager", "0"),
    ] {
        assert_eq!(get(section, key).as_deref(), Some(value), "{section} {key}");
    }
    assert_eq!(parsed.description.commissioned_node_id(), Some(17));
}

#[test]
fn each_problem_has_a_place() {
    let text = file(
        "",
        "<CANopenObjectList><CANopenObject index=\"10G0\" name=\"a\"/><CANopenObject name=\"a\"/>\
         <CANopenObject index=\"2000\" name=\"a\" objectType=\"7\" uniqueIDRef=\"nowhere\"/>\
         <CANopenObject index=\"2001\" name=\"a\" objectType=\"7\" dataType=\"0005\" accessType=\"rx\" defaultValue=\"300\"/>\
         </CANopenObjectList>",
    );
    let loaded = crate::load(&text);
    for code in ["E0114", "E0115", "E0405", "E0412"] {
        let found = loaded.findings.iter().find(|d| d.code() == code);
        assert!(
            found.is_some_and(|d| d.span().is_some() && d.fix.is_none()),
            "{code}"
        );
    }
    // The type and the access of the missing parameter are no faults of their own.
    let follow = |code: &&str| matches!(*code, "E0401" | "W0404");
    assert_eq!(codes(&loaded).iter().filter(|code| follow(code)).count(), 0);
    let broken = parse("<a>\n <b é></b>\n</a>");
    assert_eq!(codes(&broken), ["E0113"]);
    let span = broken.findings[0].span().expect("it has a place");
    assert_eq!(span.line, 2);
    for text in [
        "<",
        "<a",
        "<!DOCTYPE a [<!ENTITY b \"c\">]><a>&b;</a>",
        "<a></b>",
        "<?xml",
    ] {
        assert!(parse(text).description.objects.is_empty());
    }
}

#[test]
fn an_xdd_has_no_values_of_one_device_and_an_xdc_has_its_node_id() {
    let object = "<CANopenObjectList><CANopenObject index=\"2000\" name=\"a\" objectType=\"7\" dataType=\"0005\" \
         accessType=\"rw\" actualValue=\"5\"/></CANopenObjectList>";
    let node = "<deviceCommissioning nodeID=\"5\" nodeName=\"a\" actualBaudRate=\"250 Kbps\"/>";
    for (name, content, codes) in [
        ("x.xdd", String::from(object), &["W0217"][..]),
        ("x.xdd", format!("{object}{node}"), &["W0217", "W0217"]),
        ("x.xdc", String::from(object), &["W0658"]),
        ("x.xdc", format!("{object}{node}"), &[]),
    ] {
        let text = file("", &content).replace("x.xpd", name);
        assert_eq!(self::codes(&parse(&text)), codes, "{name}: {content}");
    }
}

/// The schema has `xsd:hexBinary`: two digits for each byte, and no `0x`.
#[test]
fn hexadecimal_digits_are_whole_bytes() {
    let right = "<CANopenObjectList><CANopenObject index=\"2000\" name=\"a\" objectType=\"9\" subNumber=\"1\">\
         <CANopenSubObject subIndex=\"00\" name=\"b\" objectType=\"7\" dataType=\"0005\" accessType=\"ro\" objFlags=\"00\" \
         defaultValue=\"0\"/></CANopenObject></CANopenObjectList>";
    assert!(!codes(&crate::load(&file("", right))).contains(&"W0123"));
    for (wrong, fixed) in [
        ("index=\"0x2000\"", "index=\"2000\""),
        ("subIndex=\"0\"", "subIndex=\"00\""),
        ("dataType=\"5\"", "dataType=\"0005\""),
        ("dataType=\"0x0005\"", "dataType=\"0005\""),
        ("dataType=\"005\"", "dataType=\"0005\""),
        ("objFlags=\"0\"", "objFlags=\"00\""),
    ] {
        let text = file("", &right.replacen(fixed, wrong, 1));
        let loaded = crate::load(&text);
        let found: Vec<_> = loaded
            .findings
            .iter()
            .filter(|own| own.code() == "W0123")
            .collect();
        assert_eq!(found.len(), 1, "{wrong}: {:?}", loaded.findings);
        let find = |document: &crate::Document| document.load().findings;
        let done = crate::fix::fix(
            &crate::Document::new(text),
            crate::fix::Applicability::Safe,
            find,
        );
        assert!(
            done.document.text().contains(fixed),
            "{wrong}: {}",
            done.document.text()
        );
    }
    // Two digits are a whole byte.
    let text = file(
        "",
        &right.replacen("dataType=\"0005\"", "dataType=\"05\"", 1),
    );
    assert!(!codes(&crate::load(&text)).contains(&"W0123"));
}

#[test]
fn the_class_of_a_profile_is_that_of_its_body() {
    let profile = |class: &str, body: &str| {
        format!(
            "<ISO15745ProfileContainer><ISO15745Profile><ProfileHeader><ProfileClassID>{class}</ProfileClassID>\
             </ProfileHeader><ProfileBody xmlns:x=\"http://www.w3.org/2001/XMLSchema-instance\" x:type=\"{body}\"/>\
             </ISO15745Profile></ISO15745ProfileContainer>"
        )
    };
    let (device, network) = (
        "ProfileBody_Device_CANopen",
        "ProfileBody_CommunicationNetwork_CANopen",
    );
    for (class, body, is_right) in [
        ("Device", device, true),
        ("Device", "ProfileBody_Devise_CANopen", false),
        ("CommunicationNetwork", network, true),
        ("Device", network, false),
        ("CommunicationNetwork", device, false),
        ("Resource", device, false),
        ("Communication", "", false),
        ("Resource", "", true),
    ] {
        let found = codes(&parse(&profile(class, body)));
        assert_eq!(!found.contains(&"W0123"), is_right, "{class} {body}");
    }
}

#[test]
fn names_are_written_in_the_capitals_of_the_schema_and_parts_are_numbers() {
    let unit = |name: &str| {
        format!(
            "<ISO15745ProfileContainer><parameter uniqueID=\"a\"><unit {name}=\"#mbar\"/></parameter>\
             </ISO15745ProfileContainer>"
        )
    };
    assert!(!codes(&parse(&unit("unitURI"))).contains(&"W0318"));
    assert!(codes(&parse(&unit("unitUri"))).contains(&"W0318"));
    for (text, is_right) in [
        ("<ISO15745Part>1</ISO15745Part>", true),
        ("<ISO15745Part>one</ISO15745Part>", false),
        ("<ISO15745Edition>0</ISO15745Edition>", false),
        ("<CANopenGeneralFeatures granularity=\"8\"/>", true),
        ("<CANopenGeneralFeatures/>", false),
    ] {
        let text = format!("<ISO15745ProfileContainer>{text}</ISO15745ProfileContainer>");
        let found = codes(&parse(&text));
        assert_eq!(!found.contains(&"W0123"), is_right, "{text}");
    }
}

#[test]
fn a_finding_has_the_terms_of_the_schema() {
    let text = file(
        "",
        "<CANopenObjectList><CANopenObject index=\"2000\" name=\"a\" objectType=\"7\" dataType=\"0005\" accessType=\"rw\" \
         lowLimit=\"0\" highLimit=\"9\" actualValue=\"10\"/></CANopenObjectList>\
         <deviceCommissioning nodeID=\"5\" actualBaudRate=\"7 Kbps\"/>",
    );
    let found = crate::load(&text.replace("x.xpd", "x.xdc")).findings;
    let said: Vec<String> = found
        .iter()
        .map(|one| crate::say(one, &crate::Eds).message)
        .collect();
    for expected in ["actualValue", "actualBaudRate `7` is not valid"] {
        assert!(said.iter().any(|own| own.contains(expected)), "{said:?}");
    }
    for eds in ["ParameterValue", "HighLimit", "Baudrate `"] {
        assert!(!said.iter().any(|own| own.contains(eds)), "{eds}: {said:?}");
    }
}

#[test]
fn attributes_of_a_parameter_are_those_of_the_schema() {
    let parameter = |inside: &str| {
        let list = format!(
            "<parameterList><parameter uniqueID=\"P\" access=\"readWrite\"><label lang=\"en\">a</label>\
             <INT/>{inside}</parameter></parameterList>"
        );
        let findings = crate::load(&file(&list, "")).findings;
        let own = findings.iter().map(|one| crate::say(one, &crate::Eds));
        let own = own.filter(|said| ["W0123", "W0318"].contains(&said.code));
        own.map(|said| said.message).collect::<Vec<_>>()
    };
    for (inside, expected) in [
        (
            "<defaultValue values=\"0\"/>",
            &[
                "attribute value of defaultValue is missing",
                "`values` is not an attribute of CiA 311 for this element",
            ][..],
        ),
        (
            "<unit multiplier=\"1\" unitUrl=\"#bar\"/>",
            &["`unitUrl` is not an attribute of CiA 311 for this element"],
        ),
        (
            "<unit multiplier=\"0.1 bar\" unitURI=\"#bar\"/>",
            &["`0.1 bar` is not a valid multiplier"],
        ),
        (
            "<property name=\"a\"/>",
            &["attribute value of property is missing"],
        ),
        (
            "<defaultValue value=\"0\"/><unit multiplier=\"1\" unitURI=\"#bar\"/><property name=\"a\" value=\"b\"/>",
            &[],
        ),
    ] {
        assert_eq!(parameter(inside), expected, "{inside}");
    }
}
