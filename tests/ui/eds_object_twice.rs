//! An object described twice.

use od_macros::object_dictionary;

object_dictionary! {
    mod device {
        eds = "eds/object_twice.eds";
    }
}

fn main() {}
