//! The datasheet of a device, from its dictionary and profiles.
//!
//! The texts are ours; the facts come from dictionary and profiles, so a page agrees with
//! the behaviour of the device.

mod encoder;
mod notes;
mod services;

use std::format;
use std::prelude::v1::*;

use od_eds::convert::markdown::{identity, objects, section};
use odkit::DeviceKind;

/// The datasheet of a built-in device, in Markdown.
///
/// Links lead from `docs/datasheets` to the scripts of its family.
pub fn page(kind: &DeviceKind) -> String {
    let mut page = format!(
        "# {}\n\n{}. A virtual device of odkit: `odkit sim {}`, `odkit export {}`.\n\
         Shown by [scripts](../../tests/conformance/{}) of its family.\n\n\
         This page is generated: `odkit dump {} --format md`.\n",
        kind.name, kind.title, kind.name, kind.name, kind.family, kind.name
    );
    section(&mut page, "Identity", &["", ""], &identity(kind.dictionary));
    if let Some(profile) = kind.encoder() {
        let facts = encoder::facts(kind, profile);
        section(&mut page, "Encoder", &["", ""], &facts);
    }
    section(&mut page, "Services", &["", ""], &services::facts(kind));
    if let Some(profile) = kind.encoder() {
        let faults = encoder::faults(kind, profile);
        section(&mut page, "Faults", &encoder::fault_head(profile), &faults);
    }
    page.push_str("\n## Objects\n\n");
    page.push_str(&objects(kind.dictionary, |address| {
        notes::note(kind, address)
    }));
    page
}
