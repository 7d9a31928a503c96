use crate::finding::{Fixability, Rule, Severity::Info};
use crate::rules::values::shared::WRITE;

pub(crate) static RULE: Rule = Rule {
    code: "I0411",
    severity: Info,
    buildable: true,
    title: "$NODEID formula is not written as `$NODEID+n`",
    why: "odkit also reads another order, other case and blanks; some tools do not. Without `$NODEID` no tool finds the node ID, and the finding is an error.",
    source: "CiA 306-1, $NODEID",
    fixability: Fixability::Safe,
    says: "odkit reads `{given}` as `$NODEID` plus a number",
    help: WRITE,
    ..Rule::NEW
};
