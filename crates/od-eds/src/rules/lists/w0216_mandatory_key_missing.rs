use alloc::format;
use alloc::vec::Vec;

use crate::description::Description;
use crate::fact::Fact;
use crate::finding::{Check, Finding, Form, Rule, Severity::Info};
use crate::span::Span;

pub(crate) static W0216: Rule = Rule {
    title: "mandatory key of [FileInfo] or [DeviceInfo] is missing",
    why: "A tool that identifies the file or the device by the key finds nothing, and some tools stop. odkit assumes that the value is empty or 0.",
    source: "CiA 306-1, FileInfo and DeviceInfo",
    says: "[{section}] lacks {missing}",
    help: "add each key with its value, such as `{first}=`",
    also: &[LAST_EDS],
    check: Check::Device(check),
    ..Rule::of("W0216")
};

/// Help for a DCF that does not name its EDS.
const LAST_EDS: Form = Form {
    help: "add `LastEDS=` and the name of the EDS from which the DCF was made",
    ..Form::OWN
};

/// The finding about a DCF that does not name its EDS, at its `[FileInfo]`.
pub(crate) fn w0216_last_eds_missing(at: Span) -> Finding {
    let finding = W0216.at(at).form(&LAST_EDS).severity_of(Info);
    let finding = finding.fact("section", "FileInfo");
    finding.fact("missing", "`LastEDS`")
}

/// The mandatory keys. ModificationTime, ModificationDate and ModifiedBy belong to files that were changed;
/// OrderCode, DynamicChannelsSupported and GroupMessaging to devices that have them.
const SECTIONS: [(&str, &[&str]); 2] = [
    (
        "FileInfo",
        &[
            "FileName",
            "FileVersion",
            "FileRevision",
            "EDSVersion",
            "Description",
            "CreationTime",
            "CreationDate",
            "CreatedBy",
        ],
    ),
    (
        "DeviceInfo",
        &[
            "VendorName",
            "VendorNumber",
            "ProductName",
            "ProductNumber",
            "RevisionNumber",
            "BaudRate_10",
            "BaudRate_20",
            "BaudRate_50",
            "BaudRate_125",
            "BaudRate_250",
            "BaudRate_500",
            "BaudRate_800",
            "BaudRate_1000",
            "SimpleBootUpMaster",
            "SimpleBootUpSlave",
            "Granularity",
            "NrOfRXPDO",
            "NrOfTXPDO",
            "LSS_Supported",
        ],
    ),
];

fn check(description: &Description, findings: &mut Vec<Finding>) {
    if description.objects.is_empty() {
        return;
    }
    for (name, keys) in SECTIONS {
        let Some(section) = description.section(name) else {
            continue;
        };
        let missing = keys.iter().filter(|key| section.get(key).is_none());
        let missing: Vec<&&str> = missing.collect();
        if let Some(first) = missing.first() {
            let list = missing.iter().map(|key| Fact::Text(format!("`{key}`")));
            let finding = W0216.at(section.name.span).fact("section", name);
            let finding = finding.fact("missing", list.collect::<Vec<_>>());
            findings.push(finding.fact("first", **first));
        }
    }
}
