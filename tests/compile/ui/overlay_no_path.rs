//! A path is a text.

use odkit::object_dictionary;

object_dictionary! {
    mod device {
        eds = "../../eds/small.eds" + overlay;
    }
}

fn main() {}
