//! A file with a name that is nearly right.

use od_macros::object_dictionary;

object_dictionary! {
    mod device {
        eds = "eds/mny.eds";
    }
}

fn main() {}
