use crate::finding::{Finding, Form, Rule, Severity::Info};
use crate::scan::known::Form as Wanted;
use crate::scan::placed::Text;

pub(crate) static RULE: Rule = Rule {
    code: "I0610",
    severity: Info,
    title: "date or time is not written as CiA 306 writes it",
    why: "`MM-DD-YYYY` and `hh:mmAM`. It is kept as it is; some editors drop it.",
    source: "CiA 306-1, FileInfo",
    says: "{name} is written as `{given}`",
    help: "write month, day and year: `07-14-2026`",
    also: &[TIME],
    ..Rule::NEW
};

const TIME: Form = Form {
    help: "write hour, minute and half of the day: `09:30AM`",
    ..Form::OWN
};

/// The finding about a date or a time in another form.
pub(crate) fn finding(key: &str, given: &Text<'_>, wanted: Wanted) -> Finding {
    let finding = RULE.given(given).fact("name", key);
    match wanted {
        Wanted::Time => finding.form(&TIME),
        _ => finding,
    }
}
