//! A path that is no text.

use od_macros::object_dictionary;

object_dictionary! {
    mod device {
        eds = device.eds;
    }
}

fn main() {}
