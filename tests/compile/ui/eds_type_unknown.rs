//! An object with an unknown data type.

use odkit::object_dictionary;

object_dictionary! {
    mod device {
        warnings = off;
        eds = "eds/type_unknown.eds";
    }
}

fn main() {}
