//! Rules whose codes begin with 12: nodes of a network that do not fit together, and networks that cannot be read.

catalogue! {
    nodes E1201 (example)
    nodes E1202 (example)
    nodes W1203 (example)
    nodes E1204 (example)
    nodes W1205 (example)
    nodes W1206 (example)
    list W1207 (example)
    project W1208 (example)
    project E1209 (example)
    nodes E1210 (example)
    project W1211 (example)
    project E1212 (example)
    project W1213 (example)
    project E1214 (example)
    project W1215 (example)
    reading E1216 (example)
    reading E1217 (example)
    reading E1218 (example)
}

pub(crate) mod list;
pub(crate) mod nodes;
pub(crate) mod project;
pub(crate) mod reading;
