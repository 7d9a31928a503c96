use alloc::format;
use alloc::vec::Vec;

use crate::description::Description;
use crate::finding::{Check, Finding, Rule, Severity::Warning};
use crate::scan::number::number;

pub(crate) static RULE: Rule = Rule {
    code: "W0243",
    severity: Warning,
    title: "module has no section",
    why: "A configuration tool offers the module but cannot add it. [SupportedModules] counts the modules; [MxModuleInfo] describes module x.",
    source: "CiA 306-1, SupportedModules",
    says: "section [{section}] of module {module} is missing",
    help: "add a section [{section}], or lower NrOfEntries",
    check: Check::Device(check),
    ..Rule::NEW
};

fn check(description: &Description, findings: &mut Vec<Finding>) {
    let Some(modules) = description.section("SupportedModules") else {
        return;
    };
    let count = modules.get("NrOfEntries").and_then(|count| number(count));
    for module in 1..=count.unwrap_or(0).clamp(0, 255) {
        let section = format!("M{module}ModuleInfo");
        if description.section(&section).is_none() {
            let finding = RULE.at(modules.name.span).fact("section", section);
            findings.push(finding.fact("module", module));
        }
    }
}
