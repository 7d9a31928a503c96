//! More faults than are shown.

use od_macros::object_dictionary;

object_dictionary! {
    mod device {
        eds = "eds/many.eds";
    }
}

fn main() {}
