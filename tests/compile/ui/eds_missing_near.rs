//! A file with a name that is nearly right.

use odkit::object_dictionary;

object_dictionary! {
    mod device {
        eds = "eds/mny.eds";
    }
}

fn main() {}
