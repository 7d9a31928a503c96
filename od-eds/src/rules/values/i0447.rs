//! I0447: mappable, but into which PDO.

use crate::finding::Severity::Info;
use crate::finding::Rule;

pub(crate) static RULE: Rule = Rule {
    code: "I0447",
    severity: Info,
    title: "mappable, but into which PDO",
    why: "An object that is rw and mappable may stand in TPDOs and RPDOs alike; rwr or rww says which, if it is only one.",
    source: "CiA 306-1, AccessType",
    ..Rule::NEW
};
