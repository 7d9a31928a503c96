//! A default that is no number.

use od_macros::object_dictionary;

object_dictionary! {
    mod device {
        eds = "eds/default_no_number.eds";
    }
}

fn main() {}
