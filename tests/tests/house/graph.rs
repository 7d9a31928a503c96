//! Files and the arrows between them.

use std::collections::{BTreeMap, BTreeSet};

/// The imports of each file: paths from the workspace, each with the first line that makes it and
/// the name there.
#[derive(Default)]
pub(crate) struct Arrows(BTreeMap<String, BTreeMap<String, (usize, String)>>);

/// An import that is part of a cycle.
pub(crate) struct Arrow<'a> {
    pub(crate) from: &'a str,
    pub(crate) to: &'a str,
    /// The line in `from`.
    pub(crate) line: usize,
    /// Name that the line imports.
    pub(crate) name: &'a str,
}

impl Arrows {
    /// Adds that `from` uses `name` of `to` in this line.
    pub(crate) fn add(&mut self, from: &str, to: &str, line: usize, name: &str) {
        if from != to {
            let all = self.0.entry(from.into()).or_default();
            let first = all.entry(to.into()).or_insert((line, name.into()));
            if line < first.0 {
                *first = (line, name.into());
            }
        }
    }

    /// The arrows that are part of a cycle.
    pub(crate) fn circles(&self) -> Vec<Arrow<'_>> {
        let mut found = Vec::new();
        for (from, all) in &self.0 {
            for (to, (line, name)) in all {
                if self.leads(to, from) {
                    found.push(Arrow {
                        from,
                        to,
                        line: *line,
                        name,
                    });
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
            let next = self.0.get(file).into_iter().flat_map(BTreeMap::keys);
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
        arrows.add(from, to, 1, to);
    }
    let circles = arrows.circles();
    let found: Vec<_> = circles.iter().map(|found| (found.from, found.to)).collect();
    assert_eq!(found, [("a", "b"), ("b", "c"), ("c", "a")]);
}
