//! Edits to a description: how a spec table is built and how a variant differs.
//!
//! A patch is strict. Editing or removing what the base lacks is an error, and so
//! is adding what is there already; a patch that says nothing false is the only
//! one that applies without a word. Every finding is a [`Diagnostic`] whose span
//! is the one that the edit carries, so the caller can point at its own token:
//! see [`token`].
//!
//! ```
//! use od_model::patch::{self, Edit, Raw, Target};
//! use od_model::{DataType, Description};
//!
//! let mut device = Description::default();
//! let gear = Edit::add(Target::object(0x2110))
//!     .name("Gear")
//!     .data_type(DataType::Unsigned16)
//!     .default(Raw::Integer(4));
//! assert!(patch::apply(&mut device, &[gear.clone()]).is_empty());
//!
//! let findings = patch::apply(&mut device, &[gear]);
//! assert_eq!(findings[0].message, "2110h is there already");
//! ```

use alloc::format;
use alloc::string::{String, ToString};
use alloc::vec::Vec;
use core::fmt;

use crate::{
    Access, Address, DataType, Description, Diagnostic, EntryDescription, Group, Kind, ObjectCode,
    ObjectDescription, Span, Spanned, Value,
};

mod find;
mod raw;

pub use find::missing;
pub use raw::Raw;

/// A span that stands for the caller's token number `id`, not for a stretch of text.
///
/// The macro numbers its tokens, puts these spans into its edits and finds the
/// token of a diagnostic again with [`token_of`].
pub const fn token(id: u32) -> Span {
    Span {
        start: id,
        end: id,
        line: u32::MAX,
        column: 0,
    }
}

/// The number that [`token`] put into this span, if it is one of its.
pub const fn token_of(span: Span) -> Option<u32> {
    if span.line == u32::MAX {
        Some(span.start)
    } else {
        None
    }
}

/// What an edit is about: a whole object, or one of its members.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub struct Target {
    /// Index.
    pub index: u16,
    /// The member; `None` for the object, which is how the value of a VAR is named too.
    pub sub: Option<u8>,
}

impl Target {
    /// The object at `index`.
    pub const fn object(index: u16) -> Self {
        Self { index, sub: None }
    }

    /// The member at `index` and `sub`.
    pub const fn member(index: u16, sub: u8) -> Self {
        Self {
            index,
            sub: Some(sub),
        }
    }

    /// The value it names, with sub-index 0 for an object.
    pub const fn address(self) -> Address {
        Address::new(
            self.index,
            match self.sub {
                Some(sub) => sub,
                None => 0,
            },
        )
    }
}

/// As it is written in a macro call, `0x1018sub2`: the EDS section's own spelling behind `0x`.
impl fmt::Display for Target {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.sub {
            Some(sub) => write!(f, "0x{:04X}sub{sub:X}", self.index),
            None => write!(f, "0x{:04X}", self.index),
        }
    }
}

/// What an edit does.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Action {
    /// Makes an object or a member that is not there yet.
    Add,
    /// Changes some fields of one that is.
    Modify,
    /// Takes it away; an object goes with its members.
    Remove,
}

/// One field of an edit, and what it becomes.
#[derive(Clone, PartialEq, Debug)]
#[allow(missing_docs)] // the variants are the fields' names
pub enum Change {
    Code(ObjectCode),
    Name(String),
    Type(DataType),
    Access(Access),
    Mappable(bool),
    Save(Group),
    /// `None` takes the default away.
    Default(Option<Raw>),
    /// `None` takes the limit away.
    Low(Option<Raw>),
    /// `None` takes the limit away.
    High(Option<Raw>),
}

impl Change {
    /// The field's name in a macro call.
    pub const fn key(&self) -> &'static str {
        match self {
            Self::Code(_) => "code",
            Self::Name(_) => "name",
            Self::Type(_) => "type",
            Self::Access(_) => "access",
            Self::Mappable(_) => "mappable",
            Self::Save(_) => "save",
            Self::Default(_) => "default",
            Self::Low(_) => "low",
            Self::High(_) => "high",
        }
    }
}

/// One statement of a patch.
#[derive(Clone, PartialEq, Debug)]
pub struct Edit {
    /// Add, modify or remove.
    pub action: Action,
    /// What.
    pub target: Spanned<Target>,
    /// The fields given, in the order they were given; the span is the value's.
    pub changes: Vec<Spanned<Change>>,
}

macro_rules! setters {
    ($($(#[$doc:meta])* $name:ident($t:ty) => $variant:expr;)*) => {$(
        $(#[$doc])*
        #[must_use]
        pub fn $name(mut self, value: $t) -> Self {
            self.changes.push(Spanned::from($variant(value.into())));
            self
        }
    )*};
}

impl Edit {
    /// An edit without fields yet.
    pub fn new(action: Action, target: Target) -> Self {
        Self {
            action,
            target: Spanned::from(target),
            changes: Vec::new(),
        }
    }

    /// `add`, without fields yet.
    pub fn add(target: Target) -> Self {
        Self::new(Action::Add, target)
    }

    /// `modify`, without fields yet.
    pub fn modify(target: Target) -> Self {
        Self::new(Action::Modify, target)
    }

    /// `remove`.
    pub fn remove(target: Target) -> Self {
        Self::new(Action::Remove, target)
    }

    setters! {
        /// Says the object code; VAR unless said.
        code(ObjectCode) => Change::Code;
        /// Says the name.
        name(&str) => Change::Name;
        /// Says the data type.
        data_type(DataType) => Change::Type;
        /// Says the access; `ro` unless said.
        access(Access) => Change::Access;
        /// Says whether a PDO can carry it; no unless said.
        mappable(bool) => Change::Mappable;
        /// Says which sub-index of 1010h saves it.
        save(Group) => Change::Save;
        /// Says the default.
        default(Raw) => |raw: Raw| Change::Default(Some(raw));
        /// Says the smallest value.
        low(Raw) => |raw: Raw| Change::Low(Some(raw));
        /// Says the largest value.
        high(Raw) => |raw: Raw| Change::High(Some(raw));
    }
}

/// Applies the edits in their order and returns what was wrong with them.
///
/// An edit with a fault does what of it makes sense, so that one mistake is one
/// finding. A RECORD or ARRAY that the patch added without saying its sub-index 0
/// gets one: UNSIGNED8, `const`, the highest sub-index as its default.
#[must_use]
pub fn apply(description: &mut Description, edits: &[Edit]) -> Vec<Diagnostic> {
    let mut findings = Vec::new();
    let mut containers = Vec::new();
    for edit in edits {
        let target = *edit.target;
        match (edit.action, target.sub) {
            (Action::Remove, _) => remove(description, edit, &mut findings),
            (Action::Modify, _) => modify(description, edit, &mut findings),
            (Action::Add, None) => {
                if add_object(description, edit, &mut findings) {
                    containers.push((target.index, edit.target.span));
                }
            }
            (Action::Add, Some(_)) => add_member(description, edit, &mut findings),
        }
    }
    for (index, span) in containers {
        if let Some(object) = description.objects.get_mut(&index) {
            count_members(object, span);
        }
    }
    findings
}

fn finding(code: &'static str, at: Span, target: Target, message: String) -> Diagnostic {
    Diagnostic::error(code, message)
        .with_span(at)
        .with_address(target.address())
}

fn remove(description: &mut Description, edit: &Edit, findings: &mut Vec<Diagnostic>) {
    let target = *edit.target;
    if let Some(fault) = missing(description, &edit.target) {
        findings.push(fault);
        return;
    }
    match target.sub {
        None => {
            description.objects.remove(&target.index);
        }
        Some(sub) => {
            if let Some(object) = description.objects.get_mut(&target.index) {
                object.entries.remove(&sub);
            }
        }
    }
}

fn modify(description: &mut Description, edit: &Edit, findings: &mut Vec<Diagnostic>) {
    let target = *edit.target;
    if let Some(fault) = missing(description, &edit.target) {
        findings.push(fault);
        return;
    }
    let Some(object) = description.objects.get_mut(&target.index) else {
        return;
    };
    let whole = target.sub.is_none();
    let has_value = !whole || !object.code.has_members();
    for change in &edit.changes {
        match &change.value {
            Change::Code(code) if whole => object.code = Spanned::new(*code, change.span),
            Change::Name(name) if whole => object.name = Spanned::new(name.clone(), change.span),
            Change::Code(_) => findings.push(code_of_member(change, target)),
            other if !has_value => findings.push(value_of_container(change.span, target, other)),
            _ => {}
        }
    }
    if !has_value {
        return;
    }
    if let Some(entry) = object.entries.get_mut(&target.address().sub) {
        fill(entry, edit, findings);
    }
}

/// Adds an object; `true` if it is one with members, which may still lack sub-index 0.
fn add_object(description: &mut Description, edit: &Edit, findings: &mut Vec<Diagnostic>) -> bool {
    let target = *edit.target;
    if description.objects.contains_key(&target.index) {
        findings.push(already(edit));
        return false;
    }
    let code = edit.changes.iter().find_map(|change| match change.value {
        Change::Code(code) => Some(Spanned::new(code, change.span)),
        _ => None,
    });
    let code = code.unwrap_or_default();
    let name = name_of(edit, findings);
    let mut object = ObjectDescription {
        code,
        name,
        sub_number: None,
        entries: Default::default(),
        flags: 0,
        extra: Vec::new(),
        span: edit.target.span,
    };
    if code.has_members() {
        for change in &edit.changes {
            if !matches!(change.value, Change::Code(_) | Change::Name(_)) {
                findings.push(value_of_container(change.span, target, &change.value));
            }
        }
    } else if let Some(entry) = make(edit, findings) {
        object.entries.insert(0, entry);
    }
    let container = code.has_members();
    description.objects.insert(target.index, object);
    container
}

fn add_member(description: &mut Description, edit: &Edit, findings: &mut Vec<Diagnostic>) {
    let target = *edit.target;
    let sub = target.address().sub;
    let Some(object) = description.objects.get_mut(&target.index) else {
        findings.push(
            finding(
                "E0703",
                edit.target.span,
                target,
                format!(
                    "{target} has no object to stand in: {:04X}h does not exist",
                    target.index
                ),
            )
            .with_help(format!(
                "add the object first: `add 0x{:04X} {{ code = record; name = \"…\" }}`",
                target.index
            )),
        );
        return;
    };
    if !object.code.has_members() {
        findings.push(
            finding(
                "E0704",
                edit.target.span,
                target,
                format!("{:04X}h is a {}: it has no members", target.index, *object.code),
            )
            .with_help("only a RECORD or an ARRAY has sub-indices; remove the object and add it with `code = record`"),
        );
        return;
    }
    if object.entries.contains_key(&sub) {
        findings.push(already(edit));
        return;
    }
    for change in &edit.changes {
        if matches!(change.value, Change::Code(_)) {
            findings.push(code_of_member(change, target));
        }
    }
    if let Some(mut entry) = make(edit, findings) {
        entry.name = name_of(edit, findings);
        object.entries.insert(sub, entry);
    }
}

fn name_of(edit: &Edit, findings: &mut Vec<Diagnostic>) -> Spanned<String> {
    for change in &edit.changes {
        if let Change::Name(name) = &change.value {
            return Spanned::new(name.clone(), change.span);
        }
    }
    let target = *edit.target;
    findings.push(
        finding(
            "E0705",
            edit.target.span,
            target,
            format!("`add {target}` gives no name"),
        )
        .with_help("say `name = \"…\"`: the handle is called after it"),
    );
    Spanned::new(target.to_string(), edit.target.span)
}

/// The entry that an `add` describes, without its name; `None` if it has no type.
fn make(edit: &Edit, findings: &mut Vec<Diagnostic>) -> Option<EntryDescription> {
    let target = *edit.target;
    let Some(data_type) = edit.changes.iter().find_map(|change| match change.value {
        Change::Type(data_type) => Some(data_type),
        _ => None,
    }) else {
        findings.push(
            finding(
                "E0706",
                edit.target.span,
                target,
                format!("`add {target}` gives no type"),
            )
            .with_help("say `type = u16`, `type = str`, `type = UNSIGNED24` …"),
        );
        return None;
    };
    let mut entry = EntryDescription::new("", data_type);
    entry.span = edit.target.span;
    entry.access.span = edit.target.span;
    fill(&mut entry, edit, findings);
    Some(entry)
}

/// Writes the fields of an edit into an entry; the values after the type that they are of.
fn fill(entry: &mut EntryDescription, edit: &Edit, findings: &mut Vec<Diagnostic>) {
    let target = *edit.target;
    let gives = |key: &str| edit.changes.iter().any(|change| change.key() == key);
    for change in &edit.changes {
        let span = change.span;
        match &change.value {
            Change::Name(name) => entry.name = Spanned::new(name.clone(), span),
            Change::Access(access) => entry.access = Spanned::new(*access, span),
            Change::Mappable(mappable) => entry.mappable = Spanned::new(*mappable, span),
            Change::Save(group) => entry.group = Some(Spanned::new(*group, span)),
            Change::Type(data_type) => {
                entry.data_type = Some(Spanned::new(*data_type, span));
                for (key, value) in [
                    ("default", &mut entry.default),
                    ("low", &mut entry.low),
                    ("high", &mut entry.high),
                ] {
                    if !gives(key) {
                        findings.extend(retype(key, value, *data_type, span, target));
                    }
                }
            }
            Change::Code(_) | Change::Default(_) | Change::Low(_) | Change::High(_) => {}
        }
    }
    let Some(data_type) = entry.data_type.map(|t| t.value) else {
        return;
    };
    for change in &edit.changes {
        let (field, raw) = match &change.value {
            Change::Default(raw) => (&mut entry.default, raw),
            Change::Low(raw) => (&mut entry.low, raw),
            Change::High(raw) => (&mut entry.high, raw),
            _ => continue,
        };
        match raw.as_ref().map(|raw| raw.value_for(data_type)) {
            None => *field = None,
            Some(Ok(value)) => *field = Some(Spanned::new(value, change.span)),
            Some(Err(fault)) => findings.push(
                finding(
                    "E0707",
                    change.span,
                    target,
                    format!("`{}`: {}", change.key(), fault.message),
                )
                .with_help(fault.help),
            ),
        }
    }
    // A DCF's value would hide the default that the edit gives.
    if gives("default") {
        entry.parameter = None;
    }
}

/// Gives a value that stays the form that the entry's new type wants.
fn retype(
    key: &str,
    field: &mut Option<Spanned<Value>>,
    data_type: DataType,
    at: Span,
    target: Target,
) -> Option<Diagnostic> {
    let old = field.take()?;
    match Raw::from(&old.value).value_for(data_type) {
        Ok(value) => {
            *field = Some(Spanned::new(value, old.span));
            None
        }
        Err(fault) => Some(
            finding(
                "E0708",
                at,
                target,
                format!(
                    "the {key} of the base does not fit the new type: {}",
                    fault.message
                ),
            )
            .with_help(format!("give `{key}` with the type, or `{key} = none`")),
        ),
    }
}

fn already(edit: &Edit) -> Diagnostic {
    let target = *edit.target;
    let what = match target.sub {
        None => format!("{:04X}h", target.index),
        Some(_) => target.address().to_string(),
    };
    finding(
        "E0702",
        edit.target.span,
        target,
        format!("{what} is there already"),
    )
    .with_help(format!("to change it, write `modify {target} {{ … }}`"))
}

fn code_of_member(change: &Spanned<Change>, target: Target) -> Diagnostic {
    finding(
        "E0709",
        change.span,
        target,
        format!("{target} is a member: it has no object code"),
    )
    .with_help(format!(
        "`code` stands in the object: `0x{:04X} {{ code = record }}`",
        target.index
    ))
}

fn value_of_container(at: Span, target: Target, change: &Change) -> Diagnostic {
    finding(
        "E0710",
        at,
        target,
        format!(
            "{:04X}h has members: `{}` belongs to one of them",
            target.index,
            change.key()
        ),
    )
    .with_help(format!(
        "name the member, for example `0x{:04X}sub1`",
        target.index
    ))
}

fn count_members(object: &mut ObjectDescription, span: Span) {
    if object.entries.contains_key(&0) {
        return;
    }
    let highest = object.entries.keys().next_back().copied().unwrap_or(0);
    let mut entry = EntryDescription::new("Highest sub-index supported", DataType::Unsigned8);
    entry.access = Spanned::new(Access::Const, span);
    entry.default = Some(Spanned::new(Value::Unsigned(u64::from(highest)), span));
    entry.span = span;
    object.entries.insert(0, entry);
}

/// Is this one of the types that only a record can have?
fn is_record(data_type: DataType) -> bool {
    data_type.kind() == Kind::Record
}

#[cfg(test)]
mod tests;
