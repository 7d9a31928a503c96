//! An overlay with an unresolved merge conflict.
use odkit::object_dictionary;

object_dictionary! {
    mod device {
        eds = "../../eds/small.eds" + "eds/merge_conflict.overlay";
    }
}

fn main() {}
