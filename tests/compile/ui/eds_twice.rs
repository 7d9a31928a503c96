//! Two files for one family.

use odkit::object_dictionary;

object_dictionary! {
    mod device {
        warnings = off;
        eds = "eds/skeleton.eds";
        eds = "eds/many.eds";
    }
}

fn main() {}
