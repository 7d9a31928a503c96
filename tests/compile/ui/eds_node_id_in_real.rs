//! `$NODEID` in a real number.

use odkit::object_dictionary;

object_dictionary! {
    mod device {
        eds = "eds/node_id_in_real.eds";
    }
}

fn main() {}
