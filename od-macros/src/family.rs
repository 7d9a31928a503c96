//! A base and its variants: edits applied, rules checked, handles named.

use std::collections::{BTreeMap, BTreeSet};

use od_eds::patch::{Action, Change, Edit, apply};
use od_eds::{Description, Finding, Key, Spanned, Tables};
use od_model::{Address, ObjectCode, Slot};
use proc_macro2::Span;

use crate::files::Files;
use crate::findings;
use crate::handles::{self, Item, Naming};
use crate::input::{Input, Statement};
use crate::report::Report;
use crate::source::Source;

/// The devices that a call describes.
pub(crate) struct Family {
    pub(crate) base: Device,
    /// The variants, in the order of the call.
    pub(crate) variants: Vec<Device>,
    /// Services that objects need although the call leaves them out.
    pub(crate) needed: Vec<&'static str>,
    /// Number of findings about the file that are not errors.
    pub(crate) remarks: usize,
}

pub(crate) struct Device {
    pub(crate) tables: Tables,
    pub(crate) items: Vec<Item>,
}

/// Builds all devices of a call; errors go to `report`.
pub(crate) fn build(input: &Input, source: &Source, report: &mut Report) -> Family {
    let home = match &input.eds {
        Some(path) => path.span(),
        None => input.name.span(),
    };
    let files = source.files.as_ref();

    let mut base = source.description.clone();
    let before = if base.objects.is_empty() || input.statements.is_empty() {
        Vec::new()
    } else {
        od_eds::check::check(&base)
    };
    let before = Checked {
        all: before,
        ..Checked::default()
    };
    let mut made = patch(
        &mut base,
        &before,
        &input.statements,
        home,
        "",
        files,
        report,
    );
    let left = source.findings.iter();
    let left = left.filter(|finding| !fixed(finding, &base, &input.statements));
    let old = std::mem::take(&mut made.old);
    let mut eds: Vec<Finding> = left.cloned().chain(old).collect();
    eds.sort_by_key(|finding| finding.span().map_or(0, |span| span.start));
    source.allows.clone().filter(&mut eds);
    findings::tell(&eds, home, files, &base, report);
    let device_type = Address::new(0x1000, 0);
    let is_sound = report.is_read(0x1000) && !made.broken.contains(&device_type);
    if let (Some(profile), true) = (&input.profile, is_sound) {
        crate::profile::check(profile, &base, report);
    }

    let variants: Vec<Description> = input
        .variants
        .iter()
        .map(|variant| {
            let mut description = base.clone();
            let context = format!("variant `{}`: ", variant.name);
            let of_module = report.add_doubts(&variant.doubts);
            patch(
                &mut description,
                &made,
                &variant.statements,
                variant.name.span(),
                &context,
                files,
                report,
            );
            report.replace_doubts(of_module);
            description
        })
        .collect();
    if input.is_quiet {
        report.hide_warnings();
    }
    let mut family = devices(input, source, base, variants, report);
    if source.files.is_some() {
        family.remarks = eds.iter().filter(|finding| !finding.is_unsound()).count();
    }
    family
}

/// Returns whether statements of the module replace the text that could not be read: a file that
/// must not be changed can be corrected in the call.
fn fixed(finding: &Finding, base: &Description, statements: &[Statement]) -> bool {
    let Some(address) = finding.object else {
        return false;
    };
    if base.entry(address).is_none() && !base.objects.contains_key(&address.index) {
        return true;
    }
    // An edit of the default also replaces the value of a DCF.
    let key = match finding.key {
        Some(Key::ParameterValue) => Key::DefaultValue,
        Some(key) => key,
        None => return false,
    };
    statements.iter().any(|statement| match statement {
        Statement::Edit { target, fields, .. } => {
            target.target.address() == address && fields.iter().any(|f| f.change.key() == key)
        }
        Statement::Rename { .. } => false,
    })
}

fn devices(
    input: &Input,
    source: &Source,
    base: Description,
    variants: Vec<Description>,
    report: &mut Report,
) -> Family {
    let mut tables = Tables::new(&base);
    let mut others: Vec<Tables> = variants.iter().map(Tables::new).collect();
    let mut all: Vec<&mut Tables> = std::iter::once(&mut tables).chain(&mut others).collect();
    lay_out(&mut all);

    let mut needed = Vec::new();
    let own = std::iter::once(("", &tables));
    let of_variants = input.variants.iter().zip(&others);
    let of_variants: Vec<_> = of_variants
        .map(|(variant, tables)| (variant.name.to_string(), tables))
        .collect();
    let of_variants = of_variants.iter().map(|(name, tables)| (&**name, *tables));
    for (name, tables) in own.chain(of_variants) {
        let of_one = input.services.check(name, tables.dictionary(), report);
        needed.extend(of_one);
    }

    let files = source.files.as_ref();
    let modules = input.variants.iter().map(|v| v.name.to_string()).collect();
    let naming = Naming {
        files,
        family: &[],
        modules,
        statements: &input.statements,
    };
    let items = handles::items(&base, &tables, &naming, report);
    let mut family = Family {
        base: Device { tables, items },
        variants: Vec::new(),
        needed,
        remarks: 0,
    };
    for ((variant, description), tables) in input.variants.iter().zip(variants).zip(others) {
        let naming = Naming {
            files,
            family: &family.base.items,
            modules: BTreeSet::new(),
            statements: &variant.statements,
        };
        let items = handles::items(&description, &tables, &naming, report);
        family.variants.push(Device { tables, items });
    }
    family
}

/// Findings about a description after a patch.
#[derive(Default)]
struct Checked {
    /// Findings that the base has, too, and that are not a consequence.
    old: Vec<Finding>,
    all: Vec<Finding>,
    /// Addresses with errors of the statements so far.
    broken: BTreeSet<Address>,
}

/// Applies statements to a description with the findings `before`, and checks the result.
///
/// Errors of the statements and new findings are reported at the edit that caused them, or at `home`, but no
/// finding that may be a consequence of a wrong statement.
fn patch(
    description: &mut Description,
    before: &Checked,
    statements: &[Statement],
    home: Span,
    context: &str,
    files: Option<&Files>,
    report: &mut Report,
) -> Checked {
    let first = report.numbers();
    let edits = edits(statements, report);
    let mut faults = apply(description, &edits);
    faults.extend(handles::check_renames(statements, description, report));
    faults.retain(|fault| {
        let Some(address) = fault.object else {
            return true;
        };
        let is_missing = matches!(fault.code(), "E0701" | "E0703" | "E0704");
        let is_known = !report.has_lost() && report.is_read(address.index);
        !report.half_read_ones().contains(&address) && (is_known || !is_missing)
    });
    let of_edits = findings::Patch {
        edits: &edits,
        tokens: first..report.numbers(),
        home,
        context,
        files,
    };
    of_edits.tell(&faults, description, report);
    let all = od_eds::check::check(description);
    let mut broken = before.broken.clone();
    broken.extend(faults.iter().filter_map(|fault| fault.object));
    let doubtful = &broken | report.half_read_ones();
    let is_sure = |finding: &&Finding| {
        !finding.may_follow(&doubtful) && (finding.rule.is_of_one_value() || !report.has_lost())
    };
    let sure = all.iter().filter(is_sure).cloned();
    if edits.is_empty() {
        let old = sure.collect();
        return Checked { old, all, broken };
    }
    let mut known: BTreeMap<_, Vec<&Finding>> = BTreeMap::new();
    for finding in &before.all {
        let key = (finding.code(), finding.object);
        known.entry(key).or_default().push(finding);
    }
    let is_old = |finding: &Finding| {
        let alike = known.get(&(finding.code(), finding.object));
        alike.is_some_and(|alike| alike.contains(&finding))
    };
    let (old, new): (Vec<Finding>, Vec<Finding>) = sure.partition(is_old);
    of_edits.blame(&new, description, report);
    Checked { old, all, broken }
}
/// Assigns a place to every stored value of the family; a string has room for its longest default.
///
/// A value has the same place in the store of every variant that has it with the same type. A handle of the family
/// therefore works with all of them, and a variant re-exports it instead of making its own.
fn lay_out(family: &mut [&mut Tables]) {
    let mut places: BTreeMap<(Address, u16), Slot> = BTreeMap::new();
    let stored = |tables: &Tables| {
        let stored = tables
            .dictionary()
            .entries()
            .filter(|entry| entry.slot.len > 0);
        stored
            .map(|entry| ((entry.address, entry.data_type.code()), entry.slot.len))
            .collect::<Vec<_>>()
    };
    for (key, len) in family.iter().flat_map(|tables| stored(tables)) {
        let place = places.entry(key).or_default();
        place.len = place.len.max(len);
    }
    let mut offset = 0;
    for place in places.values_mut() {
        place.offset = offset;
        offset += u32::from(place.len);
    }
    for tables in family {
        tables.place(|entry| {
            let place = places.get(&(entry.address, entry.data_type.code()));
            place.copied().unwrap_or(entry.slot)
        });
    }
}

/// Returns whether a statement adds a sub-object to this object.
fn has_members(statements: &[Statement], object: u16) -> bool {
    statements.iter().any(|statement| match statement {
        Statement::Edit { action, target, .. } => {
            let target = target.target;
            *action == Action::Add && target.index == object && target.sub.is_some()
        }
        Statement::Rename { .. } => false,
    })
}

/// The statements of a call as edits of the description, in their order, each with the place of its token.
fn edits(statements: &[Statement], report: &mut Report) -> Vec<Edit> {
    let mut edits = Vec::new();
    for statement in statements {
        let Statement::Edit {
            action,
            target,
            fields,
        } = statement
        else {
            continue;
        };
        let mut edit = Edit::new(*action, target.target);
        edit.target.span = report.number(target.span);
        for field in fields {
            let span = report.number(field.place);
            edit.changes.push(Spanned::new(field.change.clone(), span));
        }
        // Its code may be what could not be read.
        let is_half_read = !report.is_read(target.target.index) && target.target.sub.is_none();
        if *action == Action::Add && is_half_read && has_members(statements, target.target.index) {
            edit.changes
                .insert(0, Spanned::from(Change::Code(ObjectCode::Record)));
        }
        edits.push(edit);
    }
    edits
}
