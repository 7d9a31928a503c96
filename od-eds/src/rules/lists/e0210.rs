//! E0210: text has no objects.

use crate::finding::Severity::Error;
use crate::finding::Rule;

pub(crate) static RULE: Rule = Rule {
    code: "E0210",
    severity: Error,
    title: "text has no objects",
    why: "This is no EDS and no DCF, or an empty one.",
    source: "CiA 306-1",
    before: "\
        [FileInfo]\n\
        FileName=case.eds\n\
        EDSVersion=4.0",
    after: "\
        [FileInfo]\n\
        FileName=case.eds\n\
        FileVersion=1\n\
        FileRevision=0\n\
        EDSVersion=4.0\n\
        Description=A case\n\
        CreationTime=09:30AM\n\
        CreationDate=11-21-2026\n\
        \n\
        [DeviceInfo]\n\
        VendorName=odkit\n\
        VendorNumber=0x5F\n\
        ProductName=Case\n\
        ProductNumber=0x10\n\
        RevisionNumber=0x10001",
    ..Rule::NEW
};
