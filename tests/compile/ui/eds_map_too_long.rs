//! A mapping past the 64 bits of a frame.

use odkit::object_dictionary;

object_dictionary! {
    mod device {
        warnings = off;
        eds = "eds/map_too_long.eds";
    }
}

fn main() {}
