//! `0x1018sub2`: the object of a statement.

use od_eds::patch::Target;
use proc_macro2::Span;
use syn::LitInt;
use syn::parse::{Parse, ParseStream};

/// `0x1018sub2`, with its token's place.
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
        let target = literal.to_string().parse();
        target
            .map(|target| Self { target, span })
            .map_err(|message: String| syn::Error::new(span, message))
    }
}
