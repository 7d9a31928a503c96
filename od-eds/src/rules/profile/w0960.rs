//! W0960: cams are incomplete.

use crate::finding::Severity::Warning;
use crate::finding::Rule;

pub(crate) static RULE: Rule = Rule {
    code: "W0960",
    severity: Warning,
    title: "cams are incomplete",
    why: "A cam channel has its state, enable, polarity, two limits and a hysteresis.",
    source: "CiA 406, objects 6300h to 6330h",
    before: "\
        [OptionalObjects]\n\
        SupportedObjects=21\n\
        1=0x1017\n\
        12=0x6320\n\
        13=0x6500\n\
        14=0x6501\n\
        15=0x6502\n\
        16=0x6503\n\
        17=0x6504\n\
        18=0x6505\n\
        19=0x6506\n\
        20=0x6507\n\
        21=0x6509\n\
        \n\
        [6320sub1]",
    after: "\
        [OptionalObjects]\n\
        SupportedObjects=22\n\
        1=0x1017\n\
        12=0x6320\n\
        13=0x6330\n\
        14=0x6500\n\
        15=0x6501\n\
        16=0x6502\n\
        17=0x6503\n\
        18=0x6504\n\
        19=0x6505\n\
        20=0x6506\n\
        21=0x6507\n\
        22=0x6509",
    ..Rule::NEW
};
