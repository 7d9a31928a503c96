//! `OD.h`: counters, the types of the variables, and a shortcut to each object.

use alloc::format;
use alloc::string::String;
use alloc::vec::Vec;
use core::fmt::Write;

use super::plan::{Planned, Shape, is_array};
use super::source::{RULER, TITLE, chapter, groups};
use crate::convert::c_header::comment;
use crate::description::Description;
use od_model::ObjectCode;

/// Counters of CANopenNode, with the first and last index that each one counts.
const COUNTERS: [(&str, u16, u16); 15] = [
    ("NMT", 0x1000, 0x1000),
    ("EM", 0x1001, 0x1001),
    ("SYNC", 0x1005, 0x1005),
    ("SYNC_PROD", 0x1006, 0x1006),
    ("STORAGE", 0x1010, 0x1010),
    ("TIME", 0x1012, 0x1012),
    ("EM_PROD", 0x1014, 0x1014),
    ("HB_CONS", 0x1016, 0x1016),
    ("HB_PROD", 0x1017, 0x1017),
    ("SDO_SRV", 0x1200, 0x127F),
    ("SDO_CLI", 0x1280, 0x12FF),
    ("GFC", 0x1300, 0x1300),
    ("SRDO", 0x1301, 0x1340),
    ("RPDO", 0x1400, 0x15FF),
    ("TPDO", 0x1800, 0x19FF),
];

/// The fields of `CO_config_t` (CANopen.h) in their order: counters, objects (`H`), array lengths.
const CONFIG: &str = "NMT H1017 HB_CONS A1016 H1016 EM H1001 H1014 H1015 A1003 H1003 SDO_SRV H1200 \
    SDO_CLI H1280 TIME H1012 SYNC H1005 H1006 H1007 H1019 RPDO H1400 H1600 TPDO H1800 H1A00 LEDS GFC \
    H1300 SRDO H1301 H1381 H13FE H13FF LSS_SLV LSS_MST GTWA TRACE";

pub(super) fn write(
    description: &Description,
    objects: &[Planned],
    name: &str,
    (stem, file): (&str, &str),
) -> String {
    let mut out = String::new();
    // Writing to a String cannot fail, here and below.
    let _ = write!(
        out,
        "{TITLE}\n    DON'T EDIT THIS FILE MANUALLY !!!!\n{RULER}*\n\n"
    );
    out.push_str(&about(description, stem, file));
    let _ = write!(out, "{RULER}/\n\n#ifndef {name}_H\n#define {name}_H\n");
    out.push_str(chapter("Counters of OD objects").trim_start());
    for (label, first, last) in COUNTERS {
        let count = count(objects, first, last);
        if count > 0 {
            let _ = writeln!(out, "#define {name}_CNT_{label} {count}");
        }
    }
    let _ = write!(out, "\n{}", chapter("Sizes of OD arrays"));
    for (index, elements) in arrays(description, objects) {
        let _ = writeln!(out, "#define {name}_CNT_ARR_{index:04X} {elements}");
    }
    let _ = write!(out, "\n{}", chapter("OD data declaration of all groups"));
    declarations(&mut out, objects, name);
    let short = |object: &Planned| format!("{:04X}", object.index);
    for (title, of) in [
        ("shortcuts", &short as &dyn Fn(&Planned) -> String),
        ("shortcuts with names", &|object| object.name.clone()),
    ] {
        let title = format!("Object dictionary entries - {title}");
        let _ = write!(out, "\n{}", chapter(&title));
        for (at, object) in objects.iter().enumerate() {
            let _ = writeln!(
                out,
                "#define {name}_ENTRY_H{} &{name}->list[{at}]",
                of(object)
            );
        }
    }
    let _ = write!(out, "\n{}", chapter("OD config structure"));
    config(&mut out, description, objects, name);
    let _ = writeln!(out, "\n#endif /* {name}_H */");
    out
}

fn count(objects: &[Planned], first: u16, last: u16) -> usize {
    let counted = objects.iter();
    counted
        .filter(|object| (first..=last).contains(&object.index))
        .count()
}

/// The arrays with their numbers of elements, including those that became records.
fn arrays(description: &Description, objects: &[Planned]) -> Vec<(u16, usize)> {
    let code = |object: &&Planned| {
        let described = description.objects.get(&object.index);
        let code = described.map_or(ObjectCode::Var, |described| *described.code);
        object.shape != Shape::Var && is_array(object.index, code)
    };
    let arrays = objects.iter().filter(code);
    arrays
        .map(|object| (object.index, object.elements().len()))
        .collect()
}

fn about(description: &Description, stem: &str, file: &str) -> String {
    let key = |section: &str, key: &str| {
        let value = description
            .section(section)
            .and_then(|found| found.get(key));
        value.map_or(String::new(), |value| comment(value.trim()))
    };
    let info = |name: &str| key("FileInfo", name);
    let device = |name: &str| key("DeviceInfo", name);
    let made = |what: &str| {
        let (date, time) = (info(&format!("{what}Date")), info(&format!("{what}Time")));
        format!("{date} {time}").trim_end().into()
    };
    let lines: [(&str, String); 12] = [
        ("File Names:   ", format!("{stem}.h; {stem}.c")),
        ("Project File: ", comment(file)),
        ("File Version: ", info("FileVersion")),
        ("Created:      ", made("Creation")),
        ("Created By:   ", info("CreatedBy")),
        ("Modified:     ", made("Modification")),
        ("Modified By:  ", info("ModifiedBy")),
        ("Vendor Name:  ", device("VendorName")),
        ("Vendor ID:    ", device("VendorNumber")),
        ("Product Name: ", device("ProductName")),
        ("Product ID:   ", device("ProductNumber")),
        ("Description:  ", info("Description")),
    ];
    let mut out = String::from("    File info:\n");
    for (at, (title, value)) in lines.iter().enumerate() {
        match at {
            3 | 11 => out.push('\n'),
            7 => out.push_str("\n    Device Info:\n"),
            _ => {}
        }
        let line = format!("        {title}{value}");
        let _ = writeln!(out, "{}", line.trim_end());
    }
    out
}

fn declarations(out: &mut String, objects: &[Planned], name: &str) {
    let groups = groups(objects);
    for group in &groups {
        let _ = writeln!(out, "typedef struct {{");
        for object in objects.iter().filter(|object| object.group == *group) {
            declaration(out, object, name);
        }
        let _ = writeln!(out, "}} {name}_{group}_t;\n");
    }
    for group in &groups {
        let _ = writeln!(
            out,
            "#ifndef {name}_ATTR_{group}\n#define {name}_ATTR_{group}\n#endif\n\
             extern {name}_ATTR_{group} {name}_{group}_t {name}_{group};\n"
        );
    }
    let _ = writeln!(
        out,
        "#ifndef {name}_ATTR_OD\n#define {name}_ATTR_OD\n#endif\nextern {name}_ATTR_OD OD_t *{name};"
    );
}

fn declaration(out: &mut String, object: &Planned, dictionary: &str) {
    let Planned { index, name, .. } = object;
    let mut stored = object.members.iter().filter(|one| one.data.first.is_some());
    match object.shape {
        Shape::Var => {
            for one in stored.take(1) {
                let (c_type, array) = (one.data.c_type, one.data.array());
                let _ = writeln!(out, "    {c_type} x{name}{array};");
            }
        }
        Shape::Array => {
            let _ = writeln!(out, "    uint8_t x{name}_sub0;");
            if let Some(one) = stored.nth(1) {
                let (c_type, array) = (one.data.c_type, one.data.array());
                let length = format!("{dictionary}_CNT_ARR_{index:04X}");
                let _ = writeln!(out, "    {c_type} x{name}[{length}]{array};");
            }
        }
        Shape::Record => {
            let members = stored.map(|one| {
                let (c_type, array) = (one.data.c_type, one.data.array());
                format!("        {c_type} {}{array};\n", one.name)
            });
            let members: String = members.collect();
            if !members.is_empty() {
                let _ = writeln!(out, "    struct {{\n{members}    }} x{name};");
            }
        }
    }
}

fn config(out: &mut String, description: &Description, objects: &[Planned], name: &str) {
    let _ = writeln!(
        out,
        "#ifdef CO_MULTIPLE_OD\n#define {name}_INIT_CONFIG(config) {{\\"
    );
    let arrays = arrays(description, objects);
    for field in CONFIG.split(' ') {
        let index = field
            .get(1..)
            .and_then(|hex| u16::from_str_radix(hex, 16).ok());
        let (field, value, has, none) = match (field.as_bytes()[0], index) {
            (b'H', Some(index)) => {
                let has = objects.iter().any(|object| object.index == index);
                (
                    format!("ENTRY_{field}"),
                    format!("ENTRY_{field}"),
                    has,
                    "NULL",
                )
            }
            (b'A', Some(index)) => {
                let has = arrays.iter().any(|(own, _)| *own == index);
                let own = format!("CNT_ARR_{index:04X}");
                (own.clone(), own, has, "0")
            }
            _ => {
                let counter = COUNTERS.iter().find(|(label, ..)| *label == field);
                let has = counter.is_some_and(|(_, first, last)| count(objects, *first, *last) > 0);
                (format!("CNT_{field}"), format!("CNT_{field}"), has, "0")
            }
        };
        let value = if has {
            format!("{name}_{value}")
        } else {
            none.into()
        };
        let _ = writeln!(out, "    (config).{field} = {value};\\");
    }
    out.push_str("}\n#endif\n");
}
