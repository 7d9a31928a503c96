//! The checks of dcf-tools on types, limits and values.

use alloc::string::ToString;

use super::lint::Lint;
use super::rules::{NUMBER, RANGE, UNKNOWN};
use super::values::{formula, is_real, limits, parts, real};
use crate::fact::Key;
use crate::fix::Fix;
use crate::tools::configparser::{Pair, Section};
use crate::tools::python::int;

impl<'a> Lint<'a> {
    /// Reports a value that is not a number.
    pub(super) fn not_a_number(&mut self, pair: &Pair<'_>, data_type: Option<i128>) {
        let finding = NUMBER
            .at(pair.span)
            .fact("name", &*pair.key)
            .fact("value", &*pair.value);
        let known = crate::scan::number::number(&pair.value);
        self.reading
            .push(match (known, data_type.is_some_and(is_real)) {
                (_, true) => finding.form(&NUMBER.also[1]),
                (Some(number), _) => finding
                    .fact("text", number.to_string())
                    .fix(Fix::safe().replace(pair.span, number.to_string())),
                (None, _) => finding.form(&NUMBER.also[0]),
            });
    }

    /// Type, limits and values of a section.
    pub(super) fn value_section(&mut self, section: &'a Section<'a>) {
        self.check_limits(section);
        for key in [Key::DefaultValue, Key::ParameterValue] {
            if let Some(pair) = self.given(section, key.name()) {
                self.check_value(section, pair);
            }
        }
    }

    pub(super) fn check_limits(&mut self, section: &'a Section<'a>) {
        if self.given(section, "DataType").is_none() {
            return;
        }
        let data_type = self.number(section, "DataType");
        for key in ["LowLimit", "HighLimit"] {
            let Some(pair) = self.given(section, key) else {
                continue;
            };
            let Some((low, high)) = limits(data_type) else {
                let finding = UNKNOWN.at(pair.at).fact("section", &*section.name);
                self.reading.push(
                    finding
                        .fact("name", key)
                        .fix(Fix::unsafe_fix().comment_out(pair.at)),
                );
                continue;
            };
            if is_real(data_type) {
                if real(&pair.value, data_type).is_none() {
                    self.not_a_number(pair, Some(data_type));
                }
                continue;
            }
            match formula(&pair.value) {
                Some((has_node_id, number)) => {
                    let (less, more) = if has_node_id { (1, 127) } else { (0, 0) };
                    if number < low - less || number > high - more {
                        self.range(pair, "its type");
                    }
                }
                // A text that is not a formula is a warning here; for values and in the reader it is an error.
                None if parts(&pair.value).is_some() => self.not_a_number(pair, None),
                None => {}
            }
        }
    }

    fn range(&mut self, pair: &Pair<'_>, what: &str) {
        let finding = RANGE.at(pair.span).fact("name", &*pair.key);
        let finding = finding.fact("value", &*pair.value);
        self.reading.push(finding.fact("what", what));
    }

    /// A value of a section against its type and limits.
    pub(super) fn check_value(&mut self, section: &'a Section<'a>, pair: &'a Pair<'a>) {
        let Some(data_type) = self.given(section, "DataType") else {
            return self.missing(section, "DataType");
        };
        let data_type = int(&data_type.value, 0).unwrap_or(0);
        let Some((mut low, mut high)) = limits(data_type) else {
            return;
        };
        let limit = |key: &str| self.given(section, key);
        let (low_pair, high_pair) = (limit("LowLimit"), limit("HighLimit"));
        if is_real(data_type) {
            let read = |pair: &Pair<'_>| real(&pair.value, data_type);
            let value = read(pair);
            if value.is_none() {
                self.not_a_number(pair, Some(data_type));
            }
            let below = low_pair
                .and_then(read)
                .zip(value)
                .is_some_and(|(low, it)| it < low);
            let above = high_pair
                .and_then(read)
                .zip(value)
                .is_some_and(|(high, it)| it > high);
            let infinite = data_type == 8 && value.is_some_and(f64::is_infinite)
                || value.is_some_and(f64::is_infinite);
            if below || above || infinite {
                self.range(pair, "its limits");
            }
            return;
        }
        let (mut low_node, mut high_node) = (false, false);
        for (limit, bound, node) in [
            (low_pair, &mut low, &mut low_node),
            (high_pair, &mut high, &mut high_node),
        ] {
            let Some(limit) = limit else { continue };
            match formula(&limit.value) {
                Some((has_node_id, number)) => (*node, *bound) = (has_node_id, number),
                None => self.not_a_number(limit, None),
            }
        }
        // `$NODEID` without a number is read only in capitals.
        let read = formula(&pair.value)
            .filter(|_| !pair.value.eq_ignore_ascii_case("$NODEID") || pair.value == "$NODEID");
        let Some((has_node_id, number)) = read else {
            return self.not_a_number(pair, None);
        };
        match (has_node_id, low_node) {
            (false, true) => low += 1,
            (true, false) => low -= 1,
            _ => {}
        }
        match (has_node_id, high_node) {
            (false, true) => high += 127,
            (true, false) => high -= 127,
            _ => {}
        }
        if number < low || number > high {
            self.range(pair, "its type or its limits");
        }
    }
}
