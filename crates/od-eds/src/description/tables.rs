//! Makes the tables of a description that a node runs: order, arenas, storage layout.

use alloc::collections::BTreeMap;
use alloc::string::String;
use alloc::vec;
use alloc::vec::Vec;

use crate::description::{Description, EntryDescription, Value};
use crate::span::Spanned;
use od_model::Visible;
use od_model::owned::{Buckets, EMPTY, Shape, bucket_count, fill};
use od_model::real::Reals;
use od_model::row::{Row, literal, words};
use od_model::varying::Varying;
use od_model::{
    Access, Address, DataType, Dictionary, Entry, Kind, Literal, Names, ObjectCode, Range, Slot,
};

/// Capacity in bytes of a string that a master may write, if its default is shorter.
const STRING_CAPACITY: usize = 64;
/// Capacity in bytes of a DOMAIN that a master may write, if its default is shorter.
const DOMAIN_CAPACITY: usize = 1024;

/// The owned form of a compiled dictionary; [`Dictionary`] is a view of it.
#[derive(Clone, PartialEq, Debug, Default)]
pub struct Tables {
    buckets: Vec<u16>,
    rows: Vec<Row>,
    pool: Vec<u32>,
    text: String,
    blob: Vec<u8>,
    store_len: usize,
    longest: usize,
    has_streams: bool,
    /// For each entry its own name and its object's.
    names: Vec<[u8; 16]>,
    names_text: String,
}

/// Texts, each kept only once.
type Interned = BTreeMap<String, Range>;

impl Tables {
    /// The tables of all usable parts of `description`.
    ///
    /// This never fails. An entry without a usable type, an object without entries, and a value
    /// that does not fit its type are left out; the checks have reported them. A ParameterValue of
    /// a DCF is used as the default.
    pub fn new(description: &Description) -> Self {
        let mut tables = Self::default();
        let (mut texts, mut names) = (Interned::new(), Interned::new());
        let mut entries = Vec::new();
        let mut offset = 0u32;
        for (&index, object) in &description.objects {
            for (&sub, entry) in &object.entries {
                let address = Address::new(index, sub);
                if let Some(made) = tables.entry(address, entry, &mut texts, &mut offset) {
                    entries.push((made, object.code.value));
                    let own = intern(
                        &mut tables.names_text,
                        &Visible(&entry.name).line(),
                        &mut names,
                    );
                    let objects = intern(
                        &mut tables.names_text,
                        &Visible(&object.name).line(),
                        &mut names,
                    );
                    tables.names.push(Names::row([own, objects]));
                }
            }
        }
        tables.pack(&entries);
        tables
    }

    /// The dictionary as a view of the tables; making the view costs nothing.
    pub fn dictionary(&self) -> Dictionary<'_> {
        Dictionary::trusted(
            Buckets::Words(&self.buckets),
            &self.rows,
            &self.pool,
            &self.text,
            &self.blob,
            self.shape(),
            self.names(),
        )
    }

    /// Facts about all values.
    pub fn shape(&self) -> Shape {
        Shape {
            store_len: self.store_len,
            longest: self.longest,
            has_streams: self.has_streams,
            reals: Reals::SOME,
            varying: Varying::SOME,
        }
    }

    /// Moves stored values to other places: for variants that share one store layout.
    /// Values that are not stored stay without a place.
    pub fn place(&mut self, mut place: impl FnMut(&Entry) -> Slot) {
        let codes: Vec<ObjectCode> = self.rows.iter().map(|row| row.code()).collect();
        let entries = self.dictionary().entries().zip(codes);
        let entries = entries.map(|(mut entry, code)| {
            if entry.slot.len > 0 {
                entry.slot = place(&entry);
            }
            (entry, code)
        });
        let entries: Vec<_> = entries.collect();
        self.pack(&entries);
    }

    /// Makes the rows of the entries, and the parts that depend on them.
    fn pack(&mut self, entries: &[(Entry, ObjectCode)]) {
        self.rows.clear();
        self.pool.clear();
        let mut known = BTreeMap::new();
        for (entry, code) in entries {
            let default = self.default_word(entry);
            let limits = self.limits(entry, &mut known);
            self.rows.push(Row::new(entry, *code, default, limits));
        }
        self.buckets = vec![EMPTY; bucket_count(self.rows.len())];
        fill(&mut self.buckets, &self.rows);
        let end = |slot: Slot| slot.offset as usize + usize::from(slot.len);
        let ends = entries.iter().map(|(entry, _)| end(entry.slot));
        self.store_len = ends.max().unwrap_or(0);
        let shape = Shape::of(&self.rows, &self.pool, self.store_len);
        (self.longest, self.has_streams) = (shape.longest, shape.has_streams);
    }

    /// The word of the default: its bits, or their position in the pool.
    fn default_word(&mut self, entry: &Entry) -> u32 {
        let (kind, bits) = literal(entry.default);
        let at = self.pool.len() as u32;
        if entry.is_variable() {
            let range = [bits as u32, (bits >> 32) as u32];
            self.pool.extend(range);
            self.pool.push(entry.slot.len.into());
        } else if words(kind) < 2 {
            return bits as u32;
        } else {
            self.pool.extend([bits as u32, (bits >> 32) as u32]);
        }
        at
    }

    /// The limits in the form of a row; each pair of limits is in the pool once.
    fn limits(&mut self, entry: &Entry, known: &mut BTreeMap<Vec<u32>, u32>) -> u32 {
        let mut all = vec![0];
        for (limit, shift) in [(entry.low, 0), (entry.high, 3)] {
            let (kind, bits) = literal(limit);
            all[0] |= kind << shift;
            all.extend([bits as u32, (bits >> 32) as u32].iter().take(words(kind)));
        }
        let next = self.pool.len() as u32 + 1;
        // No device has 80,000 pairs of limits; a file with more must not cause a panic.
        if all == [0] || next >= 1 << 18 {
            return 0;
        }
        *known.entry(all).or_insert_with_key(|all| {
            self.pool.extend(all);
            next
        })
    }

    /// The rows, and the pool for content that does not fit into them.
    pub fn parts(&self) -> (&[Row], &[u32]) {
        (&self.rows, &self.pool)
    }

    /// Names of objects and entries.
    pub fn names(&self) -> Names<'_> {
        Names {
            rows: &self.names,
            text: &self.names_text,
        }
    }

    /// VISIBLE_STRING defaults, each once.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// OCTET_STRING, UNICODE_STRING and DOMAIN defaults.
    pub fn blob(&self) -> &[u8] {
        &self.blob
    }

    fn entry(
        &mut self,
        address: Address,
        from: &EntryDescription,
        texts: &mut Interned,
        offset: &mut u32,
    ) -> Option<Entry> {
        let data_type = from.data_type?.value;
        if data_type.kind() == Kind::Record {
            return None;
        }
        let value = fitting(&from.parameter, data_type).or(fitting(&from.default, data_type));
        let default = self.literal(value, data_type, texts);
        let len = slot_len(data_type, from, value);
        let slot = Slot {
            offset: if len == 0 { 0 } else { *offset },
            len,
        };
        // No device has four gigabytes of values; a file with more must not cause a panic.
        *offset = offset.saturating_add(u32::from(len));
        Some(Entry {
            address,
            data_type,
            access: *from.access,
            mappable: *from.mappable,
            group: from.group_at(address),
            name: Range::new(0, 0),
            default,
            low: self.literal(fitting(&from.low, data_type), data_type, texts),
            high: self.literal(fitting(&from.high, data_type), data_type, texts),
            slot,
        })
    }

    fn literal(
        &mut self,
        value: Option<&Value>,
        data_type: DataType,
        texts: &mut Interned,
    ) -> Literal {
        match value {
            None => Literal::None,
            // A value that fits its type fits its literal: neither cast changes it.
            Some(Value::Unsigned(v)) if data_type.kind() == Kind::Signed => {
                Literal::Signed(*v as i64)
            }
            Some(Value::Signed(v)) if data_type.kind() != Kind::Signed => {
                Literal::Unsigned(*v as u64)
            }
            Some(Value::Unsigned(v)) => Literal::Unsigned(*v),
            Some(Value::Signed(v)) => Literal::Signed(*v),
            Some(Value::Real(v)) => Literal::Real(*v),
            Some(Value::NodeId(v)) => Literal::NodeId(*v),
            Some(Value::Text(v)) => Literal::Text(intern(&mut self.text, v, texts)),
            Some(Value::Bytes(v)) => {
                let start = self.blob.len() as u32;
                self.blob.extend_from_slice(v);
                Literal::Bytes(Range::new(start, v.len() as u32))
            }
        }
    }
}

/// The position of a text in the arena; it is added if it is not there yet.
fn intern(arena: &mut String, text: &str, known: &mut Interned) -> Range {
    if let Some(range) = known.get(text) {
        return *range;
    }
    let range = Range::new(arena.len() as u32, text.len() as u32);
    arena.push_str(text);
    known.insert(text.into(), range);
    range
}

/// The value, if it is valid for the type.
pub(crate) fn fitting(value: &Option<Spanned<Value>>, data_type: DataType) -> Option<&Value> {
    value
        .as_ref()
        .map(|value| &value.value)
        .filter(|value| value.fits(data_type))
}

/// Number of bytes of a value in the store; see [`Slot`].
fn slot_len(data_type: DataType, from: &EntryDescription, value: Option<&Value>) -> u16 {
    if *from.access == Access::Const {
        return 0;
    }
    if let Some(size) = data_type.size() {
        return size as u16;
    }
    let given = match value {
        Some(Value::Text(text)) => text.len(),
        Some(Value::Bytes(bytes)) => bytes.len(),
        _ => 0,
    };
    let room = match (from.capacity, from.access.writable()) {
        (Some(0), _) if given == 0 => return 0,
        (Some(capacity), _) => capacity.into(),
        (None, true) if data_type == DataType::Domain => DOMAIN_CAPACITY,
        (None, true) => STRING_CAPACITY,
        (None, false) if given == 0 => STRING_CAPACITY,
        (None, false) => 0,
    };
    (2 + given.max(room)).min(u16::MAX as usize) as u16
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::description::ObjectDescription;

    fn entry(data_type: DataType, default: Value) -> EntryDescription {
        EntryDescription {
            default: Some(Spanned::from(default)),
            ..EntryDescription::new("x", data_type)
        }
    }

    #[track_caller]
    fn check(data_type: DataType, default: Value, expected: Literal) {
        let mut description = Description::default();
        let object = ObjectDescription::var(entry(data_type, default));
        description.objects.insert(0x2000, object);
        let tables = Tables::new(&description);
        let made = tables.dictionary().entry(0x2000, 0).map(|e| e.default);
        assert_eq!(made, Some(expected));
    }

    #[test]
    fn a_literal_has_the_type_of_its_entry() {
        use DataType::*;
        check(Unsigned8, Value::Signed(5), Literal::Unsigned(5));
        check(Integer8, Value::Unsigned(5), Literal::Signed(5));
        check(Unsigned8, Value::Unsigned(256), Literal::None);
        check(Integer8, Value::Signed(-129), Literal::None);
        check(Unsigned32, Value::Text("x".into()), Literal::None);
        check(VisibleString, Value::Unsigned(1), Literal::None);
        check(Real32, Value::Real(1e39), Literal::None);
        check(Unsigned8, Value::NodeId(0x80), Literal::NodeId(0x80));
        check(Unsigned8, Value::NodeId(0x81), Literal::None);
        check(Unsigned64, Value::NodeId(1), Literal::None);
    }

    #[test]
    fn a_capacity_makes_room_in_the_store() {
        let slot = |default: &str, capacity| {
            let entry = EntryDescription {
                access: Spanned::from(Access::Rw),
                capacity,
                ..entry(DataType::VisibleString, Value::Text(default.into()))
            };
            let mut description = Description::default();
            description
                .objects
                .insert(0x2000, ObjectDescription::var(entry));
            Tables::new(&description).dictionary().at(0).slot.len
        };
        assert_eq!((slot("", None), slot("", Some(0))), (66, 0));
        assert_eq!((slot("abc", Some(0)), slot("abc", Some(5))), (5, 7));
        assert_eq!(
            (slot("", Some(65533)), slot("", Some(65535))),
            (65535, 65535)
        );
    }

    #[test]
    fn every_description_has_tables() {
        let mut description = Description::default();
        let mut odd = ObjectDescription::var(entry(DataType::Identity, Value::Unsigned(1)));
        odd.entries
            .insert(255, entry(DataType::Unsigned8, Value::Unsigned(1)));
        description.objects.insert(0, odd.clone());
        odd.entries.clear();
        description.objects.insert(0xFFFF, odd);
        let tables = Tables::new(&description);
        let dictionary = tables.dictionary();
        assert_eq!(dictionary.objects().len(), 1);
        assert_eq!(dictionary.entries().len(), 1);
        assert!(dictionary.entry(0, 255).is_some());
    }

    #[test]
    fn a_valid_configured_value_is_the_default() {
        let mut value = entry(DataType::Unsigned8, Value::Unsigned(1));
        for (parameter, expected) in [(2, 2), (300, 1)] {
            value.parameter = Some(Spanned::from(Value::Unsigned(parameter)));
            let mut description = Description::default();
            let object = ObjectDescription::var(value.clone());
            description.objects.insert(0x2000, object);
            let tables = Tables::new(&description);
            let made = tables.dictionary().entry(0x2000, 0).map(|e| e.default);
            assert_eq!(made, Some(Literal::Unsigned(expected)));
        }
    }
}
