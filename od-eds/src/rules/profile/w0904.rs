//! W0904: encoder lacks a mandatory object.

use crate::finding::Severity::Warning;
use crate::finding::Rule;

pub(crate) static RULE: Rule = Rule {
    code: "W0904",
    severity: Warning,
    title: "encoder lacks a mandatory object",
    why: "A master reads position, resolution and status of every CiA 406 encoder in the same objects.",
    source: "CiA 406, object overview",
    before: "\
        [OptionalObjects]\n\
        SupportedObjects=15\n\
        1=0x1017\n\
        8=0x6500\n\
        9=0x6502\n\
        10=0x6503\n\
        11=0x6504\n\
        12=0x6505\n\
        13=0x6506\n\
        14=0x6507\n\
        15=0x6509\n\
        \n\
        [6500]\n\
        DataType=0x0006",
    after: "\
        [OptionalObjects]\n\
        SupportedObjects=16\n\
        1=0x1017\n\
        8=0x6500\n\
        9=0x6501\n\
        10=0x6502\n\
        11=0x6503\n\
        12=0x6504\n\
        13=0x6505\n\
        14=0x6506\n\
        15=0x6507\n\
        16=0x6509\n\
        \n\
        [6501]\n\
        ParameterName=Physical resolution",
    ..Rule::NEW
};
