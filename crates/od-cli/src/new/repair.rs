//! Changes a description with errors until a device can be built from it, and lists the changes.

use std::collections::{BTreeMap, BTreeSet};

use od_eds::patch::{self, Edit, Target};
use od_eds::{
    Description, Eds, EntryDescription, Fact, Finding, Key, ObjectDescription, Spanned, Value, say,
};
use od_model::{Access, Address, DataType, Kind, ObjectCode};

/// Changes of a description.
#[derive(Default)]
pub(super) struct Notes {
    /// One sentence per change.
    pub(super) all: Vec<String>,
    /// The objects that were removed, each once.
    pub(super) removed: BTreeSet<String>,
}

impl Notes {
    fn removed(&mut self, object: String, why: &str) {
        self.all.push(format!("{object}: removed{why}"));
        // The sub-objects of an object are removed with it.
        let members = format!("{object}:");
        self.removed.retain(|other| !other.starts_with(&members));
        self.removed.insert(object);
    }

    /// Adds what changed in an object, and why. Returns the values that changed.
    fn changed(
        &mut self,
        index: u16,
        old: &ObjectDescription,
        new: &ObjectDescription,
        why: &str,
    ) -> BTreeSet<Address> {
        let (was, is) = (*old.code, *new.code);
        if was != is {
            let (was, is) = (was.name(), is.name());
            self.all
                .push(format!("{index:04X}h: ObjectType {was} → {is}{why}"));
        }
        let subs: BTreeSet<u8> = old
            .entries
            .keys()
            .chain(new.entries.keys())
            .copied()
            .collect();
        let mut changed = BTreeSet::new();
        for sub in subs {
            let address = Address::new(index, sub);
            match (old.entries.get(&sub), new.entries.get(&sub)) {
                (Some(old), Some(new)) => {
                    let what = changes(old, new);
                    if what.is_empty() {
                        continue;
                    }
                    self.all.push(format!("{address}: {what}{why}"));
                }
                (Some(_), None) => self.removed(address.to_string(), why),
                (None, _) => self.all.push(format!("{address}: added{why}")),
            }
            changed.insert(address);
        }
        changed
    }
}

/// Maximum number of rounds; each removes something, and a file has a few thousand entries.
const ROUNDS: usize = 100;

/// Makes the fewest changes until there is no error.
///
/// # Errors
/// The findings that remain if nothing more can be changed.
pub(super) fn fix(description: &mut Description) -> Result<Notes, Vec<Finding>> {
    let mut notes = Notes::default();
    drop_unreadable(description, &mut notes);
    let mut tries: BTreeMap<(&'static str, Option<Address>), u8> = BTreeMap::new();
    for _ in 0..ROUNDS {
        let found = od_eds::load(&od_eds::canonical(description)).findings;
        let errors: Vec<Finding> = found.into_iter().filter(Finding::is_unsound).collect();
        if errors.is_empty() {
            return Ok(notes);
        }
        let mut progress = false;
        let mut changed = BTreeSet::new();
        for error in &errors {
            // Another change may have removed its cause: the next round shows it.
            if error.object.is_some_and(|object| changed.contains(&object)) {
                continue;
            }
            let tries = tries.entry((error.code(), error.object)).or_default();
            *tries = tries.saturating_add(1);
            if let Some(values) = step(description, error, *tries, &mut notes) {
                changed.extend(values);
                progress = true;
            }
        }
        if !progress {
            return Err(errors);
        }
    }
    let left = od_eds::load(&od_eds::canonical(description)).findings;
    Err(left.into_iter().filter(Finding::is_unsound).collect())
}

/// Returns the line of a note about an error that is left.
pub(super) fn left(error: &Finding) -> String {
    let said = say(error, &Eds);
    let place = said
        .address
        .map_or(String::new(), |address| format!("{address}: "));
    let help = if said.help.is_empty() {
        String::new()
    } else {
        format!("; {}", said.help)
    };
    format!("{place}{} ({}){help}", said.message, error.code())
}

/// The access that a value should have: `rww` if an RPDO maps it, else that of the standard's object, else `ro`.
fn right_access(mapped: &BTreeSet<Address>, address: Address) -> Access {
    if mapped.contains(&address) {
        return Access::Rww;
    }
    match od_eds::outline::specified(address.index) {
        Some(_) if address.sub == 0 && has_members(address.index) => Access::Ro,
        Some(known) => known.access,
        None => Access::Ro,
    }
}

fn has_members(index: u16) -> bool {
    od_eds::outline::specified(index).is_some_and(|known| known.code.has_members())
}

/// The values that the RPDOs map by default.
fn mapped_by_rpdos(description: &Description) -> BTreeSet<Address> {
    let mappings = description.objects.range(0x1600..=0x17FF);
    let entries =
        mappings.filter_map(|(index, _)| od_eds::identifiers::mapping(description, *index));
    entries.flatten().map(|entry| entry.address).collect()
}

/// Describes what changed in a value: `DefaultValue 0x0 → 0x10`.
fn changes(old: &EntryDescription, new: &EntryDescription) -> String {
    let value = |value: &Option<Spanned<Value>>| {
        value
            .as_ref()
            .map_or("none".into(), |value| match value.value {
                Value::Unsigned(number) if number > 9 => format!("0x{number:X}"),
                _ => od_eds::shown(&value.value),
            })
    };
    let mut all = Vec::new();
    let mut compare = |key: &str, old: String, new: String| {
        if old != new {
            all.push(format!("{key} {old} → {new}"));
        }
    };
    let data_type =
        |entry: &EntryDescription| entry.data_type.map_or("none", |own| own.name()).into();
    compare("DataType", data_type(old), data_type(new));
    compare(
        "AccessType",
        old.access.name().into(),
        new.access.name().into(),
    );
    compare("DefaultValue", value(&old.default), value(&new.default));
    compare(
        "ParameterValue",
        value(&old.parameter),
        value(&new.parameter),
    );
    compare("LowLimit", value(&old.low), value(&new.low));
    compare("HighLimit", value(&old.high), value(&new.high));
    let mapping = |entry: &EntryDescription| u8::from(*entry.mappable).to_string();
    compare("PDOMapping", mapping(old), mapping(new));
    all.join(", ")
}

/// Removes sub-objects without a valid type, and fields whose text is not valid.
fn drop_unreadable(description: &mut Description, notes: &mut Notes) {
    const FIELDS: [&str; 9] = [
        "ObjectType",
        "SubNumber",
        "DataType",
        "AccessType",
        "PDOMapping",
        "DefaultValue",
        "LowLimit",
        "HighLimit",
        "ParameterValue",
    ];
    let (mut no_access, mut lost) = (BTreeSet::new(), BTreeSet::new());
    let is_field = |key: &str| FIELDS.iter().any(|field| field.eq_ignore_ascii_case(key));
    for (index, object) in &mut description.objects {
        object.extra.retain(|(key, _)| !is_field(key));
        object.entries.retain(|sub, entry| {
            let place = Address::new(*index, *sub);
            let has_text = entry.extra.iter().any(|(key, _)| key == "DataType");
            entry.extra.retain(|(key, value)| {
                let keep = !is_field(key);
                if !keep && key.eq_ignore_ascii_case("AccessType") {
                    no_access.insert(place);
                }
                if !keep && !value.trim().is_empty() {
                    let note = format!("{place}: removed the invalid {key} `{value}`");
                    notes.all.push(note);
                }
                keep
            });
            let usable = entry
                .data_type
                .is_some_and(|data_type| data_type.kind() != Kind::Record);
            if !usable {
                let code = match (entry.data_type, has_text) {
                    (Some(_), _) => "E0403",
                    (None, true) => "E0402",
                    (None, false) => "E0401",
                };
                let why = format!(" ({code}): it has no valid DataType");
                notes.removed(place.to_string(), &why);
                lost.insert(*index);
            }
            usable
        });
    }
    let mapped = mapped_by_rpdos(description);
    for (index, object) in &mut description.objects {
        for (sub, entry) in &mut object.entries {
            let place = Address::new(*index, *sub);
            let right = right_access(&mapped, place);
            if no_access.contains(&place) && *entry.access != right {
                let note = format!("{place}: AccessType not valid → {right} (odkit assumed ro)");
                notes.all.push(note);
                entry.access = Spanned::from(right);
            }
        }
        let is_mapping = matches!(index, 0x1600..=0x17FF | 0x1A00..=0x1BFF);
        if is_mapping && lost.contains(index) {
            let old = object.clone();
            map_nothing(object);
            notes.changed(*index, &old, object, ", because the mapping lost an entry");
        }
    }
    description.objects.retain(|index, object| {
        let keep = !object.entries.is_empty();
        if !keep {
            notes.removed(format!("{index:04X}h"), ": it has no valid sub-object");
        }
        keep
    });
}

/// Makes one change for an error and returns the values that it changed; `None` if nothing more can be changed.
fn step(
    description: &mut Description,
    error: &Finding,
    tries: u8,
    notes: &mut Notes,
) -> Option<BTreeSet<Address>> {
    let mandatory = match error.code() {
        "E0601" => Some(0x1000),
        "E0602" => Some(0x1001),
        "E0603" => Some(0x1018),
        _ => None,
    };
    if let Some(index) = mandatory {
        description.objects.insert(index, standard(index)?);
        let note = format!("{index:04X}h: added, because it is mandatory");
        notes.all.push(note);
        return Some(BTreeSet::new());
    }
    let address = error.object?;
    let mapped = mapped_by_rpdos(description);
    let said = format!(" ({}): {}", error.code(), say(error, &Eds).message);
    let Address { index, sub } = address;
    let is_mapping = matches!(index, 0x1600..=0x17FF | 0x1A00..=0x1BFF);
    let object = description.objects.get_mut(&index)?;
    let before = object.clone();
    match (error.code(), tries) {
        ("E0305", 1) => object.code = Spanned::from(ObjectCode::Record),
        ("E0310", 1) => count(object),
        ("E0309" | "E0509" | "E0510" | "E0604" | "E0605" | "E0606", 1)
            if right_type(error).is_some() && object.entries.contains_key(&sub) =>
        {
            let target = if object.code.has_members() {
                Target::member(index, sub)
            } else {
                Target::object(index)
            };
            // A value that the type does not allow is removed.
            let _ = patch::apply(
                description,
                &[Edit::modify(target).data_type(right_type(error)?)],
            );
        }
        ("E0606", 1) if object.code.has_members() && !object.entries.contains_key(&1) => {
            let identity = standard(index)?;
            object.entries.insert(1, identity.entries.get(&1)?.clone());
        }
        ("E0412" | "E0417" | "E0418", 1) if error.key == Some(Key::DefaultValue) => {
            object.entries.get_mut(&sub)?.default = None;
        }
        (_, 1) if error.key == Some(Key::ParameterValue) => {
            object.entries.get_mut(&sub)?.parameter = None;
        }
        (code, 1) if code.starts_with("E04") => {
            let entry = object.entries.get_mut(&sub)?;
            (entry.low, entry.high) = (None, None);
        }
        (code, 2) if code.starts_with("E04") => {
            let entry = object.entries.get_mut(&sub)?;
            (entry.default, entry.parameter) = (None, None);
        }
        (code, 1) if code.starts_with("E05") && is_mapping => {
            unmap(object, sub);
        }
        ("W0520" | "W0521" | "W0522" | "E0532", 1) => {
            let entry = object.entries.get_mut(&sub)?;
            switch_off(index, entry)?;
        }
        ("E0643", 1) => {
            object.entries.get_mut(&sub)?.access = Spanned::from(right_access(&mapped, address));
        }
        (_, ..=2) if standard(index).is_some() => {
            description.objects.insert(index, standard(index)?);
        }
        (_, 2) if sub > 0 => {
            object.entries.remove(&sub)?;
            count(object);
            if is_mapping {
                map_nothing(object);
            }
        }
        (_, ..=3) if standard(index).is_none() => {
            description.objects.remove(&index)?;
            notes.removed(format!("{index:04X}h"), &said);
            return Some(BTreeSet::from([address]));
        }
        _ => return None,
    }
    Some(notes.changed(index, &before, description.objects.get(&index)?, &said))
}

/// The data type that a finding says is right.
fn right_type(error: &Finding) -> Option<DataType> {
    let mut facts = error.facts.iter();
    facts.find_map(|(name, fact)| match fact {
        Fact::Type(right) if *name == "right" => Some(*right),
        _ => None,
    })
}

/// Sets sub-index 0 to the highest sub-index.
fn count(object: &mut ObjectDescription) {
    let highest = object.entries.keys().copied().max().unwrap_or(0);
    let name = match object.entries.get(&0) {
        Some(entry) => entry.name.value.clone(),
        None => "Highest sub-index supported".into(),
    };
    let mut entry = EntryDescription::new(name, DataType::Unsigned8);
    if let Some(old) = object.entries.get(&0) {
        entry.access = old.access;
    }
    entry.default = Some(Spanned::from(Value::Unsigned(highest.into())));
    object.entries.insert(0, entry);
    object.sub_number = None;
}

/// Sets the number of mapped objects to 0: after the loss of an entry, the others would make another PDO than the file has.
fn map_nothing(object: &mut ObjectDescription) {
    if let Some(entry) = object.entries.get_mut(&0) {
        (entry.default, entry.parameter) = (Some(Spanned::from(Value::Unsigned(0))), None);
    }
}

/// Replaces a CAN-ID that the service may not use: SYNC and TIME get the default, other services a COB-ID that is not valid (bit 31).
fn switch_off(index: u16, entry: &mut EntryDescription) -> Option<()> {
    let number = |value: &Value| match (index, value) {
        (0x1005, _) => Some(Value::Unsigned(0x80)),
        (0x1012, _) => Some(Value::Unsigned(0x100)),
        (_, Value::Unsigned(_)) => Some(Value::Unsigned(1 << 31)),
        (_, Value::NodeId(_)) => Some(Value::NodeId(1 << 31)),
        _ => None,
    };
    for value in [&mut entry.default, &mut entry.parameter]
        .into_iter()
        .flatten()
    {
        *value = Spanned::from(number(&value.value)?);
    }
    Some(())
}

/// Removes a mapping entry.
fn unmap(object: &mut ObjectDescription, sub: u8) {
    if let (1.., Some(entry)) = (sub, object.entries.get_mut(&sub)) {
        (entry.default, entry.parameter) = (Some(Spanned::from(Value::Unsigned(0))), None);
    }
    map_nothing(object);
}

/// The three mandatory objects (CiA 301, 7.5.1), in their simplest form.
fn standard(index: u16) -> Option<ObjectDescription> {
    let number = |name: &str, data_type, value| EntryDescription {
        default: Some(Spanned::from(Value::Unsigned(value))),
        ..EntryDescription::new(name, data_type)
    };
    match index {
        0x1000 => Some(ObjectDescription::var(number(
            "Device type",
            DataType::Unsigned32,
            0,
        ))),
        0x1001 => Some(ObjectDescription::var(number(
            "Error register",
            DataType::Unsigned8,
            0,
        ))),
        0x1018 => {
            let mut object =
                ObjectDescription::var(number("Identity object", DataType::Unsigned8, 1));
            object.code = Spanned::from(ObjectCode::Record);
            object.entries = BTreeMap::from([
                (
                    0,
                    number("Highest sub-index supported", DataType::Unsigned8, 1),
                ),
                (1, number("Vendor-ID", DataType::Unsigned32, 0)),
            ]);
            Some(object)
        }
        _ => None,
    }
}
