//! I0610: date or time is not written as CiA 306 writes it.

use crate::Severity::Info;
use crate::check::rules::{Mending, Rule};

pub(crate) const RULE: Rule = Rule {
    code: "I0610",
    severity: Info,
    title: "date or time is not written as CiA 306 writes it",
    why: "`MM-DD-YYYY` and `hh:mmAM`. It is kept as it is; some editors drop it.",
    source: "CiA 306-1, FileInfo",
    mending: Mending::None,
    before: "CreationDate=2026-07-14\nCreationTime=14:30\n",
    after: "CreationDate=07-14-2026\nCreationTime=02:30PM\n",
};
