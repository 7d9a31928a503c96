//! A path that is not a text.

use odkit::object_dictionary;

object_dictionary! {
    mod device {
        eds = device.eds;
    }
}

fn main() {}
