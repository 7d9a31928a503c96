//! Sub-index 0 that says something else than the members.

use odkit::object_dictionary;

object_dictionary! {
    mod device {
        eds = "eds/count_is_wrong.eds";
    }
}

fn main() {}
