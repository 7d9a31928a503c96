//! A file that does not exist.

use odkit::object_dictionary;

object_dictionary! {
    mod device {
        eds = "elsewhere/device.eds";
    }
}

fn main() {}
