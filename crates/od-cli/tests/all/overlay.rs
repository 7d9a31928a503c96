//! `base.eds+variant.eds` in place of a device.

use std::fs;

use crate::support::{file, folder, odkit, repository};

const VARIANT: &str = "\
; a coarse one without customer data
[1008]
DefaultValue=MINE
[6001]
DefaultValue=0x1000
[2300]
Remove=1
[5000]
ParameterName=Lamp
DataType=0x0005
AccessType=rw
DefaultValue=1
";

#[test]
fn a_variant_is_a_file_of_differences() {
    let variant = file("variant.overlay", VARIANT).display().to_string();
    let name = format!("gxmm+{variant}");
    let diff = odkit(&["diff", "gxmm", &name], "");
    assert_eq!(diff.code, 0, "{}", diff.err);
    for line in [" ~ 1008h", "!- 2300h", " + 5000h", " ~ 6001h"] {
        assert!(diff.out.contains(line), "{line}\n{}", diff.out);
    }
    assert!(
        diff.out.contains("4 differences, 1 breaking"),
        "{}",
        diff.out
    );
    assert_eq!(odkit(&["check", &name], "").code, 0);
    let script =
        format!("device {name}\nexpect 701#00\nsdo read 5000h = 1\nsdo read 6001h = 4096\n");
    let run = odkit(&["run", "-"], &script);
    assert_eq!(run.code, 0, "{}", run.err);
    let export = odkit(&["export", &name], "");
    let path = file("variant.eds", &export.out).display().to_string();
    let same = odkit(&["diff", &name, &path, "--fail-on", "any"], "");
    assert_eq!(same.code, 0, "{}", same.out);
}

#[test]
fn findings_are_in_the_file_that_they_are_about() {
    let base = repository("devices/eds/GXMM.eds");
    let wrong = file(
        "wrong.overlay",
        "; x\n[5000]\nParameterName=Lamp\nDataType=0x0005\nDefaultValue=300\n",
    );
    let wrong = wrong.display().to_string();
    let check = odkit(&["check", &format!("{base}+{wrong}")], "");
    assert_eq!(check.code, 1);
    assert!(
        check.out.contains(&format!("{wrong}:5:14")),
        "{}",
        check.out
    );
    let gone = file("gone.overlay", "[5001]\nRemove=1\n")
        .display()
        .to_string();
    let check = odkit(&["dump", &format!("{base}+{gone}")], "");
    assert_eq!(check.code, 1);
    assert!(
        check.err.contains("section [5001] to remove is missing"),
        "{}",
        check.err
    );
    assert!(check.err.contains("gone.overlay:1"), "{}", check.err);
    let nowhere = odkit(&["dump", "gxmm+nowhere.overlay"], "");
    assert!(nowhere.err.contains("nowhere.overlay"), "{}", nowhere.err);
}

#[test]
fn an_overlay_alone_names_its_base() {
    let folder = folder("overlay-alone", &[]);
    fs::copy(repository("devices/eds/GXMM.eds"), folder.join("a.eds")).expect("a file");
    let write = |name: &str, text: &str| {
        let path = folder.join(name);
        fs::write(&path, text).expect("a file");
        path.display().to_string()
    };
    // The only EDS of the folder.
    let plain = write("plain.overlay", "[6001]\nDefaultValue=abc\n");
    let check = odkit(&["check", &plain], "");
    assert_eq!(check.code, 1, "{}", check.out);
    assert!(check.out.contains("plain.overlay:2:14"), "{}", check.out);
    write(
        "b.eds",
        "[1000]\nParameterName=x\nDataType=7\nAccessType=ro\n",
    );
    let check = odkit(&["check", &plain], "");
    let said =
        format!("odkit: {plain}: an overlay needs a base; add a first line `;odkit-base=my.eds`");
    assert_eq!(check.err.lines().last(), Some(&*said));
    let named = write(
        "named.overlay",
        ";odkit-base=a.eds\n[6001]\nDefaultValue=0x1000\n",
    );
    assert_eq!(odkit(&["check", &named], "").code, 0);
    let diff = odkit(
        &["diff", &folder.join("a.eds").display().to_string(), &named],
        "",
    );
    assert!(diff.out.contains(" ~ 6001h"), "{}{}", diff.out, diff.err);
    let own = write("own.overlay", ";odkit-base=own.overlay\n[6001]\n");
    let check = odkit(&["check", &own], "");
    assert_eq!(check.code, 1);
    assert!(check.err.contains("name an EDS or a DCF"), "{}", check.err);
    let gone = write("gone.overlay", ";odkit-base=none.eds\n[6001]\n");
    let check = odkit(&["check", &gone], "");
    assert!(check.err.contains("line 1: the base "), "{}", check.err);
    assert!(
        check.err.contains("none.eds does not exist"),
        "{}",
        check.err
    );
}
