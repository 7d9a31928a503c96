//! Hover, definition and completion in a call.

use std::ops::Range;

use od_eds::Description;
use od_eds::outline::{Place, profile_objects};
use od_eds::patch::Target;
use od_eds::row::{CODES, FIELDS, GROUPS, TYPES};
use od_model::Access;

use crate::file::File;
use crate::macros::base::{Base, Find};
use crate::macros::call::{self, Call, Statement};
use crate::standard;
use crate::types::{
    CompletionItem, CompletionList, Hover, Location, Markup, Range as Places, TextEdit,
};
use crate::words;

/// The call at a byte.
fn call_at(file: &File, offset: usize) -> Option<Call> {
    let calls = call::all(file.str()).into_iter();
    let inside = |call: &Call| (call.body.start..=call.body.end).contains(&offset);
    calls.into_iter().find(inside)
}

fn holds(bytes: &Range<usize>, offset: usize) -> bool {
    bytes.start <= offset && offset <= bytes.end
}

/// The object at a byte.
fn target_at(call: &Call, offset: usize) -> Option<(Target, Range<usize>)> {
    let targets = call.statements.iter().filter_map(|own| own.target.clone());
    targets.into_iter().find(|(_, bytes)| holds(bytes, offset))
}

/// The object, or the file, at a byte.
pub(crate) fn hover(file: &File, offset: usize, find: Find<'_>) -> Option<Hover> {
    let call = call_at(file, offset)?;
    let base = Base::of(file, &call, find).ok()?;
    // A call without a file has only the names of the standards.
    let none = Description::default();
    let description = base.as_ref().map_or(&none, |base| &base.description);
    let (said, bytes) = match target_at(&call, offset) {
        Some((target, bytes)) => {
            let mut said = words::heading(description, target.address());
            let entry = description.entry(target.address());
            if let Some(entry) = entry {
                said.push_str(&format!("\n\n{}", words::of_type(entry)));
                let given = entry.default.as_ref();
                let value = given.and_then(|given| {
                    words::value(description, target.address(), entry, &given.value)
                });
                if let Some(value) = value {
                    said.push_str(&format!("\n\ndefault: {}", words::escaped(&value)));
                }
            }
            (said, bytes)
        }
        None => {
            let bytes = call.eds.filter(|bytes| holds(bytes, offset))?;
            let findings = base.as_ref()?.findings.iter();
            let errors = findings.filter(|one| one.is_unsound()).count();
            let objects = description.objects.len();
            (format!("Objects: {objects}, errors: {errors}"), bytes)
        }
    };
    Some(Hover {
        contents: Markup::markdown(said),
        range: Some(file.text.range(bytes)),
    })
}

/// Place of the description of the object at a byte.
pub(crate) fn definition(file: &File, offset: usize, find: Find<'_>) -> Option<Location> {
    let call = call_at(file, offset)?;
    let base = Base::of(file, &call, find).ok()??;
    if call.eds.as_ref().is_some_and(|bytes| holds(bytes, offset)) {
        return Some(Location {
            uri: base.eds.uri,
            range: Places::default(),
        });
    }
    let (target, _) = target_at(&call, offset)?;
    let member = target.sub.map(|sub| Place::Member(target.index, sub));
    let member = member.and_then(|place| base.described(place));
    member.or_else(|| base.described(Place::Object(target.index)))
}

/// Returns the completions at a byte.
pub(crate) fn complete(file: &File, offset: usize, find: Find<'_>) -> Option<CompletionList> {
    let call = call_at(file, offset)?;
    let source = file.str();
    let line = file.text.line(file.text.line_at(offset));
    let before = source.get(line.start..offset)?;
    let word = before.trim_end_matches(|c: char| c.is_ascii_alphanumeric() || c == '_');
    let bytes = line.start + word.len()..offset;
    let own = |own: &&Statement| {
        own.braces
            .as_ref()
            .is_some_and(|braces| holds(braces, offset))
    };
    let items = if call.statements.iter().any(|statement| own(&statement)) {
        fields(word)
    } else if let Some(statement) = word.split_whitespace().next_back()
        && matches!(statement, "modify" | "remove" | "rename" | "add")
    {
        let base = Base::of(file, &call, find).ok().flatten();
        let description = base.map(|base| base.description).unwrap_or_default();
        objects(&description, statement == "add")
    } else if word.trim_end().is_empty() || word.trim_end().ends_with([';', '{', '}']) {
        statements()
    } else {
        Vec::new()
    };
    let range = file.text.range(bytes);
    let ranked = items.into_iter().enumerate();
    let items = ranked.map(|(rank, (label, detail))| CompletionItem {
        kind: 12,
        sort_text: format!("{rank:05}"),
        filter_text: format!("{label} {detail}"),
        text_edit: TextEdit {
            range,
            new_text: label.clone(),
        },
        label,
        detail,
        documentation: None,
    });
    Some(CompletionList {
        is_incomplete: false,
        items: items.collect(),
    })
}

/// The objects of the file with their sub-objects; or the objects of its standards that it lacks.
fn objects(description: &Description, missing: bool) -> Vec<(String, String)> {
    let profile = standard::profile(description);
    if missing {
        let known = profile.into_iter().flat_map(profile_objects);
        let known = known.filter(|(index, _)| !description.objects.contains_key(index));
        return known
            .map(|(index, name)| (Target::object(index).to_string(), name.to_owned()))
            .collect();
    }
    let mut all = Vec::new();
    for (index, object) in &description.objects {
        all.push((
            Target::object(*index).to_string(),
            object.name.value.clone(),
        ));
        if object.code.has_members() {
            let members = object.entries.iter();
            all.extend(members.map(|(sub, entry)| {
                (
                    Target::member(*index, *sub).to_string(),
                    entry.name.value.clone(),
                )
            }));
        }
    }
    all
}

fn statements() -> Vec<(String, String)> {
    [
        ("add", "an object that the file lacks"),
        ("modify", "fields of an object"),
        ("remove", "an object"),
        ("rename", "the handle of an object"),
        ("variant", "statements of their own"),
        ("eds", "path of the file"),
        ("profile", "the device profile that is checked"),
        ("without", "services that the node does not have"),
        ("behaves", "the profile of the node's services"),
        (
            "warnings",
            "`warnings = off;` hides the warnings of the rules",
        ),
        ("crate", "path of the crate `odkit`"),
    ]
    .map(|(word, said)| (word.to_owned(), said.to_owned()))
    .into()
}

/// The fields, or the values of the field at the cursor.
fn fields(before: &str) -> Vec<(String, String)> {
    let field = before.rsplit([';', '{']).next().unwrap_or_default().trim();
    let owned = |word: &str| (word.to_owned(), String::new());
    let Some(key) = field.strip_suffix('=').map(str::trim_end) else {
        return FIELDS.into_iter().map(owned).collect();
    };
    match key {
        "type" => TYPES
            .iter()
            .map(|(word, own)| ((*word).to_owned(), own.name().to_owned()))
            .collect(),
        "access" => Access::ALL
            .into_iter()
            .map(|own| (own.name().to_owned(), words::access(own).to_owned()))
            .collect(),
        "code" => CODES.iter().map(|(word, _)| owned(word)).collect(),
        "save" => GROUPS.iter().map(|(word, _)| owned(word)).collect(),
        "mappable" => ["true", "false"].map(owned).into(),
        _ => Vec::new(),
    }
}
