//! Limits the wrong way round.

use odkit::object_dictionary;

object_dictionary! {
    mod device {
        warnings = off;
        eds = "eds/limits_swapped.eds";
    }
}

fn main() {}
