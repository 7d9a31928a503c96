//! Files and the arrows between them.

use std::collections::{BTreeMap, BTreeSet};

/// The imports of each file: paths from the workspace.
#[derive(Default)]
pub(crate) struct Arrows(BTreeMap<String, BTreeSet<String>>);

impl Arrows {
    /// Adds that `from` uses something of `to`.
    pub(crate) fn add(&mut self, from: &str, to: &str) {
        if from != to {
            self.0.entry(from.into()).or_default().insert(to.into());
        }
    }

    /// The arrows that are part of a circle.
    pub(crate) fn circles(&self) -> BTreeSet<(&str, &str)> {
        let mut found = BTreeSet::new();
        for (from, all) in &self.0 {
            for to in all {
                if self.leads(to, from) {
                    found.insert((from.as_str(), to.as_str()));
                }
            }
        }
        found
    }

    fn leads(&self, from: &str, to: &str) -> bool {
        let mut seen = BTreeSet::from([from]);
        let mut open = vec![from];
        while let Some(file) = open.pop() {
            if file == to {
                return true;
            }
            let next = self.0.get(file).into_iter().flatten();
            open.extend(next.map(String::as_str).filter(|next| seen.insert(next)));
        }
        false
    }
}

#[test]
fn a_circle_is_all_arrows_on_it() {
    let mut arrows = Arrows::default();
    for (from, to) in [
        ("a", "b"),
        ("b", "c"),
        ("c", "a"),
        ("c", "d"),
        ("d", "e"),
        ("d", "d"),
    ] {
        arrows.add(from, to);
    }
    let found: Vec<_> = arrows.circles().into_iter().collect();
    assert_eq!(found, [("a", "b"), ("b", "c"), ("c", "a")]);
}
