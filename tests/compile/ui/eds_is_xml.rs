//! The file is an XDD.
use odkit::object_dictionary;

object_dictionary! {
    mod device {
        eds = "eds/device.xdd";
    }
}

fn main() {}
