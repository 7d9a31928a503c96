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
        let text = literal.to_string().replace('_', "");
        parse_target(&text)
            .map(|target| Self { target, span })
            .map_err(|message| syn::Error::new(span, message))
    }
}

/// `0x1018sub2` as rustc lexes it: one integer literal, `sub2` its suffix.
fn parse_target(text: &str) -> Result<Target, String> {
    let lower = text.to_ascii_lowercase();
    let Some(hex) = lower.strip_prefix("0x") else {
        let help = match text.parse::<u16>() {
            Ok(index) => format!("`0x{text}`; or `0x{index:04X}`, which is {text}"),
            Err(_) => "for example `0x6004` or `0x1018sub2`".to_string(),
        };
        return Err(format!("an index is written in hex\nhelp: {help}"));
    };
    let (index, sub) = match hex.split_once("sub") {
        Some((index, sub)) => (index, Some(sub)),
        None => (hex, None),
    };
    let index = u16::from_str_radix(index, 16).map_err(|_| {
        format!("`{text}` is not an index\nhelp: four hex digits, `0x0001` to `0xFFFF`")
    })?;
    let sub = match sub {
        None => None,
        Some(sub) => Some(u8::from_str_radix(sub, 16).map_err(|_| {
            format!("`{text}` has no sub-index\nhelp: up to two hex digits behind `sub`: `0x{index:04X}sub0` to `0x{index:04X}subFF`")
        })?),
    };
    Ok(Target { index, sub })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn targets_are_spelled_as_in_the_eds() {
        assert_eq!(parse_target("0x6004"), Ok(Target::object(0x6004)));
        assert_eq!(parse_target("0x1018sub2"), Ok(Target::member(0x1018, 2)));
        assert_eq!(
            parse_target("0x1a00Sub1F"),
            Ok(Target::member(0x1A00, 0x1F))
        );
        for bad in [
            "6004",
            "0x1018sub",
            "0x1018sub100",
            "0x12345",
            "0x1018u8",
            "0x",
        ] {
            assert!(parse_target(bad).is_err(), "{bad}");
        }
    }
}
