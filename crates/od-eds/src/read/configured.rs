//! Keys and sections of a configured device in the file of a type of device, and the one that a configured device lacks.

use crate::log::Log;
use crate::rules::lists::reader::{w0217_dcf_key, w0217_dcf_section};
use crate::rules::lists::w0216_mandatory_key_missing::w0216_last_eds_missing;
use crate::rules::standard::reader::w0658_commissioning_missing;
use crate::scan::names::{Compact, Place, place};
use crate::scan::section::TextSection;

/// The two kinds of files of one standard, by the ends of their names, and the keys of objects that only the second has.
pub(crate) struct Kinds {
    of_type: &'static str,
    of_device: &'static str,
    /// Each as odkit names it, and as the file does.
    keys: &'static [(&'static str, &'static str)],
}

/// EDS and DCF (CiA 306-1).
pub(crate) const EDS: Kinds = Kinds {
    of_type: ".eds",
    of_device: ".dcf",
    keys: &[
        ("ParameterValue", "ParameterValue"),
        ("Denotation", "Denotation"),
        ("UploadFile", "UploadFile"),
        ("DownloadFile", "DownloadFile"),
        ("ParamRefd", "ParamRefd"),
    ],
};

/// XDD and XDC (CiA 311).
#[cfg(feature = "xdd")]
pub(crate) const XDD: Kinds = Kinds {
    of_type: ".xdd",
    of_device: ".xdc",
    keys: &[("ParameterValue", "actualValue")],
};

/// Sections that only the file of a configured device has.
const SECTIONS: [&str; 3] = [
    "DeviceComissioning",
    "DeviceCommissioning",
    "ConnectedModules",
];

/// Reports what only a configured device has if the file is that of a type, and the missing commissioning if it is
/// that of a device: by its name on the disk, otherwise by FileName.
pub(crate) fn check(
    sections: &[TextSection<'_>],
    file: Option<&str>,
    kinds: &'static Kinds,
    log: &mut Log,
) {
    let find = |name: &str| {
        let mut all = sections.iter();
        all.find(|section| section.name.eq_ignore_ascii_case(name))
    };
    let info = find("FileInfo");
    let name = info.and_then(|info| info.get("FileName"));
    let name = file.or(name.map(|name| &*name.value)).unwrap_or_default();
    let ends = name.len().checked_sub(4).and_then(|at| name.get(at..));
    let is = |kind: &str| ends.is_some_and(|ends| ends.eq_ignore_ascii_case(kind));
    let is_xml = kinds.of_type == ".xdd";
    if is(kinds.of_device) {
        if SECTIONS[..2].iter().all(|name| find(name).is_none()) {
            log.push(w0658_commissioning_missing(is_xml));
        }
        // An XDC has no place for the name of its XDD.
        if !is_xml && let Some(info) = info.filter(|info| info.get("LastEDS").is_none()) {
            log.push(w0216_last_eds_missing(info.header));
        }
    }
    if !is(kinds.of_type) {
        return;
    }
    for section in sections {
        let name = &section.name;
        if name.eq_ignore_ascii_case("FileInfo") {
            let mut keys = section.pairs.iter();
            let last =
                keys.find(|(key, value)| key.eq_ignore_ascii_case("LastEDS") && !value.is_empty());
            last.iter()
                .for_each(|(key, _)| log.push(w0217_dcf_key(key.span, key, false)));
        }
        match place(name) {
            Place::Object(_) | Place::Member(..) => {
                for (key, _) in section.pairs.iter().filter(|(_, value)| !value.is_empty()) {
                    let mut known = kinds.keys.iter();
                    let own = known.find(|(known, _)| known.eq_ignore_ascii_case(key));
                    if let Some((_, named)) = own {
                        log.push(w0217_dcf_key(key.span, named, is_xml));
                    }
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
                log.push(if is_xml {
                    w0217_dcf_key(section.header, "deviceCommissioning", true)
                } else {
                    w0217_dcf_section(section.header, name)
                });
            }
            _ => {}
        }
    }
}
