//! An object with an access type that there is not.

use odkit::object_dictionary;

object_dictionary! {
    mod device {
        eds = "eds/access_unknown.eds";
    }
}

fn main() {}
