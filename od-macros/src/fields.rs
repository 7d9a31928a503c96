//! The fields between the braces of `add` and `modify`: `key = value;`.

use od_eds::patch::{Change, Raw};
use od_eds::row::FIELDS;
use proc_macro2::{Delimiter, Ident, Span, TokenTree};
use syn::parse::{Parse, ParseStream, discouraged::Speculative};
use syn::{Lit, Token, ext::IdentExt};

use crate::report::{Place, Report};
use crate::words;

/// One field with the place of its value.
pub(crate) struct Field {
    pub(crate) change: Change,
    pub(crate) place: Place,
}

const KEYS: &str = "`name`, `type`, `access`, `default`, `low`, `high`, `mappable`, `save`, `code` or \
     `capacity`";

/// Reads the fields up to the closing brace; invalid fields are reported and ignored.
pub(crate) fn read(body: ParseStream, report: &mut Report) -> Vec<Field> {
    let mut fields: Vec<Field> = Vec::new();
    while !body.is_empty() {
        match field(body) {
            Ok((key, field)) => {
                if fields.iter().any(|f| f.change.key() == field.change.key()) {
                    report.at(key.span(), format!("`{key}` is given twice"));
                } else {
                    fields.push(field);
                }
            }
            Err(error) => {
                report.push(error);
                skip_field(body);
            }
        }
        if body.is_empty() {
            break;
        }
        if body.parse::<Token![;]>().is_err() {
            report.at(
                body.span(),
                "expected `;`\nhelp: fields are separated by semicolons: `{ type = u16; access = rw }`",
            );
            skip_field(body);
            let _ = body.parse::<Token![;]>();
        }
    }
    fields
}

fn skip_field(body: ParseStream) {
    while !body.is_empty() && !body.peek(Token![;]) {
        let _ = body.parse::<TokenTree>();
    }
}

fn field(body: ParseStream) -> syn::Result<(Ident, Field)> {
    let key = Ident::parse_any(body)
        .map_err(|e| syn::Error::new(e.span(), format!("expected {KEYS}")))?;
    let name = key.to_string();
    if !FIELDS.contains(&name.as_str()) {
        return Err(syn::Error::new(
            key.span(),
            match words::near(&name, FIELDS.into_iter()) {
                Some(meant) => format!("`{key}` is not a field\nhelp: did you mean `{meant}`?"),
                None => format!("`{key}` is not a field\nhelp: a field is {KEYS}"),
            },
        ));
    }
    body.parse::<Token![=]>()
        .map_err(|e| syn::Error::new(e.span(), format!("expected `=` after `{key}`")))?;
    let first = body.span();
    let (change, last) = match name.as_str() {
        "name" => (Change::Name(text(body)?), None),
        "type" => (Change::Type(words::TYPES.read(body)?), None),
        "access" => (Change::Access(words::ACCESS.read(body)?), None),
        "save" => (Change::Save(words::GROUPS.read(body)?), None),
        "code" => (Change::Code(words::CODES.read(body)?), None),
        "capacity" => (Change::Capacity(capacity(body)?), None),
        "mappable" => (Change::Mappable(boolean(body)?), None),
        _ => {
            let (raw, last) = value(body)?;
            let change = match name.as_str() {
                "default" => Change::Default(raw),
                "low" => Change::Low(raw),
                _ => Change::High(raw),
            };
            (change, last)
        }
    };
    let last = last.unwrap_or(first);
    let place = Place { first, last };
    Ok((key, Field { change, place }))
}

fn text(body: ParseStream) -> syn::Result<String> {
    body.parse::<syn::LitStr>()
        .map(|literal| literal.value())
        .map_err(|e| syn::Error::new(e.span(), "expected a text\nhelp: `name = \"Gear\"`"))
}

/// Limit of bytes: with two more for the length they fit into a slot, whose length has 16 bits.
fn capacity(body: ParseStream) -> syn::Result<u16> {
    let wrong = |span| {
        let help = "`capacity = 64`";
        let message = format!("expected a number of bytes from 0 to 65533\nhelp: {help}");
        syn::Error::new(span, message)
    };
    let literal: syn::LitInt = body.parse().map_err(|e| wrong(e.span()))?;
    let bytes = literal.base10_parse().ok().filter(|bytes| *bytes <= 65533);
    bytes.ok_or_else(|| wrong(literal.span()))
}

fn boolean(body: ParseStream) -> syn::Result<bool> {
    body.parse::<syn::LitBool>()
        .map(|literal| literal.value)
        .map_err(|e| {
            syn::Error::new(
                e.span(),
                "expected `true` or `false`\nhelp: `mappable = true`",
            )
        })
}

/// A default or a limit, with its last token if it has several.
fn value(body: ParseStream) -> syn::Result<(Option<Raw>, Option<Span>)> {
    let first = body.span();
    if body.peek(Token![$]) || (body.peek(syn::Ident) && !body.peek(syn::LitBool)) {
        let dollar = body.parse::<Option<Token![$]>>()?;
        let word: Ident = body.parse()?;
        if word == "none" && dollar.is_none() {
            return Ok((None, None));
        }
        if word != "NODEID" {
            return Err(syn::Error::new(word.span(), VALUE));
        }
        if !body.peek(Token![+]) {
            calculated(body, "a formula only adds a number: `$NODEID + 0x180`")?;
            return Ok((Some(Raw::NodeId(0)), Some(word.span())));
        }
        body.parse::<Token![+]>()?;
        let offset: syn::LitInt = body
            .parse()
            .map_err(|e| syn::Error::new(e.span(), "expected a number after `$NODEID +`"))?;
        return Ok((
            Some(Raw::NodeId(offset.base10_parse()?)),
            Some(offset.span()),
        ));
    }
    if let Some(minus) = body.parse::<Option<Token![-]>>()? {
        let literal = Lit::parse(body)?;
        let span = Some(literal.span());
        return match &literal {
            Lit::Int(int) => Ok((Some(Raw::Integer(-number(int)?)), span)),
            Lit::Float(float) => Ok((Some(Raw::Real(-float.base10_parse::<f64>()?)), span)),
            _ => Err(syn::Error::new(minus.span, VALUE)),
        };
    }
    if let Ok(TokenTree::Group(group)) = body.fork().parse::<TokenTree>()
        && group.delimiter() != Delimiter::None
    {
        return Err(syn::Error::new(first, VALUE));
    }
    let literal = Lit::parse(body).map_err(|e| syn::Error::new(e.span(), VALUE))?;
    let raw = match &literal {
        Lit::Int(int) => Raw::Integer(number(int)?),
        Lit::Float(float) => Raw::Real(float.base10_parse()?),
        Lit::Bool(b) => Raw::Bool(b.value),
        Lit::Str(text) => Raw::Text(text.value()),
        Lit::ByteStr(bytes) => Raw::Bytes(bytes.value()),
        other => return Err(syn::Error::new(other.span(), VALUE)),
    };
    let ahead = body.fork();
    if ahead.parse::<Token![+]>().is_ok()
        && ahead.parse::<Option<Token![$]>>().is_ok()
        && let Ok(word) = ahead.parse::<Ident>()
    {
        body.advance_to(&ahead);
        return match (&literal, word == "NODEID") {
            (Lit::Int(int), true) => {
                Ok((Some(Raw::NodeId(int.base10_parse()?)), Some(word.span())))
            }
            _ => Err(syn::Error::new(word.span(), VALUE)),
        };
    }
    calculated(body, "write the result as a number")?;
    Ok((Some(raw), None))
}

/// Reports an operator after a value.
fn calculated(body: ParseStream, help: &str) -> syn::Result<()> {
    match body.fork().parse::<TokenTree>() {
        Ok(TokenTree::Punct(sign)) if "+-*/%<>&|^".contains(sign.as_char()) => {
            let message = format!("the macro does not calculate\nhelp: {help}");
            Err(syn::Error::new(sign.span(), message))
        }
        _ => Ok(()),
    }
}

const VALUE: &str = "expected a value\nhelp: a number, `true`, `\"text\"`, `b\"bytes\"`, `$NODEID + 0x180`, or `none`";

fn number(literal: &syn::LitInt) -> syn::Result<i128> {
    if !literal.suffix().is_empty() {
        return Err(syn::Error::new(
            literal.span(),
            format!(
                "a value has no suffix\nhelp: the type is given by `type`; write `{}`",
                literal.base10_digits()
            ),
        ));
    }
    literal.base10_parse().map_err(|_| {
        syn::Error::new(
            literal.span(),
            "this number is longer than any CANopen type",
        )
    })
}
