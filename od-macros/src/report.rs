//! All faults of a call, each at its token.

use od_eds::{Finding, token_of};
use proc_macro2::{Ident, Span, TokenStream};
use quote::{ToTokens, TokenStreamExt};

/// Collects what is wrong with a call.
#[derive(Default)]
pub(crate) struct Report {
    errors: Vec<syn::Error>,
    tokens: Vec<Place>,
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

impl ToTokens for Place {
    fn to_tokens(&self, tokens: &mut TokenStream) {
        for span in [self.first, self.last] {
            tokens.append(Ident::new("_", span));
        }
    }
}

impl Report {
    /// Takes a fault.
    pub(crate) fn push(&mut self, error: syn::Error) {
        self.errors.push(error);
    }

    /// A fault at this place.
    pub(crate) fn at(&mut self, place: impl Into<Place>, message: impl std::fmt::Display) {
        self.tokens(place.into(), message);
    }

    /// A fault of these tokens.
    pub(crate) fn tokens(&mut self, tokens: impl ToTokens, message: impl std::fmt::Display) {
        self.errors.push(syn::Error::new_spanned(tokens, message));
    }

    /// A span for the model that leads back to this token.
    pub(crate) fn number(&mut self, place: impl Into<Place>) -> od_eds::Span {
        let span = od_eds::token(self.numbers());
        self.tokens.push(place.into());
        span
    }

    /// The number that the next token gets.
    pub(crate) fn numbers(&self) -> u32 {
        // A call of four thousand million tokens does not come to an end.
        u32::try_from(self.tokens.len()).unwrap_or(u32::MAX)
    }

    /// The token behind a finding, if it came from one.
    pub(crate) fn token(&self, finding: &Finding) -> Option<Place> {
        self.span(finding.span()?)
    }

    /// The token behind a span of the model.
    pub(crate) fn span(&self, span: od_eds::Span) -> Option<Place> {
        self.tokens.get(token_of(span)? as usize).copied()
    }

    /// Nothing told so far?
    pub(crate) fn is_empty(&self) -> bool {
        self.errors.is_empty()
    }

    /// `compile_error!` for each fault.
    pub(crate) fn into_tokens(self) -> TokenStream {
        self.errors
            .iter()
            .map(syn::Error::to_compile_error)
            .collect()
    }
}
