//! A file without 1018h.

use odkit::object_dictionary;

object_dictionary! {
    mod device {
        warnings = off;
        eds = "eds/no_identity.eds";
    }
}

fn main() {}
