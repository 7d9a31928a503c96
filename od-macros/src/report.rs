//! All errors and warnings of a call, each at its token.

use std::collections::BTreeSet;

use od_eds::{Finding, token_of};
use od_model::Address;
use proc_macro2::{Ident, Span, TokenStream};
use quote::{ToTokens, TokenStreamExt, quote};

/// Collects the errors and warnings of a call.
#[derive(Default)]
pub(crate) struct Report {
    errors: Vec<syn::Error>,
    warnings: Vec<Warning>,
    tokens: Vec<Place>,
    doubts: Doubts,
}

/// Statements that could not be read, of the module or of one variant: another error may follow from them.
#[derive(Clone, Default)]
pub(crate) struct Doubts {
    /// Addresses of statements that could not be read completely.
    half_read: BTreeSet<Address>,
    /// The file, or a statement whose object is not known, could not be read.
    has_lost: bool,
}

/// A warning of rustc.
struct Warning {
    place: Place,
    code: &'static str,
    message: String,
}

/// From the first token to the last.
#[derive(Clone, Copy)]
pub(crate) struct Place {
    pub(crate) first: Span,
    pub(crate) last: Span,
}

impl From<Span> for Place {
    fn from(span: Span) -> Self {
        Self {
            first: span,
            last: span,
        }
    }
}

impl Place {
    /// The line in the source; `None` outside of the compiler.
    pub(crate) fn line(self) -> Option<usize> {
        proc_macro::is_available().then(|| self.first.unwrap().line())
    }
}

impl ToTokens for Place {
    fn to_tokens(&self, tokens: &mut TokenStream) {
        for span in [self.first, self.last] {
            tokens.append(Ident::new("_", span));
        }
    }
}

impl Report {
    /// Adds an error.
    pub(crate) fn push(&mut self, error: syn::Error) {
        self.errors.push(error);
    }

    /// Adds an error at this place.
    pub(crate) fn at(&mut self, place: impl Into<Place>, message: impl std::fmt::Display) {
        self.tokens(place.into(), message);
    }

    /// Adds an error for these tokens.
    pub(crate) fn tokens(&mut self, tokens: impl ToTokens, message: impl std::fmt::Display) {
        self.errors.push(syn::Error::new_spanned(tokens, message));
    }

    /// Adds a warning at this place.
    pub(crate) fn warn(&mut self, place: impl Into<Place>, code: &'static str, message: String) {
        let place = place.into();
        self.warnings.push(Warning {
            place,
            code,
            message,
        });
    }

    /// Records that a statement about this address could not be read completely.
    pub(crate) fn half_read(&mut self, address: Address) {
        self.doubts.half_read.insert(address);
    }

    /// Records that the file, or a statement whose object is not known, could not be read.
    pub(crate) fn lose(&mut self) {
        self.doubts.has_lost = true;
    }

    /// Returns whether the file, or a statement whose object is not known, could not be read.
    pub(crate) const fn has_lost(&self) -> bool {
        self.doubts.has_lost
    }

    /// Addresses of statements that could not be read completely.
    pub(crate) const fn half_read_ones(&self) -> &BTreeSet<Address> {
        &self.doubts.half_read
    }

    /// Replaces the doubts by those of another part of the call. Returns the previous ones.
    pub(crate) fn replace_doubts(&mut self, doubts: Doubts) -> Doubts {
        std::mem::replace(&mut self.doubts, doubts)
    }

    /// Adds the doubts of a variant to those of the module. Returns those of the module.
    pub(crate) fn add_doubts(&mut self, of_variant: &Doubts) -> Doubts {
        let before = self.doubts.clone();
        self.doubts.half_read.extend(&of_variant.half_read);
        self.doubts.has_lost |= of_variant.has_lost;
        before
    }

    /// Drops the warnings: `warnings = off;`.
    pub(crate) fn hide_warnings(&mut self) {
        self.warnings.clear();
    }

    /// Returns whether every statement about this object could be read.
    pub(crate) fn is_read(&self, index: u16) -> bool {
        let mut half_read = self.doubts.half_read.iter();
        !half_read.any(|address| address.index == index)
    }

    /// Number of errors so far.
    pub(crate) fn error_count(&self) -> usize {
        self.errors.len()
    }

    /// Returns a span that stands for these tokens in a description.
    pub(crate) fn number(&mut self, place: impl Into<Place>) -> od_eds::Span {
        let span = od_eds::token(self.numbers());
        self.tokens.push(place.into());
        span
    }

    /// The number that the next token gets.
    pub(crate) fn numbers(&self) -> u32 {
        // No call has four billion tokens.
        u32::try_from(self.tokens.len()).unwrap_or(u32::MAX)
    }

    /// The tokens that a finding is about.
    pub(crate) fn token(&self, finding: &Finding) -> Option<Place> {
        self.span(finding.span()?)
    }

    /// The tokens for which a span stands.
    pub(crate) fn span(&self, span: od_eds::Span) -> Option<Place> {
        self.tokens.get(token_of(span)? as usize).copied()
    }

    /// `compile_error!` for each error, and the warnings.
    pub(crate) fn into_tokens(self) -> TokenStream {
        let errors = self.errors.iter().map(syn::Error::to_compile_error);
        errors
            .chain(self.warnings.iter().map(Warning::tokens))
            .collect()
    }
}

impl Warning {
    /// The use of a deprecated constant: the only warning that a macro can cause.
    fn tokens(&self) -> TokenStream {
        let name = Ident::new(self.code, self.place.first);
        let message = &self.message;
        quote! {
            const _: () = {
                #[deprecated(note = #message)]
                const #name: () = ();
                #name
            };
        }
    }
}
