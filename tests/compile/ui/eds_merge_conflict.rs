//! A file with the marks of a merge conflict.
use odkit::object_dictionary;

object_dictionary! {
    mod device {
        warnings = off;
        eds = "eds/merge_conflict.eds";
    }
}

fn main() {}
