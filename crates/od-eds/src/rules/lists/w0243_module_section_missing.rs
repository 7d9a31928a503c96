use alloc::format;
use alloc::vec::Vec;

use crate::description::Description;
use crate::finding::{Check, Finding, Form, Rule, Severity};
use crate::scan::number::number;
use crate::span::Span;

pub(crate) static W0243: Rule = Rule {
    buildable: true,
    title: "module has no section",
    why: "A configuration tool offers the module but cannot add it. [SupportedModules] counts the modules; [MxModuleInfo] describes module x.",
    source: "CiA 306-1, SupportedModules",
    says: "section [{section}] of module {module} is missing",
    help: "add a section [{section}], or lower NrOfEntries",
    also: &[CONNECTED, NUMBER],
    check: Check::Device(check),
    ..Rule::of("W0243")
};

/// The help for a module that is connected and not supported.
const CONNECTED: Form = Form {
    help: "write the number of a module of [SupportedModules]",
    ..Form::OWN
};

/// Sentence for a number that no module has.
const NUMBER: Form = Form {
    says: "`{given}` is not the number of a module",
    help: "write the number of a module, from 1",
};

fn check(description: &Description, findings: &mut Vec<Finding>) {
    let connected = description.section("ConnectedModules");
    let slots = connected.iter().flat_map(|section| &section.pairs);
    let slots = || slots.clone().filter(|(key, _)| number(key).is_some());
    for (_, given) in slots() {
        if !number(given).is_some_and(|module| (1..=0xFFFF).contains(&module)) {
            let finding = W0243.given(given).form(&NUMBER);
            findings.push(finding.severity_of(Severity::Error));
        }
    }
    let Some(modules) = description.section("SupportedModules") else {
        return;
    };
    let count = modules.get("NrOfEntries").and_then(|count| number(count));
    let count = count.unwrap_or(0).clamp(0, 255);
    let mut needs = |module: i128, span: Span, form: &'static Form| {
        let section = format!("M{module}ModuleInfo");
        if description.section(&section).is_none() {
            let finding = W0243.at(span).form(form).fact("section", section);
            let finding = finding.fact("module", module);
            // The device does not support it.
            let is_connected = *form == CONNECTED;
            findings.push(if is_connected {
                finding.severity_of(Severity::Error)
            } else {
                finding
            });
        }
    };
    (1..=count).for_each(|module| needs(module, modules.name.span, &Form::OWN));
    for (_, given) in slots() {
        if let Some(module) = number(given).filter(|module| (count + 1..=0xFFFF).contains(module)) {
            needs(module, given.span, &CONNECTED);
        }
    }
}
