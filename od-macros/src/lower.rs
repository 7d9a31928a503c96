//! The statements of a call as edits of the model, each knowing its token.

use od_eds::Spanned;
use od_eds::patch::Edit;

use crate::input::Statement;
use crate::report::Report;

/// The edits among the statements, in their order.
pub(crate) fn edits(statements: &[Statement], report: &mut Report) -> Vec<Edit> {
    let mut edits = Vec::new();
    for statement in statements {
        let Statement::Edit {
            action,
            target,
            fields,
        } = statement
        else {
            continue;
        };
        let mut edit = Edit::new(*action, target.target);
        edit.target.span = report.number(target.span);
        for field in fields {
            let span = report.number(field.place);
            edit.changes.push(Spanned::new(field.change.clone(), span));
        }
        edits.push(edit);
    }
    edits
}
