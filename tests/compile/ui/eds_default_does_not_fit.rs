//! A default longer than its type.

use odkit::object_dictionary;

object_dictionary! {
    mod device {
        warnings = off;
        eds = "eds/default_does_not_fit.eds";
    }
}

fn main() {}
