//! An object with a data type that there is not.

use odkit::object_dictionary;

object_dictionary! {
    mod device {
        eds = "eds/type_unknown.eds";
    }
}

fn main() {}
