//! Tokens out: tables, handles, and the tracking include.
//!
//! Written as text and lexed once. For thousands of entries this is several times
//! faster than building the tokens one by one, and easier to read here.

use std::fmt::Write;

use od_eds::Tables;
use od_model::owned::SMALL;
use od_model::real::Reals;
use od_model::varying::Varying;
use proc_macro2::{Span, TokenStream};
use quote::{quote, quote_spanned};
use syn::spanned::Spanned;

use crate::docs;
use crate::family::{Device, Family};
use crate::handles::{Body, Handle, Item};
use crate::input::Input;
use crate::near_names;
use crate::source::Source;

/// The module that a call generates.
pub(crate) fn module(input: &Input, source: &Source, family: &Family) -> TokenStream {
    let Input {
        attrs,
        visibility,
        name,
        ..
    } = input;
    let names = names(input);
    let body = device(input, &family.base, None);
    let paths = source.paths.iter().filter_map(|path| path.to_str());
    let track = paths.map(|path| quote! { const _: &[u8] = ::core::include_bytes!(#path); });
    let about = about(source, family);
    let variants = input.variants.iter().zip(&family.variants);
    let variants = variants.map(|(variant, made)| {
        let body = device(input, made, Some(&family.base.items));
        let (attrs, name) = (&variant.attrs, &variant.name);
        let about = docs::variant(&input.name.to_string(), &variant.statements);
        quote! {
            #(#attrs)*
            #[doc = #about]
            pub mod #name { #body }
        }
    });
    quote! {
        #(#attrs)*
        #[doc = #about]
        #[allow(dead_code, non_snake_case, unused_imports, unreachable_pub, clippy::all)]
        #visibility mod #name {
            #(#track)*
            #names
            #body
            #(#variants)*
        }
    }
}

/// The module with the names that generated code uses; its path has a number that changes with their version, so that a
/// macro and a crate of different versions do not compile together.
///
/// Each name is in the list: if the path of the crate is wrong, the compiler reports the path, and none of the names.
fn names(input: &Input) -> TokenStream {
    let (path, place) = match &input.root {
        // The path is seen from the module of the call, which is one level above.
        Some(path)
            if path
                .segments
                .first()
                .is_some_and(|first| first.ident == "super") =>
        {
            (quote!(super::#path), path.span())
        }
        Some(path) => (quote!(#path), path.span()),
        None => (quote!(::odkit), Span::call_site()),
    };
    quote_spanned! { place=>
        #[doc(hidden)]
        mod __odkit {
            pub use #path::__private8::{
                Address, Const, Device, Dictionary, NoApplication, NoPdo, NoStorage, Node, Pdo, Profile, Ro, Rooms, Rw,
                Rwr, Rww, Series, Services, Text, Values, Var, Wo, __a, __s, __t, __v, rooms,
                table::{
                    Buckets, Names, Reals, Row, Shape, Varying, bucket_count, buckets, names, rows, small_buckets,
                },
            };
        }
    }
}

fn about(source: &Source, family: &Family) -> String {
    let objects = family.base.tables.dictionary().objects().len();
    let mut text = format!("\n\n{objects} objects");
    if let Some(files) = &source.files {
        let _ = write!(text, ", from `{}`", files.shown());
    }
    text.push('.');
    text.push_str(
        " A handle `NAME` is compared with an address (`address == NAME`); its address in a pattern is `NAME::ADDRESS`.",
    );
    if family.remarks > 0 {
        let remarks = family.remarks;
        let _ = write!(text, " `odkit check` has {remarks} remarks on the file.");
    }
    text
}

/// Lexes generated text, which has only escaped strings and checked identifiers.
fn lex(text: &str) -> TokenStream {
    // `proc_macro2` would lex twice, as a protection that this text does not need.
    let tokens = if proc_macro::is_available() {
        text.parse::<proc_macro::TokenStream>()
            .map(TokenStream::from)
            .map_err(|error| error.to_string())
    } else {
        text.parse::<TokenStream>()
            .map_err(|error| error.to_string())
    };
    tokens.unwrap_or_else(|error| {
        let message = format!("odkit made code that does not lex, please report this: {error}");
        quote! { ::core::compile_error!(#message); }
    })
}

/// The contents of the module of one device; a variant re-exports the items that it shares with `family`.
fn device(input: &Input, device: &Device, of_variant: Option<&[Item]>) -> TokenStream {
    let root = match of_variant {
        None => "__odkit",
        Some(_) => "super::__odkit",
    };
    let path = lex(root);
    let family = of_variant.unwrap_or_default();
    let out = &mut String::new();
    dictionary(out, root, &device.tables);
    node(out, root, &input.services.constants());
    let mut handed_on = Vec::new();
    for item in &device.items {
        match family.iter().find(|other| other.index == item.index) {
            Some(other) if other.alike(item) => {
                handed_on.push(hand_on(&other.name, &item.name));
            }
            other => self::item(out, root, item, other),
        }
    }
    if !handed_on.is_empty() {
        let _ = writeln!(out, "pub use super::{{{}}};", handed_on.join(", "));
    }
    if of_variant.is_none() {
        near_names::write(out, &device.items);
    }
    let depth = if of_variant.is_some() { 2 } else { 1 };
    let profile = input.services.profile(depth);
    let text = lex(out);
    quote! {
        use #path::*;
        #text
        impl #path::Device for Device {
            type Values = Values;
            type Rooms = Rooms;
            #[inline]
            fn dictionary(&self) -> Dictionary<'_> { DICTIONARY }
            #profile
        }
    }
}

fn hand_on(from: &str, to: &str) -> String {
    if from == to {
        from.to_string()
    } else {
        format!("{from} as {to}")
    }
}

fn item(out: &mut String, root: &str, item: &Item, family: Option<&Item>) {
    match &item.body {
        Body::Value(handle) => constant(out, item.index, handle),
        Body::Members(handles) => {
            let _ = writeln!(
                out,
                "#[doc = {:?}] pub mod {} {{ use super::{root}::*;",
                item.doc, item.name
            );
            let series = item.series();
            if let [first, .., last] = series {
                self::series(out, item.index, first, last, series.len());
            }
            // Handles that have a constant of their own.
            let own = |handles, series: &[Handle]| -> Vec<&Handle> {
                let handles: &[Handle] = handles;
                let (first, len) = (series.first().map(|first| first.sub), series.len());
                let is_one = |handle: &&Handle| {
                    let from = |first| handle.sub.checked_sub(first);
                    handle.is_renamed()
                        || first.and_then(from).is_none_or(|at| usize::from(at) >= len)
                };
                handles.iter().filter(is_one).collect()
            };
            let others =
                family.map_or_else(Vec::new, |family| own(family.members(), family.series()));
            let mut handed_on = Vec::new();
            for handle in own(handles, series) {
                match others.iter().find(|other| other.alike(handle)) {
                    Some(other) => handed_on.push(hand_on(&other.name, &handle.name)),
                    None => constant(out, item.index, handle),
                }
            }
            if let (Some(family), false) = (family, handed_on.is_empty()) {
                let list = handed_on.join(", ");
                let _ = writeln!(out, "pub use super::super::{}::{{{list}}};", family.name);
            }
            out.push_str("}\n");
        }
    }
}

/// The handles of a long ARRAY as one constant, since one for each handle takes the compiler too long.
fn series(out: &mut String, index: u16, first: &Handle, last: &Handle, count: usize) {
    let rust_type = first.rust_type().replacen("Var<", "Series<", 1);
    let doc = format!(
        "{index:04X}h:{:02X} {:?} to {index:04X}h:{:02X} {:?}; `at(sub)` is the handle of one.",
        first.sub,
        first.label(),
        last.sub,
        last.label()
    );
    let (sub, offset, len) = (first.sub, first.slot.offset, first.slot.len);
    let bits = first.data_type.bits().unwrap_or_default();
    let _ = writeln!(
        out,
        "#[doc = {doc:?}] pub const ENTRIES: {rust_type} = \
         __s(__v({index:#06X}, {sub}, {offset}, {len}, {bits}), {count});"
    );
}

/// The handle of a value, and its address for patterns: `LIMIT`, `LIMIT::ADDRESS`.
fn constant(out: &mut String, index: u16, handle: &Handle) {
    let Handle {
        name,
        doc,
        sub,
        slot,
        ..
    } = handle;
    let rust_type = handle.rust_type();
    let _ = write!(out, "#[doc = {doc:?}] pub const {name}: {rust_type} = ");
    let (offset, len) = (slot.offset, slot.len);
    let _ = match handle.data_type.bits() {
        Some(bits) => writeln!(out, "__v({index:#06X}, {sub}, {offset}, {len}, {bits});"),
        None => writeln!(out, "__t({index:#06X}, {sub}, {offset}, {len});"),
    };
    let _ = writeln!(out, "__a!({name} {index:#06X} {sub});");
}

/// `DICTIONARY` with its tables inside, so that they need no names outside.
fn dictionary(out: &mut String, root: &str, tables: &Tables) {
    let objects = tables.dictionary().objects().len();
    let (rows, pool) = tables.parts();
    let (entries, words) = (rows.len(), pool.len());
    let names = tables.names();
    let name_bytes = names.rows.iter().flatten().copied();
    let shape = tables.shape();
    let _ = write!(
        out,
        "#[doc = \"The object dictionary: {objects} objects, {entries} values.\"]
pub const DICTIONARY: {root}::Dictionary<'static> = {{
use {root}::*;
static ROWS: [Row; {entries}] = rows(&["
    );
    for row in rows {
        let _ = write!(out, "{:#x},", row.number());
    }
    let _ = write!(out, "]);\nstatic POOL: [u32; {words}] = [");
    for word in pool {
        let _ = write!(out, "{word},");
    }
    let (number, make, kind) = if entries <= SMALL {
        ("u8", "small_buckets", "Bytes")
    } else {
        ("u16", "buckets", "Words")
    };
    let _ = write!(
        out,
        "];
static BUCKETS: [{number}; bucket_count({entries})] = {make}(&ROWS);
Dictionary::trusted(Buckets::{kind}(&BUCKETS), &ROWS, &POOL, {:?}, ",
        tables.text()
    );
    bytes(out, tables.blob().iter().copied());
    let functions = |kind: &str, is_some| {
        if is_some {
            format!("{kind}::SOME")
        } else {
            String::from("::core::option::Option::None")
        }
    };
    let (reals, varying) = (
        functions("Reals", Reals::of(rows).is_some()),
        functions("Varying", Varying::of(rows).is_some()),
    );
    let (store_len, longest, has_streams) = (shape.store_len, shape.longest, shape.has_streams);
    let _ = write!(
        out,
        ", Shape {{ store_len: {store_len}, longest: {longest}, has_streams: {has_streams}, reals: {reals}, \
         varying: {varying} }}, Names {{ rows: names("
    );
    bytes(out, name_bytes);
    let _ = write!(
        out,
        "), text: {:?} }})
}};
#[doc = \"Bytes that a store of the values needs.\"]
pub const STORE_LEN: usize = DICTIONARY.store_len();
",
        names.text
    );
}

/// The device as a type, and its node.
fn node(out: &mut String, root: &str, services: &str) {
    let _ = write!(
        out,
        "#[doc = \"The device of [`DICTIONARY`], as a type.\"]
#[derive(Clone, Copy, Debug, Default)]
pub struct Device;
impl {root}::Services for Device {{
const DICTIONARY: ::core::option::Option<{root}::Dictionary<'static>> =
::core::option::Option::Some(DICTIONARY);
{services}}}
{root}::rooms!(Device);
#[doc = \"A node of this device, with the behaviour `A` and the storage `S`.\"]
pub type Node<A = {root}::NoApplication, S = {root}::NoStorage> = {root}::Node<Device, A, S>;
"
    );
}

/// A byte string literal. Most bytes are 0, which `escape_ascii` would write with four letters.
fn bytes(out: &mut String, bytes: impl Iterator<Item = u8>) {
    out.push_str("b\"");
    for byte in bytes {
        match byte {
            0 => out.push_str("\\0"),
            other => out.extend(other.escape_ascii().map(char::from)),
        }
    }
    out.push('"');
}
