//! For each EDS file of the project, the macro at compile time and `od-model` at run time make the
//! same dictionary from the same text, compared object by object.
//!
//! A file without a line below fails [`no_file_is_forgotten`].

use std::collections::BTreeSet;
use std::path::Path;

use od_eds::Tables;
use od_model::{Dictionary, Object};
use odkit::object_dictionary;

/// `module: "path from this folder"`, one line a file.
macro_rules! files {
    ($($name:ident: $path:literal,)*) => {
        $(object_dictionary! { mod $name { eds = $path; warnings = off; } })*

        const FILES: &[&str] = &[$($path),*];

        $(#[test]
        fn $name() {
            equal(self::$name::DICTIONARY, include_bytes!($path));
        })*
    };
}

files! {
    small: "../eds/small.eds",
    services: "../eds/services.eds",
    gxmm: "../../devices/eds/GXMM.eds",
    eam_mt: "../../devices/eds/EAM_MT.eds",
    en580c: "../../devices/eds/EN580C.eds",
    io: "../../devices/eds/IO.eds",
    drive: "../../devices/eds/DRIVE.eds",
}

#[track_caller]
fn equal(compiled: Dictionary<'_>, file: &[u8]) {
    let parsed = od_eds::parse(&od_eds::decode(file));
    let tables = Tables::new(&parsed.description);
    let loaded = tables.dictionary();
    let count = parsed.description.objects.len();
    assert!(count > 3, "{count} objects: the file was not understood");
    assert_eq!(compiled.objects().len(), count);
    for (a, b) in compiled.objects().zip(loaded.objects()) {
        let shown = |d: &Dictionary<'_>, o: Object| {
            format!("{:#?}", (o, d.members(&o).collect::<Vec<_>>()))
        };
        assert_eq!((a.index, a.code, a.count), (b.index, b.code, b.count));
        assert_eq!(shown(&compiled, a), shown(&loaded, b));
    }
    assert_eq!(compiled, loaded);
    assert_eq!(compiled.store_len(), loaded.store_len());
}

#[test]
fn no_file_is_forgotten() {
    let here = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests");
    let listed: BTreeSet<_> = FILES
        .iter()
        .map(|path| here.join(path).canonicalize().unwrap())
        .collect();
    for folder in ["../eds", "../../devices/eds"] {
        for entry in here.join(folder).read_dir().into_iter().flatten() {
            let path = entry.unwrap().path().canonicalize().unwrap();
            let name = path.file_name().unwrap().to_string_lossy().into_owned();
            let described = matches!(name.rsplit('.').next(), Some("eds" | "dcf"));
            assert!(
                !described || listed.contains(&path),
                "give {name} its line in `files!` in {}",
                file!()
            );
        }
    }
}
