//! A base and its variants: edits applied, rules checked, handles named.

use std::collections::BTreeSet;

use od_eds::patch;
use od_eds::{Description, Finding, Key, Tables};
use proc_macro2::Span;

use crate::files::Files;
use crate::handles::{self, Item, Naming};
use crate::input::{Input, Statement};
use crate::report::Report;
use crate::source::Source;
use crate::{findings, layout, lower};

/// The devices that a call describes.
pub(crate) struct Family {
    pub(crate) base: Device,
    /// In the order of the call's variants.
    pub(crate) variants: Vec<Device>,
    /// Number of findings about the file that are not errors.
    pub(crate) remarks: usize,
}

/// One device.
pub(crate) struct Device {
    pub(crate) tables: Tables,
    pub(crate) items: Vec<Item>,
}

/// Builds all there is to build; what is wrong goes to `report`.
pub(crate) fn build(input: &Input, source: &Source, report: &mut Report) -> Family {
    // Without the file nothing is known to be wrong: one mistake, one error.
    // The same after a fault of grammar.
    let quiet = !report.is_empty();
    let home = match &input.eds {
        Some(path) => path.span(),
        None => input.name.span(),
    };
    let files = source.files.as_ref();
    let told = Findings { home, files, quiet };

    let mut base = source.description.clone();
    let found = told.patch(
        &mut base,
        &source.description,
        &input.statements,
        home,
        "",
        report,
    );
    let left = source.findings.iter();
    let left = left.filter(|finding| !fixed(finding, &base, &input.statements));
    let mut eds: Vec<Finding> = left.cloned().chain(found).collect();
    eds.sort_by_key(|finding| finding.span().map_or(0, |span| span.start));
    source.allows.clone().filter(&mut eds);
    told.tell(&eds, &base, report);
    if let (Some(profile), false) = (&input.profile, quiet) {
        crate::profile::check(profile, &base, report);
    }

    let variants: Vec<Description> = input
        .variants
        .iter()
        .map(|variant| {
            let mut description = base.clone();
            let context = format!("variant `{}`: ", variant.name);
            told.patch(
                &mut description,
                &base,
                &variant.statements,
                variant.name.span(),
                &context,
                report,
            );
            description
        })
        .collect();
    let mut family = devices(input, source, base, variants, report);
    if source.files.is_some() {
        family.remarks = eds.iter().filter(|finding| !finding.is_unsound()).count();
    }
    family
}

/// Did the module's statements replace what the reader could not read? So a file that
/// cannot be changed is fixed in the call.
fn fixed(finding: &Finding, base: &Description, statements: &[Statement]) -> bool {
    let Some(address) = finding.object else {
        return false;
    };
    if base.entry(address).is_none() && !base.objects.contains_key(&address.index) {
        return true;
    }
    // An edit of the default takes the place of a DCF's value, too.
    let key = match finding.key {
        Some(Key::ParameterValue) => Key::DefaultValue,
        Some(key) if finding.is_unsound() => key,
        _ => return false,
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
    layout::lay_out(&mut all);

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

/// Receiver of findings.
struct Findings<'a> {
    home: Span,
    files: Option<&'a Files>,
    quiet: bool,
}

impl Findings<'_> {
    /// Applies statements to `description`, which is still `before`, and checks the result.
    ///
    /// Faults of the statements are reported. What the checks find in a base is
    /// returned; what they find in a variant that was not there `before` is reported
    /// at the edit that made it, or at `home`.
    fn patch(
        &self,
        description: &mut Description,
        before: &Description,
        statements: &[Statement],
        home: Span,
        context: &str,
        report: &mut Report,
    ) -> Vec<Finding> {
        let first = report.numbers();
        let edits = lower::edits(statements, report);
        let mut findings = patch::apply(description, &edits);
        findings.extend(handles::check_renames(statements, description, report));
        if self.quiet {
            return Vec::new();
        }
        if !findings.is_empty() {
            self.tell(&findings, description, report);
            return Vec::new();
        }
        let found = od_eds::check::check(description);
        if edits.is_empty() {
            return if context.is_empty() {
                found
            } else {
                Vec::new()
            };
        }
        let mut known = if before.objects.is_empty() {
            Vec::new()
        } else {
            od_eds::check::check(before)
        };
        known.retain(Finding::is_unsound);
        let (old, new): (Vec<_>, Vec<_>) = found
            .into_iter()
            .partition(|f| !f.is_unsound() || known.contains(f));
        let patch = findings::Patch {
            edits: &edits,
            tokens: first..report.numbers(),
            home,
            context,
            files: self.files,
        };
        patch.blame(&new, description, report);
        if context.is_empty() { old } else { Vec::new() }
    }

    fn tell(&self, findings: &[Finding], description: &Description, report: &mut Report) {
        findings::tell(findings, self.home, self.files, description, report);
    }
}
