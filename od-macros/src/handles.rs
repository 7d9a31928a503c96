//! Typed handles of a device, and their names.

use std::collections::{BTreeMap, BTreeSet};

use od_eds::patch;
use od_eds::patch::Target;
use od_eds::{Description, Spanned, Tables};
use od_model::{Access, DataType, Kind, Slot};
use proc_macro2::Ident;
use syn::ext::IdentExt;

use crate::files::Files;
use crate::input::{At, Statement};
use crate::report::Report;
use crate::{docs, names};

/// The item of one object in the module.
#[derive(Clone, PartialEq)]
pub(crate) struct Item {
    pub(crate) index: u16,
    /// The object's name in the description.
    label: String,
    pub(crate) name: String,
    pub(crate) doc: String,
    pub(crate) body: Body,
}

/// A constant, or a module of constants.
#[derive(Clone, PartialEq)]
pub(crate) enum Body {
    Value(Handle),
    Members(Vec<Handle>),
}

/// One constant.
#[derive(Clone, PartialEq)]
pub(crate) struct Handle {
    pub(crate) sub: u8,
    label: String,
    pub(crate) name: String,
    pub(crate) doc: String,
    pub(crate) data_type: DataType,
    pub(crate) access: Access,
    pub(crate) mappable: bool,
    pub(crate) slot: Slot,
    /// Whether the call gives its name.
    is_renamed: bool,
}

/// Names that the module needs for itself.
const CONSTANTS: [&str; 2] = ["DICTIONARY", "STORE_LEN"];

/// Input for names besides the description.
pub(crate) struct Naming<'a> {
    /// The EDS file, for the docs.
    pub(crate) files: Option<&'a Files>,
    /// The items of the family: a variant uses the same names for the items that it keeps.
    pub(crate) family: &'a [Item],
    /// Names that are taken: those of the variants.
    pub(crate) modules: BTreeSet<String>,
    /// The statements with the renames.
    pub(crate) statements: &'a [Statement],
}

/// The items for all values in `tables`; `description` has their names.
pub(crate) fn items(
    description: &Description,
    tables: &Tables,
    naming: &Naming<'_>,
    report: &mut Report,
) -> Vec<Item> {
    let mut items = Vec::new();
    let dictionary = tables.dictionary();
    for object in dictionary.objects() {
        let Some(about) = description.objects.get(&object.index) else {
            continue;
        };
        let single = !about.code.has_members() && object.count == 1;
        let entries = dictionary.members(&object);
        let handles: Vec<Handle> = entries
            .filter_map(|entry| {
                let described = about.entries.get(&entry.address.sub)?;
                Some(Handle {
                    sub: entry.address.sub,
                    label: described.name.value.clone(),
                    name: String::new(),
                    doc: docs::entry(
                        entry.address,
                        !single,
                        described,
                        entry.data_type,
                        naming.files,
                    ),
                    data_type: entry.data_type,
                    access: entry.access,
                    mappable: entry.mappable,
                    slot: entry.slot,
                    is_renamed: false,
                })
            })
            .collect();
        let (doc, body) = match handles.first() {
            Some(handle) if single => (handle.doc.clone(), Body::Value(handle.clone())),
            _ => {
                let doc = docs::object(object.index, about, naming.files);
                (doc, Body::Members(handles))
            }
        };
        items.push(Item {
            index: object.index,
            label: about.name.value.clone(),
            name: String::new(),
            doc,
            body,
        });
    }
    name_items(&mut items, naming, report);
    items
}

fn name_items(items: &mut [Item], naming: &Naming<'_>, report: &mut Report) {
    let renames: BTreeMap<Target, &Ident> = naming
        .statements
        .iter()
        .filter_map(|statement| match statement {
            Statement::Rename { target, name } => Some((target.target, name)),
            Statement::Edit { .. } => None,
        })
        .collect();
    let kept: BTreeMap<u16, &Item> = naming
        .family
        .iter()
        .map(|item| (item.index, item))
        .collect();
    // A handle is a constant and a module with its address, so no object's module may have the name of a handle.
    let mut taken = naming.modules.clone();
    taken.extend(CONSTANTS.map(String::from));
    for modules in [false, true] {
        let wanted: Vec<Wanted> = items
            .iter()
            .filter(|item| item.is_module() == modules)
            .map(|item| Wanted {
                target: Target::object(item.index),
                derived: if modules {
                    names::module(&item.label, item.index)
                } else {
                    names::constant(&item.label, item.index, None)
                },
                kept: kept
                    .get(&item.index)
                    .filter(|kept| kept.label == item.label && kept.is_module() == modules)
                    .map(|kept| kept.name.clone()),
            })
            .collect();
        let named = assign(&wanted, &taken, &renames, modules, report);
        taken.extend(named.values().cloned());
        for item in items.iter_mut() {
            if let Some(name) = named.get(&Target::object(item.index)) {
                item.name.clone_from(name);
            }
        }
    }
    for item in items {
        let index = item.index;
        match &mut item.body {
            Body::Value(handle) => handle.name.clone_from(&item.name),
            Body::Members(handles) => {
                let kept = kept
                    .get(&index)
                    .map(|item| item.members())
                    .unwrap_or_default();
                let wanted: Vec<Wanted> = handles
                    .iter()
                    .map(|handle| Wanted {
                        target: Target::member(index, handle.sub),
                        derived: names::constant(&handle.label, index, Some(handle.sub)),
                        kept: kept
                            .iter()
                            .find(|kept| kept.sub == handle.sub && kept.label == handle.label)
                            .map(|kept| kept.name.clone()),
                    })
                    .collect();
                let named = assign(&wanted, &BTreeSet::new(), &renames, false, report);
                for handle in handles {
                    if let Some(name) = named.get(&Target::member(index, handle.sub)) {
                        handle.name.clone_from(name);
                    }
                    handle.is_renamed = renames.contains_key(&Target::member(index, handle.sub));
                }
            }
        }
    }
}

/// An item that needs a name.
struct Wanted {
    target: Target,
    derived: String,
    kept: Option<String>,
}

/// Names for all items of one scope: those of `rename`, else derived ones.
fn assign(
    wanted: &[Wanted],
    taken: &BTreeSet<String>,
    renames: &BTreeMap<Target, &Ident>,
    modules: bool,
    report: &mut Report,
) -> BTreeMap<Target, String> {
    let renamed = |w: &&Wanted| renames.contains_key(&w.target);
    let kept = wanted.iter().filter(|w| !renamed(w)).filter_map(|w| {
        let name = w.kept.clone()?;
        Some((w.target, name))
    });
    let mut named: BTreeMap<Target, String> = kept.collect();
    let fresh: Vec<(Target, String)> = wanted
        .iter()
        .filter(|w| !named.contains_key(&w.target))
        .map(|w| (w.target, w.derived.clone()))
        .collect();
    let mut used = taken.clone();
    used.extend(named.values().cloned());
    let fresh = names::distinct(&fresh, &used, |target| match target.sub {
        None if modules => format!("{:04x}", target.index),
        None => format!("{:04X}", target.index),
        Some(sub) => format!("{sub:02X}"),
    });
    named.extend(fresh);
    let derived = named.clone();
    for want in wanted {
        if let Some(ident) = renames.get(&want.target) {
            named.insert(want.target, ident.unraw().to_string());
        }
    }
    for want in wanted {
        let Some(ident) = renames.get(&want.target) else {
            continue;
        };
        let name = ident.unraw().to_string();
        let other = named
            .iter()
            .find(|(key, n)| **key != want.target && **n == name);
        let fault = match (other, taken.contains(&name)) {
            (Some((other, _)), _) => Some(format!(
                "there are two handles `{name}`: of {other} and of {}\nhelp: rename one of them to something else",
                want.target
            )),
            (None, true) => Some(format!(
                "the module itself defines `{name}`\nhelp: choose another name for {}",
                want.target
            )),
            (None, false) => miswritten(&name, want.target, modules),
        };
        if let Some(fault) = fault {
            report.at(ident.span(), fault);
            if let Some(name) = derived.get(&want.target) {
                named.insert(want.target, name.clone());
            }
        }
    }
    named
}

fn miswritten(name: &str, target: Target, modules: bool) -> Option<String> {
    if names::is_keyword(name) {
        return Some(format!(
            "`{name}` is a keyword\nhelp: `rename {target} = {name}_;`"
        ));
    }
    let (right, what) = if modules {
        (
            name.to_ascii_lowercase(),
            "a RECORD or ARRAY and becomes a module; write its name in lower case",
        )
    } else if target.sub.is_some() {
        (
            name.to_ascii_uppercase(),
            "a sub-object and becomes a constant; write its name in capitals",
        )
    } else {
        (
            name.to_ascii_uppercase(),
            "a VAR and becomes a constant; write its name in capitals",
        )
    };
    (right != name).then(|| format!("{target} is {what}\nhelp: `rename {target} = {right};`"))
}

/// Returns a finding for each `rename` of a missing object, and reports an object that is renamed twice.
pub(crate) fn check_renames(
    statements: &[Statement],
    description: &Description,
    report: &mut Report,
) -> Vec<od_eds::Finding> {
    let mut findings = Vec::new();
    let mut seen = BTreeSet::new();
    for statement in statements {
        let Statement::Rename {
            target: At { target, span },
            ..
        } = statement
        else {
            continue;
        };
        let at = Spanned::new(*target, report.number(*span));
        findings.extend(patch::missing(description, &at));
        if !seen.insert(*target) {
            report.at(*span, format!("{target} is renamed twice"));
        }
    }
    findings
}

impl Item {
    /// The name derived from the description, before the suffix for repeated names and keywords.
    pub(crate) fn near_name(&self) -> String {
        if self.is_module() {
            let name = names::module(&self.label, self.index);
            let bare = name.trim_end_matches('_');
            if names::is_keyword(bare) {
                bare.into()
            } else {
                name
            }
        } else {
            names::constant(&self.label, self.index, None)
        }
    }

    pub(crate) fn is_module(&self) -> bool {
        matches!(self.body, Body::Members(_))
    }

    /// Returns whether it is the same except for the name.
    pub(crate) fn alike(&self, other: &Self) -> bool {
        self.doc == other.doc
            && match (&self.body, &other.body) {
                (Body::Value(a), Body::Value(b)) => a.alike(b),
                (a, b) => a == b,
            }
    }

    /// The handles of a long ARRAY that one [`od_model::typed::Series`] represents: more than 64 of one type with
    /// adjacent values.
    pub(crate) fn series(&self) -> &[Handle] {
        const LONG: usize = 64;
        let [_, handles @ ..] = self.members() else {
            return &[];
        };
        let follows = |pair: &[Handle]| {
            let [one, next] = pair else { return false };
            one.data_type == next.data_type
                && one.access == next.access
                && one.mappable == next.mappable
                && one.sub.checked_add(1) == Some(next.sub)
                && one.slot.len == next.slot.len
                && one.slot.offset + u32::from(one.slot.len) == next.slot.offset
        };
        let is_scalar = handles
            .first()
            .is_some_and(|first| scalar(first.data_type).is_some());
        if handles.len() > LONG && is_scalar && handles.windows(2).all(follows) {
            handles
        } else {
            &[]
        }
    }

    /// The handles of a module; empty for a constant.
    pub(crate) fn members(&self) -> &[Handle] {
        match &self.body {
            Body::Value(_) => &[],
            Body::Members(handles) => handles,
        }
    }
}

impl Handle {
    /// Returns whether it is the same except for the name.
    pub(crate) fn alike(&self, other: &Self) -> bool {
        let all = |h: &Self| (h.sub, h.data_type, h.access, h.mappable, h.slot);
        all(self) == all(other) && self.doc == other.doc
    }

    /// Its name in the description.
    pub(crate) fn label(&self) -> &str {
        &self.label
    }

    /// Returns whether the call gives its name; then it has a constant of its own even if it belongs to a series.
    pub(crate) fn is_renamed(&self) -> bool {
        self.is_renamed
    }

    /// The handle's Rust type in generated code.
    pub(crate) fn rust_type(&self) -> String {
        let access = match self.access {
            Access::Ro => "Ro",
            Access::Wo => "Wo",
            Access::Rw => "Rw",
            Access::Rwr => "Rwr",
            Access::Rww => "Rww",
            Access::Const => "Const",
        };
        match (scalar(self.data_type), self.mappable) {
            (None, _) => format!("Text<{access}>"),
            (Some(scalar), false) => format!("Var<{scalar}, {access}>"),
            (Some(scalar), true) => format!("Var<{scalar}, {access}, Pdo>"),
        }
    }
}

/// The Rust type that holds a value of this type; `None` for strings and domains.
fn scalar(data_type: DataType) -> Option<&'static str> {
    let bits = data_type.bits()?;
    Some(match (data_type.kind(), bits) {
        (Kind::Boolean, _) => "bool",
        (Kind::Unsigned, ..=8) => "u8",
        (Kind::Unsigned, ..=16) => "u16",
        (Kind::Unsigned, ..=32) => "u32",
        (Kind::Unsigned, _) => "u64",
        (Kind::Signed, ..=8) => "i8",
        (Kind::Signed, ..=16) => "i16",
        (Kind::Signed, ..=32) => "i32",
        (Kind::Signed, _) => "i64",
        (Kind::Real, ..=32) => "f32",
        (Kind::Real, _) => "f64",
        (Kind::Text | Kind::Bytes | Kind::Record, _) => return None,
    })
}
