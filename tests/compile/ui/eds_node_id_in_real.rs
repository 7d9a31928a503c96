//! `$NODEID` in a real number.

use odkit::object_dictionary;

object_dictionary! {
    mod device {
        warnings = off;
        eds = "eds/node_id_in_real.eds";
    }
}

fn main() {}
