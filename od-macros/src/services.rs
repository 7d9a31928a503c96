//! `without lss, block;`, `behaves = PROFILE;` and `errors = 4;`: what the node of the device has code
//! and room for.

use std::fmt::Write;

use proc_macro2::{Ident, Span};
use quote::ToTokens;
use syn::parse::ParseStream;
use syn::{LitInt, Path, Token};

use crate::report::Report;
use crate::words;

/// The services by their words, and the constants of `Device`.
const SERVICES: [(&str, &str); 13] = [
    ("lss", "LSS"),
    ("segmented", "SEGMENTED"),
    ("block", "BLOCK"),
    ("rpdos", "RPDOS"),
    ("changes", "CHANGES"),
    ("guarding", "GUARDING"),
    ("consumer", "CONSUMER"),
    ("storage", "STORAGE"),
    ("behaviour", "BEHAVIOUR"),
    ("events", "EVENTS"),
    ("servers", "SERVERS"),
    ("sync_producer", "SYNC_PRODUCER"),
    ("time", "TIME"),
];

/// The services that a call names.
#[derive(Default)]
pub(crate) struct Services {
    /// Constants of `Device` that are `false`.
    off: Vec<&'static str>,
    /// Path of the profile, as seen from the call.
    profile: Option<Path>,
    /// Errors that the node has room for.
    errors: Option<u8>,
}

impl Services {
    /// The list behind `without`. Returns where it ends.
    pub(crate) fn without(&mut self, body: ParseStream, report: &mut Report) -> syn::Result<Span> {
        loop {
            let word: Ident = body.parse().map_err(|e| {
                syn::Error::new(e.span(), "expected a service\nhelp: `without lss, block;`")
            })?;
            let text = word.to_string();
            match SERVICES.iter().find(|(name, _)| *name == text) {
                Some((_, constant)) if self.off.contains(constant) => {
                    report.at(word.span(), format!("`{word}` is given twice"));
                }
                Some((_, constant)) => self.off.push(constant),
                None => {
                    let names = || SERVICES.iter().map(|(name, _)| *name);
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

    /// The path behind `behaves =`.
    pub(crate) fn behaves(&mut self, body: ParseStream) -> syn::Result<()> {
        let path = Path::parse_mod_style(body).map_err(|e| {
            let help = "`behaves = PROFILE;`, where PROFILE is a `static` or a `const`";
            syn::Error::new(e.span(), format!("expected a profile's path\nhelp: {help}"))
        })?;
        self.profile = Some(path);
        Ok(())
    }

    /// The number behind `errors =`.
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

    /// Whether a constant of `Device` is `false`.
    pub(crate) fn lacks(&self, constant: &str) -> bool {
        self.off.contains(&constant)
    }

    /// Whether `behaves` was given.
    pub(crate) const fn has_profile(&self) -> bool {
        self.profile.is_some()
    }

    /// The constants, for a module `depth` levels below the call.
    pub(crate) fn constants(&self, out: &mut String, root: &str, depth: usize) {
        for constant in &self.off {
            let _ = writeln!(out, "const {constant}: bool = false;");
        }
        if let Some(errors) = self.errors {
            let _ = writeln!(out, "const ERRORS: usize = {errors};");
        }
        let Some(path) = &self.profile else { return };
        let first = path
            .segments
            .first()
            .map(|segment| segment.ident.to_string());
        let is_absolute = path.leading_colon.is_some() || first.as_deref() == Some("crate");
        let up = "super::".repeat(if is_absolute { 0 } else { depth });
        let path = path.to_token_stream();
        let _ = writeln!(
            out,
            "const PROFILE: ::core::option::Option<&'static {root}::Profile> =
::core::option::Option::Some(&{up}{path});"
        );
    }
}
