//! A mistake in an overlay is reported in the overlay.

use odkit::object_dictionary;

object_dictionary! {
    mod device {
        warnings = off;
        eds = "../../eds/small.eds" + "eds/wrong.overlay";
    }
}

fn main() {}
