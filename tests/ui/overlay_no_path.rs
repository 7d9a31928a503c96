//! A path is a text.

use od_macros::object_dictionary;

object_dictionary! {
    mod device {
        eds = "../eds/small.eds" + overlay;
    }
}

fn main() {}
