//! `odkit export`.

use crate::support::{file, odkit};

#[test]
fn an_exported_device_has_no_findings_and_exports_to_itself() {
    for device in od_devices::DEVICES {
        let export = odkit(&["export", device.name], "");
        assert_eq!((export.code, export.err.as_str()), (0, ""));
        let path = file(&od_devices::text::eds_name(device), &export.out)
            .display()
            .to_string();
        let check = odkit(&["check", &path], "");
        assert_eq!(check.code, 0, "{}", check.out);
        assert_eq!(check.out, "1 file checked: nothing to report\n");
        let again = odkit(&["export", &path], "");
        assert_eq!((again.code, again.out), (0, export.out));
    }
}

#[test]
fn values_that_cannot_be_read_keep_their_text() {
    let text = "[2000]\nParameterName=Gain\nDataType=0x0005\nAccessType=rw\nDefaultValue=red\n";
    let path = file("red.eds", text).display().to_string();
    let export = odkit(&["export", &path], "");
    assert_eq!(export.code, 0);
    assert!(export.out.contains("DefaultValue=red\n"), "{}", export.out);
    assert!(export.err.contains("E0412"), "{}", export.err);
}

#[test]
fn a_file_is_written_or_the_reason_is_reported() {
    let path = file("out.eds", "").display().to_string();
    let export = odkit(&["export", "gxam", "--output", &path], "");
    assert_eq!((export.code, export.out.as_str()), (0, ""));
    let written = std::fs::read_to_string(&path).unwrap();
    assert!(written.contains("ProductName=GXAM\n"));
    let export = odkit(&["export", "gxam", "-o", &format!("{path}/x.eds")], "");
    assert_eq!(export.code, 1);
    assert!(
        export.err.contains("x.eds cannot be written"),
        "{}",
        export.err
    );
    let export = odkit(
        &["export", &file("empty.eds", "").display().to_string()],
        "",
    );
    assert_eq!(export.code, 1);
    assert!(
        export.err.contains("does not define any object"),
        "{}",
        export.err
    );
}
