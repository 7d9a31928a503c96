//! Differences of two dictionaries, and their impact on a master.
//!
//! [`compare`] reads two dictionaries entry by entry, whatever their source: a file, a
//! compiled device, a variant. Order, spelling and comments of a text do not count.

mod difference;
mod fields;
mod impact;

pub use difference::{Difference, Field, Impact};

use alloc::string::String;
use alloc::vec::Vec;

use od_model::{Address, Dictionary, Entry, Object};

/// All differences, by address.
pub fn compare(before: Dictionary<'_>, after: Dictionary<'_>) -> Vec<Difference> {
    let mut found = Vec::new();
    let (old, new): (Vec<_>, Vec<_>) = (before.objects().collect(), after.objects().collect());
    let pairs = merge(&old, &new, |object| object.index);
    for pair in pairs {
        match pair {
            (Some(old), None) => found.push(whole(before, old, Field::ObjectRemoved)),
            (None, Some(new)) => found.push(whole(after, new, Field::ObjectAdded)),
            (Some(old), Some(new)) => object(&mut found, (before, old), (after, new)),
            (None, None) => {}
        }
    }
    found
}

fn object(
    found: &mut Vec<Difference>,
    (before, old): (Dictionary<'_>, &Object),
    (after, new): (Dictionary<'_>, &Object),
) {
    let (old_name, new_name) = (before.text(old.name), after.text(new.name));
    let about = |field, before: &str, after: &str, impact| Difference {
        index: new.index,
        sub: None,
        name: new_name.into(),
        field,
        before: before.into(),
        after: after.into(),
        impact,
    };
    if old.code != new.code {
        let impact = impact::object_code(old.code, new.code);
        found.push(about(
            Field::ObjectCode,
            old.code.name(),
            new.code.name(),
            impact,
        ));
    }
    // The name of a VAR is the name of its entry.
    if old_name != new_name && (old.code.has_members() || new.code.has_members()) {
        found.push(about(Field::Name, old_name, new_name, Impact::Compatible));
    }
    let (olds, news): (Vec<_>, Vec<_>) =
        (before.members(old).collect(), after.members(new).collect());
    let members = merge(&olds, &news, |entry| entry.address);
    for pair in members {
        match pair {
            (Some(entry), None) => found.push(part(before, entry, Field::EntryRemoved)),
            (None, Some(entry)) => found.push(part(after, entry, Field::EntryAdded)),
            (Some(a), Some(b)) => {
                let has_members = old.code.has_members() || new.code.has_members();
                let sub = has_members.then_some(b.address.sub);
                fields::compare(found, sub, (before, a), (after, b));
            }
            (None, None) => {}
        }
    }
}

fn whole(dictionary: Dictionary<'_>, object: &Object, field: Field) -> Difference {
    let text = alloc::format!(
        "{} of {}",
        object.code.name(),
        match object.count {
            1 => "1 entry".into(),
            count => alloc::format!("{count} entries"),
        }
    );
    let name = dictionary.text(object.name);
    gone_or_new(object.index, None, name, field, text)
}

fn part(dictionary: Dictionary<'_>, entry: &Entry, field: Field) -> Difference {
    let text = alloc::format!("{} {}", entry.data_type.name(), entry.access.name());
    let Address { index, sub } = entry.address;
    gone_or_new(index, Some(sub), dictionary.text(entry.name), field, text)
}

fn gone_or_new(index: u16, sub: Option<u8>, name: &str, field: Field, text: String) -> Difference {
    let is_new = matches!(field, Field::ObjectAdded | Field::EntryAdded);
    let (before, after, impact) = if is_new {
        (String::new(), text, Impact::Compatible)
    } else {
        (text, String::new(), Impact::Breaking)
    };
    Difference {
        index,
        sub,
        name: name.into(),
        field,
        before,
        after,
        impact,
    }
}

/// Goes through two sorted lists in parallel; entries with the same key come together.
fn merge<'a, 'b, T, K: Ord>(
    left: &'a [T],
    right: &'b [T],
    key: impl Fn(&T) -> K,
) -> Vec<(Option<&'a T>, Option<&'b T>)> {
    let (mut left, mut right) = (left.iter().peekable(), right.iter().peekable());
    let mut pairs = Vec::new();
    loop {
        let order = match (left.peek(), right.peek()) {
            (Some(a), Some(b)) => key(a).cmp(&key(b)),
            (Some(_), None) => core::cmp::Ordering::Less,
            (None, Some(_)) => core::cmp::Ordering::Greater,
            (None, None) => return pairs,
        };
        pairs.push(match order {
            core::cmp::Ordering::Less => (left.next(), None),
            core::cmp::Ordering::Greater => (None, right.next()),
            core::cmp::Ordering::Equal => (left.next(), right.next()),
        });
    }
}

#[cfg(test)]
mod tests;
