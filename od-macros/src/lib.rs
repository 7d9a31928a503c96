//! `object_dictionary!`: an EDS file, or rows in the source, become a typed `const`
//! object dictionary.
//!
//! ```
//! use odkit::object_dictionary;
//! use odkit::typed::{Mapping, pdo};
//!
//! object_dictionary! {
//!     /// A thermometer.
//!     pub mod thermometer {
//!         add 0x1000 { name = "Device type"; type = u32; access = const; default = 0 }
//!         add 0x1001 { name = "Error register"; type = u8; mappable = true }
//!         add 0x1018 { code = record; name = "Identity object" }
//!         add 0x1018sub1 { name = "Vendor-ID"; type = u32; default = 0x5F }
//!         add 0x2000 { name = "Temperature"; type = i16; mappable = true; low = -400; high = 1250 }
//!         add 0x2001 { name = "Fahrenheit"; type = bool; access = rw; default = false }
//!
//!         variant outdoor {
//!             modify 0x2000 { low = -900 }
//!             remove 0x2001;
//!         }
//!     }
//! }
//!
//! const TPDO1: Mapping<2> = pdo([thermometer::TEMPERATURE.map(), thermometer::ERROR_REGISTER.map()]);
//!
//! let entry = thermometer::DICTIONARY.entry(0x2000, 0).unwrap();
//! assert_eq!(thermometer::DICTIONARY.text(entry.name), "Temperature");
//! assert!(thermometer::outdoor::DICTIONARY.entry(0x2001, 0).is_none());
//! assert_eq!(thermometer::identity_object::VENDOR_ID.address().sub, 1);
//! ```
//!
//! The calling crate depends on `odkit`; if its path is not `::odkit`, `crate = path;` gives the path.
//!
//! # Grammar
//!
//! ```text
//! call      = { attribute } [ visibility ] "mod" name "{" { item } "}"
//! item      = "eds" "=" "path" [ "+" "path" ] ";"  relative to this source file; an overlay
//!           | "crate" "=" path ";"                 path of `odkit`, if not ::odkit
//!           | "profile" "=" cia406 ";"             checked against 1000h, nothing else
//!           | "without" service { "," service } ";"  the node of the device has no code for these:
//!                        lss, segmented, block (SDO transfers), rpdos, changes (PDOs when a value
//!                        changes), guarding, consumer (heartbeat), storage, behaviour (1029h), events,
//!                        servers (SDO servers past the first), sync_producer, time, deadlines (of
//!                        RPDOs), sync_length (of SYNC messages)
//!           | "behaves" "=" path ";"               the device's `Profile`, known to the compiler
//!           | "warnings" "=" off ";"                 warnings of the rules are not shown
//!           | "errors" "=" 4 ";"                   number of EMCY errors that can be active, and come or
//!                                                  go in one call; 32 unless given
//!           | { attribute } "variant" name "{" { statement } "}"
//!           | statement
//! statement = "add" target "{" fields "}"          an object that does not exist yet
//!           | "modify" target "{" fields "}"       an object that exists
//!           | "remove" target ";"
//!           | "rename" target "=" IDENTIFIER ";"   the handle, not the object
//! target    = 0x6004 | 0x1018sub2                  sub-indices are hex, as in the EDS
//! fields    = [ field { ";" field } [ ";" ] ]
//! field     = "name" "=" "text"
//!           | "type" "=" u8 … u64, i8 … i64, f32, f64, bool, str, or UNSIGNED24,
//!                        OCTET_STRING, DOMAIN … as CiA 301 spells them
//!           | "access" "=" ro | wo | rw | rwr | rww | const
//!           | "default" "=" value | "low" "=" value | "high" "=" value
//!           | "mappable" "=" true | false
//!           | "save" "=" communication | application | manufacturer | none
//!           | "code" "=" var | array | record | domain
//!           | "capacity" "=" 1024                  bytes of a string or DOMAIN that the store holds
//! value     = 42 | -1 | 0x1F | 1.5 | true | "text" | b"bytes" | none
//!           | "$NODEID" [ "+" 0x180 ]              "NODEID" inside macro_rules
//! ```
//!
//! `add` needs `name` and `type`. The defaults of the other fields: `access = ro`, `code = var`,
//! `mappable = false`, `capacity = 64` (1,024 for a DOMAIN that a master can write, and never less than the default
//! value needs). With `capacity = 0` the store does not hold the value, and the application streams it. Add a
//! RECORD or an ARRAY first, then its sub-objects. Sub-index 0 is added automatically unless an `add` gives it
//! (of 1003h with 0: no error), and it is adapted when a patch adds or removes sub-objects. `none` removes a default or a limit.
//!
//! The statements of the module make the base; each variant starts from it. It is an error to edit a missing
//! object, or to add an existing one. The checks apply to the result, so a call can correct errors in a file
//! that must not be changed: `modify 0x2300 { default = 1 }` replaces an invalid default.
//!
//! # Generated module
//!
//! The module contains `DICTIONARY`, `STORE_LEN`, the type `Device`, of which `odkit::Node::new` makes a node, the type
//! `Node<A, S>` of such a node, and a handle for every value: constants
//! for VARs, modules of constants for RECORDs and ARRAYs. Their names come from the names in the
//! EDS: `Device type` becomes `DEVICE_TYPE`, `Identity object` the module
//! `identity_object`. Characters other than letters and digits separate words. **Names that
//! repeat all get their index or sub-index as a suffix**: `RESERVED_2110`, `RESERVED_2111`
//! or `RESERVED_05`. `rename` gives better names; two renames to the same name are an
//! error. A name that is also that of a variant or of an item of the module gets its index, too.
//! The documentation of every item gives index, type, access, default, limits and its place in the EDS.
//!
//! An application that gets an address compares it with a handle, `address == thermometer::TEMPERATURE`. In a pattern it
//! is a constant beside the handle: `match address { thermometer::TEMPERATURE::ADDRESS => … }`.
//!
//! An ARRAY of more than 64 sub-objects of one type has one constant for them, `ENTRIES`, and
//! `ENTRIES.at(5)` is the handle of sub-index 5; a `rename` of one of them gives it a constant, too.
//!
//! A variant is a module inside this module: `thermometer::outdoor` has its own `DICTIONARY` and
//! re-exports the handles of objects that it keeps, so a removed object has no handle there.
//! The family has one storage layout: **a handle of the family works with the store of every
//! variant that keeps the object and its type**, so code for all variants is written once, with the
//! family's handles.
//!
//! # Errors
//!
//! The macro reports all errors at once: those of the call at their tokens, those of the EDS at its path with
//! `file:line:column` in the text. It still makes the module from the valid parts, so that one mistake is
//! one error, and a statement that cannot be read does not hide the mistakes of other statements.
//!
//! Findings of `odkit check` that do not prevent a device become warnings of the compiler: those of a file at its path,
//! one warning for each rule with its first place; those of a statement at its token. The warning is the lint
//! `deprecated` of rustc, the only one that a macro can cause: `use of deprecated constant W0452: …`. `warnings = off;`
//! hides warnings, and a comment `;odkit-allow=CODE reason` in the file allows a finding.
//!
//! A change of the EDS causes a rebuild. The binary contains only names, texts and values of the EDS, not its
//! other text.

mod docs;
mod emit;
mod family;
mod fields;
mod files;
mod findings;
mod handles;
mod input;
mod names;
mod near_names;
mod profile;
mod report;
mod services;
mod source;
mod words;

use proc_macro2::TokenStream;

/// A module with a typed, const object dictionary, from an EDS file or from rows. See the crate.
#[proc_macro]
pub fn object_dictionary(input: proc_macro::TokenStream) -> proc_macro::TokenStream {
    expand(input.into()).into()
}

/// Parses, builds and emits; errors are reported in addition to the valid parts.
fn expand(tokens: TokenStream) -> TokenStream {
    let mut report = report::Report::default();
    let made = input::Input::read(tokens, &mut report).map(|mut input| {
        let source = source::read(&input, &mut report);
        if input.eds.is_some() && source.paths.is_empty() {
            report.lose();
        }
        let family = family::build(&input, &source, &mut report);
        input.services.keep(&family.needed);
        emit::module(&input, &source, &family)
    });
    let mut tokens = report.into_tokens();
    tokens.extend(made);
    tokens
}

#[cfg(test)]
mod tests {
    use quote::quote;

    use super::*;

    /// The complete output for a small module, so that a change of it is seen.
    #[test]
    fn a_small_module_has_these_items() {
        let made = expand(quote! {
            pub mod device {
                add 0x1000 { name = "Device type"; type = u32; default = 0x196 }
                add 0x1001 { name = "Error register"; type = u8; mappable = true }
                add 0x1018 { code = record; name = "Identity" }
                add 0x1018sub1 { name = "Vendor-ID"; type = u32; access = const; default = 7 }
                add 0x2000 { name = "Speed"; type = u16; access = rw; default = 7 }
                variant blind { remove 0x2000; }
            }
        });
        let tight = |text: &str| text.replace([' ', '\n'], "");
        let made = tight(&made.to_string());
        let (_, base) = made.split_once("pubmoddevice").unwrap();
        let (base, variant) = base.split_once("pubmodblind").unwrap();
        for part in [
            "mod __odkit { pub use ::odkit::__private8::{",
            "pub const DICTIONARY: __odkit::Dictionary<'static> =",
            "static ROWS: [Row; 5] = rows(&[0x",
            "Shape { store_len: 7, longest: 4, has_streams: false, reals: ::core::option::Option::None,",
            "Names { rows: names(b\"",
            "pub const ERROR_REGISTER: Var<u8, Ro, Pdo> = __v(0x1001, 0, 4, 1, 8);",
            "pub mod identity {",
            "pub const VENDOR_ID: Var<u32, Const> = __v(0x1018, 1, 0, 0, 32);",
            "pub const STORE_LEN: usize = DICTIONARY.store_len();",
            "__odkit::rooms!(Device);",
            "pub type Node<A = __odkit::NoApplication, S = __odkit::NoStorage> = __odkit::Node<Device, A, S>;",
        ] {
            assert!(base.contains(&tight(part)), "{part}\n\n{base}");
        }
        let handed_on = tight("pub use super::{DEVICE_TYPE, ERROR_REGISTER, identity};");
        assert!(variant.contains(&handed_on), "{variant}");
        assert!(!variant.contains("SPEED"));
        assert!(!made.contains("compile_error"), "{made}");
    }

    /// Limit of the output for each entry: an IDE keeps it, and the compiler reads it for each build.
    #[test]
    fn an_entry_costs_few_tokens() {
        let made = |count: usize| {
            let row = |i| {
                format!(
                    "add 0x{:04X} {{ name = \"Temperature of channel {i}\"; type = i32; \
                     access = rw; default = {i}; low = -200000; high = 200000 }}",
                    0x2000 + i
                )
            };
            let rows: String = (0..count).map(row).collect();
            let text = format!(
                "mod device {{ add 0x1000 {{ name = \"Type\"; type = u32 }} \
                 add 0x1001 {{ name = \"Error register\"; type = u8 }} \
                 add 0x1018 {{ code = record; name = \"Identity\" }} \
                 add 0x1018sub1 {{ name = \"Vendor-ID\"; type = u32; default = 7 }} {rows} }}"
            );
            let made = expand(text.parse().unwrap());
            let text = made.to_string();
            assert!(!text.contains("compile_error"), "{text}");
            (tokens(made), text.len())
        };
        let (few, short) = made(10);
        let (many, long) = made(510);
        let (tokens, bytes) = ((many - few) / 500, (long - short) / 500);
        assert!(tokens <= 40, "{tokens} tokens for each value");
        assert!(bytes <= 700, "{bytes} bytes for each value");
    }

    fn tokens(stream: TokenStream) -> usize {
        let count = |token| match token {
            proc_macro2::TokenTree::Group(group) => 2 + tokens(group.stream()),
            _ => 1,
        };
        stream.into_iter().map(count).sum()
    }

    #[test]
    fn after_a_fault_the_rest_is_made() {
        let made = expand(quote! {
            mod device {
                add 0x2000 { name = "Speed"; type = u16 }
                add 0x2001 { name = "Torque"; type = uint16 }
            }
        });
        let made = made.to_string();
        // The type, and the mandatory objects 1000h, 1001h and 1018h.
        assert_eq!(made.matches("compile_error").count(), 4, "{made}");
        assert!(made.contains("SPEED") && made.contains("DICTIONARY"));
    }

    /// A device whose objects depend on each other: PDOs, SYNC, EMCY, SDO, saved values.
    const WIDE: &str = r#"
        add 0x1000 { name = "Device type"; type = u32; access = const; default = 0x191 }
        add 0x1001 { name = "Error register"; type = u8; mappable = true }
        add 0x1003 { code = array; name = "Error history" }
        add 0x1003sub0 { name = "Number of errors"; type = u8; access = rw; default = 0 }
        add 0x1003sub1 { name = "Error"; type = u32 }
        add 0x1005 { name = "COB-ID SYNC"; type = u32; access = rw; default = 0x80 }
        add 0x1010 { code = array; name = "Store parameters" }
        add 0x1010sub1 { name = "Save all"; type = u32; access = rw; default = 1 }
        add 0x1011 { code = array; name = "Restore parameters" }
        add 0x1011sub1 { name = "Restore all"; type = u32; access = rw; default = 1 }
        add 0x1014 { name = "COB-ID EMCY"; type = u32; access = rw; default = $NODEID + 0x80 }
        add 0x1016 { code = array; name = "Consumers" }
        add 0x1016sub1 { name = "Consumer"; type = u32; access = rw; default = 0 }
        add 0x1017 { name = "Producer heartbeat time"; type = u16; access = rw; default = 0 }
        add 0x1018 { code = record; name = "Identity" }
        add 0x1018sub1 { name = "Vendor-ID"; type = u32; default = 7 }
        add 0x1019 { name = "SYNC counter overflow"; type = u8; access = rw; default = 0 }
        add 0x1200 { code = record; name = "SDO server" }
        add 0x1200sub1 { name = "Request"; type = u32; default = $NODEID + 0x600 }
        add 0x1200sub2 { name = "Response"; type = u32; default = $NODEID + 0x580 }
        add 0x1400 { code = record; name = "RPDO" }
        add 0x1400sub1 { name = "COB-ID of RPDO"; type = u32; access = rw; default = $NODEID + 0x200 }
        add 0x1400sub2 { name = "Type of RPDO"; type = u8; access = rw; default = 255 }
        add 0x1600 { code = record; name = "RPDO mapping" }
        add 0x1600sub0 { name = "Entries of RPDO"; type = u8; access = rw; default = 1 }
        add 0x1600sub1 { name = "Entry of RPDO"; type = u32; access = rw; default = 0x62000108 }
        add 0x1800 { code = record; name = "TPDO" }
        add 0x1800sub1 { name = "COB-ID of TPDO"; type = u32; access = rw; default = $NODEID + 0x180 }
        add 0x1800sub2 { name = "Type of TPDO"; type = u8; access = rw; default = 1 }
        add 0x1800sub3 { name = "Inhibit time"; type = u16; access = rw; default = 0 }
        add 0x1800sub6 { name = "SYNC start value"; type = u8; access = rw; default = 0 }
        add 0x1A00 { code = record; name = "TPDO mapping" }
        add 0x1A00sub0 { name = "Entries of TPDO"; type = u8; access = rw; default = 2 }
        add 0x1A00sub1 { name = "Entry of TPDO"; type = u32; access = rw; default = 0x60000108 }
        add 0x1A00sub2 { name = "Second entry of TPDO"; type = u32; access = rw; default = 0x20000020 }
        add 0x2000 { name = "Position"; type = i32; mappable = true; low = -9; high = 9; default = 1 }
        add 0x6000 { code = array; name = "Inputs" }
        add 0x6000sub1 { name = "Inputs 1 to 8"; type = u8; mappable = true; default = 0 }
        add 0x6200 { code = array; name = "Outputs" }
        add 0x6200sub1 { name = "Outputs 1 to 8"; type = u8; access = rww; mappable = true; default = 0 }"#;

    /// Errors of a call with these statements.
    fn errors(statements: &str) -> Vec<String> {
        errors_of(&format!(
            "mod device {{ profile = cia401; {statements} \
             rename 0x2000 = TURN; rename 0x1018sub1 = MAKER; \
             variant small {{ remove 0x1A00sub2; modify 0x1800sub2 {{ default = 255 }} }} }}"
        ))
    }

    /// Errors of a call.
    fn errors_of(text: &str) -> Vec<String> {
        let made = expand(text.parse().unwrap()).to_string();
        let (_, errors) =
            made.split_at(made.find(":: core :: compile_error").unwrap_or(made.len()));
        let mut errors: Vec<String> = errors
            .split(":: core :: compile_error")
            .map(String::from)
            .collect();
        errors.remove(0);
        errors
    }

    /// A statement that cannot be read has no second error by what other statements say about its object, and it
    /// does not hide the mistakes of others.
    #[test]
    fn one_mistake_is_one_error() {
        assert_eq!(errors(WIDE), [""; 0]);
        let rows: Vec<&str> = WIDE.lines().skip(1).collect();
        let other = "
            add 0x5000 { name = \"Other\"; type = u16; access = rw; default = 70000 }
            modify 0x1999 { default = 1 }
            rename 0x5000 = other;";
        for (at, row) in rows.iter().enumerate() {
            let wrong = [
                row.replacen("add", "plus", 1),
                row.replacen("name =", "title =", 1),
                row.replacen("type =", "kind =", 1),
                row.replacen("code =", "shape =", 1),
                row.replacen("access =", "rights =", 1),
                row.replacen("default =", "default", 1),
                row.replacen("mappable = true", "mappable = yes", 1),
                row.replacen(" {", " = {", 1),
                row.replacen("type = u", "type = v", 1),
                row.replacen("access = rw", "access = const; default = \"text\"", 1),
            ];
            // A third of them, since each takes milliseconds.
            for (kind, wrong) in wrong.iter().enumerate() {
                if wrong == row || (at + kind) % 3 != 0 {
                    continue;
                }
                let mut rows = rows.clone();
                rows[at] = wrong;
                let told = errors(&format!("{}{other}", rows.join("\n")));
                assert_eq!(told.len(), 4, "{wrong}: {told:#?}");
            }
        }
    }

    /// After a missing semicolon each kind of item is read.
    #[test]
    fn a_missing_semicolon_hides_no_item() {
        for item in [
            "profile = cia401;",
            "without lss;",
            "behaves = PROFILE;",
            "errors = 4;",
            "crate = ::other::odkit;",
            "warnings = off;",
            "add 0x3000 { name = \"Speed\"; type = u16 }",
            "modify 0x1000 { default = 0x191 }",
            "variant small { }",
        ] {
            let errors = errors_of(&format!(
                "mod device {{ {WIDE} rename 0x1000 = KIND {item} }}"
            ));
            assert_eq!(errors.len(), 1, "{item}");
            assert!(errors[0].contains("expected `;` after this"), "{item}");
        }
    }

    /// Any input gives errors, never a panic.
    #[test]
    fn any_input_gives_an_error() {
        for text in [
            "",
            "mod",
            "mod x",
            "mod x;",
            "mod x { add }",
            "mod x { add 0x1 }",
            "mod x { add 0x1 { = } }",
            "mod x { add 0x1 { default = - } }",
            "mod x { add 0x1 { default = $ } }",
            "mod x { add 0x1 { default = $NODEID + } }",
            "mod x { add 0x1 { default = 1 + } }",
            "mod x { add 0x1 { default = 99999999999999999999999999999999999999999 } }",
            "mod x { add 0x1 { name = b\"x\" } }",
            "mod x { rename 0x1 }",
            "mod x { rename 0x1 = self; }",
            "mod x { eds }",
            "mod x { eds = 5; }",
            "mod x { variant }",
            "mod x { variant v; }",
            "mod x { variant v { variant w {} } }",
            "mod x { #[doc = 1] }",
            "mod x { ; }",
            "mod x { 0x1018 }",
            "mod x { profile = ; }",
        ] {
            let made = expand(text.parse().unwrap()).to_string();
            assert!(made.contains("compile_error"), "{text}: {made}");
        }
    }
}
