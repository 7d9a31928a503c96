//! Keys and sections of a DCF that are in an EDS, and the one that a DCF lacks.

use crate::log::Log;
use crate::rules::lists::reader::{w0217_dcf_key, w0217_dcf_section};
use crate::rules::standard::reader::w0658_commissioning_missing;
use crate::scan::names::{Compact, Place, place};
use crate::scan::section::TextSection;

/// Keys of objects that only a DCF has.
const KEYS: [&str; 5] = [
    "ParameterValue",
    "Denotation",
    "UploadFile",
    "DownloadFile",
    "ParamRefd",
];

/// Sections that only a DCF has.
const SECTIONS: [&str; 3] = [
    "DeviceComissioning",
    "DeviceCommissioning",
    "ConnectedModules",
];

/// Reports keys and sections of a DCF if the file is an EDS, and the missing commissioning if it is a DCF: by its
/// name on the disk, otherwise by FileName.
pub(crate) fn check(sections: &[TextSection<'_>], file: Option<&str>, log: &mut Log) {
    let info = |section: &&TextSection<'_>| section.name.eq_ignore_ascii_case("FileInfo");
    let name = sections
        .iter()
        .find(info)
        .and_then(|info| info.get("FileName"));
    let name = file.or(name.map(|name| &*name.value)).unwrap_or_default();
    let ends = name.len().checked_sub(4).and_then(|at| name.get(at..));
    let is = |kind: &str| ends.is_some_and(|ends| ends.eq_ignore_ascii_case(kind));
    if is(".dcf") {
        let names = ["DeviceComissioning", "DeviceCommissioning"];
        let is_one = |section: &TextSection<'_>| {
            names
                .iter()
                .any(|name| section.name.eq_ignore_ascii_case(name))
        };
        if !sections.iter().any(is_one) {
            log.push(w0658_commissioning_missing());
        }
    }
    if !is(".eds") {
        return;
    }
    for section in sections {
        let name = &section.name;
        if name.eq_ignore_ascii_case("FileInfo") {
            let mut keys = section.pairs.iter();
            let last =
                keys.find(|(key, value)| key.eq_ignore_ascii_case("LastEDS") && !value.is_empty());
            last.iter()
                .for_each(|(key, _)| log.push(w0217_dcf_key(key)));
        }
        match place(name) {
            Place::Object(_) | Place::Member(..) => {
                let own = |key: &str| KEYS.iter().any(|known| known.eq_ignore_ascii_case(key));
                let keys = section.pairs.iter();
                for (key, _) in keys.filter(|(key, value)| own(key) && !value.is_empty()) {
                    log.push(w0217_dcf_key(key));
                }
            }
            Place::Compact(_, Compact::Value | Compact::Denotation) => {
                log.push(w0217_dcf_section(section.header, name));
            }
            Place::Other
                if SECTIONS
                    .iter()
                    .any(|known| name.eq_ignore_ascii_case(known)) =>
            {
                log.push(w0217_dcf_section(section.header, name));
            }
            _ => {}
        }
    }
}
