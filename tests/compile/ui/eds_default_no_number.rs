//! A default that is not a number.

use odkit::object_dictionary;

object_dictionary! {
    mod device {
        warnings = off;
        eds = "eds/default_no_number.eds";
    }
}

fn main() {}
