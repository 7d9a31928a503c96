//! Sub-index 0 that is not the highest sub-index.

use odkit::object_dictionary;

object_dictionary! {
    mod device {
        warnings = off;
        eds = "eds/count_is_wrong.eds";
    }
}

fn main() {}
