//! Deviations that a manual documents: cases that a product may skip, with the reason.

use super::eds::Eds;

/// Cases that a product may skip.
#[derive(Clone, PartialEq, Eq, Debug, Default)]
pub(crate) struct Deviations(Vec<Deviation>);

#[derive(Clone, PartialEq, Eq, Debug)]
struct Deviation {
    vendor: i128,
    products: Vec<i128>,
    cases: Vec<String>,
    reason: String,
}

impl Deviations {
    /// The deviations of the built-in devices.
    pub(crate) fn built_in() -> Self {
        Self::parse(include_str!("deviations.txt"))
    }

    /// Reads lines `vendor products | cases | reason`; other lines are ignored.
    fn parse(text: &str) -> Self {
        let lines = text.lines().filter(|line| !line.starts_with('#'));
        Self(lines.filter_map(line).collect())
    }

    /// Reason why the product of this EDS may skip a case.
    pub(crate) fn reason(&self, eds: &Eds, id: &str) -> Option<&str> {
        let number = |sub| eds.entry(0x1018, sub)?.default.integer(0);
        let (vendor, product) = (number(1)?, number(2)?);
        let is_it = |one: &&Deviation| {
            one.vendor == vendor
                && one.products.contains(&product)
                && one.cases.iter().any(|case| case == id)
        };
        self.0.iter().find(is_it).map(|one| one.reason.as_str())
    }
}

fn line(line: &str) -> Option<Deviation> {
    let mut parts = line.split('|').map(str::trim);
    let mut numbers = parts
        .next()?
        .split_whitespace()
        .map(od_model::values::integer);
    Some(Deviation {
        vendor: numbers.next()??,
        products: numbers.collect::<Option<_>>()?,
        cases: parts
            .next()?
            .split_whitespace()
            .map(str::to_owned)
            .collect(),
        reason: parts.next()?.to_owned(),
    })
}
