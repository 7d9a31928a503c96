//! One value: what a section with a DataType says.

use alloc::format;
use alloc::string::{String, ToString};
use alloc::vec::Vec;

use crate::check::text;
use crate::description::{EntryDescription, Value};
use crate::fact::Key;
use crate::finding::Finding;
use crate::fix::Fix;
use crate::read::fields::Fields;
use crate::read::values;
use crate::read::words;
use crate::rules;
use crate::scan::number;
use crate::scan::number::Note;
use crate::scan::placed;
use crate::scan::placed::Text;
use crate::span::{Span, Spanned};
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
            self.report(
                rules::W0315
                    .told(fields.header, "there is no ParameterName")
                    .with_help("write `ParameterName=` and a name"),
            );
            Spanned::from(String::new())
        })
    }

    /// A number without a type of its own: ObjectType, SubNumber, ObjFlags …
    pub(crate) fn number(&mut self, key: &str, from: &Text<'_>) -> Option<i128> {
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
        let default = value("DefaultValue", None);
        let low = value("LowLimit", None);
        let high = value("HighLimit", low.as_ref().map(|low| &low.value));
        let parameter = value("ParameterValue", None);
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
        let number = self.number("DataType", &given);
        let known = number
            .and_then(|code| u16::try_from(code).ok())
            .and_then(DataType::from_code);
        let known = known.or_else(|| {
            let data_type = words::data_type(&given)?;
            self.word("DataType", &given, &format!("0x{:04X}", data_type.code()));
            Some(data_type)
        });
        if known.is_none() {
            self.report(
                rules::E0402
                    .told(given.span, format!("`{}` is no data type", given.value))
                    .key(Key::DataType)
                    .with_help("write the code of a type, for example `0x0007` for UNSIGNED32"),
            );
            unread.push(("DataType".into(), given.value.into_owned()));
        }
        known.map(|data_type| Spanned::new(data_type, given.span))
    }

    fn access(&mut self, fields: &mut Fields<'_>, unread: &mut Unread) -> Spanned<Access> {
        let Some(given) = fields.take("AccessType") else {
            self.report(
                rules::W0404
                    .told(fields.header, "there is no AccessType")
                    .with_help("write `AccessType=ro`, which is taken now, or what it is")
                    .fix(Fix::unsafe_fix().below(fields.header, "AccessType=ro")),
            );
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
            self.word("AccessType", &given, access.name());
            Some(access)
        });
        match known {
            Some(access) => {
                self.notes(&notes, "AccessType", &given, || access.name().into());
                Spanned::new(access, given.span)
            }
            None => {
                self.report(
                    rules::E0405
                        .told(given.span, format!("`{}` is no AccessType", given.value))
                        .key(Key::AccessType)
                        .with_help("write ro, wo, rw, rwr, rww or const; `ro` is taken now"),
                );
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
        let mappable = match self.number("PDOMapping", &given) {
            Some(0) => false,
            Some(1) => true,
            _ => self.mappable_word(&given).unwrap_or_else(|| {
                self.report(
                    rules::W0406
                        .told(
                            given.span,
                            format!("PDOMapping is 0 or 1, not `{}`", given.value),
                        )
                        .with_help("write `PDOMapping=0`, which is taken now, or `PDOMapping=1`")
                        .fix(Fix::unsafe_fix().replace(given.span, "0")),
                );
                unread.push(("PDOMapping".into(), given.to_string()));
                false
            }),
        };
        Spanned::new(mappable, given.span)
    }

    fn mappable_word(&mut self, given: &Text<'_>) -> Option<bool> {
        let mappable = words::mappable(given)?;
        self.word("PDOMapping", given, if mappable { "1" } else { "0" });
        Some(mappable)
    }

    /// ObjectType, as a number or as a word.
    pub(crate) fn object_code(&mut self, given: &Text<'_>) -> Option<ObjectCode> {
        let number = self.number("ObjectType", given);
        let code = number
            .and_then(|code| u8::try_from(code).ok())
            .and_then(ObjectCode::from_code);
        code.or_else(|| {
            let code = words::object_code(given)?;
            self.word("ObjectType", given, &format!("0x{:X}", code.code()));
            Some(code)
        })
    }

    /// Reports a word that is read as this value.
    fn word(&mut self, key: &str, given: &Text<'_>, right: &str) {
        self.report(
            rules::W0424
                .told(
                    given.span,
                    format!("`{}` is read as `{right}`", given.value),
                )
                .with_help(format!("write `{key}={right}`"))
                .fix(Fix::safe().replace(given.span, right)),
        );
    }

    /// ObjFlags; 0 where it is missing.
    pub(crate) fn flags(&mut self, fields: &mut Fields<'_>, unread: &mut Unread) -> u32 {
        let Some(given) = fields.take("ObjFlags") else {
            return 0;
        };
        let number = self.number("ObjFlags", &given);
        number
            .and_then(|flags| u32::try_from(flags).ok())
            .unwrap_or_else(|| {
                self.report(
                    rules::W0407
                        .told(given.span, format!("`{}` are no ObjFlags", given.value))
                        .with_help("write `ObjFlags=0`, or leave the line out")
                        .fix(Fix::unsafe_fix().replace(given.span, "0")),
                );
                unread.push(("ObjFlags".into(), given.value.into_owned()));
                0
            })
    }

    fn value(
        &mut self,
        fields: &mut Fields<'_>,
        key: &'static str,
        data_type: Option<Spanned<DataType>>,
        low: Option<&Value>,
        unread: &mut Unread,
    ) -> Option<Spanned<Value>> {
        let given = fields.take(key)?;
        if let Some(data_type) = data_type
            && matches!(data_type.kind(), Kind::Text | Kind::Bytes)
            && matches!(key, "LowLimit" | "HighLimit")
        {
            let finding = text::no_limit(key, &given, data_type);
            self.report(finding);
            unread.push((key.into(), given.value.into_owned()));
            return None;
        }
        let value = self.typed(key, &given, data_type, low);
        if value.is_none() {
            unread.push((key.into(), given.value.into_owned()));
        }
        value
    }

    /// The value of a key by its type; named if it is none of it. A HighLimit comes
    /// with the LowLimit: between 0 and FFh of an INTEGER8, FFh is not -1.
    pub(crate) fn typed(
        &mut self,
        key: &str,
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
                let finding = text::no_value(key, given, given.span, data_type);
                self.report(finding);
                None
            }
        }
    }

    /// Names what was odd about a value that was understood.
    fn notes(
        &mut self,
        notes: &[Note],
        key: &str,
        given: &Text<'_>,
        canonical: impl Fn() -> String,
    ) {
        for note in notes {
            let finding = note_finding(*note, given, given.span);
            let mended: String = match note {
                Note::Comment => number::without_comment(given, &mut Vec::new()).into(),
                _ => canonical(),
            };
            let fix = match note {
                // The comment keeps a line of its own.
                Note::Comment => {
                    let comment = given.get(mended.len()..).unwrap_or_default().trim();
                    let comment = format!(";{}", &comment[comment.len().min(1)..]);
                    Fix::safe().replace(given.span, format!("{mended}\n{comment}"))
                }
                _ => Fix::safe().replace(given.span, mended.clone()),
            };
            let help = format!("write `{key}={mended}`");
            self.report(finding.with_help(help).fix(fix));
        }
    }
}

fn note_finding(note: Note, given: &str, span: Span) -> Finding {
    let (rule, message) = match note {
        Note::Comment => (
            &rules::W0109,
            format!("a comment stands behind the value: `{given}`"),
        ),
        Note::Octal => (&rules::I0408, format!("`{given}` is read as octal")),
        Note::NotOctal => (&rules::W0409, format!("`{given}` is read as decimal")),
        Note::TwosComplement => (
            &rules::I0410,
            format!("`{given}` is read as a negative number"),
        ),
        Note::NodeId => (
            &rules::I0411,
            format!("`{given}` is read as `$NODEID` plus a number"),
        ),
        Note::Characters => (
            &rules::W0419,
            format!("`{given}` is no string of hexadecimal bytes"),
        ),
        Note::Suffix => (&rules::W0420, format!("`{given}` is read as an integer")),
        Note::BareHex => (&rules::W0422, format!("`{given}` is read as hexadecimal")),
        Note::Comma => (
            &rules::W0423,
            format!("`{given}` is read with a decimal point"),
        ),
        Note::Word => (&rules::W0421, format!("`{given}` is read as a number")),
    };
    rule.told(span, message)
}
