//! A compiled device as an EDS, for masters and tools that need a file.

use std::format;
use std::prelude::v1::*;

use odkit::DeviceKind;

/// Date of the facts; it does not change when a file is written.
const DATE: &str = "11-21-2026";

const COMMENTS: &[&str] = &[
    "Written by odkit from the facts of the manual; not the manufacturer's file.",
    "StorageLocation comments name the group of 1010h that saves a value.",
];

/// Bit rates of the LSS table, for a device that has no object for its bit rate.
const LSS_RATES: &[u16] = &[10, 20, 50, 125, 250, 500, 800, 1000];

/// Name of its EDS file: its name in capitals.
pub fn eds_name(kind: &DeviceKind) -> String {
    format!("{}.eds", kind.name.to_uppercase())
}

/// Its EDS. Parsing it gives the same dictionary.
///
/// ```
/// let gcam = od_devices::find("gcam").unwrap();
/// assert!(od_devices::text::eds(gcam).contains("ProductName=GCAM\n"));
/// ```
pub fn eds(kind: &DeviceKind) -> String {
    let file = eds_name(kind);
    let about = od_eds::About {
        file: &file,
        description: kind.title,
        date: DATE,
        vendor: "odkit virtual devices",
        bit_rates: kind
            .encoder()
            .map_or(LSS_RATES, |encoder| encoder.bit_rates),
        lss: kind.profile.lss.is_some(),
        simple_boot_up: true,
        comments: COMMENTS,
    };
    od_eds::canonical(&od_eds::describe(kind.dictionary, &about))
}
