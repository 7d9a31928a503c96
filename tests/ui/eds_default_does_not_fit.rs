//! A default longer than its type.

use od_macros::object_dictionary;

object_dictionary! {
    mod device {
        eds = "eds/default_does_not_fit.eds";
    }
}

fn main() {}
