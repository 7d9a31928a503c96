use super::*;
use crate::description::tables::Tables;

#[track_caller]
fn round(text: &str) -> String {
    let description = crate::parse(text).description;
    let written = write(&description);
    let again = crate::parse(&written);
    assert!(again.findings.is_empty(), "{:?}\n{written}", again.findings);
    let [a, b] = [&description, &again.description].map(Tables::new);
    assert!(a.dictionary() == b.dictionary(), "{written}");
    for section in ["DeviceInfo", "DeviceComissioning"] {
        for key in [
            "VendorNumber",
            "BaudRate_500",
            "NrOfTXPDO",
            "NodeID",
            "Baudrate",
        ] {
            assert_eq!(
                value(&description, section, key),
                value(&again.description, section, key)
            );
        }
    }
    written
}

#[test]
fn a_written_file_can_be_read_again() {
    let written = round(
        "[FileInfo]\nFileName=a&b.eds\nCreationDate=07-14-2026\nDescription=\"x\" < y\n\
             [DeviceInfo]\nVendorNumber=0x5F\nBaudRate_500=1\nBaudRate_10=0\nNrOfTXPDO=1\n\
             [DeviceComissioning]\nNodeID=5\nBaudrate=250\n[DummyUsage]\nDummy0005=1\n\
             [MandatoryObjects]\nSupportedObjects=1\n1=0x1000\n\
             [1000]\nParameterName=Type <&> \"1\"\nDataType=7\nAccessType=const\nDefaultValue=0x20196\n\
             [OptionalObjects]\nSupportedObjects=1\n1=0x1014\n\
             [1014]\nParameterName=COB\n;StorageLocation=PERSIST_COMM\nDataType=7\nAccessType=rw\n\
             DefaultValue=$NODEID+0x80\n\
             [ManufacturerObjects]\nSupportedObjects=3\n1=0x2000\n2=0x2001\n3=0x2002\n\
             [2000]\nParameterName=R\nObjectType=9\nSubNumber=3\n\
             [2000sub0]\nParameterName=n\nDataType=5\nAccessType=ro\nDefaultValue=2\n\
             [2000sub1]\nParameterName=a\nDataType=3\nAccessType=rwr\nPDOMapping=1\nDefaultValue=-5\n\
             LowLimit=-9\nHighLimit=9\nParameterValue=3\n\
             [2000sub2]\nParameterName=b\nDataType=9\nAccessType=ro\nDefaultValue=a <b>\n\
             [2001]\nParameterName=w\nDataType=5\nAccessType=rww\nPDOMapping=1\n\
             [2002]\nParameterName=w\nDataType=0x16\nAccessType=rw\nPDOMapping=1\n",
    );
    for part in [
        "fileCreationDate=\"2026-07-14\"",
        "name=\"Type &lt;&amp;&gt; &quot;1&quot;\"",
        "actualValue=\"3\"",
        "<deviceCommissioning nodeID=\"5\" actualBaudRate=\"250 Kbps\"/>",
        "<dummy entry=\"Dummy0005=1\"/>",
    ] {
        assert!(written.contains(part), "{part}\n{written}");
    }
}

/// The schema of CiA 311 allows decimal numbers only.
#[test]
fn hexadecimal_numbers_of_an_eds_are_decimal() {
    let text = "[DeviceInfo]\nGranularity=0x8\nNrOfRXPDO=0x1\nSimpleBootUpSlave=0x1\nBaudRate_500=0x1\n\
         [DeviceComissioning]\nNodeID=0x38\nBaudrate=0x3E8\nNetNumber=0x1\nCANopenManager=0x1\n\
         [1000]\nParameterName=t\nDataType=7\nAccessType=ro\nDefaultValue=0x20196\n";
    let written = write(&crate::parse(text).description);
    for part in [
        "granularity=\"8\" nrOfRxPDO=\"1\" bootUpSlave=\"true\"",
        "<supportedBaudRate value=\"500 Kbps\"/>",
        "<deviceCommissioning nodeID=\"56\" actualBaudRate=\"1000 Kbps\" networkNumber=\"1\" CANopenManager=\"true\"/>",
    ] {
        assert!(written.contains(part), "{part}\n{written}");
    }
}

#[test]
fn a_file_names_its_kind() {
    let text = "[FileInfo]\nFileName=a.eds\nFileVersion=1\nFileRevision=7\nCreationTime=02:05PM\nCreationDate=07-14-2026\n\
        ModificationTime=12:30AM\nModificationDate=07-15-2026\n[Comments]\nLines=2\nLine1=one <1>\nLine2=two\n\
        [1000]\nParameterName=t\nDataType=7\nAccessType=ro\nDefaultValue=0x20196\n\
        [1009]\nParameterName=h\nDataType=9\nAccessType=const\nDefaultValue=1.0\n\
        [100A]\nParameterName=s\nDataType=9\nAccessType=const\nDefaultValue=2.1 & more\n\
        [1018]\nParameterName=Identity\nObjectType=9\nSubNumber=2\n\
        [1018sub0]\nParameterName=n\nDataType=5\nAccessType=const\nDefaultValue=1\n\
        [1018sub1]\nParameterName=Vendor\nDataType=7\nAccessType=ro\nDefaultValue=5\n\
        [2000]\nParameterName=Gains\nObjectType=8\nDataType=8\nAccessType=rw\nCompactSubObj=3\n\
        [2001]\nParameterName=Odd\nObjectType=9\nSubNumber=2\n\
        [2001sub0]\nParameterName=n\nDataType=5\nAccessType=const\nDefaultValue=1\n\
        [2001sub1]\nParameterName=x\nDataType=0x0099\nAccessType=ro\n";
    let description = crate::parse(text).description;
    let written = write(&description);
    for part in [
        "fileCreationTime=\"14:05:00\"",
        "fileModificationTime=\"00:30:00\"",
        "<version versionType=\"HW\">1.0</version>",
        "<version versionType=\"SW\">2.1 &amp; more</version>",
        "<label lang=\"en\">CiA 406</label>",
        "<label lang=\"en\">one &lt;1&gt;</label>",
        "<array name=\"Gains\" uniqueID=\"UID_TYPE_2000\">",
        "<subrange lowerLimit=\"0\" upperLimit=\"3\"/>",
        "<varDeclaration name=\"Vendor\" uniqueID=\"UID_SUB_101801\">",
        "<dataTypeIDRef uniqueIDRef=\"UID_TYPE_1018\"/>",
        "dataType=\"0099\"",
    ] {
        assert!(written.contains(part), "{part}\n{written}");
    }
    // The list has no type with a member of an unknown type.
    assert!(!written.contains("UID_TYPE_2001"));
    let again = crate::parse(&written).description;
    assert_eq!(again.objects, description.objects);
    for (section, key) in [
        ("FileInfo", "FileRevision"),
        ("FileInfo", "CreationTime"),
        ("FileInfo", "ModificationTime"),
        ("Comments", "Lines"),
        ("Comments", "Line1"),
    ] {
        let [before, after] = [&description, &again].map(|one| value(one, section, key));
        assert_eq!(before, after, "{key}");
    }
}

#[test]
fn an_unknown_type_is_kept() {
    for data_type in ["0x21478", "0x123456789ABCDEF01", "MINE"] {
        let text = format!(
            "[1018]\nParameterName=Identity\nObjectType=9\nSubNumber=2\n\
            [1018sub0]\nParameterName=n\nDataType=5\nAccessType=const\nDefaultValue=1\n\
            [1018sub1]\nParameterName=x\nDataType={data_type}\nAccessType=ro\n"
        );
        let description = crate::parse(&text).description;
        let again = crate::parse(&write(&description)).description;
        assert_eq!(again.objects, description.objects, "{data_type}");
    }
}
