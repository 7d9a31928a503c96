//! `without lss, block;`, `behaves = PROFILE;` and `errors = 4;`: the services that the node has code for, and its
//! room for errors.

use std::fmt::Write;
use std::ops::RangeInclusive;

use od_model::Dictionary;
use proc_macro2::{Ident, Span, TokenStream};
use quote::{quote, quote_spanned};
use syn::parse::ParseStream;
use syn::spanned::Spanned;
use syn::{LitInt, Path, Token};

use crate::report::Report;
use crate::words;

/// Each service: its word, the constant of `Device`, and the objects that need it, if there are any.
const SERVICES: [(&str, &str, Option<RangeInclusive<u16>>); 15] = [
    ("lss", "LSS", None),
    ("segmented", "SEGMENTED", None),
    ("block", "BLOCK", None),
    ("rpdos", "RPDOS", Some(0x1400..=0x17FF)),
    ("changes", "CHANGES", None),
    ("guarding", "GUARDING", Some(0x100C..=0x100D)),
    ("consumer", "CONSUMER", Some(0x1016..=0x1016)),
    ("storage", "STORAGE", Some(0x1010..=0x1011)),
    ("behaviour", "BEHAVIOUR", Some(0x1029..=0x1029)),
    ("events", "EVENTS", None),
    ("servers", "SERVERS", Some(0x1201..=0x127F)),
    ("sync_producer", "SYNC_PRODUCER", Some(0x1005..=0x1005)),
    ("time", "TIME", Some(0x1012..=0x1012)),
    ("deadlines", "DEADLINES", None),
    ("sync_length", "SYNC_LENGTH", None),
];

/// The services that a call names.
#[derive(Default)]
pub(crate) struct Services {
    /// Constants of `Device` that are `false`, each with its word.
    off: Vec<(&'static str, Ident)>,
    /// Path of the profile, as seen from the call.
    profile: Option<Path>,
    /// Number of errors that the node has room for.
    errors: Option<u8>,
}

impl Services {
    /// Reads the list after `without`. Returns its last token.
    pub(crate) fn without(&mut self, body: ParseStream, report: &mut Report) -> syn::Result<Span> {
        loop {
            let word: Ident = body.parse().map_err(|e| {
                syn::Error::new(e.span(), "expected a service\nhelp: `without lss, block;`")
            })?;
            let text = word.to_string();
            match SERVICES.iter().find(|(name, ..)| *name == text) {
                Some((_, constant, _)) if self.lacks(constant) => {
                    report.at(word.span(), format!("`{word}` is given twice"));
                }
                Some((_, constant, _)) => self.off.push((constant, word.clone())),
                None => {
                    let names = || SERVICES.iter().map(|(name, ..)| *name);
                    let help = match words::near(&text, names()) {
                        Some(meant) => format!("did you mean `{meant}`?"),
                        None => format!("`{}`", names().collect::<Vec<_>>().join("`, `")),
                    };
                    let message = format!("`{word}` is not a service\nhelp: {help}");
                    report.at(word.span(), message);
                }
            }
            if body.parse::<Option<Token![,]>>()?.is_none() {
                return Ok(word.span());
            }
        }
    }

    /// Reads the path after `behaves =`.
    pub(crate) fn behaves(&mut self, body: ParseStream) -> syn::Result<()> {
        let path = Path::parse_mod_style(body).map_err(|e| {
            let help = "`behaves = PROFILE;`, where PROFILE is a `static` or a `const`";
            syn::Error::new(e.span(), format!("expected a profile's path\nhelp: {help}"))
        })?;
        self.profile = Some(path);
        Ok(())
    }

    /// Reads the number after `errors =`.
    pub(crate) fn errors(
        &mut self,
        body: ParseStream,
        key: Span,
        report: &mut Report,
    ) -> syn::Result<()> {
        let help =
            "`errors = 4;`, 1 to 128: the number that can be active, and come or go in one call";
        let number: LitInt = body.parse().map_err(|e| {
            syn::Error::new(
                e.span(),
                format!("expected a number of errors\nhelp: {help}"),
            )
        })?;
        if self.errors.is_some() {
            report.at(key, "`errors` is given twice");
        }
        match number.base10_parse() {
            Ok(errors @ 1..=128) => self.errors = Some(errors),
            _ => report.at(
                number.span(),
                format!("`{number}` is not a number of errors\nhelp: {help}"),
            ),
        }
        Ok(())
    }

    /// Reports the objects of the base, or of the variant of this name, that need a service which is left out.
    pub(crate) fn check(
        &self,
        variant: &str,
        dictionary: Dictionary<'_>,
        report: &mut Report,
    ) -> Vec<&'static str> {
        let mut needed = Vec::new();
        for (constant, word) in &self.off {
            let service = SERVICES.iter().find(|(_, own, _)| own == constant);
            let Some((_, _, Some(range))) = service else {
                continue;
            };
            // 1005h needs the service only if bit 30 is set.
            let needs = |index: u16| {
                index != 0x1005
                    || dictionary
                        .entry(0x1005, 0)
                        .and_then(|entry| entry.default.integer(0))
                        .is_some_and(|cob_id| cob_id & 1 << 30 != 0)
            };
            let mut indices = dictionary.objects().map(|object| object.index);
            if let Some(index) = indices.find(|index| range.contains(index) && needs(*index)) {
                needed.push(*constant);
                let context = if variant.is_empty() {
                    String::new()
                } else {
                    format!("variant `{variant}`: ")
                };
                let help = if index == 0x1005 {
                    "clear bit 30 of 1005h".into()
                } else {
                    format!("write `remove 0x{index:04X};`")
                };
                report.at(
                    word.span(),
                    format!("{context}{index:04X}h needs `{word}`\nhelp: remove `{word}` from the list, or {help}"),
                );
            }
        }
        needed
    }

    /// Includes these services in spite of `without`, so that one mistake is one error.
    pub(crate) fn keep(&mut self, needed: &[&str]) {
        self.off.retain(|(constant, _)| !needed.contains(constant));
    }

    /// Returns whether `without` has named the service of this constant.
    fn lacks(&self, constant: &str) -> bool {
        self.off.iter().any(|(off, _)| *off == constant)
    }

    /// Returns whether `behaves` was given.
    pub(crate) const fn has_profile(&self) -> bool {
        self.profile.is_some()
    }

    /// The constants of `Device` that differ from their defaults.
    pub(crate) fn constants(&self) -> String {
        let off = self.off.iter();
        let mut out: String = off
            .map(|(constant, _)| format!("const {constant}: bool = false;\n"))
            .collect();
        if let Some(errors) = self.errors {
            let _ = writeln!(out, "const ERRORS: usize = {errors};");
        }
        out
    }

    /// The function of `Device` that returns the profile, if there is one, for a module `depth` levels below
    /// the call. Its tokens have the places of those in the call, so that the compiler reports a wrong path there.
    pub(crate) fn profile(&self, depth: usize) -> TokenStream {
        let Some(path) = &self.profile else {
            return TokenStream::new();
        };
        let first = path
            .segments
            .first()
            .map(|segment| segment.ident.to_string());
        let is_absolute = path.leading_colon.is_some() || first.as_deref() == Some("crate");
        let place = path.span();
        let up = std::iter::repeat_n(quote_spanned!(place=> super::), depth);
        let up = up.filter(|_| !is_absolute);
        let profile = quote_spanned!(place=> &#(#up)*#path);
        quote! {
            #[inline]
            fn profile(&self) -> &Profile { #profile }
        }
    }
}
