//! `include/odkit.h` must be what cbindgen makes of the sources.
//!
//! `ODKIT_ACCEPT=1 cargo test -p od-capi --test header` writes it again.

use std::fs;
use std::path::Path;

const HEAD: &str = "/* A CANopen node: odkit for C.
 *
 * Made by cbindgen; see crates/od-capi/tests/header.rs.
 *
 * Functions that return uint32_t return ODKIT_OK, an error of the call (ODKIT_NULL and so on), or an
 * SDO abort code of CiA 301 (0x05030000 and above).
 *
 * Each node of the program has a handle, the first argument of all functions: a macro of
 * odkit_objects.h, ODKIT_NODE of a library with one node.
 *
 * One thread at a time may call for a node; an interrupt or a thread that calls while another call is
 * not over gets ODKIT_BUSY, as long as that call is not inside a callback. Pointers are used during
 * the call only, but for the callbacks and the context of odkit_power_on.
 *
 * The library uses static memory only. If it finds an error in itself, it calls
 * `void odkit_panic(void)`, which the firmware defines and which must not return; a linker that drops
 * unused functions asks for it only if the library can get there.
 */";

const KEY: &str = "
/* An address as one number, for `switch (ODKIT_KEY(index, sub))` and `case ODKIT_KEY(OD_TEMPERATURE):`. Not in C89 and
 * C++98, which have no macros with a variable number of arguments; ODKIT_KEY_OF takes index and sub-index there. */
#if (defined(__STDC_VERSION__) && __STDC_VERSION__ >= 199901L) || (defined(__cplusplus) && __cplusplus >= 201103L)
#define ODKIT_KEY(...) ODKIT_KEY_OF(__VA_ARGS__)
#endif
#define ODKIT_KEY_OF(index, sub) ((uint32_t)(index) << 8 | (uint32_t)(sub))";

/// The functions are those in the body of `export!`.
fn source() -> String {
    let read = |name: &str| {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("src").join(name);
        fs::read_to_string(path).unwrap()
    };
    let export = read("export.rs");
    let (_, body) = export
        .split_once("// `tests/header.rs` reads what follows.")
        .unwrap();
    let body = body.trim_end().strip_suffix("};\n}").unwrap();
    let all = [
        read("answer.rs"),
        read("types.rs"),
        body.replace("$crate::types::", "").replace("$crate::", ""),
    ]
    .join("\n");
    // The comment of a whole file.
    let is_inner = |line: &&str| line.starts_with("//!") || line.starts_with("#![");
    let lines = all.lines().filter(|line| !is_inner(line));
    lines.collect::<Vec<_>>().join("\n")
}

fn header() -> String {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR"));
    let path = folder.join("edge.rs");
    fs::write(&path, source()).unwrap();
    let config = cbindgen::Config {
        language: cbindgen::Language::C,
        style: cbindgen::Style::Both,
        cpp_compat: true,
        header: Some(String::from(HEAD)),
        include_guard: Some(String::from("ODKIT_H")),
        no_includes: true,
        sys_includes: ["stdbool.h", "stddef.h", "stdint.h"]
            .map(String::from)
            .to_vec(),
        after_includes: Some(String::from(KEY)),
        usize_is_size_t: true,
        documentation_style: cbindgen::DocumentationStyle::C,
        line_length: 100,
        ..cbindgen::Config::default()
    };
    let bindings = cbindgen::Builder::new().with_config(config).with_src(path);
    let mut text = Vec::new();
    bindings.generate().unwrap().write(&mut text);
    // Comments that every C compiler accepts.
    let text = String::from_utf8(text).unwrap();
    text.replace("// __cplusplus", "/* __cplusplus */")
        .replace("// extern \"C\"", "/* extern \"C\" */")
}

#[test]
fn the_header_is_current() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("include/odkit.h");
    let made = header();
    if std::env::var_os("ODKIT_ACCEPT").is_some() {
        fs::write(&path, &made).unwrap();
    }
    let listed = fs::read_to_string(&path).unwrap_or_default();
    assert_eq!(
        listed, made,
        "ODKIT_ACCEPT=1 cargo test -p od-capi --test header renews it"
    );
    assert!(!made.contains("//"));
    // It contains every function of the macro.
    let source = source();
    let functions = source.split("extern \"C\" fn ").skip(1);
    let mut names = functions.filter_map(|text| text.split('(').next());
    assert!(names.clone().count() > 10);
    assert!(names.all(|name| made.contains(&format!(" {name}("))));
}
