use crate::finding::{Finding, Form, Rule, Severity::Info};
use crate::scan::known::Form as Wanted;
use crate::scan::placed::Text;

pub(crate) static RULE: Rule = Rule {
    code: "I0610",
    severity: Info,
    title: "date or time is not as CiA 306 specifies",
    why: "Some editors drop the value; odkit keeps it. CiA 306 specifies `MM-DD-YYYY` and `hh:mmAM`.",
    source: "CiA 306-1, FileInfo",
    says: "{name} `{given}` is not as CiA 306 specifies",
    help: "write month, day and year, such as `07-14-2026`",
    also: &[TIME],
    ..Rule::NEW
};

const TIME: Form = Form {
    help: "write hour, minute, and AM or PM, such as `09:30AM`",
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
