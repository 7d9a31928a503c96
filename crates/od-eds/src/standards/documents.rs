//! The objects that the documents of CiA define, and whether odkit has a row for them: a list beside the tables, so
//! that a row cannot be lost, and an object without a row has its reason.

use alloc::vec::Vec;

use super::{cia301, profile_name, rows};

/// A range of objects of a document: first and last index, and the reason why the tables do not have it; empty if
/// they do.
type Listed = (u16, u16, &'static str);

/// The tables in which the objects of a document are.
struct Document {
    name: &'static str,
    /// Number of the device profile; 0 for the tables of CiA 301 and CiA 302.
    profile: u16,
    objects: &'static [Listed],
}

const SDO_MANAGER: &str = "only an SDO manager has it, and no tool for device files reads one";
const NO_FILE: &str = "no device file is known that has it, so no finding about it could be judged";

#[rustfmt::skip]
const DOCUMENTS: &[Document] = &[
    Document { name: "CiA 301", profile: 0, objects: &[
        (0x1000, 0x1003, ""), (0x1005, 0x100A, ""), (0x100C, 0x100D, ""), (0x1010, 0x1019, ""),
        (0x1020, 0x1029, ""), (0x1200, 0x12FF, ""), (0x1400, 0x1BFF, ""), (0x1FA0, 0x1FFF, ""),
    ] },
    Document { name: "CiA 302-2", profile: 0, objects: &[
        (0x102A, 0x102A, ""), (0x1F80, 0x1F8A, ""), (0x1F90, 0x1F91, ""),
    ] },
    Document { name: "CiA 302-3", profile: 0, objects: &[
        (0x1F20, 0x1F27, ""), (0x1F50, 0x1F51, ""), (0x1F52, 0x1F52, NO_FILE), (0x1F53, 0x1F57, ""),
        (0x1F58, 0x1F58, "the program of an NMT slave: master.dcf of dcfgen has it, with an access of its own"),
    ] },
    Document { name: "CiA 302-4", profile: 0, objects: &[
        (0xA000, 0xAFFF, "network variables: a programmable device describes them by [DynamicChannels]"),
    ] },
    Document { name: "CiA 302-5", profile: 0, objects: &[(0x1F00, 0x1F11, SDO_MANAGER)] },
    Document { name: "CiA 302-6", profile: 0, objects: &[(0x1F60, 0x1F60, NO_FILE)] },
    Document { name: "CiA 302-7", profile: 0, objects: &[(0x1F2C, 0x1F2F, NO_FILE)] },
    // CiA 303 is about cables, units and indicators, and CiA 305 about LSS: they define no object. The units of
    // CiA 303-2 are in meanings.rs, the LSS address of CiA 305 is 1018h.
    Document { name: "CiA 303", profile: 0, objects: &[] },
    Document { name: "CiA 305", profile: 0, objects: &[] },
    Document { name: "CiA 401", profile: 401, objects: &[
        (0x6000, 0x6000, ""), (0x6002, 0x6003, ""), (0x6005, 0x6008, ""), (0x6020, 0x6027, ""),
        (0x6030, 0x603F, ""), (0x6050, 0x6057, ""), (0x6060, 0x6067, ""), (0x6070, 0x6077, ""),
        (0x6100, 0x6100, ""), (0x6102, 0x6103, ""), (0x6106, 0x6108, ""),
        (0x6120, 0x6120, ""), (0x6122, 0x6123, ""), (0x6126, 0x6128, ""),
        (0x6200, 0x6200, ""), (0x6202, 0x6202, ""), (0x6206, 0x6208, ""), (0x6220, 0x6227, ""),
        (0x6240, 0x6247, ""), (0x6250, 0x6257, ""), (0x6260, 0x6267, ""), (0x6270, 0x6277, ""),
        (0x6300, 0x6300, ""), (0x6302, 0x6302, ""), (0x6306, 0x6308, ""),
        (0x6320, 0x6320, ""), (0x6322, 0x6322, ""), (0x6326, 0x6328, ""),
        (0x6400, 0x6404, ""), (0x6410, 0x6414, ""), (0x6421, 0x6432, ""), (0x6441, 0x6447, ""),
        (0x6450, 0x6450, ""),
    ] },
    Document { name: "CiA 402", profile: 402, objects: &[
        (0x6007, 0x6007, ""), (0x603F, 0x6044, ""), (0x6046, 0x605E, ""), (0x6060, 0x609A, ""),
        (0x60A2, 0x60A4, ""), (0x60A8, 0x60AB, ""), (0x60B0, 0x60B2, ""), (0x60B8, 0x60BD, ""),
        (0x60C0, 0x60C6, ""), (0x60D0, 0x60DA, ""), (0x60E0, 0x60E1, ""), (0x60E3, 0x60EE, ""),
        (0x60F2, 0x60F2, ""), (0x60F4, 0x60F4, ""), (0x60F6, 0x60F6, ""), (0x60F8, 0x60FF, ""),
        (0x6402, 0x6407, ""), (0x6410, 0x6410, ""), (0x6502, 0x6505, ""), (0x6510, 0x6510, ""),
        (0x67FE, 0x67FE, "the version of the document; devices use the index for another object"),
        (0x67FF, 0x67FF, ""),
    ] },
    Document { name: "CiA 404", profile: 404, objects: &[
        (0x6100, 0x6100, ""), (0x6110, 0x6114, ""), (0x6120, 0x6127, ""), (0x6130, 0x6136, ""),
        (0x6148, 0x6149, ""), (0x6150, 0x6150, ""), (0x61A0, 0x61A1, ""), (0x6300, 0x6302, ""), (0x6310, 0x6310, ""),
        (0x6320, 0x6321, ""), (0x6330, 0x6330, ""), (0x6340, 0x6341, ""),
        (0x6400, 0x64FF, "controllers: no device file is known that has one"),
        (0x6500, 0x65FF, "alarms: no device file is known that has one"),
        (0x7100, 0x7100, ""), (0x7120, 0x7124, ""), (0x7130, 0x7130, ""), (0x7133, 0x7136, ""),
        (0x7148, 0x7149, ""), (0x7300, 0x7300, ""), (0x7320, 0x7321, ""), (0x7330, 0x7330, ""),
        (0x7341, 0x7341, ""),
        (0x8100, 0x8100, ""), (0x8120, 0x8124, ""), (0x8130, 0x8130, ""), (0x8133, 0x8136, ""),
        (0x8148, 0x8149, ""), (0x8300, 0x8300, ""), (0x8320, 0x8321, ""), (0x8330, 0x8330, ""),
        (0x8341, 0x8341, ""),
        (0x9100, 0x9100, ""), (0x9120, 0x9124, ""), (0x9130, 0x9130, ""), (0x9133, 0x9136, ""),
        (0x9148, 0x9149, ""), (0x9300, 0x9300, ""), (0x9320, 0x9321, ""), (0x9330, 0x9330, ""),
        (0x9341, 0x9341, ""),
    ] },
    Document { name: "CiA 406", profile: 406, objects: &[
        (0x6000, 0x6005, ""), (0x6008, 0x6009, ""), (0x600C, 0x600C, ""), (0x6010, 0x6010, ""),
        (0x6020, 0x6020, ""), (0x6030, 0x6030, ""), (0x6040, 0x6040, ""), (0x6050, 0x6050, ""),
        (0x6200, 0x6200, ""), (0x6300, 0x6302, ""), (0x6310, 0x6317, ""), (0x6320, 0x6327, ""),
        (0x6330, 0x6337, ""), (0x6400, 0x6402, ""), (0x6500, 0x650C, ""),
        (0x650D, 0x650E, NO_FILE),
    ] },
];

/// Whether the tables have an object.
fn has(profile: u16, index: u16) -> bool {
    match profile {
        0 => cia301::of(index).is_some(),
        profile => profile_name(profile, index).is_some(),
    }
}

#[test]
fn each_object_of_a_document_has_a_row_or_a_reason() {
    for document in DOCUMENTS {
        for (first, last, reason) in document.objects {
            for index in *first..=*last {
                let name = document.name;
                match (has(document.profile, index), reason.is_empty()) {
                    (false, true) => panic!(
                        "{name}: {index:04X}h has no row in src/standards; write one, or the reason in DOCUMENTS"
                    ),
                    (true, false) => panic!(
                        "{name}: {index:04X}h has a row in src/standards; remove its reason from DOCUMENTS"
                    ),
                    _ => {}
                }
            }
        }
    }
}

#[test]
fn each_row_is_an_object_of_a_document() {
    for profile in [0, 401, 402, 404, 406] {
        let own = DOCUMENTS.iter().filter(|one| one.profile == profile);
        let listed: Vec<&Listed> = own.flat_map(|one| one.objects).collect();
        let ranges: Vec<(u16, u16)> = match profile {
            0 => cia301::tests::ranges().collect(),
            profile => rows(profile).map(|row| (row.first, row.last)).collect(),
        };
        for (first, last) in ranges {
            for index in first..=last {
                let is_here = |(first, last, _): &&&Listed| (*first..=*last).contains(&index);
                assert!(
                    listed.iter().any(|listed| is_here(&listed)),
                    "{index:04X}h has a row, but DOCUMENTS does not list it (profile {profile}); 0: CiA 301, 302"
                );
            }
        }
    }
}
