//! A missing object cannot be removed.

use odkit::object_dictionary;

object_dictionary! {
    mod device {
        eds = "../../eds/small.eds" + "eds/removes_nothing.overlay";
    }
}

fn main() {}
