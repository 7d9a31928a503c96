//! W0637: device supports no bit rate.

use crate::finding::Severity::Warning;
use crate::finding::Rule;

pub(crate) static RULE: Rule = Rule {
    code: "W0637",
    severity: Warning,
    title: "device supports no bit rate",
    why: "[DeviceInfo] says the bit rates of a device; a tool that offers what all devices have offers nothing.",
    source: "CiA 306-1, DeviceInfo",
    before: "\
        [DeviceInfo]\n\
        BaudRate_50=0\n\
        BaudRate_125=0\n\
        BaudRate_250=0\n\
        BaudRate_500=0\n\
        BaudRate_800=0\n\
        BaudRate_1000=0\n\
        SimpleBootUpMaster=0",
    after: "\
        [DeviceInfo]\n\
        BaudRate_50=0\n\
        BaudRate_125=1\n\
        BaudRate_250=1\n\
        BaudRate_500=1\n\
        BaudRate_800=0\n\
        BaudRate_1000=1\n\
        SimpleBootUpMaster=0",
    ..Rule::NEW
};
