//! Names that a user may expect although no handle has them: of objects with repeated names, and of keywords.
//!
//! Each becomes a deprecated item, so that the compiler reports the right name where it is written.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;

use crate::handles::Item;
use crate::names;

/// Writes the items for the objects of a module.
pub(crate) fn write(out: &mut String, items: &[Item]) {
    let mut wanted: BTreeMap<(bool, String), Vec<&Item>> = BTreeMap::new();
    for item in items {
        let name = item.near_name();
        let is_own = items
            .iter()
            .any(|other| other.is_module() == item.is_module() && other.name == name);
        if !is_own {
            let key = (item.is_module(), name);
            wanted.entry(key).or_default().push(item);
        }
    }
    for ((is_module, name), items) in wanted {
        let names: Vec<&str> = items.iter().map(|item| &*item.name).collect();
        let index = items.first().map_or(0, |item| item.index);
        let why = if names.len() > 1 {
            let count = names.len();
            format!("{count} objects have the name `{name}`")
        } else if names::is_keyword(&name) {
            format!("`{name}` is a keyword")
        } else {
            continue;
        };
        let shown: Vec<String> = names
            .iter()
            .take(3)
            .map(|name| format!("`{name}`"))
            .collect();
        let dots = if names.len() > 3 { " …" } else { "" };
        let shown = shown.join(" or ");
        let note =
            format!("{why}: write {shown}{dots}, or `rename 0x{index:04X} = …;` in the call");
        let item = format!("#[doc(hidden)] #[deprecated(note = {note:?})] pub");
        if !is_module {
            let _ = writeln!(out, "{item} const {name}: () = ();");
            continue;
        }
        let name = if names::is_keyword(&name) {
            format!("r#{name}")
        } else {
            name
        };
        // `self` and `crate` cannot be written at all.
        if syn::parse_str::<syn::Ident>(&name).is_err() {
            continue;
        }
        // The compiler reports the use of a deprecated constant, not that of its module.
        let members = items.iter().flat_map(|item| item.members());
        let members: BTreeSet<&str> = members.map(|handle| &*handle.name).collect();
        let _ = writeln!(out, "#[doc(hidden)] pub mod {name} {{");
        for member in members {
            let _ = writeln!(out, "{item} const {member}: () = ();");
        }
        out.push_str("}\n");
    }
}
