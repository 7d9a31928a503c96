//! A folder instead of a file.

use odkit::object_dictionary;

object_dictionary! {
    mod device {
        eds = "eds";
    }
}

fn main() {}
