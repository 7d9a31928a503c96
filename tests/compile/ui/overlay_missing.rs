//! The overlay's name is nearly right.

use odkit::object_dictionary;

object_dictionary! {
    mod device {
        eds = "../../eds/small.eds" + "eds/wrong.overlaay";
    }
}

fn main() {}
