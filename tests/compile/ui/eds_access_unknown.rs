//! An object with an unknown access type.

use odkit::object_dictionary;

object_dictionary! {
    mod device {
        warnings = off;
        eds = "eds/access_unknown.eds";
    }
}

fn main() {}
