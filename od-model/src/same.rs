//! Equality of dictionaries: two are equal if a master cannot tell them apart.

use crate::dictionary::Dictionary;
use crate::value::Literal;

impl PartialEq for Dictionary<'_> {
    /// Compares object by object: names, types, access, limits, defaults, groups. The places of
    /// texts in the arena and of values in the store do not count.
    fn eq(&self, other: &Self) -> bool {
        let literal = |a: Literal, b: Literal| match (a, b) {
            (Literal::Text(a), Literal::Text(b)) => self.text(a) == other.text(b),
            (Literal::Bytes(a), Literal::Bytes(b)) => self.blob(a) == other.blob(b),
            (a, b) => a == b,
        };
        self.len() == other.len()
            && self.objects().len() == other.objects().len()
            && self.objects().zip(other.objects()).all(|(a, b)| {
                (a.index, a.code) == (b.index, b.code)
                    && a.count == b.count
                    && self.text(a.name) == other.text(b.name)
            })
            && self.entries().zip(other.entries()).all(|(a, b)| {
                (a.address, a.data_type, a.access, a.mappable, a.group)
                    == (b.address, b.data_type, b.access, b.mappable, b.group)
                    && self.text(a.name) == other.text(b.name)
                    && literal(a.default, b.default)
                    && literal(a.low, b.low)
                    && literal(a.high, b.high)
            })
    }
}
