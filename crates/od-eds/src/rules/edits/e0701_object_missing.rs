use crate::fact::Fact;
use crate::finding::{Finding, Form, Rule, Severity::Error};
use crate::patch::target::Target;
use crate::span::Spanned;
use alloc::string::ToString;

pub(crate) static RULE: Rule = Rule {
    code: "E0701",
    severity: Error,
    title: "edit of a missing object",
    why: "A variant changes and removes only objects that its base has. odkit reports the statement and ignores it.",
    source: "odkit, object_dictionary!",
    example: "modify 0x2000 { default = 7 }      // the EDS has no 2000h",
    says: "{object} does not exist",
    help: "list the objects of a file with `odkit dump`",
    also: &[NEAR, FIRST, MEMBERS],
    ..Rule::NEW
};

/// An object whose index differs in one digit.
const NEAR: Form = Form {
    help: "write `{meant}` (\"{name}\")",
    ..Form::OWN
};
/// A target that nothing is like.
const FIRST: Form = Form {
    help: "write `add {target} {{ … }}` first",
    ..Form::OWN
};
const MEMBERS: Form = Form {
    help: "write one of the sub-indices {subs}",
    ..Form::OWN
};

/// The finding about an object that the description lacks.
pub(crate) fn finding(target: &Spanned<Target>) -> Finding {
    let finding = target.finding(&RULE, target.span);
    finding.fact("object", Fact::Index(target.index))
}

/// The same, with the object of this name that is likely meant.
pub(crate) fn near(target: &Spanned<Target>, meant: Target, name: &str) -> Finding {
    let finding = finding(target).form(&NEAR);
    finding.fact("meant", meant.to_string()).fact("name", name)
}

/// The same, in a description without objects.
pub(crate) fn first(target: &Spanned<Target>) -> Finding {
    let object = Target::object(target.index);
    finding(target)
        .form(&FIRST)
        .fact("target", object.to_string())
}

/// The finding about a sub-index that the object lacks; it has those that `subs` names.
pub(crate) fn sub_index(target: &Spanned<Target>, subs: &str) -> Finding {
    let finding = target.finding(&RULE, target.span);
    let finding = finding.fact("object", target.address());
    match subs {
        "" => finding.form(&FIRST).fact("target", target.to_string()),
        subs => finding.form(&MEMBERS).fact("subs", subs),
    }
}
