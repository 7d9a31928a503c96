//! A file that is not there.

use odkit::object_dictionary;

object_dictionary! {
    mod device {
        eds = "elsewhere/device.eds";
    }
}

fn main() {}
