use crate::finding::{Fixability, Rule, Severity::Info};

pub(crate) static RULE: Rule = Rule {
    code: "I0411",
    severity: Info,
    title: "$NODEID is not written as `$NODEID+n`",
    why: "Another order, other case or blanks are read the same; not every reader does.",
    source: "CiA 306-1, $NODEID",
    fixability: Fixability::Safe,
    says: "`{given}` is read as `$NODEID` plus a number",
    help: "write `{key={right}}`",
    ..Rule::NEW
};
