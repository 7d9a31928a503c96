//! The output of `odkit new`. `cargo xtask test --long` checks that it builds and runs.

use std::fs;
use std::path::{Path, PathBuf};

use crate::support::{file, fresh, odkit, read, repository};

#[test]
fn a_file_without_errors_is_copied_unchanged() {
    let eds = repository("devices/eds/GXMM.eds");
    let folder = fresh("new-encoder");
    let path = folder.display().to_string();
    let made = odkit(&["new", &eds, "--name", "my-encoder", "--path", &path], "");
    assert_eq!(made.code, 0, "{}", made.err);
    assert!(made.out.contains("cargo test"), "{}", made.out);
    let copy = read(&folder, "my-encoder.eds");
    assert_eq!(copy, fs::read_to_string(&eds).expect("the file"));
    let library = read(&folder, "src/lib.rs");
    assert!(library.contains("eds = \"../my-encoder.eds\""), "{library}");
    assert!(library.contains("my_encoder::dictionary"), "{library}");
    let script = read(&folder, "tests/scripts/boot-up.script");
    assert!(script.contains("expect 701#00"), "{script}");
    assert!(script.contains("sdo read 1000h:00 = 0x20196"), "{script}");
    for name in ["Cargo.toml", "README.md", "src/main.rs", "tests/scripts.rs"] {
        let text = read(&folder, name);
        assert!(
            !text.contains("{{") && !text.contains("}}"),
            "{name}\n{text}"
        );
    }
    let again = odkit(&["new", &eds, "--name", "my-encoder", "--path", &path], "");
    assert_eq!(again.code, 1);
    assert!(again.err.contains("not empty"), "{}", again.err);
}

const BROKEN: &str = "\
[DeviceInfo]
ProductName=Gate {{name}} \"7\"
[MandatoryObjects]
SupportedObjects=1
1=0x1001
[ManufacturerObjects]
SupportedObjects=2
1=0x2000
2=0x2001
[1001]
ParameterName=Error register
DataType=5
AccessType=rw
[2000]
ParameterName=Speed
DataType=5
AccessType=rw
DefaultValue=fast
LowLimit=9
HighLimit=3
[2001]
ParameterName=Nothing
AccessType=rw
";

#[test]
fn a_broken_file_is_fixed_and_each_change_is_listed() {
    let eds = file("broken-new.eds", BROKEN).display().to_string();
    let folder = fresh("new-broken");
    let path = folder.display().to_string();
    let arguments = ["new", &eds, "--name", "gate", "--path", &path, "--lossy"];
    let refused = odkit(&arguments[..6], "");
    assert_eq!(refused.code, 1, "{}", refused.err);
    for told in ["2001h: removed", "(E0401)", "lack 1 object", "`--lossy`"] {
        assert!(refused.err.contains(told), "{told}\n{}", refused.err);
    }
    assert!(!folder.exists());
    let made = odkit(&arguments, "");
    assert_eq!(made.code, 0, "{}", made.err);
    let readme = read(&folder, "README.md");
    for told in [
        "removed the invalid DefaultValue `fast`",
        "1000h: added",
        "2001h: removed",
    ] {
        assert!(readme.contains(told), "{told}\n{readme}");
        assert!(made.err.contains(told), "{told}\n{}", made.err);
    }
    let copy = folder.join("gate.eds").display().to_string();
    let check = odkit(&["check", &copy], "");
    assert_eq!(check.code, 0, "{}", check.out);
    assert!(read(&folder, "src/lib.rs").contains("\"Gate name 7\""));
}

#[test]
fn a_cob_id_that_no_device_may_use_is_made_not_valid() {
    let text = "[DeviceInfo]\nProductName=Sender\n[1800]\nParameterName=TPDO\nObjectType=0x9\nSubNumber=3\n\
                [1800sub0]\nParameterName=Count\nDataType=5\nAccessType=const\nDefaultValue=2\n\
                [1800sub2]\nParameterName=Type\nDataType=5\nAccessType=rw\nDefaultValue=255\n\
                [1800sub1]\nParameterName=COB-ID\nDataType=7\nAccessType=rw\nDefaultValue=$NODEID+0x790\n";
    let eds = file("new-cob-id.eds", text).display().to_string();
    let folder = fresh("new-cob-id");
    let path = folder.display().to_string();
    let made = odkit(&["new", &eds, "--name", "sender", "--path", &path], "");
    assert_eq!(made.code, 0, "{}", made.err);
    let copy = read(&folder, "sender.eds");
    assert!(copy.contains("DefaultValue=$NODEID+0x80000000"), "{copy}");
}

#[test]
fn a_fix_gives_the_access_of_the_standard_and_says_old_and_new() {
    let text = "[DeviceInfo]\nProductName=Valve\n\
                [1400]\nParameterName=RPDO\nObjectType=0x9\nSubNumber=3\n\
                [1400sub0]\nParameterName=Count\nDataType=5\nAccessType=const\nDefaultValue=2\n\
                [1400sub1]\nParameterName=COB-ID\nDataType=7\nAccessType=xx\nDefaultValue=$NODEID+0x680\n\
                [1400sub2]\nParameterName=Type\nDataType=5\nAccessType=rw\nDefaultValue=255\n\
                [1600]\nParameterName=Mapping\nObjectType=0x9\nSubNumber=2\n\
                [1600sub0]\nParameterName=Count\nDataType=5\nAccessType=rw\nDefaultValue=1\n\
                [1600sub1]\nParameterName=Entry\nDataType=7\nAccessType=rw\nDefaultValue=0x20000008\n\
                [2000]\nParameterName=Opening\nDataType=5\nAccessType=writable\nPDOMapping=1\n\
                [1010]\nParameterName=Save\nObjectType=0x8\nSubNumber=2\n\
                [1010sub0]\nParameterName=Count\nDataType=5\nAccessType=const\nDefaultValue=1\n\
                [1010sub1]\nParameterName=All\nDataType=7\nAccessType=ro\nDefaultValue=1\n";
    let eds = file("new-access.eds", text).display().to_string();
    let folder = fresh("new-access");
    let path = folder.display().to_string();
    let arguments = ["new", &eds, "--name", "valve", "--path", &path, "--strict"];
    let strict = odkit(&arguments, "");
    assert_eq!(strict.code, 1, "{}", strict.err);
    let told = strict.err.contains("1010h:01");
    assert!(told && !folder.exists(), "{}", strict.err);
    let made = odkit(&arguments[..6], "");
    assert_eq!(made.code, 0, "{}", made.err);
    let readme = read(&folder, "README.md");
    for told in [
        "2000h:00: AccessType not valid → rww",
        "1400h:01: AccessType not valid → rw",
        "DefaultValue $NODEID+0x680 → $NODEID+0x80000000 (W0520)",
        "## Still wrong",
        "(E0643)",
    ] {
        assert!(readme.contains(told), "{told}\n{readme}");
    }
    assert!(read(&folder, "Cargo.toml").contains("rust-version = \"1.89\""));
}

/// The section of a sub-object.
fn member(section: &str, name: &str, data_type: u8, value: &str) -> String {
    format!(
        "[{section}]\nParameterName={name}\nDataType={data_type}\nAccessType=rw\nDefaultValue={value}\n"
    )
}

#[test]
fn each_change_is_listed_with_old_and_new_and_leaves_nothing_wrong() {
    let text = [
        "[DeviceInfo]\nProductName=Gate\n",
        "[1800]\nParameterName=TPDO\nObjectType=9\nSubNumber=3\n",
        &member("1800sub0", "Count", 5, "2"),
        &member("1800sub1", "COB-ID", 7, "$NODEID+0x180"),
        &member("1800sub2", "Type", 6, "255"),
        // The first two entries are of objects that do not exist, the third one is right.
        "[1A00]\nParameterName=Mapping\nObjectType=9\nSubNumber=4\n",
        &member("1A00sub0", "Count", 5, "3"),
        &member("1A00sub1", "First", 7, "0x60410010"),
        &member("1A00sub2", "Second", 7, "0x60610008"),
        &member("1A00sub3", "Third", 7, "0x20000008"),
        "[2000]\nParameterName=Opening\nDataType=5\nAccessType=ro\nPDOMapping=1\n",
        // A count that is not a valid UNSIGNED8, and a value of a wrong type with a limit that is right.
        "[2001]\nParameterName=Speeds\nObjectType=8\nSubNumber=2\n",
        &member("2001sub0", "Count", 0x15, "1"),
        &member("2001sub1", "Speed", 6, "7"),
        "[1000]\nParameterName=Device type\nDataType=6\nAccessType=const\nDefaultValue=4\nHighLimit=9\n",
        "[1018]\nParameterName=Identity\nObjectType=9\nSubNumber=2\n",
        &member("1018sub0", "Count", 5, "3"),
        &member("1018sub3", "Revision number", 7, "0x10002"),
    ]
    .concat();
    let eds = file("new-each-change.eds", &text).display().to_string();
    let folder = fresh("new-each-change");
    let path = folder.display().to_string();
    let made = odkit(&["new", &eds, "--name", "gate", "--path", &path], "");
    assert_eq!(made.code, 0, "{}", made.err);
    let readme = read(&folder, "README.md");
    for told in [
        "1000h:00: DataType UNSIGNED16 → UNSIGNED32 (E0604)",
        "1018h:01: added (E0606)",
        "1800h:02: DataType UNSIGNED16 → UNSIGNED8 (E0509)",
        "1A00h:00: DefaultValue 3 → 0 (E0501)",
        "1A00h:01: DefaultValue 0x60410010 → 0 (E0501)",
        "1A00h:02: DefaultValue 0x60610008 → 0 (E0501)",
        "2001h:00: DataType INTEGER64 → UNSIGNED8 (E0309)",
    ] {
        assert!(readme.contains(told), "{told}\n{readme}");
    }
    assert!(!readme.contains(": changed"), "{readme}");
    assert!(!readme.contains("Still wrong"), "{readme}");
    let copy = read(&folder, "gate.eds");
    assert!(copy.contains("DefaultValue=0x20000008"), "{copy}");
    assert!(
        copy.contains("HighLimit=0x9") && copy.contains("=0x10002"),
        "{copy}"
    );
}

#[test]
fn a_merge_conflict_is_left_to_the_user() {
    let text = "[DeviceInfo]\nProductName=Two\n[2000]\nParameterName=T\nDataType=5\nAccessType=rw\n\
                <<<<<<< HEAD\nDefaultValue=5\n=======\nDefaultValue=6\n>>>>>>> other\n";
    let eds = file("new-merge.eds", text).display().to_string();
    let folder = fresh("new-merge");
    let path = folder.display().to_string();
    let made = odkit(&["new", &eds, "--name", "two", "--path", &path], "");
    assert_eq!(made.code, 1, "{}", made.err);
    assert!(
        made.err.contains("E0118") && made.err.contains("resolve the conflict"),
        "{}",
        made.err
    );
    assert!(!folder.exists());
}

#[test]
fn objects_that_the_node_does_not_serve_are_removed_in_the_call() {
    let text = "[DeviceInfo]\nProductName=Master\n[1005]\nParameterName=COB-ID SYNC\nDataType=7\n\
                AccessType=rw\nDefaultValue=0x40000080\n";
    let eds = file("new-unserved.eds", text).display().to_string();
    let folder = fresh("new-unserved");
    let path = folder.display().to_string();
    let made = odkit(&["new", &eds, "--name", "unserved", "--path", &path], "");
    assert_eq!(made.code, 0, "{}", made.err);
    let library = read(&folder, "src/lib.rs");
    let sync = "        modify 0x1005 { default = 0x00000080 }\n";
    assert!(library.contains(sync), "{library}");
}

#[test]
fn impossible_arguments_are_reported() {
    let eds = repository("devices/eds/GXMM.eds");
    for name in ["5x", "fn", "a b", "od-model"] {
        let run = odkit(&["new", &eds, "--name", name], "");
        assert_eq!(run.code, 2, "{name}");
        assert!(run.err.contains(name), "{}", run.err);
    }
    let empty = file("empty-new.eds", "").display().to_string();
    assert_eq!(odkit(&["new", &empty, "--name", "x1"], "").code, 1);
    // A folder that cannot be created: nothing is created.
    let path = format!("{empty}/x1");
    let run = odkit(&["new", &eds, "--path", &path], "");
    assert_eq!(run.code, 1);
    assert!(run.err.contains("x1"), "{}", run.err);
}

/// The EDS and DCF files of `tests/corpus`, or of the folder that `ODKIT_CORPUS` names.
fn corpus() -> Vec<PathBuf> {
    let given = std::env::var_os("ODKIT_CORPUS").map(PathBuf::from);
    let root = given.unwrap_or_else(|| PathBuf::from(repository("tests/corpus")));
    let is_text = |path: &PathBuf| {
        let ending = path.extension().and_then(|ending| ending.to_str());
        let ending = ending.unwrap_or_default().to_ascii_lowercase();
        matches!(ending.as_str(), "eds" | "dcf")
    };
    let mut files: Vec<PathBuf> = all_files(&root).into_iter().filter(is_text).collect();
    files.sort();
    assert!(
        files.len() >= 60,
        "{} files in {}",
        files.len(),
        root.display()
    );
    files
}

fn is_long() -> bool {
    std::env::var_os("ODKIT_LONG").is_some()
}

/// All files below a folder.
fn all_files(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    let paths = entries.map(|entry| entry.path());
    paths
        .flat_map(|path| {
            if path.is_dir() {
                all_files(&path)
            } else {
                vec![path]
            }
        })
        .collect()
}

/// A crate contains all that it needs, or depends on versions, or finds a checkout by a relative path.
#[test]
fn a_crate_finds_odkit_wherever_it_is() {
    let eds = repository("devices/eds/GXMM.eds");
    let root = repository("");
    let root = Path::new(&root).canonicalize().expect("the checkout");
    let made = |name: &str, more: &[&str]| {
        let folder = fresh(name);
        let path = folder.display().to_string();
        let arguments = [&["new", &eds, "--path", &path], more].concat();
        let made = odkit(&arguments, "");
        assert_eq!(made.code, 0, "{}", made.err);
        // No file contains the path of this test, and the name is that of the file.
        for file in all_files(&folder) {
            let text = String::from_utf8_lossy(&fs::read(&file).expect("a file")).into_owned();
            assert!(!text.contains(&root.display().to_string()), "{file:?}");
        }
        let manifest = read(&folder, "Cargo.toml");
        assert!(manifest.contains("name = \"gxmm\""), "{manifest}");
        (folder, manifest)
    };
    let (vendored, manifest) = made("new-vendored", &[]);
    assert!(
        manifest.contains("odkit = { path = 'vendor/odkit' }"),
        "{manifest}"
    );
    assert!(vendored.join("vendor/LICENSE-MIT").is_file());
    let (registry, manifest) = made("new-registry", &["--registry"]);
    assert!(manifest.contains("odkit = { version = \""), "{manifest}");
    assert!(!manifest.contains("vendor") && !registry.join("vendor").exists());
    let (checkout, manifest) = made("new-checkout", &["--odkit", &root.display().to_string()]);
    assert!(!checkout.join("vendor").exists());
    let line = manifest.lines().find(|line| line.starts_with("odkit = "));
    let path = line
        .and_then(|line| line.split('\'').nth(1))
        .expect("a path");
    assert!(path.starts_with("../"), "{manifest}");
    let there = checkout
        .join(path)
        .canonicalize()
        .expect("the way to odkit");
    assert_eq!(there, root.join("crates/odkit"));
    let path = fresh("new-nowhere").display().to_string();
    let wrong = odkit(&["new", &eds, "--path", &path, "--odkit", &eds], "");
    assert_eq!(wrong.code, 1);
    assert!(wrong.err.contains("no crate `odkit`"), "{}", wrong.err);
    assert!(!Path::new(&path).exists());
}

/// Every shipped file makes a crate whose EDS has no error that prevents a device.
#[test]
fn the_corpus_makes_crates() {
    let all = fresh("new-corpus");
    let files = corpus();
    for (number, path) in files.iter().enumerate() {
        let to = all.join(number.to_string()).display().to_string();
        let from = path.display().to_string();
        let arguments = [
            "new",
            &from,
            "--name",
            "real",
            "--path",
            &to,
            "--lossy",
            "--registry",
        ];
        let made = odkit(&arguments, "");
        assert_eq!(made.code, 0, "{from}: {}", made.err);
    }
    let check = odkit(
        &["check", "--format", "json", &all.display().to_string()],
        "",
    );
    let report: serde_json::Value = serde_json::from_str(&check.out).expect("JSON");
    let files = report["files"].as_array().expect("files");
    for finding in files
        .iter()
        .flat_map(|file| file["diagnostics"].as_array())
        .flatten()
    {
        let code = finding["code"].as_str().expect("a code");
        let rule = od_eds::check::rule(code).expect("a rule");
        // Errors that only concern a master stay: the vendor wrote them.
        assert!(
            finding["severity"] != "error" || rule.buildable,
            "{finding}"
        );
    }
}

/// A new crate does not depend on the command line, or on dependencies of it alone.
#[test]
fn a_new_crate_does_not_depend_on_the_command_line() {
    let folder = fresh("new-tree");
    make(&repository("devices/eds/GXMM.eds"), "tree", &folder, &[]);
    let tree = cargo(
        &folder,
        &[
            "tree",
            "--edges",
            "normal,build",
            "--prefix",
            "none",
            "--offline",
        ],
    );
    for name in ["od-sim", "od-model"] {
        assert!(tree.contains(&format!("{name} v")), "{name}\n{tree}");
    }
    for name in ["od-cli", "od-devices", "clap", "annotate-snippets"] {
        assert!(!tree.contains(&format!("{name} v")), "{name}\n{tree}");
    }
}

/// Creates a crate with the versions that this checkout was tested with and that are already
/// downloaded.
fn make(from: &str, name: &str, folder: &Path, more: &[&str]) {
    let to = folder.display().to_string();
    let arguments = [&["new", from, "--name", name, "--path", &to], more].concat();
    let made = odkit(&arguments, "");
    assert_eq!(made.code, 0, "{from}: {}", made.err);
    fs::copy(repository("Cargo.lock"), folder.join("Cargo.lock")).expect("a lock file");
}

/// Output of a successful cargo call in a crate.
fn cargo(folder: &Path, arguments: &[&str]) -> String {
    let cargo = std::process::Command::new(env!("CARGO"))
        .args(arguments)
        .env("CARGO_TARGET_DIR", target())
        .env("CARGO_PROFILE_DEV_DEBUG", "0")
        .current_dir(folder)
        .output()
        .expect("cargo starts");
    let out = String::from_utf8_lossy(&cargo.stdout);
    let err = String::from_utf8_lossy(&cargo.stderr);
    assert!(cargo.status.success(), "{}\n{out}{err}", folder.display());
    out.into_owned()
}

/// Target folder for new crates: that of this workspace, which has the dependencies.
fn target() -> &'static Path {
    let temporary = Path::new(env!("CARGO_TARGET_TMPDIR"));
    temporary.parent().unwrap_or(temporary)
}

/// Puts a crate in the place of another and uses its copies of odkit: they are then not built again,
/// since cargo identifies packages of a workspace by their path.
fn replace(place: &Path, folder: &Path) {
    for name in ["src", "tests"] {
        fs::remove_dir_all(place.join(name)).expect("a folder of the one before");
    }
    for file in fs::read_dir(folder).expect("the crate").flatten() {
        fs::rename(file.path(), place.join(file.file_name())).expect("a free place");
    }
    let manifest = place.join("Cargo.toml");
    let text = fs::read_to_string(&manifest).expect("the manifest");
    let inside = text.replace("../made/vendor", "vendor");
    let inside = inside.replace("[workspace]", "[workspace]\nexclude = [\"vendor\"]");
    assert!(inside.contains("'vendor/odkit'"), "{text}");
    fs::write(manifest, inside).expect("it is ours");
}

/// The text of an EDS with SYNC, which the node does not serve, and a second SDO server, which few nodes have.
fn producer(eds: &Path) -> String {
    let text = fs::read_to_string(eds).expect("the file");
    let produces = text.replacen("DefaultValue=0x80\n", "DefaultValue=0x40000080\n", 1);
    assert_ne!(produces, text);
    produces
        + "\n[1201]\nParameterName=SDO server\nObjectType=9\nSubNumber=1\n\
           [1201sub0]\nParameterName=Highest sub-index\nDataType=5\nAccessType=ro\nDefaultValue=2\n"
}

/// `cargo test` passes in a new crate: of an encoder and of a module, and in a long run also for twenty files of the corpus
/// and in the workspace of a firmware.
#[test]
fn a_new_crate_builds_and_its_tests_pass() {
    if !is_long() && std::env::var_os("CI").is_none() {
        println!("skipped: it builds odkit again; set CI=true or ODKIT_LONG=1");
        return;
    }
    let encoder = PathBuf::from(repository("devices/eds/GXMM.eds"));
    // Without a position the crate has another template.
    let module = PathBuf::from(repository("devices/eds/IO.eds"));
    let mut sources = vec![file("new-producer.eds", &producer(&encoder)), module];
    if is_long() {
        let files = corpus();
        let step = files.len() / 20;
        sources.extend(files.into_iter().step_by(step).take(20));
    }
    let all = fresh("new-crates");
    let place = all.join("made");
    let vendor = place.join("vendor").display().to_string();
    for (number, source) in sources.iter().enumerate() {
        let (source, name) = (source.display().to_string(), format!("made-{number}"));
        if number == 0 {
            make(&source, &name, &place, &[]);
        } else {
            let folder = all.join(&name);
            make(&source, &name, &folder, &["--odkit", &vendor]);
            replace(&place, &folder);
        }
        cargo(&place, &["test", "--quiet", "--offline"]);
    }
    if !is_long() {
        return;
    }
    // The simulation and the tests of a firmware; the lock file has the versions for all boards.
    let folder = all.join("workspace");
    let more = ["--firmware", "generic", "--odkit", &vendor];
    make("gxmm", "workspace", &folder, &more);
    let lock = repository("tests/boards/Cargo.lock");
    fs::copy(lock, folder.join("Cargo.lock")).expect("a lock file");
    cargo(&folder, &["test", "--quiet"]);
}
