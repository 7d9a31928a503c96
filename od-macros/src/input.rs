//! Tokens to AST: the grammar of `object_dictionary!`, without its meaning.
//!
//! After an error the parser continues with the next statement, so that all errors of a
//! call are reported at once.

use od_eds::patch::{Action, Target};
use proc_macro2::{Ident, Span, TokenStream, TokenTree};
use syn::parse::{Parse, ParseStream};
use syn::{Attribute, LitInt, LitStr, Path, Token, Visibility, braced, ext::IdentExt};

use crate::fields::{self, Field};
use crate::report::{Doubts, Report};
use crate::services::Services;
use crate::words;

/// One call of the macro.
pub(crate) struct Input {
    pub(crate) attrs: Vec<Attribute>,
    pub(crate) visibility: Visibility,
    pub(crate) name: Ident,
    /// Path of the crate `odkit`; `None` for `::odkit`.
    pub(crate) root: Option<Path>,
    pub(crate) eds: Option<LitStr>,
    /// Path of the overlay.
    pub(crate) overlay: Option<LitStr>,
    pub(crate) profile: Option<Ident>,
    pub(crate) services: Services,
    /// `warnings = off;`.
    pub(crate) is_quiet: bool,
    /// `add`, `modify`, `remove` and `rename` outside of the variants, in their order.
    pub(crate) statements: Vec<Statement>,
    pub(crate) variants: Vec<Variant>,
}

/// `variant name { … }`.
pub(crate) struct Variant {
    pub(crate) attrs: Vec<Attribute>,
    pub(crate) name: Ident,
    pub(crate) statements: Vec<Statement>,
    pub(crate) doubts: Doubts,
}

/// One statement about one object.
pub(crate) enum Statement {
    Edit {
        action: Action,
        target: At,
        fields: Vec<Field>,
    },
    Rename {
        target: At,
        name: Ident,
    },
}

/// The object of a statement: `0x1018sub2`, with its token's place.
#[derive(Clone, Copy)]
pub(crate) struct At {
    pub(crate) target: Target,
    pub(crate) span: Span,
}

impl Parse for At {
    fn parse(stream: ParseStream) -> syn::Result<Self> {
        let literal: LitInt = stream.parse().map_err(|e| {
            syn::Error::new(
                e.span(),
                "expected an object\nhelp: an index in hex, `0x6004`, or a member, `0x1018sub2`",
            )
        })?;
        let span = literal.span();
        // rustc lexes it as one integer literal with the suffix `sub2`.
        let target = literal.to_string().parse::<Target>();
        let target = target.map_err(|refused| syn::Error::new(span, refused))?;
        match apart(target, stream) {
            Some(error) => Err(error),
            None => Ok(Self { target, span }),
        }
    }
}

/// The error about `0x1018:02` and `0x1018 sub2`, and about several objects, which other programs write.
fn apart(target: Target, stream: ParseStream) -> Option<syn::Error> {
    let at = stream.span();
    let ahead = stream.fork();
    let next = ahead.parse::<TokenTree>().ok()?;
    let digits = match &next {
        TokenTree::Ident(word) => word.to_string().strip_prefix("sub").map(String::from),
        TokenTree::Punct(sign) if matches!(sign.as_char(), ':' | '/') => {
            let sub = ahead.parse::<LitInt>();
            Some(sub.map_or(String::from("2"), |sub| sub.to_string()))
        }
        TokenTree::Punct(sign)
            if matches!(sign.as_char(), '.' | ',' | '-') && !stream.peek(Token![->]) =>
        {
            let help = "write a statement for each object";
            let message = format!("a statement is about one object\nhelp: {help}");
            return Some(syn::Error::new(at, message));
        }
        _ => None,
    };
    let is_hex = |digits: &String| {
        digits
            .chars()
            .all(|digit| digit.is_ascii_hexdigit() || digit == 'x')
    };
    let digits = digits.filter(|digits| target.sub.is_none() && is_hex(digits))?;
    let digits = digits.trim_start_matches("0x").trim_start_matches('0');
    let digits = if digits.is_empty() { "0" } else { digits };
    let help = format!("write `{target}sub{digits}`");
    Some(syn::Error::new(
        at,
        format!("a sub-index follows `sub`, as a part of its object\nhelp: {help}"),
    ))
}

/// Reads `=` after a word.
fn equals(body: ParseStream, word: &Ident, example: &str) -> syn::Result<()> {
    body.parse::<Token![=]>().map(drop).map_err(|e| {
        let message = format!("expected `=` after `{word}`\nhelp: `{example}`");
        syn::Error::new(e.span(), message)
    })
}

impl Input {
    /// Reads a call; `None` if it has no module.
    pub(crate) fn read(tokens: TokenStream, report: &mut Report) -> Option<Self> {
        let mut input = None;
        let parser = |stream: ParseStream| {
            input = Some(Self::module(stream, report)?);
            if !stream.is_empty() {
                let help = "one call makes one module: put variants inside it, and other devices into their own call";
                report.at(
                    stream.span(),
                    format!("unexpected tokens after the module\nhelp: {help}"),
                );
                skip_all(stream);
            }
            Ok(())
        };
        if let Err(error) = syn::parse::Parser::parse2(parser, tokens) {
            report.push(error);
        }
        input
    }

    fn module(stream: ParseStream, report: &mut Report) -> syn::Result<Self> {
        if stream.is_empty() {
            return Err(syn::Error::new(
                Span::call_site(),
                "expected a module\nhelp: `object_dictionary! { pub mod my_device { eds = \"my_device.eds\"; } }`",
            ));
        }
        let attrs = stream.call(Attribute::parse_outer)?;
        let visibility = stream.parse()?;
        if !stream.peek(Token![mod]) {
            return Err(stream.error(
                "expected `mod`\nhelp: the macro makes a module: `pub mod my_device { eds = \"my_device.eds\"; }`",
            ));
        }
        stream.parse::<Token![mod]>()?;
        let mut input = Self {
            attrs,
            visibility,
            name: stream.parse()?,
            root: None,
            eds: None,
            overlay: None,
            profile: None,
            services: Services::default(),
            is_quiet: false,
            statements: Vec::new(),
            variants: Vec::new(),
        };
        let body;
        braces(stream, || {
            format!("`mod {} {{ eds = \"my_device.eds\"; }}`", input.name)
        })?;
        braced!(body in stream);
        while !body.is_empty() {
            let start = body.fork();
            let result = input.item(&body, report);
            recover(&body, &start, result, report);
        }
        Ok(input)
    }

    fn item(&mut self, body: ParseStream, report: &mut Report) -> syn::Result<()> {
        let attrs = body.call(Attribute::parse_outer)?;
        let word = Ident::parse_any(&body.fork()).ok();
        let word = word.as_ref().map(Ident::to_string).unwrap_or_default();
        if word != "variant" {
            refuse(&attrs, report);
        }
        match word.as_str() {
            "eds" => {
                let key = Ident::parse_any(body)?;
                equals(body, &key, "eds = \"my_device.eds\";")?;
                let path: LitStr = body.parse().map_err(|e| {
                    syn::Error::new(e.span(), "expected the path of an EDS file\nhelp: `eds = \"my_device.eds\";`, relative to this source file")
                })?;
                let overlay = overlay(body)?;
                let end = overlay.as_ref().unwrap_or(&path).span();
                semicolon(body, end, report)?;
                match self.eds {
                    None => (self.eds, self.overlay) = (Some(path), overlay),
                    Some(_) => report.at(key.span(), "`eds` is given twice\nhelp: a family has one EDS file; say what differs in a `variant`"),
                }
            }
            "crate" => {
                let key = Ident::parse_any(body)?;
                equals(body, &key, "crate = ::my_crate::odkit;")?;
                let path = Path::parse_mod_style(body).map_err(|e| {
                    syn::Error::new(
                        e.span(),
                        "expected a path\nhelp: `crate = ::my_crate::odkit;`, where the crate `odkit` is",
                    )
                })?;
                semicolon(body, key.span(), report)?;
                match self.root {
                    None => self.root = Some(path),
                    Some(_) => report.at(key.span(), "`crate` is given twice"),
                }
            }
            "profile" => {
                let key = Ident::parse_any(body)?;
                equals(body, &key, "profile = cia406;")?;
                let profile: Ident = body.parse().map_err(|e| {
                    syn::Error::new(e.span(), "expected a profile\nhelp: `profile = cia406;`")
                })?;
                semicolon(body, profile.span(), report)?;
                match self.profile {
                    None => self.profile = Some(profile),
                    Some(_) => report.at(key.span(), "`profile` is given twice"),
                }
            }
            "warnings" => {
                let key = Ident::parse_any(body)?;
                equals(body, &key, "warnings = off;")?;
                let word = Ident::parse_any(body)
                    .ok()
                    .filter(|word| word == "off")
                    .ok_or_else(|| {
                        syn::Error::new(
                            key.span(),
                            "expected `off`\nhelp: `warnings = off;` hides the warnings of the rules",
                        )
                    })?;
                semicolon(body, word.span(), report)?;
                self.is_quiet = true;
            }
            "without" => {
                Ident::parse_any(body)?;
                let end = self.services.without(body, report)?;
                semicolon(body, end, report)?;
            }
            "behaves" => {
                let key = Ident::parse_any(body)?;
                equals(body, &key, "behaves = PROFILE;")?;
                if self.services.has_profile() {
                    report.at(key.span(), "`behaves` is given twice");
                }
                self.services.behaves(body)?;
                semicolon(body, key.span(), report)?;
            }
            "errors" => {
                let key = Ident::parse_any(body)?;
                equals(body, &key, "errors = 4;")?;
                self.services.errors(body, key.span(), report)?;
                semicolon(body, key.span(), report)?;
            }
            "variant" => {
                Ident::parse_any(body)?;
                let name: Ident = body.parse()?;
                let inner;
                braces(body, || {
                    format!(
                        "a variant says what differs: `variant {name} {{ modify 0x6004 {{ default = 0 }} }}`"
                    )
                })?;
                braced!(inner in body);
                let of_module = report.replace_doubts(Doubts::default());
                let statements = statements(&inner, report);
                let doubts = report.replace_doubts(of_module);
                let statements = statements?;
                let help = "choose another name for the variant";
                if self.variants.iter().any(|variant| variant.name == name) {
                    let message = format!("there are two variants `{name}`\nhelp: {help}");
                    report.at(name.span(), message);
                    return Ok(());
                }
                if OWN.contains(&&*name.to_string()) {
                    let message = format!("the module itself defines `{name}`\nhelp: {help}");
                    report.at(name.span(), message);
                    return Ok(());
                }
                self.variants.push(Variant {
                    attrs,
                    name,
                    statements,
                    doubts,
                });
            }
            _ => self
                .statements
                .push(statement(body, Scope::Module, report)?),
        }
        Ok(())
    }
}

/// Types of the module that the macro makes, whose names no variant can have.
const OWN: [&str; 4] = ["Device", "Node", "Rooms", "Values"];

/// Reports that a brace does not follow.
fn braces(body: ParseStream, help: impl FnOnce() -> String) -> syn::Result<()> {
    if body.peek(syn::token::Brace) {
        return Ok(());
    }
    Err(body.error(format!("expected `{{`\nhelp: {}", help())))
}

/// `+ "variant.overlay"` after the path of an EDS.
fn overlay(body: ParseStream) -> syn::Result<Option<LitStr>> {
    if !body.peek(Token![+]) {
        return Ok(None);
    }
    body.parse::<Token![+]>()?;
    let path: LitStr = body.parse().map_err(|e| {
        syn::Error::new(
            e.span(),
            "expected the path of an overlay\nhelp: `eds = \"my_device.eds\" + \"variant.overlay\";`",
        )
    })?;
    if body.peek(Token![+]) {
        return Err(body.error(
            "a file has one overlay\nhelp: write the sections of both into one overlay, or what differs into a `variant`",
        ));
    }
    Ok(Some(path))
}

/// The statements of a variant.
fn statements(body: ParseStream, report: &mut Report) -> syn::Result<Vec<Statement>> {
    let mut statements = Vec::new();
    while !body.is_empty() {
        refuse(&body.call(Attribute::parse_outer)?, report);
        let start = body.fork();
        let result = statement(body, Scope::Variant, report);
        statements.extend(recover(body, &start, result, report));
    }
    Ok(statements)
}

/// Token after the word of an item.
#[derive(Clone, Copy, PartialEq)]
enum Follows {
    /// An object: the item is a statement, of the module or of a variant.
    Object,
    Equals,
    Name,
}

/// The words with which an item of the module begins.
const ITEMS: [(&str, Follows); 12] = [
    ("eds", Follows::Equals),
    ("profile", Follows::Equals),
    ("without", Follows::Name),
    ("behaves", Follows::Equals),
    ("errors", Follows::Equals),
    ("crate", Follows::Equals),
    ("warnings", Follows::Equals),
    ("add", Follows::Object),
    ("modify", Follows::Object),
    ("remove", Follows::Object),
    ("rename", Follows::Object),
    ("variant", Follows::Name),
];

/// Part of a call that has statements.
#[derive(Clone, Copy, PartialEq)]
enum Scope {
    Module,
    Variant,
}

impl Scope {
    /// The words that can begin an item in this part, as a list for a message.
    fn words(self) -> String {
        let items = ITEMS.iter();
        let allowed =
            items.filter(|(_, follows)| self == Self::Module || *follows == Follows::Object);
        let words: Vec<String> = allowed.map(|(word, _)| format!("`{word}`")).collect();
        match words.split_last() {
            Some((last, others)) => format!("{} or {last}", others.join(", ")),
            None => String::new(),
        }
    }
}

fn statement(body: ParseStream, scope: Scope, report: &mut Report) -> syn::Result<Statement> {
    let allowed = scope.words();
    let expected = || format!("expected {allowed}");
    let word = Ident::parse_any(body).map_err(|e| syn::Error::new(e.span(), expected()))?;
    let action = match word.to_string().as_str() {
        "add" => Action::Add,
        "modify" => Action::Modify,
        "remove" => {
            let target: At = body.parse()?;
            semicolon(body, target.span, report)?;
            return Ok(Statement::Edit {
                action: Action::Remove,
                target,
                fields: Vec::new(),
            });
        }
        "rename" => {
            let target: At = body.parse()?;
            let example = format!("rename {} = POSITION;", target.target);
            equals(body, &word, &example)?;
            let name: Ident = body.parse().map_err(|e| {
                let message = format!("expected the handle's new name\nhelp: `{example}`");
                syn::Error::new(e.span(), message)
            })?;
            semicolon(body, name.span(), report)?;
            return Ok(Statement::Rename { target, name });
        }
        other if ITEMS.iter().any(|(item, _)| *item == other) => {
            return Err(syn::Error::new(
                word.span(),
                format!(
                    "`{word}` belongs in the module, not in a variant\nhelp: a variant takes {allowed}"
                ),
            ));
        }
        other => {
            let message = match words::near(other, ITEMS.iter().map(|(item, _)| *item)) {
                Some(meant) => {
                    format!("`{other}` is not a statement\nhelp: did you mean `{meant}`?")
                }
                None => format!("`{other}` is not a statement\nhelp: {}", expected()),
            };
            return Err(syn::Error::new(word.span(), message));
        }
    };
    let target: At = body.parse()?;
    if !body.peek(syn::token::Brace) {
        let help = match action {
            Action::Add => format!("`add {} {{ name = \"…\"; type = u16 }}`", target.target),
            _ => format!("`modify {} {{ default = 0 }}`", target.target),
        };
        return Err(syn::Error::new(
            target.span,
            format!(
                "expected the fields of {} in braces\nhelp: {help}",
                target.target
            ),
        ));
    }
    let inner;
    braced!(inner in body);
    let before = report.error_count();
    let fields = fields::read(&inner, report);
    if report.error_count() > before {
        report.half_read(target.target.address());
    }
    // A semicolon after the brace is harmless and easily typed.
    let _ = body.parse::<Option<Token![;]>>()?;
    if action == Action::Modify && fields.is_empty() && report.error_count() == before {
        report.at(
            target.span,
            format!(
                "`modify {}` changes nothing\nhelp: say what, for example `{{ default = 0 }}`",
                target.target
            ),
        );
    }
    Ok(Statement::Edit {
        action,
        target,
        fields,
    })
}

/// The end of a statement. If only the semicolon is missing, the statement is kept.
fn semicolon(body: ParseStream, last: Span, report: &mut Report) -> syn::Result<()> {
    if body.parse::<Option<Token![;]>>()?.is_some() {
        return Ok(());
    }
    if body.is_empty() || starts_statement(body) {
        report.at(last, "expected `;` after this");
        return Ok(());
    }
    Err(syn::Error::new(body.span(), "expected `;`"))
}

fn refuse(attrs: &[Attribute], report: &mut Report) {
    for attr in attrs {
        report.tokens(
            attr,
            "only the module and its variants take attributes and doc comments",
        );
    }
}

/// Reports an error and continues at the next place where a statement can begin. The wrong one began at `start`.
fn recover<T>(
    body: ParseStream,
    start: ParseStream,
    result: syn::Result<T>,
    report: &mut Report,
) -> Option<T> {
    let error = match result {
        Ok(value) => return Some(value),
        Err(error) => error,
    };
    report.push(error);
    doubt(start, report);
    while !body.is_empty() && !starts_statement(body) {
        match body.parse::<TokenTree>() {
            Ok(TokenTree::Punct(p)) if p.as_char() == ';' => break,
            Ok(TokenTree::Group(g)) if g.delimiter() == proc_macro2::Delimiter::Brace => break,
            _ => {}
        }
    }
    None
}

/// Records what the statement that begins here describes, since it cannot be read.
fn doubt(start: ParseStream, report: &mut Report) {
    let _ = start.call(Attribute::parse_outer);
    let word = Ident::parse_any(start);
    let word = word.map_or(String::new(), |word| word.to_string());
    // An `eds` that cannot be read hides the objects of its file.
    let is_of_no_object = |(item, follows): &(&str, Follows)| {
        *item == word && *item != "eds" && *follows != Follows::Object
    };
    if ITEMS.iter().any(is_of_no_object) {
        return;
    }
    let literal = start.parse::<LitInt>().ok();
    match literal.and_then(|literal| literal.to_string().parse::<Target>().ok()) {
        Some(target) => report.half_read(target.address()),
        None => report.lose(),
    }
}

/// Returns whether a statement begins here. The word alone is not enough: `eds` is also the
/// end of `device.eds`.
fn starts_statement(body: ParseStream) -> bool {
    let ahead = body.fork();
    let Ok(word) = Ident::parse_any(&ahead) else {
        return false;
    };
    let item = ITEMS.iter().find(|(item, _)| word == item);
    match item.map(|(_, follows)| follows) {
        Some(Follows::Object) => ahead.peek(LitInt),
        Some(Follows::Equals) => ahead.peek(Token![=]),
        Some(Follows::Name) => ahead.peek(syn::Ident),
        None => false,
    }
}

fn skip_all(stream: ParseStream) {
    while stream.parse::<TokenTree>().is_ok() {}
}
