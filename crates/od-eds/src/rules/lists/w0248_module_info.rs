use alloc::format;
use alloc::vec::Vec;

use crate::description::Description;
use crate::finding::{Check, Finding, Form, Rule};
use crate::scan::number::number;

pub(crate) static W0248: Rule = Rule {
    title: "[MxModuleInfo] is incomplete or belongs to no module",
    why: "A configuration tool does not offer the module, or shows it without a name.",
    source: "CiA 306-1, MxModuleInfo",
    says: "[{section}] describes a module that [SupportedModules] does not list",
    help: "add `{module}=` and the name of the module to [SupportedModules]",
    also: &[LACKS],
    check: Check::Device(check),
    ..Rule::of("W0248")
};

/// Sentence for a module without a key.
const LACKS: Form = Form {
    says: "[{section}] lacks `{field}`",
    help: "add `{field}=` and its value",
};

fn check(description: &Description, findings: &mut Vec<Finding>) {
    let list = description.section("SupportedModules");
    for section in &description.sections {
        let name = section.name.as_str();
        let number_of = name.len().checked_sub("ModuleInfo".len()).and_then(|at| {
            let (start, word) = name.split_at_checked(at)?;
            let own = word.eq_ignore_ascii_case("ModuleInfo");
            number(start.strip_prefix(['M', 'm']).filter(|_| own)?)
        });
        let Some(module) = number_of else {
            continue;
        };
        let finding = W0248.at(section.name.span).fact("section", name);
        // No list of names is needed: the number of modules gives their names.
        let is_listed = list.is_some_and(|list| {
            let has_names = list.pairs.iter().any(|(key, _)| number(key).is_some());
            let count = list.get("NrOfEntries").and_then(|count| number(count));
            list.get(&format!("{module}")).is_some()
                || !has_names && count.is_some_and(|count| (1..=count).contains(&module))
        });
        if !is_listed {
            findings.push(finding.fact("module", module));
            continue;
        }
        for field in ["ProductName", "ProductVersion", "ProductRevision"] {
            if section.get(field).is_none() {
                findings.push(finding.clone().form(&LACKS).fact("field", field));
            }
        }
    }
}
