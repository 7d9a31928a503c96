//! One value: what a section with a DataType says.

use alloc::format;
use alloc::string::{String, ToString};
use alloc::vec::Vec;

use crate::description::{EntryDescription, Value};
use crate::fact::Key;
use crate::finding::Finding;
use crate::read::fields::Fields;
use crate::read::values;
use crate::read::words;
use crate::rules;
use crate::rules::structure::w0315;
use crate::rules::text::w0109;
use crate::rules::values::{e0402, e0405, e0417, shared, w0404, w0406, w0407, w0416};
use crate::scan::number;
use crate::scan::number::Note;
use crate::scan::placed;
use crate::scan::placed::Text;
use crate::span::Spanned;
use od_model::{Access, Address, DataType, Kind, ObjectCode};

/// Where the diagnostics of one section go, and what it is about.
pub(crate) struct Reader<'a> {
    pub(crate) address: Address,
    pub(crate) log: &'a mut Vec<Finding>,
}

/// Values that could not be read, kept as text.
pub(crate) type Unread = Vec<(String, String)>;

/// What an object or entry keeps as text: the keys that nobody took, in file
/// order, then what could not be read, by key, so that reading again finds the same.
pub(crate) fn extra(mut rest: Vec<(String, String)>, mut unread: Unread) -> Vec<(String, String)> {
    unread.sort();
    rest.append(&mut unread);
    rest
}

impl Reader<'_> {
    pub(crate) fn report(&mut self, finding: Finding) {
        self.log.push(finding.about(self.address));
    }

    /// ParameterName; empty where it is missing.
    pub(crate) fn name(&mut self, fields: &mut Fields<'_>) -> Spanned<String> {
        let name = fields.take("ParameterName").map(placed::owned);
        name.unwrap_or_else(|| {
            self.report(w0315::finding(fields.header));
            Spanned::from(String::new())
        })
    }

    /// A number without a type of its own: ObjectType, SubNumber, ObjFlags …
    pub(crate) fn number(&mut self, key: Key, from: &Text<'_>) -> Option<i128> {
        let mut notes = Vec::new();
        let text = number::without_comment(from, &mut notes);
        let number = number::integer(text, &mut notes)?;
        self.notes(&notes, key, from, || number.value.to_string());
        Some(number.value)
    }

    /// The entry that the fields describe; takes its keys and leaves the others.
    pub(crate) fn entry(
        &mut self,
        fields: &mut Fields<'_>,
        name: Spanned<String>,
        assumed: Option<DataType>,
    ) -> (EntryDescription, Unread) {
        let mut unread = Vec::new();
        let data_type = match self.data_type(fields, &mut unread) {
            // An object of code DOMAIN may leave its type out.
            None if unread.is_empty() => assumed.map(Spanned::from),
            given => given,
        };
        let access = self.access(fields, &mut unread);
        let mappable = self.mappable(fields, &mut unread);
        let mut value = |key, low| self.value(fields, key, data_type, low, &mut unread);
        let default = value(Key::DefaultValue, None);
        let low = value(Key::LowLimit, None);
        let high = value(Key::HighLimit, low.as_ref().map(|low| &low.value));
        let parameter = value(Key::ParameterValue, None);
        let entry = EntryDescription {
            name,
            data_type,
            access,
            mappable,
            default,
            low,
            high,
            parameter,
            group: fields.group,
            flags: self.flags(fields, &mut unread),
            extra: Vec::new(),
            span: fields.header,
        };
        (entry, unread)
    }

    fn data_type(
        &mut self,
        fields: &mut Fields<'_>,
        unread: &mut Unread,
    ) -> Option<Spanned<DataType>> {
        let given = fields.take("DataType")?;
        let number = self.number(Key::DataType, &given);
        let known = number
            .and_then(|code| u16::try_from(code).ok())
            .and_then(DataType::from_code);
        let known = known.or_else(|| {
            let data_type = words::data_type(&given)?;
            self.word(
                Key::DataType,
                &given,
                &format!("0x{:04X}", data_type.code()),
            );
            Some(data_type)
        });
        if known.is_none() {
            self.report(e0402::finding(&given));
            unread.push(("DataType".into(), given.value.into_owned()));
        }
        known.map(|data_type| Spanned::new(data_type, given.span))
    }

    fn access(&mut self, fields: &mut Fields<'_>, unread: &mut Unread) -> Spanned<Access> {
        let Some(given) = fields.take("AccessType") else {
            self.report(w0404::finding(fields.header));
            return Spanned::from(Access::Ro);
        };
        let mut notes = Vec::new();
        let word = number::without_comment(&given, &mut notes);
        let known = [
            Access::Ro,
            Access::Wo,
            Access::Rw,
            Access::Rwr,
            Access::Rww,
            Access::Const,
        ]
        .into_iter()
        .find(|access| word.eq_ignore_ascii_case(access.name()))
        .or_else(|| {
            let access = words::access(&given)?;
            self.word(Key::AccessType, &given, access.name());
            Some(access)
        });
        match known {
            Some(access) => {
                self.notes(&notes, Key::AccessType, &given, || access.name().into());
                Spanned::new(access, given.span)
            }
            None => {
                self.report(e0405::finding(&given));
                let span = given.span;
                unread.push(("AccessType".into(), given.value.into_owned()));
                Spanned::new(Access::Ro, span)
            }
        }
    }

    fn mappable(&mut self, fields: &mut Fields<'_>, unread: &mut Unread) -> Spanned<bool> {
        let Some(given) = fields.take("PDOMapping") else {
            return Spanned::from(false);
        };
        let mappable = match self.number(Key::PdoMapping, &given) {
            Some(0) => false,
            Some(1) => true,
            _ => self.mappable_word(&given).unwrap_or_else(|| {
                self.report(w0406::finding(&given));
                unread.push(("PDOMapping".into(), given.to_string()));
                false
            }),
        };
        Spanned::new(mappable, given.span)
    }

    fn mappable_word(&mut self, given: &Text<'_>) -> Option<bool> {
        let mappable = words::mappable(given)?;
        self.word(Key::PdoMapping, given, if mappable { "1" } else { "0" });
        Some(mappable)
    }

    /// ObjectType, as a number or as a word.
    pub(crate) fn object_code(&mut self, given: &Text<'_>) -> Option<ObjectCode> {
        let number = self.number(Key::ObjectType, given);
        let code = number
            .and_then(|code| u8::try_from(code).ok())
            .and_then(ObjectCode::from_code);
        code.or_else(|| {
            let code = words::object_code(given)?;
            self.word(Key::ObjectType, given, &format!("0x{:X}", code.code()));
            Some(code)
        })
    }

    /// Reports a word that is read as this value.
    fn word(&mut self, key: Key, given: &Text<'_>, right: &str) {
        self.report(shared::read_as(&rules::W0424, key, given, right));
    }

    /// ObjFlags; 0 where it is missing.
    pub(crate) fn flags(&mut self, fields: &mut Fields<'_>, unread: &mut Unread) -> u32 {
        let Some(given) = fields.take("ObjFlags") else {
            return 0;
        };
        let number = self.number(Key::ObjFlags, &given);
        number
            .and_then(|flags| u32::try_from(flags).ok())
            .unwrap_or_else(|| {
                self.report(w0407::finding(&given));
                unread.push(("ObjFlags".into(), given.value.into_owned()));
                0
            })
    }

    fn value(
        &mut self,
        fields: &mut Fields<'_>,
        key: Key,
        data_type: Option<Spanned<DataType>>,
        low: Option<&Value>,
        unread: &mut Unread,
    ) -> Option<Spanned<Value>> {
        let given = fields.take(key.name())?;
        if let Some(data_type) = data_type
            && matches!(data_type.kind(), Kind::Text | Kind::Bytes)
            && matches!(key, Key::LowLimit | Key::HighLimit)
        {
            self.report(w0416::no_limits(key, &given, data_type));
            unread.push((key.name().into(), given.value.into_owned()));
            return None;
        }
        let value = self.typed(key, &given, data_type, low);
        if value.is_none() {
            unread.push((key.name().into(), given.value.into_owned()));
        }
        value
    }

    /// The value of a key by its type; named if it is none of it. A HighLimit comes
    /// with the LowLimit: between 0 and FFh of an INTEGER8, FFh is not -1.
    pub(crate) fn typed(
        &mut self,
        key: Key,
        given: &Text<'_>,
        data_type: Option<Spanned<DataType>>,
        low: Option<&Value>,
    ) -> Option<Spanned<Value>> {
        // Without a type there are no values; that was named, or the checks will.
        let data_type = data_type.filter(|t| t.kind() != Kind::Record)?;
        let mut notes = Vec::new();
        match values::value(given, *data_type, &mut notes) {
            Some(mut value) => {
                if let (Some(Value::Signed(low @ 0..)), Value::Signed(high)) = (low, &value)
                    && high < low
                    && notes.contains(&Note::TwosComplement)
                {
                    notes.retain(|note| *note != Note::TwosComplement);
                    value = values::pattern(given)?;
                }
                let canonical = || values::text(&value, Some(*data_type));
                self.notes(&notes, key, given, canonical);
                Some(Spanned::new(value, given.span))
            }
            None => {
                self.report(unfit(key, given, data_type));
                None
            }
        }
    }

    /// Names what was odd about a value that was understood.
    fn notes(
        &mut self,
        notes: &[Note],
        key: Key,
        given: &Text<'_>,
        canonical: impl Fn() -> String,
    ) {
        for note in notes {
            let rule = match note {
                Note::Comment => {
                    let value = number::without_comment(given, &mut Vec::new());
                    self.report(w0109::finding(key, given, value));
                    continue;
                }
                Note::Octal => &rules::I0408,
                Note::NotOctal => &rules::W0409,
                Note::TwosComplement => &rules::I0410,
                Note::NodeId => &rules::I0411,
                Note::Characters => &rules::W0419,
                Note::Suffix => &rules::W0420,
                Note::BareHex => &rules::W0422,
                Note::Comma => &rules::W0423,
                Note::Word => &rules::W0421,
            };
            self.report(shared::read_as(rule, key, given, &canonical()));
        }
    }
}

/// The finding about a value that is none of its type.
fn unfit(key: Key, given: &Text<'_>, data_type: Spanned<DataType>) -> Finding {
    let formula = given.to_ascii_uppercase().contains("$NODEID");
    if formula && !data_type.holds_node_id() {
        return e0417::finding(key, &*given.value, given.span, data_type);
    }
    let rule = match key {
        Key::DefaultValue => &rules::E0412,
        Key::ParameterValue => &rules::E0413,
        _ => &rules::W0416,
    };
    let finding = match formula {
        true => shared::unfit_formula(rule, key, given, data_type),
        false => shared::unfit(rule, key, &*given.value, given.span, data_type),
    };
    match key {
        Key::LowLimit | Key::HighLimit => w0416::emptied(finding),
        _ => finding,
    }
}
