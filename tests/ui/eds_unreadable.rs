//! A folder instead of a file.

use od_macros::object_dictionary;

object_dictionary! {
    mod device {
        eds = "eds";
    }
}

fn main() {}
