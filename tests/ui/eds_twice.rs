//! Two files for one family.

use od_macros::object_dictionary;

object_dictionary! {
    mod device {
        eds = "eds/skeleton.eds";
        eds = "eds/many.eds";
    }
}

fn main() {}
