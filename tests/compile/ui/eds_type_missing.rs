//! An object without DataType.

use odkit::object_dictionary;

object_dictionary! {
    mod device {
        warnings = off;
        eds = "eds/type_missing.eds";
    }
}

fn main() {}
