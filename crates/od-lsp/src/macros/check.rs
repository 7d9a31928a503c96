//! Findings about a call of the macro: errors of the file, and of the statements.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

use od_eds::check::check;
use od_eds::patch::{self, Action, Change, Edit, Raw};
use od_eds::row::{CODES, GROUPS, Row, TYPES};
use od_eds::{Description, Finding, Severity, Span, Spanned, say, token, token_of};
use od_model::{Access, DataType};

use crate::file::File;
use crate::macros::base::{Base, Find};
use crate::macros::call::{self, Call, Statement};
use crate::macros::scan::{Kind, Token};
use crate::types::{Diagnostic, RelatedInformation};

/// Severities of the protocol.
const ERROR: u8 = 1;
const WARNING: u8 = 2;
/// Limit of shown errors of the file; the others are counted.
const SHOWN: usize = 20;

/// The diagnostics of the calls in a source.
pub(crate) fn of(file: &File, find: Find<'_>) -> Vec<Diagnostic> {
    let calls = call::all(file.str());
    calls
        .iter()
        .flat_map(|call| of_call(file, call, find))
        .collect()
}

fn of_call(file: &File, call: &Call, find: Find<'_>) -> Vec<Diagnostic> {
    let (base, home) = match Base::of(file, call, find) {
        Ok(base) => (
            base,
            call.eds.clone().unwrap_or(call.body.start..call.body.start),
        ),
        Err((bytes, why)) => return vec![diagnostic(file, bytes, "", why)],
    };
    let mut found = Vec::new();
    if let Some(base) = &base {
        of_file(file, base, &home, &mut found);
    }
    let mut whole = base.map(|base| base.description).unwrap_or_default();
    let before = if whole.objects.is_empty() {
        Vec::new()
    } else {
        check(&whole)
    };
    let mut places = Vec::new();
    let before = patched(
        file,
        call,
        None,
        &mut whole,
        &before,
        &mut places,
        &mut found,
    );
    let variants = call.statements.iter().filter_map(|own| own.variant).max();
    for variant in 0..variants.map_or(0, |last| last + 1) {
        patched(
            file,
            call,
            Some(variant),
            &mut whole.clone(),
            &before,
            &mut places,
            &mut found,
        );
    }
    found.retain(|one| !call.is_quiet || one.severity == ERROR);
    found
}

/// Findings about the file, at its path: each error that prevents a device. Other findings are shown once for each
/// rule, with their number.
fn of_file(file: &File, base: &Base, home: &Range<usize>, found: &mut Vec<Diagnostic>) {
    let mut show = |finding: &Finding, more: usize| {
        let mut told = told(file, home.clone(), finding);
        if more > 0 {
            told.message
                .push_str(&format!("\nnote: {more} more of this rule"));
        }
        let location = base.place(finding);
        told.related_information
            .extend(location.map(|location| RelatedInformation {
                location,
                message: "here".into(),
            }));
        found.push(told);
    };
    let all = base.findings.iter();
    let all = all.filter(|finding| finding.severity() >= Severity::Warning);
    let (unsound, others): (Vec<&Finding>, Vec<&Finding>) = all.partition(|one| one.is_unsound());
    for finding in unsound.iter().take(SHOWN) {
        show(finding, 0);
    }
    let mut by_rule: BTreeMap<&str, (&Finding, usize)> = BTreeMap::new();
    for finding in others {
        by_rule
            .entry(finding.code())
            .and_modify(|(_, more)| *more += 1)
            .or_insert((finding, 0));
    }
    for (finding, more) in by_rule.into_values() {
        show(finding, more);
    }
    if let Some(more @ 1..) = unsound.len().checked_sub(SHOWN) {
        let said = format!("{more} more errors; open the file, or run `odkit check`");
        found.push(diagnostic(file, home.clone(), "", said));
    }
}

/// Applies the statements of a variant, or those of the module, to a description with the findings `before`. New findings
/// are shown at their tokens, or at the statement that caused them. `places` are the tokens of the call so far. Returns
/// all findings about the result.
fn patched(
    file: &File,
    call: &Call,
    variant: Option<usize>,
    description: &mut Description,
    before: &[Finding],
    places: &mut Vec<Range<usize>>,
    found: &mut Vec<Diagnostic>,
) -> Vec<Finding> {
    let first = places.len();
    let own = call.statements.iter().filter(|own| own.variant == variant);
    let own: Vec<&Statement> = own.collect();
    let mut edits: Vec<Edit> = Vec::new();
    let mut broken = BTreeSet::new();
    for statement in &own {
        match (edit(file.str(), statement, places), &statement.target) {
            (Some(edit), _) => edits.push(edit),
            (None, Some((target, _))) if statement.action.is_some() => {
                broken.insert(target.address());
            }
            (None, _) => {}
        }
    }
    let mut faults = patch::apply(description, &edits);
    for statement in own.iter().filter(|own| own.action.is_none()) {
        if let Some((target, bytes)) = &statement.target {
            let target = Spanned::new(*target, mark(bytes, places));
            faults.extend(patch::missing(description, &target));
        }
    }
    let checked = check(description);
    let index = |finding: &Finding| finding.object.map(|address| address.index);
    broken.extend(faults.iter().filter_map(|fault| fault.object));
    let is_own = |finding: &&Finding| {
        finding.severity() >= Severity::Warning
            && !finding.may_follow(&broken)
            && !before.contains(finding)
    };
    // The last edit of the object, for a finding that has no place or one in the file. No statement
    // can correct other parts of the file, such as [DeviceInfo].
    let culprit = |finding: &Finding| {
        let is_in_file = finding.span().is_some_and(|span| token_of(span).is_none());
        if !finding.is_unsound() && !finding.rule.is_of_one_value() && is_in_file {
            return None;
        }
        let last = |index: u16| edits.iter().rev().find(|edit| edit.target.index == index);
        let facts = finding.facts.iter();
        let of_facts = || facts.filter_map(|(_, fact)| last(fact.index()?)).next();
        let edit = index(finding).and_then(last).or_else(of_facts);
        edit.map(|edit| edit.target.span)
    };
    let new = checked.iter().filter(is_own);
    let mut placed: Vec<(u32, &Finding)> = faults
        .iter()
        .chain(new)
        .filter_map(|finding| {
            let own = finding.span().and_then(token_of);
            let own = own.filter(|id| *id as usize >= first);
            let id = own.or_else(|| culprit(finding).and_then(token_of))?;
            Some((id, finding))
        })
        .collect();
    placed.sort_by_key(|(id, _)| *id);
    for (id, finding) in placed {
        let bytes = places.get(id as usize);
        found.extend(bytes.map(|bytes| told(file, bytes.clone(), finding)));
    }
    checked
}

fn mark(bytes: &Range<usize>, places: &mut Vec<Range<usize>>) -> Span {
    places.push(bytes.clone());
    token(places.len() as u32 - 1)
}

fn edit(source: &str, own: &Statement, places: &mut Vec<Range<usize>>) -> Option<Edit> {
    let (target, bytes) = own.target.as_ref()?;
    let mut edit = Edit::new(own.action?, *target);
    edit.target = Spanned::new(*target, mark(bytes, places));
    for field in own.fields.split(|token| token.kind == Kind::Sign(b';')) {
        let [key, sign, value @ ..] = field else {
            continue;
        };
        let (Some(first), Some(last)) = (value.first(), value.last()) else {
            continue;
        };
        if sign.kind != Kind::Sign(b'=') {
            continue;
        }
        let key = source.get(key.bytes.clone()).unwrap_or_default();
        let change = change(source, key, value)?;
        let span = mark(&(first.bytes.start..last.bytes.end), places);
        edit.changes.push(Spanned::new(change, span));
    }
    // An incomplete `add` lacks fields, which rustc reports.
    let is_typed = own.action == Some(Action::Add) && own.braces.is_none();
    (!is_typed).then_some(edit)
}

/// A field; `None` for one that only the macro can check.
fn change(source: &str, key: &str, value: &[Token]) -> Option<Change> {
    let text = |token: &Token| source.get(token.bytes.clone());
    let [only] = value else {
        let raw = raw(source, value)?;
        return match key {
            "default" => Some(Change::Default(Some(raw))),
            "low" => Some(Change::Low(Some(raw))),
            "high" => Some(Change::High(Some(raw))),
            _ => None,
        };
    };
    let word = text(only)?;
    Some(match key {
        "name" if only.kind == Kind::Text => Change::Name(word.into()),
        "type" => Change::Type(data_type(word)?),
        "access" => Change::Access(Access::ALL.into_iter().find(|own| own.name() == word)?),
        "code" => Change::Code(CODES.iter().find(|(own, _)| *own == word)?.1),
        "save" => Change::Save(GROUPS.iter().find(|(own, _)| *own == word)?.1),
        "capacity" => Change::Capacity(word.parse().ok()?),
        "mappable" => Change::Mappable(word == "true"),
        "default" => Change::Default(raw_or_none(source, value)?),
        "low" => Change::Low(raw_or_none(source, value)?),
        "high" => Change::High(raw_or_none(source, value)?),
        _ => return None,
    })
}

fn data_type(word: &str) -> Option<DataType> {
    let known = TYPES.iter().find(|(own, _)| *own == word);
    let named = || DataType::ALL.into_iter().find(|own| own.name() == word);
    known.map(|(_, data_type)| *data_type).or_else(named)
}

fn raw_or_none(source: &str, value: &[Token]) -> Option<Option<Raw>> {
    let text = source.get(value.first()?.bytes.clone())?;
    match text {
        "none" => Some(None),
        _ => raw(source, value).map(Some),
    }
}

/// An integer, a formula with the node ID, a truth value or a text; the macro checks other values.
fn raw(source: &str, value: &[Token]) -> Option<Raw> {
    if let [sign, name, rest @ ..] = value
        && sign.kind == Kind::Sign(b'$')
        && source.get(name.bytes.clone()) == Some("NODEID")
    {
        return match rest {
            [] => Some(Raw::NodeId(0)),
            [plus, offset @ ..] if plus.kind == Kind::Sign(b'+') => match raw(source, offset)? {
                Raw::Integer(offset) => u32::try_from(offset).ok().map(Raw::NodeId),
                _ => None,
            },
            _ => None,
        };
    }
    let (negative, token) = match value {
        [sign, token] if sign.kind == Kind::Sign(b'-') => (true, token),
        [token] => (false, token),
        _ => return None,
    };
    let text = source.get(token.bytes.clone())?;
    match (token.kind, text) {
        (Kind::Number, text) => {
            let plain = text.replace('_', "");
            let number = match plain.strip_prefix("0x") {
                Some(hex) => i128::from_str_radix(hex, 16).ok()?,
                None => plain.parse().ok()?,
            };
            Some(Raw::Integer(if negative { -number } else { number }))
        }
        (Kind::Word, "true" | "false") => Some(Raw::Bool(text == "true")),
        (Kind::Text, text) if !text.contains('\\') => Some(Raw::Text(text.into())),
        _ => None,
    }
}

fn told(file: &File, bytes: Range<usize>, finding: &Finding) -> Diagnostic {
    let said = say(finding, &Row);
    let mut message = match said.address {
        Some(address) if !said.code.starts_with("E07") => {
            format!("object {address}: {}", said.message)
        }
        _ => said.message,
    };
    if !said.help.is_empty() {
        message.push_str("\nhelp: ");
        message.push_str(&said.help);
    }
    Diagnostic {
        severity: if finding.is_unsound() { ERROR } else { WARNING },
        ..diagnostic(file, bytes, said.code, message)
    }
}

fn diagnostic(file: &File, bytes: Range<usize>, code: &'static str, message: String) -> Diagnostic {
    Diagnostic {
        range: file.text.range(bytes),
        severity: ERROR,
        code,
        source: "odkit",
        message,
        related_information: Vec::new(),
    }
}
